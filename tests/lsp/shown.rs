//! States, hints, lenses and the reports of commands (R12.3, R12.4).

use serde_json::{Value, json};

use crate::folder::Bench;
use crate::lsp_client::{Client, uri};

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

/// A program on the machine of the tests, open.
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
    // A line that is no block shows the block before it.
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
