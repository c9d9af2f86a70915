//! States, hints, lenses and the reports of commands (R12.3, R12.4).

use serde_json::{Value, json};

use super::client::{Client, uri};
use crate::folder::Bench;

const LOOP: &str = "\
N10 P1 = 0
N20 $WHILE P1 < 3
N30 X[COMP OFF FRICT]
N40 LL SWITCH
N50 P1 = P1 + 1
N60 $ENDWHILE
N70 Y[COMP OFF FRICT]
N80 M30
%L SWITCH
N90 $IF P1 == 1
N100 X[COMP ON FRICT]
N110 $ENDIF
N120 M17
";

const INVALID_PARAMS: i32 = -32602;

/// Returns a program on the machine of the tests, open.
fn opened(text: &str) -> (Bench, Client, String) {
    let bench = Bench::new(&[("a.nc", "M30\n")]);
    let uri = uri(&bench.folder().join("a.nc"));
    let mut client = Client::new();
    client.open(&uri, text);
    (bench, client, uri)
}

fn at(uri: &str, line: u32) -> Value {
    json!({ "textDocument": { "uri": uri }, "position": { "line": line, "character": 3 } })
}

fn hover(client: &mut Client, uri: &str, line: u32) -> String {
    let hover = client.ask("textDocument/hover", &at(uri, line));
    hover["contents"]["value"]
        .as_str()
        .unwrap_or_default()
        .to_owned()
}

#[test]
fn a_block_shows_the_states_before_and_after_it() {
    // R12.3
    let (_bench, mut client, uri) = opened("N10 G1 X5 F100\nN20 X[COMP \\\nOFF FRICT]\nN30 M30\n");
    let text = hover(&mut client, &uri, 0);
    assert!(text.contains("| X | active | active |"), "{text}");
    assert!(
        text.contains("| Z | unconfigured | unconfigured |"),
        "{text}"
    );
    for line in [1, 2] {
        let text = hover(&mut client, &uri, line);
        assert!(text.contains("| X | active | inactive |"), "{text}");
        assert!(!text.contains("times"), "{text}");
    }
    assert_eq!(hover(&mut client, &uri, 99), "");
    client.leave();
}

#[test]
fn a_loop_shows_the_states_of_all_passes() {
    // R12.3
    let (_bench, mut client, uri) = opened(LOOP);
    let text = hover(&mut client, &uri, 2);
    assert!(
        text.contains("| X | active (2 of 3), inactive (1 of 3) | inactive |"),
        "{text}"
    );
    assert!(text.contains("executed 3 times"), "{text}");
    let text = hover(&mut client, &uri, 10);
    assert!(text.contains("| X | inactive | active |"), "{text}");
    client.drop_all();
}

#[test]
fn a_file_name_is_no_markdown() {
    // R12.16
    let called = "X[COMP ON FRICT]\nM17\n";
    let bench = Bench::new(&[("s.nc", called)]);
    let s = uri(&bench.folder().join("s.nc"));
    let reaching = format!("{}%60%5Ba%5D%28b%29%60.nc", s.trim_end_matches("s.nc"));
    let mut client = Client::new();
    client.open(&reaching, "L s.nc\nM30\n");
    client.open(&s, called);
    let text = hover(&mut client, &s, 0);
    let (_, named) = text.split_once("Called from ").expect("a reaching");
    assert!(named.starts_with("`` "), "{text}");
    assert!(named.contains("`[a](b)`.nc ``:"), "{text}");
    client.drop_all();
}

#[test]
fn a_called_program_shows_the_states_of_its_callers_that_are_open() {
    // R12.3
    let called = "G1 Y5 F100\nX[COMP ON FRICT]\nM17\n";
    let bench = Bench::new(&[("a.nc", "M30\n"), ("b.nc", "M30\n"), ("s.nc", called)]);
    let [a, b, s] = ["a.nc", "b.nc", "s.nc"].map(|name| uri(&bench.folder().join(name)));
    let mut client = Client::new();
    client.open(&a, "X[COMP OFF FRICT]\nL s.nc\nL s.nc\nM30\n");
    client.open(&b, "G1 X5 F100\nM30\n");
    client.open(&s, called);
    let text = hover(&mut client, &s, 1);
    let (own, callers) = text.split_once("Called from `").expect("a caller");
    assert!(own.contains("| X | active | active |"), "{text}");
    assert!(
        callers.contains("a.nc`") && !callers.contains("b.nc"),
        "{text}"
    );
    assert!(
        callers.contains("| X | inactive (1 of 2), active (1 of 2) | active |"),
        "{text}"
    );
    assert!(callers.contains("executed 2 times"), "{text}");
    client.drop_all();
}

#[test]
fn hints_stand_where_a_state_changes_and_at_the_end() {
    // R12.4
    let (_bench, mut client, uri) = opened(LOOP);
    let all = json!({
        "textDocument": { "uri": uri },
        "range": { "start": { "line": 0, "character": 0 }, "end": { "line": 99, "character": 0 } },
    });
    let hints = client.ask("textDocument/inlayHint", &all);
    let shown: Vec<(u64, &str)> = hints
        .as_array()
        .expect("a list")
        .iter()
        .map(|it| {
            (
                it["position"]["line"].as_u64().expect("a line"),
                it["label"].as_str().expect("text"),
            )
        })
        .collect();
    assert_eq!(
        shown,
        [
            (2, "X: active \u{2192} inactive (2 of 3)"),
            (6, "Y: active \u{2192} inactive"),
            (10, "X: inactive \u{2192} active"),
            (7, "leaves X inactive, Y inactive"),
        ]
    );
    assert_eq!(hints[0]["position"]["character"], 21);
    let part = json!({
        "textDocument": { "uri": uri },
        "range": { "start": { "line": 3, "character": 0 }, "end": { "line": 6, "character": 0 } },
    });
    assert_eq!(
        client
            .ask("textDocument/inlayHint", &part)
            .as_array()
            .map(Vec::len),
        Some(1)
    );
    client.tell(
        "workspace/didChangeConfiguration",
        &json!({ "settings": { "frictcomp": { "inlayHints": { "enable": false } } } }),
    );
    assert_eq!(client.ask("textDocument/inlayHint", &all), Value::Null);
    client.drop_all();
}

const WAYS: &str = "\
N10 G1 X1 F100
N20 $IF V.E.MATERIAL == 2
N30 X[COMP OFF FRICT]
N40 $ELSE
N50 G1 X2
N60 $ENDIF
N70 G1 X3
N80 M30
";

#[test]
fn an_unknown_state_says_when_it_is_which() {
    // R14.2
    let (_bench, mut client, uri) = opened(WAYS);
    let escaped = r"unknown \(inactive if V\.E\.MATERIAL \=\= 2 \(line 2\)\, else active\)";
    for line in [6, 7] {
        let text = hover(&mut client, &uri, line);
        let row = format!("| X | {escaped} | {escaped} |");
        assert!(text.contains(&row), "{text}");
    }
    let text = hover(&mut client, &uri, 2);
    assert!(text.contains("| X | active | inactive |"), "{text}");
    let text = hover(&mut client, &uri, 4);
    assert!(text.contains("| X | active | active |"), "{text}");

    let words = "X unknown (inactive if V.E.MATERIAL == 2 (line 2), else active)";
    let all = json!({
        "textDocument": { "uri": uri },
        "range": { "start": { "line": 0, "character": 0 }, "end": { "line": 99, "character": 0 } },
    });
    let hints = client.ask("textDocument/inlayHint", &all);
    let hints = hints.as_array().expect("a list").iter();
    let shown: Vec<_> = hints
        .map(|it| (it["position"]["line"].as_u64(), it["label"].as_str()))
        .collect();
    let met = words.replacen("X unknown", "X: unknown", 1);
    let left = format!("leaves {words}");
    assert_eq!(
        shown,
        [
            (Some(6), Some(met.as_str())),
            (Some(2), Some("X: active \u{2192} inactive")),
            (Some(7), Some(left.as_str())),
        ]
    );
    let text = json!({ "textDocument": { "uri": uri } });
    let lenses = client.ask("textDocument/codeLens", &text);
    let mut lenses = lenses.as_array().expect("a list").iter();
    assert!(lenses.any(|it| it["command"]["title"] == left.as_str()));
    client.drop_all();
}

#[test]
fn lenses_say_what_a_program_leaves() {
    // R12.4
    let (_bench, mut client, uri) = opened(LOOP);
    let text = json!({ "textDocument": { "uri": uri } });
    let lenses = client.ask("textDocument/codeLens", &text);
    let titles: Vec<&str> = lenses
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|it| it["command"]["title"].as_str())
        .collect();
    assert!(
        titles.contains(&"leaves X inactive, Y inactive"),
        "{titles:?}"
    );
    let show = lenses
        .as_array()
        .expect("a list")
        .iter()
        .find(|it| it["command"]["title"] == "Show timeline")
        .expect("a lens");
    let command = &show["command"];
    let shown = client.ask(
        "workspace/executeCommand",
        &json!({ "command": command["command"], "arguments": command["arguments"] }),
    );
    let html = shown["html"].as_str().expect("a page");
    assert!(
        html.starts_with("<!DOCTYPE html>") && html.contains("N100 X[COMP ON FRICT]"),
        "{html}"
    );
    client.drop_all();
}

#[test]
fn a_status_bar_asks_for_the_states_at_the_cursor() {
    // R12.3
    let (_bench, mut client, uri) = opened(LOOP);
    let states = client.ask("frictcomp/states", &at(&uri, 2));
    assert_eq!(
        states["axes"][0],
        json!({ "axis": "X", "before": ["active", "inactive"], "after": ["inactive"] })
    );
    assert_eq!(
        states["text"],
        "X active or inactive \u{2192} inactive, Y active, Z unconfigured"
    );
    assert_eq!(
        (&states["line"], &states["executed"], &states["times"]),
        (&json!(2), &json!(true), &json!(3))
    );
    // A line that is not a block shows the block before it.
    let states = client.ask("frictcomp/states", &at(&uri, 8));
    assert_eq!(
        (&states["line"], &states["executed"]),
        (&json!(7), &json!(false))
    );
    client.drop_all();
}

#[test]
fn a_timeline_view_asks_for_the_states_over_the_lines() {
    // R12.8
    let (_bench, mut client, uri) = opened(LOOP);
    let timeline = client.ask(
        "frictcomp/timeline",
        &json!({ "textDocument": { "uri": uri } }),
    );
    let axis = |at: usize| {
        let segments = timeline["axes"][at]["segments"].as_array().expect("a list");
        let segment = |it: &Value| (it["from"].as_u64(), it["to"].as_u64(), it["states"].clone());
        segments.iter().map(segment).collect::<Vec<_>>()
    };
    let (active, inactive) = (json!(["active"]), json!(["inactive"]));
    let either = |first: &str, other: &str| json!([first, other]);
    assert_eq!(
        axis(0),
        [
            (Some(0), Some(1), active.clone()),
            (Some(1), Some(2), either("active", "inactive")),
            (Some(2), Some(4), inactive.clone()),
            (Some(4), Some(6), either("inactive", "active")),
            (Some(6), Some(10), inactive.clone()),
            (Some(10), Some(11), active.clone()),
            (Some(11), Some(13), either("inactive", "active")),
        ]
    );
    assert_eq!(
        axis(1),
        [
            (Some(0), Some(6), active.clone()),
            (Some(6), Some(9), inactive),
            (Some(9), Some(13), active),
        ]
    );
    assert_eq!(
        (&timeline["lines"], &timeline["remark"]),
        (&json!(13), &Value::Null)
    );
    client.drop_all();
}

#[test]
fn a_motion_in_an_unknown_state_says_so() {
    // R12.20: in the words of the table.
    let text = "$IF V.E.A == 1\nX[COMP OFF FRICT]\n$ENDIF\nG1 X5 F100\nM30\n";
    let (_bench, mut client, uri) = opened(text);
    let text = hover(&mut client, &uri, 3);
    let row = text.lines().find(|line| line.starts_with("| X |"));
    let state = row
        .and_then(|row| row.split(" | ").nth(2))
        .expect("a state");
    let state = state.trim_end_matches(" |");
    assert!(state.starts_with("unknown "), "{text}");
    let moves = format!("X moves with friction compensation {state}; ");
    assert!(text.contains(&moves), "{text}");
    client.drop_all();
}

#[test]
fn the_end_of_a_program_that_is_not_checked_to_its_end_is_not_known() {
    // R12.20
    let mut client = Client::with(&json!({
        "capabilities": {},
        "initializationOptions": { "maxBlocks": 200 },
    }));
    let blocks = "G1 X1 F100\n".repeat(500);
    client.open("untitled:a", &format!("X[COMP OFF FRICT]\n{blocks}M30\n"));
    let text = json!({ "textDocument": { "uri": "untitled:a" } });
    let lenses = client.ask("textDocument/codeLens", &text).to_string();
    assert!(lenses.contains("what it leaves is not known"), "{lenses}");
    assert!(!lenses.contains("leaves X"), "{lenses}");
    client.drop_all();
}

#[test]
fn a_block_shows_what_it_switches_and_how_it_moves() {
    // R12.3
    let text = "\
N10 G90 G17 F1000
N20 G1 X0 Y0
N30 X10 Y10
N40 X[COMP OFF FRICT]
N50 X5 Y10
N60 G2 X15 Y10 I5 J0
N70 Y[COMP ON FRICT LEAD]
N80 M30
";
    let (_bench, mut client, uri) = opened(text);
    let text = hover(&mut client, &uri, 2);
    assert!(
        text.contains("X moves with friction compensation active; does not reverse"),
        "{text}"
    );
    let text = hover(&mut client, &uri, 4);
    assert!(
        text.contains("X moves with friction compensation inactive; reverses"),
        "{text}"
    );
    assert!(!text.contains("Y moves"), "{text}");
    let text = hover(&mut client, &uri, 5);
    assert!(
        text.contains("X moves with friction compensation inactive; reverses"),
        "{text}"
    );
    assert!(
        text.contains("Y moves with friction compensation active; reverses"),
        "{text}"
    );
    let on_command =
        json!({ "textDocument": { "uri": uri }, "position": { "line": 6, "character": 10 } });
    let text = client.ask("textDocument/hover", &on_command)["contents"]["value"].take();
    let text = text.as_str().expect("text");
    assert!(
        text.contains("`LEAD`: configured by P-AXIS-00175 (`lr_param.ssfk`)"),
        "{text}"
    );
    client.drop_all();
}

#[test]
fn a_list_shows_the_page_of_a_parameter() {
    // R12.3
    let mut client = Client::new();
    client.open_as(
        "file:///p/x.lis",
        "isg-list",
        "kopf.achs_nr 1\nfrict_comp.reversal_lookahead 2\nEnde\n",
    );
    let text = hover(&mut client, "file:///p/x.lis", 1);
    assert!(
        text.contains("P-COMP-00044") && text.contains("| cycles | 0 to 4 | 0 |"),
        "{text}"
    );
    assert_eq!(hover(&mut client, "file:///p/x.lis", 2), "");
    client.drop_all();
}

#[test]
fn a_lens_says_what_a_program_inherits() {
    // R12.4
    let (_bench, mut client, uri) =
        opened("N10 G1 X5 F100\nN20 Y[COMP ON FRICT]\nN30 Y5\nN40 M30\n");
    let lenses = client.ask(
        "textDocument/codeLens",
        &json!({ "textDocument": { "uri": uri } }),
    );
    let titles: Vec<&str> = lenses
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|it| it["command"]["title"].as_str())
        .collect();
    assert_eq!(
        titles,
        [
            "leaves every axis in its start-up state",
            "inherits the state of X",
            "Show timeline"
        ]
    );
    client.drop_all();
}

const NAMES: &str = "\
N10 LL SUB
N20: X1
N30 $GOTO N20
N40 L other.nc
N50 M30
%L SUB
[HERE] X2
N70 $GOTO [HERE]
N80 M17
";

/// Returns a client that says whether ISG's extension is installed.
fn beside(isg: &Value) -> (Bench, Client, String) {
    let bench = Bench::new(&[("other.nc", "M17\n")]);
    let uri = uri(&bench.folder().join("a.nc"));
    let mut client = Client::with(&json!({
        "capabilities": {},
        "initializationOptions": { "isgExtension": isg },
    }));
    client.open(&uri, NAMES);
    (bench, client, uri)
}

#[test]
fn names_are_found_and_changed_where_nobody_else_does_it() {
    // R12.6
    let (bench, mut client, uri) = beside(&json!(false));
    let text = json!({ "uri": uri });
    let symbols = client.ask(
        "textDocument/documentSymbol",
        &json!({ "textDocument": text }),
    );
    let names: Vec<&str> = symbols
        .as_array()
        .expect("a list")
        .iter()
        .map(|it| it["name"].as_str().expect("a name"))
        .collect();
    assert_eq!(names, ["N20", "SUB", "HERE"]);
    let folds = client.ask(
        "textDocument/foldingRange",
        &json!({ "textDocument": text }),
    );
    assert_eq!(folds[0], json!({ "startLine": 5, "endLine": 8 }));
    let at = |line: u32, character: u32| json!({ "line": line, "character": character });
    let call = json!({ "textDocument": text, "position": at(0, 8) });
    let found = client.ask("textDocument/definition", &call);
    assert_eq!(found["range"]["start"], at(5, 3));
    let file = json!({ "textDocument": text, "position": at(3, 7) });
    let found = client.ask("textDocument/definition", &file);
    assert_eq!(
        found["uri"],
        super::client::uri(&bench.folder().join("other.nc"))
    );
    let label = json!({
        "textDocument": text,
        "position": at(1, 1),
        "context": { "includeDeclaration": true },
    });
    let found = client.ask("textDocument/references", &label);
    assert_eq!(found.as_array().map(Vec::len), Some(2), "{found}");
    let renamed = |client: &mut Client, (line, character): (u32, u32), new: &str| {
        let params = json!({
            "textDocument": text,
            "position": at(line, character),
            "newName": new,
        });
        client.ask("textDocument/rename", &params)
    };
    let edit = renamed(&mut client, (0, 8), "FINISH");
    assert_eq!(edit["changes"][&uri].as_array().map(Vec::len), Some(2));
    let edit = renamed(&mut client, (1, 1), "N25");
    assert_eq!(edit["changes"][&uri][1]["newText"], "N25");
    // R12.17: an impossible request is an error with its reason.
    for ((line, character), new) in [
        ((1, 1), "25"),
        ((1, 1), "HERE"),
        ((0, 8), "a b"),
        ((3, 7), "x.nc"),
        ((4, 6), "M02"),
    ] {
        let params =
            json!({ "textDocument": text, "position": at(line, character), "newName": new });
        assert_eq!(
            client.refused("textDocument/rename", &params),
            INVALID_PARAMS,
            "{new}"
        );
    }
    let prepare = |line: u32, character: u32| json!({ "textDocument": text, "position": at(line, character) });
    let range = client.ask("textDocument/prepareRename", &prepare(0, 8));
    assert_eq!((&range["start"], &range["end"]), (&at(0, 7), &at(0, 10)));
    for (line, character) in [(3, 7), (4, 6)] {
        let none = client.ask("textDocument/prepareRename", &prepare(line, character));
        assert_eq!(none, Value::Null);
    }
    let whole = |at: usize| {
        (
            &symbols[at]["range"]["start"]["line"],
            &symbols[at]["range"]["end"]["line"],
        )
    };
    assert_eq!(whole(1), (&json!(5), &json!(9)), "the subprogram");
    assert_eq!(whole(0), (&json!(1), &json!(2)), "the block of the label");
    client.drop_all();
}

#[test]
fn beside_the_extension_of_isg_nothing_is_offered_twice() {
    // R12.6, R12.12: it has definitions and references, but no outline, folding or renaming.
    for isg in [json!(true), json!(null)] {
        let (_bench, mut client, uri) = beside(&isg);
        let text = json!({ "uri": uri });
        let call = json!({
            "textDocument": text,
            "position": { "line": 0, "character": 8 },
            "context": { "includeDeclaration": true },
            "newName": "FINISH",
        });
        assert_eq!(client.ask("textDocument/definition", &call), Value::Null);
        assert_eq!(client.ask("textDocument/references", &call), Value::Null);
        for method in ["documentSymbol", "foldingRange", "rename"] {
            let answer = client.ask(&format!("textDocument/{method}"), &call);
            assert_ne!(answer, Value::Null, "{method}");
        }
        client.drop_all();
    }
}

#[test]
fn a_called_program_is_found_where_the_configuration_says() {
    // R12.17
    let configuration = "[machine]\nprogram_dirs = [\"subs\"]\n[[axis]]\nname = \"X\"\n";
    let bench = Bench::new(&[("frictcomp.toml", configuration)]);
    std::fs::create_dir(bench.folder().join("subs")).expect("a folder");
    bench.write("subs/other.nc", "M17\n");
    let a = uri(&bench.folder().join("a.nc"));
    let mut client = Client::with(&json!({
        "capabilities": {},
        "initializationOptions": { "isgExtension": false },
    }));
    client.open(&a, "N10 L other.nc\nM30\n");
    let call = json!({ "textDocument": { "uri": a }, "position": { "line": 0, "character": 8 } });
    let found = client.ask("textDocument/definition", &call);
    assert_eq!(found["uri"], uri(&bench.folder().join("subs/other.nc")));
    client.drop_all();
}

#[test]
fn an_audit_takes_the_programs_as_they_are_open() {
    // R12.4
    let bench = Bench::new(&[("a.nc", "M30\n"), ("b.nc", "G1 X5 F100\nM30\n")]);
    let a = uri(&bench.folder().join("a.nc"));
    let mut client = Client::new();
    client.open(&a, "X[COMP OFF FRICT]\nM30\n");
    let params = |uri: &str| json!({ "command": "frictcomp.audit", "arguments": [{ "uri": uri }] });
    for subject in [a.clone(), uri(bench.folder())] {
        let shown = client.ask("workspace/executeCommand", &params(&subject));
        let html = shown["html"].as_str().expect("a page");
        assert!(html.contains("a.nc") && html.contains("b.nc"), "{html}");
        assert!(html.contains("X[COMP ON FRICT]"), "the cure: {html}");
    }
    for wrong in [
        json!({ "command": "frictcomp.audit" }),
        params("untitled:a"),
        json!({ "command": "frictcomp.wonder", "arguments": [{ "uri": a }] }),
    ] {
        let code = client.refused("workspace/executeCommand", &wrong);
        assert_eq!(code, INVALID_PARAMS, "{wrong}");
    }
    client.drop_all();
}
