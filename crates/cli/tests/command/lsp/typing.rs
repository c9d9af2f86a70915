//! Suggestions while typing (R12.6, R12.11), and the texts that get them (R12.12, R12.14).

use std::fs;

use serde_json::{Value, json};

use super::client::{Client, codes, uri};
use crate::folder::Bench;

/// A machine whose axes have names that are typed letter by letter.
const AXES: &str = "[[axis]]\nname = \"X\"\nenable = true\n[[axis]]\nname = \"X1\"\nenable = true\n\
                    [[axis]]\nname = \"X10\"\nenable = true\n[[axis]]\nname = \"Y\"\nenable = true\n\
                    [[axis]]\nname = \"SPINDLE\"\n[[axis]]\nname = \"LOADER\"\nenable = true\n";

fn bench() -> (Bench, Client, String) {
    let bench = Bench::new(&[("a.nc", "M30\n"), ("frictcomp.toml", AXES)]);
    let uri = uri(&bench.folder().join("a.nc"));
    (bench, Client::new(), uri)
}

fn items(client: &mut Client, uri: &str, (line, character): (usize, usize)) -> Vec<Value> {
    let at = json!({ "textDocument": { "uri": uri }, "position": { "line": line, "character": character } });
    let items = client.ask("textDocument/completion", &at);
    items.as_array().cloned().unwrap_or_default()
}

fn offered(client: &mut Client, uri: &str, at: (usize, usize)) -> Vec<String> {
    let items = items(client, uri, at).into_iter();
    items
        .map(|it| it["label"].as_str().expect("a label").to_owned())
        .collect()
}

#[test]
fn what_may_be_written_next_is_offered() {
    // R12.6, R12.11
    let text = "N10 X[COMP ON FRICT \nN20 G1 LOA\n(comment L\nN30 x[co\nM30\n";
    let (bench, mut client, uri) = bench();
    client.open(&uri, text);
    assert_eq!(
        offered(&mut client, &uri, (0, 20)),
        ["BACKLASH", "CROSS", "PLANE", "LEAD", "TEMP", "CROSSTALK"]
    );
    assert_eq!(
        offered(&mut client, &uri, (0, 11)),
        ["ON", "OFF", "OFF_ALL"]
    );
    assert_eq!(offered(&mut client, &uri, (1, 10)), ["LOADER"]);
    assert_eq!(offered(&mut client, &uri, (2, 10)), [""; 0]);
    assert_eq!(offered(&mut client, &uri, (3, 8)), ["COMP"]);
    let toml = super::client::uri(&bench.folder().join("frictcomp.toml"));
    let text = "[machine]\ncy\n\n[[axis]] # X\nname = \"X\"\nfr\n";
    client.open_as(&toml, "toml", text);
    assert_eq!(offered(&mut client, &toml, (1, 2)), ["cycle_time_ms"]);
    assert!(offered(&mut client, &toml, (5, 2)).contains(&"frict_comp".to_owned()));
    assert_eq!(offered(&mut client, &toml, (4, 8)), [""; 0]);
    assert_eq!(offered(&mut client, &toml, (2, 0)), [""; 0]);
    let list = "file:///p/x.lis";
    client.open_as(list, "isg-list", "frict_comp.m\nfrict_comp.table[3].o\n\n");
    assert_eq!(
        offered(&mut client, list, (0, 12)),
        ["frict_comp.mode", "frict_comp.max_points"]
    );
    assert_eq!(
        offered(&mut client, list, (1, 21)),
        ["frict_comp.table[3].out"]
    );
    assert_eq!(offered(&mut client, list, (2, 0)), [""; 0]);
    client.drop_all();
}

#[test]
fn keys_are_offered_on_an_empty_line_when_asked_for() {
    // R12.21
    let (bench, mut client, _) = bench();
    let of = |name: &str| uri(&bench.folder().join(name));
    let mut asked = |name: &str, language: &str, text: &str, line: u32| {
        client.open_as(&of(name), language, text);
        let at = json!({
            "textDocument": { "uri": of(name) },
            "position": { "line": line, "character": 0 },
            "context": { "triggerKind": 1 },
        });
        client.ask("textDocument/completion", &at)
    };
    let keys = asked("frictcomp.toml", "toml", "[[axis]]\nname = \"X\"\n\n", 2);
    let named = |label: &str| {
        let items = keys.as_array().expect("items").iter();
        items
            .clone()
            .find(|it| it["label"] == label)
            .cloned()
            .expect("a key")
    };
    let page = named("frict_comp")["documentation"]["value"].take();
    assert!(
        page.as_str().expect("text").contains("P-AXIS-00522"),
        "{page}"
    );
    let keys = asked("x.lis", "isg-list", "kopf.achs_nr 1\n\n", 1).to_string();
    assert!(keys.contains("frict_comp.table[0].in") && keys.contains("P-COMP-00046"));
    assert_eq!(asked("a.nc", "isg-cnc", "N10 X1\n\nM30\n", 1), json!([]));
    client.drop_all();
}

#[test]
fn an_item_says_what_it_replaces_and_where_it_stands() {
    // R12.11
    let (_bench, mut client, uri) = bench();
    client.open(&uri, "N10 (\u{dc}\u{1f600}) X[COMP of\nM30\n");
    let items = items(&mut client, &uri, (0, 19));
    let edit = |item: &Value| {
        let range = &item["textEdit"]["range"];
        let (start, end) = (&range["start"]["character"], &range["end"]["character"]);
        let text = item["textEdit"]["newText"].clone();
        (text, start.as_u64(), end.as_u64())
    };
    let edits: Vec<_> = items.iter().map(edit).collect();
    assert_eq!(
        edits,
        [
            (json!("OFF"), Some(17), Some(19)),
            (json!("OFF_ALL"), Some(17), Some(19))
        ]
    );
    assert!(items.iter().all(|item| item.get("preselect").is_none()));
    let sorted = items.iter().map(|item| item["sortText"].as_str());
    assert!(sorted.is_sorted());
    client.drop_all();
}

/// Returns the text that results from pressing Enter at the end of each line, in an editor that accepts the first item
/// that it shows on Enter.
fn typed(client: &mut Client, uri: &str, program: &str) -> String {
    let (mut text, mut version) = (String::new(), 1);
    for line in program.lines() {
        let start = text.len();
        for letter in line.chars() {
            text.push(letter);
        }
        version += 1;
        client.replace(uri, version, &text);
        let at = (text.matches('\n').count(), text.len() - start);
        match items(client, uri, at).first() {
            Some(item) => {
                let from = item["textEdit"]["range"]["start"]["character"].as_u64();
                text.truncate(start + usize::try_from(from.expect("a place")).expect("short"));
                text.push_str(item["textEdit"]["newText"].as_str().expect("a text"));
            }
            None => text.push('\n'),
        }
    }
    text
}

#[test]
fn a_program_that_is_typed_is_what_was_typed() {
    // R12.11: Enter after every kind of word, with a blank before it and without one.
    let program = "%L SUB \nN10 G90 \nN20 X\nN30 X1\nN40 X10=5 \nN45 G90 \nN50 X[COMP OFF FRICT]\nN60 X[COMP ON FRICT] \n\
                   N70 P1 = X\nN80 V.P.X = 1 \nN90 $IF P1 == 1 \nN100 L SPIN\nN110 LL SUB \n$ENDIF \n#TRAFO ON \n\
                   (comment SPIN\n; SPIN \nN120 S1000 M3 \nN130 T1 D1 \nN140 x \n\nN150 P2 = P1 + L\n[HERE] \n\
                   N160 $GOTO S\nG1X100F200 \nM30 \n";
    let (_bench, mut client, uri) = bench();
    client.open(&uri, "");
    assert_eq!(typed(&mut client, &uri, program), program);
    client.drop_all();
}

#[test]
fn enter_after_any_word_of_any_program_is_a_line_break() {
    // R12.11
    let folder = crate::workspace::root().join("programs/ok");
    let (_bench, mut client, uri) = bench();
    client.open(&uri, "M30\n");
    let files = fs::read_dir(folder).expect("a folder");
    let programs = files.filter_map(|file| {
        let path = file.expect("an entry").path();
        let text = fs::read(&path).ok()?;
        path.is_file()
            .then(|| String::from_utf8_lossy(&text).into_owned())
    });
    for (version, text) in (2..).zip(programs) {
        client.replace(&uri, version, &text);
        for (at, line) in text.lines().enumerate().take(60) {
            let upper = line.to_uppercase();
            for (end, _) in line.match_indices([' ', '\t']) {
                let open = upper[..end].rfind('[');
                let is_inside = open.is_some_and(|open| {
                    let inside = &upper[open..end];
                    inside.contains("COMP") && !inside.contains(']')
                });
                for end in [end, end + 1].into_iter().filter(|_| !is_inside) {
                    let units = line[..end].encode_utf16().count();
                    let offered = offered(&mut client, &uri, (at, units));
                    assert_eq!(offered, [""; 0], "{}", &line[..end]);
                }
            }
        }
    }
    client.drop_all();
}

#[test]
fn nothing_is_said_in_a_file_that_is_no_program_and_no_list() {
    // R12.12, R12.14
    let (bench, mut client, a) = bench();
    let wrong = "X[COMP ON FRIKT]\n[package]\nname = \"a\"\nM30\n";
    let cargo = uri(&bench.folder().join("Cargo.toml"));
    let committed = format!("git:{}?%7B%7D", a.trim_start_matches("file:"));
    for (other, language) in [
        (cargo.as_str(), "toml"),
        ("untitled:notes", "plaintext"),
        (&committed, "isg-cnc"),
    ] {
        client.open_as(other, language, wrong);
        client.replace(other, 2, wrong);
        assert_eq!(
            client.ask(
                "textDocument/hover",
                &json!({ "textDocument": { "uri": other }, "position": { "line": 0, "character": 0 } })
            ),
            Value::Null
        );
        client.close(other);
    }
    client.leave();

    // A language that the user names is one of programs.
    let mut client = Client::with(&json!({
        "capabilities": {},
        "initializationOptions": { "languages": ["gcode"] },
    }));
    client.open_as("untitled:part", "gcode", wrong);
    let said = client.diagnostics("untitled:part");
    assert!(codes(&said).contains(&("FC202".to_owned(), 0)), "{said}");
    client.drop_all();
}
