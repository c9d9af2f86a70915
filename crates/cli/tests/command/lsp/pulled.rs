//! Messages that a client requests (`textDocument/diagnostic`). Anything that is pushed or requested without
//! need fails each test at its end.

use serde_json::{Value, json};

use super::client::{Client, codes, uri};
use crate::folder::Bench;

const REFRESH: &str = "workspace/diagnostic/refresh";

/// A subprogram with a mistake in its first line, and a program that calls it.
const WRONG: &str = "X[COMP ON FRIKT]\nM17\n";
const CALLER: &str = "L sub.nc\nM30\n";

fn capabilities(refreshes: bool) -> Value {
    json!({ "capabilities": {
        "textDocument": { "diagnostic": {} },
        "workspace": { "diagnostics": { "refreshSupport": refreshes } },
    }})
}

fn pulling() -> Client {
    Client::with(&capabilities(true))
}

/// Returns the codes of a full report.
fn full(report: &Value) -> Vec<(String, u64)> {
    assert_eq!(report["kind"], "full", "{report}");
    codes(&report["items"])
}

#[test]
fn a_client_that_can_asks_and_nothing_is_pushed() {
    // R12.2
    let mut raw = Client::raw();
    let answer = raw.ask("initialize", &capabilities(true));
    assert_eq!(
        answer["capabilities"]["diagnosticProvider"],
        json!({ "interFileDependencies": true, "workspaceDiagnostics": false })
    );
    raw.leave();
    let mut client = pulling();
    client.open_as("untitled:a", "isg-cnc", "X[COMP ON FRIKT]\nM30\n");
    let first = client.pull("untitled:a", None);
    assert_eq!(full(&first), [("FC202".to_owned(), 0)]);
    // A request follows the change that the client sent before.
    client.replace("untitled:a", 2, "M30\n");
    let second = client.pull("untitled:a", Some(&first));
    assert_eq!(full(&second), []);
    client.close("untitled:a");
    assert_eq!(full(&client.pull("untitled:a", None)), []);
    client.leave();
}

#[test]
fn messages_are_pushed_to_a_client_that_would_not_ask_again() {
    // R12.2
    for capabilities in [
        capabilities(false),
        json!({ "capabilities": { "textDocument": { "diagnostic": {} } } }),
        json!({ "capabilities": { "workspace": { "diagnostics": { "refreshSupport": true } } } }),
    ] {
        let mut raw = Client::raw();
        let answer = raw.ask("initialize", &capabilities);
        assert_eq!(answer["capabilities"]["diagnosticProvider"], Value::Null);
        let said = raw.open("untitled:a", "X[COMP ON FRIKT]\nM30\n");
        assert_eq!(codes(&said), [("FC202".to_owned(), 0)]);
        raw.leave();
    }
}

#[test]
fn what_has_not_changed_is_not_sent_again() {
    // R12.2
    let mut client = pulling();
    client.open_as("untitled:a", "isg-cnc", "X[COMP ON FRIKT]\nM30\n");
    let first = client.pull("untitled:a", None);
    let same = json!({ "kind": "unchanged", "resultId": first["resultId"] });
    assert_eq!(client.pull("untitled:a", Some(&first)), same);
    client.replace("untitled:a", 2, "X[COMP ON FRIKT]\n(same)\nM30\n");
    assert_eq!(client.pull("untitled:a", Some(&first)), same);
    client.replace("untitled:a", 3, "\nX[COMP ON FRIKT]\nM30\n");
    let moved = client.pull("untitled:a", Some(&first));
    assert_eq!(full(&moved), [("FC202".to_owned(), 1)]);
    // The next server recognises an answer of an earlier one, but no other name.
    client.leave();
    let mut next = pulling();
    next.open_as("untitled:a", "isg-cnc", "X[COMP ON FRIKT]\nM30\n");
    assert_eq!(next.pull("untitled:a", Some(&first)), same);
    assert_eq!(full(&next.pull("untitled:a", Some(&moved))).len(), 1);
    next.leave();
}

#[test]
fn messages_on_a_called_program_are_told_once_whether_it_is_open_or_not() {
    // R12.2: one check reports on several texts.
    let bench = Bench::new(&[("sub.nc", WRONG)]);
    let [main, sub] = ["main.nc", "sub.nc"].map(|it| uri(&bench.folder().join(it)));
    let mut client = pulling();
    client.open_as(&main, "isg-cnc", CALLER);
    assert_eq!(full(&client.pull(&main, None)), []);
    // It is not open, so it is not requested.
    let pushed = client.diagnostics(&sub);
    assert_eq!(codes(&pushed), [("FC202".to_owned(), 0)]);
    assert_eq!(full(&client.pull(&sub, None)), []);
    // Once it is open, the pushed messages disappear and are part of the answer.
    client.open_as(&sub, "isg-cnc", WRONG);
    assert_eq!(client.diagnostics(&sub), json!([]));
    let asked = client.pull(&sub, None);
    assert_eq!(full(&asked), codes(&pushed));
    assert!(asked.to_string().contains("called from here"), "{asked}");
    // Closed again, it has the messages of its caller.
    client.close(&sub);
    assert_eq!(codes(&client.diagnostics(&sub)), codes(&pushed));
    client.settle(&main);
    client.close(&main);
    assert_eq!(client.diagnostics(&sub), json!([]));
    client.leave();
}

#[test]
fn the_client_asks_again_where_another_text_changes_what_it_shows() {
    // R12.2
    let bench = Bench::new(&[("sub.nc", "M17\n")]);
    let [main, sub] = ["main.nc", "sub.nc"].map(|it| uri(&bench.folder().join(it)));
    let mut client = pulling();
    client.open_as(&sub, "isg-cnc", "M17\n");
    client.open_as(&main, "isg-cnc", "X[COMP OFF FRICT]\nL sub.nc\nM30\n");
    let known = client.pull(&main, None);
    assert_eq!(full(&known), [("FC401".to_owned(), 0)]);
    client.settle(&sub);
    // The subprogram turns it on again: the message on the caller goes.
    client.replace(&sub, 2, "X[COMP ON FRICT]\nM17\n");
    client.does(REFRESH);
    assert_eq!(full(&client.pull(&main, Some(&known))), []);
    // A change that affects no message sends no request.
    client.replace(&sub, 3, "X[COMP ON FRICT]\n(as before)\nM17\n");
    client.settle(&sub);
    client.settle(&main);
    // The caller's messages on the open subprogram disappear with the caller.
    client.replace(
        &main,
        2,
        "X[COMP OFF FRICT]\nX[COMP ON FRICT]\nL sub.nc\nM30\n",
    );
    assert_eq!(full(&client.pull(&main, None)), []);
    client.does(REFRESH);
    let repeated = client.pull(&sub, None);
    assert_eq!(full(&repeated), [("FC402".to_owned(), 0)]);
    client.close(&main);
    client.does(REFRESH);
    assert_eq!(full(&client.pull(&sub, Some(&repeated))), []);
    client.leave();
}

#[test]
fn the_client_asks_again_after_a_change_of_a_file_or_a_setting() {
    // R12.2
    let bench = Bench::new(&[("sub.nc", "M17\n")]);
    let [main, sub] = ["main.nc", "sub.nc"].map(|it| uri(&bench.folder().join(it)));
    let mut client = pulling();
    client.open_as(&main, "isg-cnc", "X[COMP OFF FRICT]\nL sub.nc\nM30\n");
    let known = client.pull(&main, None);
    bench.write("sub.nc", "X[COMP ON FRICT]\nM17\n");
    let changes = json!({ "changes": [{ "uri": sub, "type": 2 }] });
    client.tell("workspace/didChangeWatchedFiles", &changes);
    client.does(REFRESH);
    let known = client.pull(&main, Some(&known));
    assert_eq!(full(&known), []);
    bench.write("frictcomp.toml", "[[axis]\n");
    let toml = uri(&bench.folder().join("frictcomp.toml"));
    let changes = json!({ "changes": [{ "uri": toml, "type": 2 }] });
    client.tell("workspace/didChangeWatchedFiles", &changes);
    client.does(REFRESH);
    let known = client.pull(&main, Some(&known));
    assert_eq!(full(&known), [("own".to_owned(), 0)]);
    // The configuration that cannot be read is not open.
    assert_eq!(codes(&client.diagnostics(&toml))[0].0, "FC110");
    client.close(&main);
    assert_eq!(client.diagnostics(&toml), json!([]));
    client.leave();
    let mut client = pulling();
    client.open_as("untitled:a", "isg-cnc", &("X1\n".repeat(50) + "M30\n"));
    assert_eq!(full(&client.pull("untitled:a", None)), []);
    let settings = json!({ "settings": { "frictcomp": { "maxBlocks": 20 } } });
    client.tell("workspace/didChangeConfiguration", &settings);
    client.does(REFRESH);
    assert_eq!(
        full(&client.pull("untitled:a", None)),
        [("own".to_owned(), 0)]
    );
    client.leave();
}

#[test]
fn many_texts_that_change_with_one_file_are_asked_for_once() {
    // R12.16
    let bench = Bench::new(&[("sub.nc", "M17\n")]);
    let of = |name: &str| uri(&bench.folder().join(name));
    let mut client = pulling();
    let programs: Vec<String> = (0..20).map(|at| of(&format!("p{at}.nc"))).collect();
    for program in &programs {
        client.open_as(program, "isg-cnc", "X[COMP OFF FRICT]\nL sub.nc\nM30\n");
        assert_eq!(full(&client.pull(program, None)).len(), 1);
    }
    bench.write("sub.nc", "X[COMP ON FRICT]\nM17\n");
    let changes = json!({ "changes": [{ "uri": of("sub.nc"), "type": 2 }] });
    client.tell("workspace/didChangeWatchedFiles", &changes);
    client.does(REFRESH);
    for program in &programs {
        assert_eq!(full(&client.pull(program, None)), []);
    }
    client.leave();
}
