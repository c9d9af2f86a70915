//! Random edits: after each, the server reports the same as a fresh check and a fresh run of the text
//! (R12.2, R12.3), and uses no more memory than before (R12.7).

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use fastrand::Rng;
use frictcomp::comp::Kind;
use frictcomp::interpreter::{NoFiles, Options, StopPolicy};
use frictcomp::session::{Program, Session, SessionOptions};
use frictcomp::timeline::{Record, StateView};
use frictcomp::{machine::Machine, text::SourceFile};
use serde_json::{Value, json};

use super::client::{Client, uri};
use crate::folder::{Bench, MACHINE};

/// Lines of programs, right ones and wrong ones.
const LINES: [&str; 20] = [
    "N10 G1 X1 Y2 F100",
    "X[COMP OFF FRICT]",
    "X[COMP ON FRICT]",
    "Y[COMP OFF_ALL]",
    "Y[COMP ON FRICT LEAD]",
    "Z[COMP ON FRICT]",
    "X[COMP ON FRIKT]",
    "X[COMP ON FRICT",
    "x[comp off frict]",
    "P1 = P1 + 1",
    "P1 = 0",
    "$WHILE P1 < 3",
    "$ENDWHILE",
    "$IF P1 == 1",
    "$ENDIF",
    "LL SUB",
    "X[COMP \\",
    "(\u{dc}ber \u{1f600}) Y[COMP OFF FRICT]",
    "M30",
    "%L SUB",
];

fn options() -> SessionOptions {
    SessionOptions::from(Options::default().with_stop(StopPolicy::CheckAll))
}

/// The states before and after each line's block, as a fresh run has them.
type Lines = BTreeMap<u32, (Vec<Vec<String>>, Vec<Vec<String>>, u64)>;

fn fresh_states(text: &str) -> Lines {
    let machine = Machine::from_toml(MACHINE).expect("a machine");
    let mut session = Session::new(machine, options());
    let mut lines = Lines::new();
    let states = |view: StateView<'_>| -> Vec<String> {
        let all = view
            .axes()
            .map(|(axis, _)| view.state(axis, Kind::Frict).to_string());
        all.collect()
    };
    let mut before = Vec::new();
    let mut sink = |record: &Record<'_>| {
        match record {
            Record::Program { state, .. } => before = states(*state),
            Record::Block(row) => {
                let after = states(row.state);
                let line = lines.entry(row.line).or_default();
                let sets = line
                    .0
                    .iter_mut()
                    .zip(&before)
                    .chain(line.1.iter_mut().zip(&after));
                let mut known = 0;
                for (set, state) in sets {
                    known += 1;
                    if !set.contains(state) {
                        set.push(state.clone());
                    }
                }
                if known == 0 {
                    let each =
                        |states: &[String]| states.iter().map(|it| vec![it.clone()]).collect();
                    (line.0, line.1) = (each(&before), each(&after));
                }
                line.2 += 1;
                before = after;
            }
            _ => {}
        }
        ControlFlow::Continue(())
    };
    let program = Program::Whole(SourceFile::new("a.nc", text));
    let _ = session.program("a.nc", program, &mut NoFiles, &mut sink);
    lines
}

fn fresh_messages(text: &str) -> Vec<(String, u32, String)> {
    let machine = Machine::from_toml(MACHINE).expect("a machine");
    let findings = frictcomp::check(
        SourceFile::new("a.nc", text),
        machine,
        options(),
        &mut NoFiles,
    );
    let said = findings.diagnostics();
    let mut said: Vec<_> = said
        .map(|it| {
            (
                it.code.to_string(),
                it.place.start().line - 1,
                it.message.clone(),
            )
        })
        .collect();
    said.sort();
    said
}

fn shown_messages(said: &Value, path: &str) -> Vec<(String, u32, String)> {
    let mut shown: Vec<_> = said
        .as_array()
        .expect("a list")
        .iter()
        .map(|it| {
            let line = it["range"]["start"]["line"].as_u64().expect("a line");
            let message = it["message"]
                .as_str()
                .expect("text")
                .split("\nhelp: ")
                .next()
                .expect("a line");
            // A message may name its file.
            let message = message.replace(path, "a.nc");
            (
                it["code"].as_str().expect("a code").to_owned(),
                u32::try_from(line).expect("small"),
                message,
            )
        })
        .collect();
    shown.sort();
    shown
}

/// Returns a random change of a text, as the client sends it, in units of UTF-16.
fn change(rng: &mut Rng, text: &mut String) -> Value {
    let lines: Vec<&str> = text.split('\n').collect();
    let line = rng.usize(..lines.len());
    let units = |text: &str| text.encode_utf16().count();
    let start: usize = lines[..line].iter().map(|it| it.len() + 1).sum();
    let (from, to, new) = match rng.u8(..4) {
        0 => (0, 0, format!("{}\n", rng.choice(LINES).expect("a line"))),
        1 if line + 1 < lines.len() => (0, lines[line].len() + 1, String::new()),
        2 => (
            0,
            lines[line].len(),
            rng.choice(LINES).expect("a line").to_owned(),
        ),
        _ => {
            let at = lines[line]
                .char_indices()
                .map(|(at, _)| at)
                .collect::<Vec<_>>();
            let at = rng.choice(at).unwrap_or(0);
            (
                at,
                at,
                rng.choice(["X", "[", "]", "1", "\n", "\u{dc}"])
                    .expect("a letter")
                    .to_owned(),
            )
        }
    };
    let position = |offset: usize| {
        if offset > lines[line].len() {
            return json!({ "line": line + 1, "character": 0 });
        }
        json!({ "line": line, "character": units(&lines[line][..offset]) })
    };
    let range = json!({ "start": position(from), "end": position(to) });
    text.replace_range(start + from..start + to, &new);
    json!({ "range": range, "text": new })
}

#[test]
fn after_random_edits_the_server_knows_what_a_fresh_run_knows() {
    // R12.2, R12.3
    let bench = Bench::new(&[]);
    let path = bench.folder().join("a.nc").display().to_string();
    let uri = uri(&bench.folder().join("a.nc"));
    for seed in 0..12 {
        let mut rng = Rng::with_seed(seed);
        let mut text = "N10 X[COMP OFF FRICT]\nN20 M30\n".to_owned();
        let mut client = Client::new();
        let mut said = client.open(&uri, &text);
        for version in 2..22 {
            let edits = rng.usize(1..4);
            let changes: Vec<Value> = (0..edits).map(|_| change(&mut rng, &mut text)).collect();
            client.change(&uri, version, &Value::Array(changes));
            said = client.settled(&uri).unwrap_or(said);
            assert_eq!(
                shown_messages(&said, &path),
                fresh_messages(&text),
                "{seed}: {text}"
            );
            for (line, (before, after, times)) in fresh_states(&text) {
                let at = json!({
                    "textDocument": { "uri": uri },
                    "position": { "line": line - 1, "character": 0 },
                });
                let states = client.ask("frictcomp/states", &at);
                let all = |key: &str| -> Vec<Value> {
                    states["axes"]
                        .as_array()
                        .expect("axes")
                        .iter()
                        .map(|it| it[key].clone())
                        .collect()
                };
                let found = (json!(all("before")), json!(all("after")), &states["times"]);
                assert_eq!(
                    found,
                    (json!(before), json!(after), &json!(times)),
                    "{seed}: {line}: {text}"
                );
            }
        }
        client.drop_all();
    }
}

/// Returns the memory of a process in KiB.
#[cfg(target_os = "linux")]
fn held(process: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).expect("a process");
    let line = status
        .lines()
        .find(|line| line.starts_with("VmRSS:"))
        .expect("a size");
    line.split_whitespace()
        .nth(1)
        .and_then(|it| it.parse().ok())
        .expect("a number")
}

/// Types letters into a program of so many blocks, and returns the memory of the server after ten of them
/// and after all.
#[cfg(target_os = "linux")]
fn typed(blocks: usize, edits: i32) -> (u64, u64) {
    use std::io::{BufReader, Write as _};
    use std::process::Stdio;

    use lsp_server::{Message, Notification, Request, RequestId};

    let bench = Bench::new(&[]);
    let mut command = bench.command(&["lsp"]);
    let mut server = command
        .stdin(Stdio::piped())
        .spawn()
        .expect("the tool starts");
    let mut input = server.stdin.take().expect("piped");
    let mut output = BufReader::new(server.stdout.take().expect("piped"));
    let mut tell = |message: Message| {
        message.write(&mut input).expect("a server");
        input.flush().expect("a server");
    };
    let mut wait = |id: i32| {
        let id = RequestId::from(id);
        while !matches!(Message::read(&mut output), Ok(Some(Message::Response(it))) if it.id == id)
        {
        }
    };
    let request = |id: i32, method: &str, params: Value| {
        Message::from(Request::new(RequestId::from(id), method.to_owned(), params))
    };
    let notification =
        |method: &str, params: Value| Message::from(Notification::new(method.to_owned(), params));
    tell(request(-1, "initialize", json!({ "capabilities": {} })));
    wait(-1);
    let text = "N10 G1 X1.5 Y2 F100\n".repeat(blocks) + "X[COMP ON FRICT]\nM30\n";
    let text = json!({ "uri": "untitled:a", "languageId": "isg-cnc", "version": 0, "text": text });
    tell(notification(
        "textDocument/didOpen",
        json!({ "textDocument": text }),
    ));
    let mut after = Vec::new();
    for version in 1..=edits {
        let at = |character: u32| json!({ "line": blocks, "character": character });
        let letter = if version % 2 == 0 { "C" } else { "K" };
        let change = json!({ "range": { "start": at(13), "end": at(14) }, "text": letter });
        let text = json!({ "uri": "untitled:a", "version": version });
        tell(notification(
            "textDocument/didChange",
            json!({ "textDocument": text, "contentChanges": [change] }),
        ));
        if version % 500 == 0 || version <= 10 {
            let lens = json!({ "textDocument": { "uri": "untitled:a" } });
            tell(request(version, "textDocument/codeLens", lens));
            wait(version);
        }
        if version == 10 || version == edits {
            after.push(held(server.id()));
        }
    }
    tell(request(-2, "shutdown", Value::Null));
    wait(-2);
    tell(notification("exit", Value::Null));
    assert!(server.wait().expect("an end").success());
    (after[0], after[1])
}

#[cfg(target_os = "linux")]
#[test]
fn memory_does_not_grow_with_edits() {
    // R12.7
    let (ten, all) = typed(2_000, 3_000);
    assert!(
        all < ten + ten / 4,
        "{ten} KiB after 10 edits, {all} KiB after 3000"
    );
}

#[cfg(target_os = "linux")]
#[test]
#[ignore = "takes minutes"]
fn memory_does_not_grow_with_edits_of_a_long_program() {
    // R12.7
    let (ten, all) = typed(100_000, 10_000);
    assert!(
        all < ten + ten / 4,
        "{ten} KiB after 10 edits, {all} KiB after 10000"
    );
}
