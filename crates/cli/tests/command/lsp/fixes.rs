//! Fixes as an editor applies them (R12.5).

use std::collections::BTreeMap;
use std::fs;

use serde_json::{Value, json};

use super::client::{Client, codes, uri};
use crate::folder::Bench;

/// Returns the capabilities of a client that supports versioned edits.
fn versions() -> Value {
    json!({ "capabilities": { "workspace": { "workspaceEdit": { "documentChanges": true } } } })
}

fn actions(client: &mut Client, uri: &str, only: &[&str]) -> Vec<Value> {
    let everywhere = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 99_999, "character": 0 } });
    let actions = client.ask(
        "textDocument/codeAction",
        &json!({
            "textDocument": { "uri": uri },
            "range": everywhere,
            "context": { "diagnostics": [], "only": only },
        }),
    );
    actions.as_array().cloned().unwrap_or_default()
}

/// Returns a text after the edits of an action; columns are bytes of ASCII.
fn applied(text: &str, edits: &Value) -> String {
    let mut starts = vec![0];
    let bytes = text.as_bytes();
    for (at, byte) in bytes.iter().enumerate() {
        if *byte == b'\n' || (*byte == b'\r' && bytes.get(at + 1) != Some(&b'\n')) {
            starts.push(at + 1);
        }
    }
    let at = |place: &Value| {
        let number =
            |key: &str| usize::try_from(place[key].as_u64().expect("a number")).expect("small");
        starts
            .get(number("line"))
            .map_or(text.len(), |start| start + number("character"))
    };
    let mut edits: Vec<_> = edits
        .as_array()
        .expect("edits")
        .iter()
        .map(|it| {
            (
                at(&it["range"]["start"]),
                at(&it["range"]["end"]),
                it["newText"].as_str().expect("text"),
            )
        })
        .collect();
    edits.sort_unstable();
    let mut text = text.to_owned();
    for (start, end, new) in edits.into_iter().rev() {
        text.replace_range(start..end, new);
    }
    text
}

fn counted(said: &Value) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for (code, _) in codes(said) {
        *counts.entry(code).or_default() += 1;
    }
    counts
}

#[test]
fn a_fix_takes_its_message_away() {
    // R12.5: every program with a mistake, every fix of it.
    let root = crate::workspace::root().join("programs/err");
    let bench = Bench::new(&[]);
    let configuration = bench.read("frictcomp.toml");
    let mut client = Client::with(&versions());
    let mut fixed: BTreeMap<String, usize> = BTreeMap::new();
    let mut paths: Vec<_> = fs::read_dir(&root)
        .expect("programs")
        .map(|it| it.expect("an entry").path())
        .collect();
    paths.sort();
    for path in paths {
        let Ok(text) = fs::read_to_string(&path) else {
            continue;
        };
        let name = path.file_name().expect("a name").to_str().expect("text");
        if !text.is_ascii() || text.len() > 100_000 || name.starts_with("FC91") {
            continue;
        }
        let uri = uri(&bench.folder().join(name));
        let toml = super::client::uri(&bench.folder().join("frictcomp.toml"));
        let before = client.open(&uri, &text);
        let mut last = before.clone();
        let mut version = 1;
        for action in actions(&mut client, &uri, &["quickfix"]) {
            let title = action["title"].as_str().expect("a title");
            if title.starts_with("allow ") {
                continue;
            }
            let change = &action["edit"]["documentChanges"][0];
            let code = action["diagnostics"][0]["code"]
                .as_str()
                .expect("a code")
                .to_owned();
            let in_program = change["textDocument"]["uri"] == uri;
            if in_program {
                assert_eq!(change["textDocument"]["version"], 1, "{name}");
                client.replace(&uri, version + 1, &applied(&text, &change["edits"]));
            } else {
                assert_eq!(change["textDocument"]["uri"], toml, "{name}");
                client.open_as(&toml, "toml", &applied(&configuration, &change["edits"]));
            }
            last = client.settled(&uri).unwrap_or(last);
            let (was, is) = (counted(&before), counted(&last));
            assert!(is.get(&code) < was.get(&code), "{name}: {title}");
            let is_unsafe = action["isPreferred"].is_null();
            for (other, times) in &is {
                // Working code may now be reported as left, without a list, unused, not configured or not described.
                let expected = ["FC303", "FC401", "FC408", "FC490", "P-ERR-70495"];
                let follows = is_unsafe && expected.contains(&other.as_str());
                let more = *times > was.get(other).copied().unwrap_or_default();
                assert!(!more || follows, "{name}: {title}: {other}");
            }
            *fixed.entry(code).or_default() += 1;
            if in_program {
                version += 2;
                client.replace(&uri, version, &text);
            } else {
                client.close(&toml);
            }
            last = client.settled(&uri).unwrap_or(last);
        }
        client.close(&uri);
    }
    let codes: Vec<&str> = fixed.keys().map(String::as_str).collect();
    for code in [
        "FC202",
        "FC205",
        "FC401",
        "FC404",
        "FC407",
        "FC490",
        "FC491",
        "P-ERR-21301",
    ] {
        assert!(codes.contains(&code), "{codes:?}");
    }
    client.drop_all();
}

#[test]
fn safe_fixes_are_preferred_and_applied_together() {
    // R12.5
    let bench = Bench::new(&[]);
    let uri = uri(&bench.folder().join("a.nc"));
    let text = "n10 x[comp off frict]\r\nN15 X[COMP ON FRICT]\r\nN20 G1 X1 F100 (frictcomp: allow FC402)\r\nN30 M30\r\n";
    let mut client = Client::new();
    let said = client.open(&uri, text);
    let all = actions(&mut client, &uri, &["source"]);
    assert_eq!(all.len(), 1, "{said}");
    assert_eq!(all[0]["kind"], "source.fixAll");
    // A client without version support gets its changes by text.
    let edits = &all[0]["edit"]["changes"][&uri];
    let expected = "N10 x[COMP OFF FRICT]\r\nN15 X[COMP ON FRICT]\r\nN20 G1 X1 F100\r\nN30 M30\r\n";
    assert_eq!(applied(text, edits), expected);
    assert_eq!(actions(&mut client, &uri, &["refactor"]), [] as [Value; 0]);
    let quick = actions(&mut client, &uri, &["quickfix"]);
    assert!(quick.iter().any(|it| it["isPreferred"] == true));
    client.leave();
}

#[test]
fn a_message_is_allowed_where_it_is_said() {
    // R12.5
    let bench = Bench::new(&[]);
    let uri = uri(&bench.folder().join("a.nc"));
    let text = "N10 X[COMP OFF FRICT]\nN20 M30\n";
    let mut client = Client::new();
    client.open(&uri, text);
    let quick = actions(&mut client, &uri, &["quickfix"]);
    let allow = quick
        .iter()
        .find(|it| it["title"] == "allow FC401 here")
        .expect("an action");
    client.replace(&uri, 2, &applied(text, &allow["edit"]["changes"][&uri]));
    assert_eq!(client.diagnostics(&uri), json!([]));
    client.leave();
}

#[test]
fn a_comment_is_offered_only_where_it_can_be_written() {
    // R12.20: lists and configurations have no comments to this tool.
    let bench = Bench::new(&[]);
    let of = |name: &str| uri(&bench.folder().join(name));
    let mut client = Client::new();
    let is_allow = |it: &Value| {
        it["title"]
            .as_str()
            .is_some_and(|it| it.starts_with("allow "))
    };
    for (name, text, offered) in [
        ("a.nc", "X[COMP OFF FRICT]\nM30\n", true),
        (
            "frictcomp.toml",
            "[[axis]]\nname = \"X\"\nfrict_com = true\n",
            false,
        ),
        (
            "x.lis",
            "kopf.achs_nr 1\nlr_param.frict_comp 7\nEnde\n",
            false,
        ),
    ] {
        let said = client.open(&of(name), text);
        assert!(!codes(&said).is_empty(), "{name}");
        let actions = actions(&mut client, &of(name), &["quickfix"]);
        assert_eq!(actions.iter().any(is_allow), offered, "{name}: {actions:?}");
    }
    client.drop_all();
}
