//! Life of a server from the first request to the last, with all kinds of clients.

use std::io::Write as _;

use lsp_server::{Request, RequestId};
use serde_json::{Value, json};

use super::client::Client;

const METHOD_NOT_FOUND: i32 = -32601;
const INVALID_PARAMS: i32 = -32602;
const INVALID_REQUEST: i32 = -32600;
const NOT_INITIALIZED: i32 = -32002;
const CANCELLED: i32 = -32800;

#[test]
fn a_client_comes_and_goes() {
    // R12.1
    Client::new().leave();
}

#[test]
fn what_comes_before_initialize_is_refused() {
    // R12.1
    let mut client = Client::raw();
    client.tell("initialized", &json!({}));
    assert_eq!(
        client.refused("textDocument/hover", &json!({})),
        NOT_INITIALIZED
    );
    assert_eq!(client.refused("initialize", &json!(7)), INVALID_PARAMS);
    client.ask("initialize", &json!({ "capabilities": {} }));
    assert_eq!(
        client.refused("initialize", &json!({ "capabilities": {} })),
        INVALID_REQUEST
    );
    client.leave();
}

#[test]
fn columns_are_counted_as_agreed() {
    // R12.1
    for (offered, agreed) in [
        (json!({}), "utf-16"),
        (
            json!({ "general": { "positionEncodings": ["utf-32", "utf-16"] } }),
            "utf-16",
        ),
        (
            json!({ "general": { "positionEncodings": ["utf-16", "utf-8"] } }),
            "utf-8",
        ),
    ] {
        let mut client = Client::raw();
        let answer = client.ask("initialize", &json!({ "capabilities": offered }));
        assert_eq!(answer["capabilities"]["positionEncoding"], agreed);
        let column = if agreed == "utf-8" { 6 } else { 4 };
        let said = client.open("untitled:a", "(\u{1f600})X[COMP ON FRIKT]\nM30\n");
        assert_eq!(
            said[0]["range"]["start"]["character"],
            column + 10,
            "{said}"
        );
        client.leave();
    }
}

#[test]
fn what_is_not_known_is_refused_and_what_is_wrong_is_said() {
    // R12.1
    let mut client = Client::new();
    assert_eq!(
        client.refused("textDocument/wonders", &json!({})),
        METHOD_NOT_FOUND
    );
    for params in [
        json!(null),
        json!([]),
        json!({}),
        json!({ "textDocument": 5 }),
        json!("x"),
    ] {
        assert_eq!(
            client.refused("textDocument/hover", &params),
            INVALID_PARAMS,
            "{params}"
        );
    }
    let far = json!({ "textDocument": { "uri": "untitled:a" }, "position": { "line": -1, "character": 0 } });
    assert_eq!(client.refused("textDocument/hover", &far), INVALID_PARAMS);
    for (method, params) in [
        ("textDocument/didOpen", json!({})),
        ("textDocument/didChange", json!([1])),
        ("textDocument/didClose", json!(null)),
        (
            "textDocument/didClose",
            json!({ "textDocument": { "uri": "untitled:b" } }),
        ),
        ("workspace/didChangeWatchedFiles", json!({ "changes": 3 })),
    ] {
        client.tell(method, &params);
        client.told("window/logMessage");
    }
    client.change("untitled:never", 2, &json!([{ "text": "M30" }]));
    client.told("window/logMessage");
    // Methods that the server need not support.
    client.tell("$/setTrace", &json!({ "value": "off" }));
    client.tell(
        "textDocument/didSave",
        &json!({ "textDocument": { "uri": "untitled:a" } }),
    );
    client.send(lsp_server::Response::new_ok(RequestId::from(99), ()));
    client.told("window/logMessage");
    client.leave();
}

#[test]
fn after_shutdown_nothing_is_answered() {
    // R12.1
    let mut client = Client::new();
    client.open("untitled:a", "M30\n");
    assert_eq!(client.ask("shutdown", &Value::Null), Value::Null);
    assert_eq!(
        client.refused("textDocument/hover", &json!({})),
        INVALID_REQUEST
    );
    client.vanish();
}

#[test]
fn a_client_that_is_gone_ends_the_server() {
    // R12.1
    Client::new().vanish();
    let client = Client::new();
    let text = "X[COMP OFF FRICT]\nX[COMP ON FRICT]\n".repeat(20_000);
    client.open_as("untitled:a", "isg-cnc", &text);
    client.vanish();
}

#[test]
fn a_question_is_taken_back_at_any_time() {
    // R12.1
    let mut client = Client::new();
    let text = "G1 X1 F100\nX[COMP OFF FRICT]\nX[COMP ON FRICT]\n".repeat(10_000) + "M30\n";
    client.open_as("untitled:a", "isg-cnc", &text);
    let lens = json!({ "textDocument": { "uri": "untitled:a" } });
    let first = client.begin("textDocument/codeLens", &lens);
    client.tell("$/cancelRequest", &json!({ "id": 2 }));
    let answer = client.answer(&first);
    assert_eq!(
        answer.response_result.expect_err("taken back").code,
        CANCELLED
    );
    // Nothing of this id, no id, an id of another kind.
    for id in [
        json!(2),
        json!("2"),
        json!(null),
        json!([]),
        json!(1.5),
        json!(1e99),
    ] {
        client.tell("$/cancelRequest", &json!({ "id": id }));
    }
    client.tell("$/cancelRequest", &json!(null));
    client.diagnostics("untitled:a");
    // Before or after the answer: exactly one comes.
    for _ in 0..20 {
        let id = client.begin("textDocument/codeLens", &lens);
        client.tell(
            "$/cancelRequest",
            &json!({ "id": serde_json::to_value(&id).expect("an id") }),
        );
        client.answer(&id);
    }
    client.leave();
}

#[test]
fn an_id_means_one_question() {
    // R12.1
    let mut client = Client::new();
    client.open_as("untitled:a", "isg-cnc", &"G1 X1 F100\n".repeat(50_000));
    let lens = json!({ "textDocument": { "uri": "untitled:a" } });
    let id = client.begin("textDocument/codeLens", &lens);
    client.send(Request::new(
        id.clone(),
        "textDocument/codeLens".to_owned(),
        &lens,
    ));
    let codes = [client.answer(&id), client.answer(&id)]
        .map(|it| it.response_result.err().map(|it| it.code));
    assert_eq!(codes, [Some(INVALID_REQUEST), None]);
    client.diagnostics("untitled:a");
    client.leave();
}

#[test]
fn settings_come_first_or_later() {
    // R12.4
    let mut client = Client::with(&json!({
        "capabilities": { "workspace": {
            "configuration": true,
            "didChangeWatchedFiles": { "dynamicRegistration": true },
        }},
        "initializationOptions": { "inlayHints": { "enable": 5 } },
    }));
    assert!(
        client.told("window/logMessage")["message"]
            .as_str()
            .is_some_and(|it| it.contains("inlayHints"))
    );
    let registration = client.asked("client/registerCapability");
    client.send(lsp_server::Response::new_ok(registration.id, ()));
    let asked = client.asked("workspace/configuration");
    client.send(lsp_server::Response::new_ok(
        asked.id,
        [json!({ "codeLens": { "enable": false } })],
    ));
    client.open("untitled:a", "X[COMP OFF FRICT]\nM30\n");
    let text = json!({ "textDocument": { "uri": "untitled:a" } });
    assert_eq!(client.ask("textDocument/codeLens", &text), Value::Null);
    client.tell(
        "workspace/didChangeConfiguration",
        &json!({ "settings": null }),
    );
    let asked = client.asked("workspace/configuration");
    client.send(lsp_server::Response::new_err(asked.id, -1, "no".to_owned()));
    client.told("window/logMessage");
    client.leave();
}

#[test]
fn a_server_that_is_ended_without_having_been_asked_says_so_by_its_status() {
    // R12.17
    let bench = crate::folder::Bench::new(&[]);
    let mut command = bench.command(&["lsp"]);
    let mut server = command
        .stdin(std::process::Stdio::piped())
        .spawn()
        .expect("the tool starts");
    let body = r#"{"jsonrpc":"2.0","method":"exit"}"#;
    let mut input = server.stdin.take().expect("an input");
    write!(input, "Content-Length: {}\r\n\r\n{body}", body.len()).expect("written");
    assert_eq!(server.wait().expect("an end").code(), Some(1));
}
