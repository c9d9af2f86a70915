//! Delay of the messages in an editor after typing (R12.7): `cargo bench --bench lsp`.

#![allow(clippy::print_stdout, reason = "a benchmark prints what it measures")]

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use frictcomp_editor::lsp::serve;
use lsp_server::{Connection, Message, Notification, Request, RequestId};
use serde_json::{Value, json};

const URI: &str = "untitled:bench";

/// Number of measurements of each kind; the median is shown.
const ROUNDS: i32 = 15;

struct Client(Connection);

impl Client {
    fn tell(&self, method: &str, params: &Value) {
        let notification = Notification::new(method.to_owned(), params);
        self.0.sender.send(notification.into()).expect("a server");
    }

    fn ask(&self, id: i32, method: &str, params: &Value) {
        let request = Request::new(RequestId::from(id), method.to_owned(), params);
        self.0.sender.send(request.into()).expect("a server");
        while !matches!(self.next(), Message::Response(it) if it.id == RequestId::from(id)) {}
    }

    fn next(&self) -> Message {
        let patience = Duration::from_secs(120);
        self.0.receiver.recv_timeout(patience).expect("a message")
    }

    /// Measures the time until messages about the text come.
    fn messages(&self, since: Instant) -> Duration {
        let is_it = |method: &str| method == "textDocument/publishDiagnostics";
        while !matches!(self.next(), Message::Notification(it) if is_it(&it.method)) {}
        since.elapsed()
    }

    /// Types one letter: `FRICT` becomes `FRIKT`, or the other way round.
    fn type_letter(&self, version: i32, line: u64) -> Duration {
        let letter = if version % 2 == 0 { "K" } else { "C" };
        let at = |character: u64| json!({ "line": line, "character": character });
        let change = json!({ "range": { "start": at(13), "end": at(14) }, "text": letter });
        let since = Instant::now();
        self.tell(
            "textDocument/didChange",
            &json!({ "textDocument": { "uri": URI, "version": version }, "contentChanges": [change] }),
        );
        self.messages(since)
    }
}

/// Returns where the command stands that is changed: in the part of a program that is checked.
fn changed_line(blocks: u64) -> u64 {
    blocks.min(100_000) / 2
}

/// Returns a milling program of so many blocks, with a COMP command among them.
fn program(blocks: u64) -> String {
    let mut text = String::new();
    for block in 0..blocks {
        if block == changed_line(blocks) {
            text += "X[COMP ON FRICT]\n";
        } else {
            let (x, y) = (block % 97, block % 89);
            let _ = writeln!(text, "N{block} G01 X{x}.125 Y{y}.25 Z-1.5 F2000");
        }
    }
    text + "M30\n"
}

fn main() {
    for (blocks, goals) in [
        (100_000, Some((300, 150))),
        (1_000_000, None),
        (5_000_000, None),
    ] {
        measure(blocks, goals);
    }
}

fn measure(blocks: u64, goals: Option<(u128, u128)>) {
    let (ours, other) = Connection::memory();
    let server = std::thread::spawn(move || serve(&other).expect("threads"));
    let client = Client(ours);
    client.ask(0, "initialize", &json!({ "capabilities": {} }));
    client.tell("initialized", &json!({}));
    let text = program(blocks);
    let rounds = if goals.is_some() { ROUNDS } else { 3 };
    let (mut opened, mut typed) = (Vec::new(), Vec::new());
    let mut version = 1;
    for round in 0..rounds {
        let document = json!({ "uri": URI, "languageId": "isg-cnc", "version": 1, "text": text });
        let since = Instant::now();
        client.tell("textDocument/didOpen", &json!({ "textDocument": document }));
        opened.push(client.messages(since));
        version = 1;
        if round + 1 < rounds {
            client.tell(
                "textDocument/didClose",
                &json!({ "textDocument": { "uri": URI } }),
            );
            client.messages(Instant::now());
        }
    }
    for _ in 0..rounds {
        version += 1;
        typed.push(client.type_letter(version, changed_line(blocks)));
    }
    show(
        &format!("{blocks} blocks: opened"),
        opened,
        goals.map(|it| it.0),
    );
    show(
        &format!("{blocks} blocks: one letter"),
        typed,
        goals.map(|it| it.1),
    );
    client.ask(1, "shutdown", &Value::Null);
    client.tell("exit", &Value::Null);
    server.join().expect("a proper end");
}

fn show(what: &str, mut times: Vec<Duration>, goal: Option<u128>) {
    times.sort_unstable();
    let median = times[times.len() / 2].as_millis();
    let goal = goal.map_or(String::new(), |goal| format!("   goal {goal} ms"));
    println!("{what:<32} {median:>6} ms{goal}");
}
