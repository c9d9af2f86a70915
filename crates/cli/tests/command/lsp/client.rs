//! A client in memory. It expects every message that the server sends: an unexpected one fails the
//! test at the end.

use std::collections::{BTreeMap, VecDeque};
use std::path::Path;
use std::thread::JoinHandle;
use std::time::Duration;

use frictcomp_editor::lsp::{Shutdown, serve};
use lsp_server::{Connection, Message, Notification, Request, RequestId, Response};
use serde_json::{Value, json};

/// Time limit, longer than any answer takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

pub(crate) struct Client {
    connection: Connection,
    server: JoinHandle<Shutdown>,
    /// Messages that arrived while another one was awaited.
    kept: VecDeque<Message>,
    next: i32,
}

impl Client {
    /// Returns a client without special capabilities.
    pub(crate) fn new() -> Self {
        Self::with(&json!({ "capabilities": {} }))
    }

    /// Returns a client that has initialised the server in this way.
    pub(crate) fn with(params: &Value) -> Self {
        let mut client = Self::raw();
        let answer = client.ask("initialize", params);
        assert_eq!(answer["serverInfo"]["name"], "frictcomp");
        client.tell("initialized", &json!({}));
        client
    }

    /// Returns a client that has not sent anything yet.
    pub(crate) fn raw() -> Self {
        let (connection, other) = Connection::memory();
        let server = std::thread::spawn(move || serve(&other).expect("threads"));
        Self {
            connection,
            server,
            kept: VecDeque::new(),
            next: 0,
        }
    }

    pub(crate) fn tell(&self, method: &str, params: &Value) {
        let notification = Notification::new(method.to_owned(), params);
        self.send(notification);
    }

    pub(crate) fn send(&self, message: impl Into<Message>) {
        self.connection
            .sender
            .send(message.into())
            .expect("a server");
    }

    /// Sends a request and returns at once.
    pub(crate) fn begin(&mut self, method: &str, params: &Value) -> RequestId {
        self.next += 1;
        let id = RequestId::from(self.next);
        self.send(Request::new(id.clone(), method.to_owned(), params));
        id
    }

    /// Returns the answer to a request.
    pub(crate) fn answer(&mut self, id: &RequestId) -> Response {
        let found = self.take(|message| matches!(message, Message::Response(it) if it.id == *id));
        match found {
            Message::Response(response) => response,
            other => unreachable!("{other:?}"),
        }
    }

    /// Sends a request and waits for the result.
    #[track_caller]
    pub(crate) fn ask(&mut self, method: &str, params: &Value) -> Value {
        let id = self.begin(method, params);
        self.answer(&id).response_result.expect("a result")
    }

    /// Sends a request and waits for the refusal: its number.
    #[track_caller]
    pub(crate) fn refused(&mut self, method: &str, params: &Value) -> i32 {
        let id = self.begin(method, params);
        self.answer(&id)
            .response_result
            .expect_err("a refusal")
            .code
    }

    /// Returns the next notification of a method: its parameters.
    #[track_caller]
    pub(crate) fn told(&mut self, method: &str) -> Value {
        match self.take(|it| matches!(it, Message::Notification(it) if it.method == method)) {
            Message::Notification(it) => it.params,
            other => unreachable!("{other:?}"),
        }
    }

    /// Returns the next request of the server of a method.
    pub(crate) fn asked(&mut self, method: &str) -> Request {
        match self.take(|it| matches!(it, Message::Request(it) if it.method == method)) {
            Message::Request(it) => it,
            other => unreachable!("{other:?}"),
        }
    }

    /// Waits for the next message of a kind; earlier ones are kept.
    #[track_caller]
    fn take(&mut self, wanted: impl Fn(&Message) -> bool) -> Message {
        if let Some(at) = self.kept.iter().position(&wanted) {
            return self.kept.remove(at).expect("it is there");
        }
        loop {
            let message = self.connection.receiver.recv_timeout(PATIENCE);
            let message = message.unwrap_or_else(|error| panic!("{error}; kept: {:?}", self.kept));
            if wanted(&message) {
                return message;
            }
            self.kept.push_back(message);
        }
    }

    /// Opens a text and returns the messages about it.
    pub(crate) fn open(&mut self, uri: &str, text: &str) -> Value {
        self.open_as(uri, "isg-cnc", text);
        self.diagnostics(uri)
    }

    pub(crate) fn open_as(&self, uri: &str, language: &str, text: &str) {
        let document = json!({ "uri": uri, "languageId": language, "version": 1, "text": text });
        self.tell("textDocument/didOpen", &json!({ "textDocument": document }));
    }

    /// Replaces a whole text.
    pub(crate) fn replace(&self, uri: &str, version: i32, text: &str) {
        self.change(uri, version, &json!([{ "text": text }]));
    }

    pub(crate) fn change(&self, uri: &str, version: i32, changes: &Value) {
        let text = json!({ "uri": uri, "version": version });
        let params = json!({ "textDocument": text, "contentChanges": changes });
        self.tell("textDocument/didChange", &params);
    }

    pub(crate) fn close(&self, uri: &str) {
        self.tell(
            "textDocument/didClose",
            &json!({ "textDocument": { "uri": uri } }),
        );
    }

    /// Returns the next messages about a text.
    #[track_caller]
    pub(crate) fn diagnostics(&mut self, uri: &str) -> Value {
        let is_it = |it: &Notification| {
            it.method == "textDocument/publishDiagnostics" && it.params["uri"] == uri
        };
        match self.take(|message| matches!(message, Message::Notification(it) if is_it(it))) {
            Message::Notification(mut it) => it.params["diagnostics"].take(),
            other => unreachable!("{other:?}"),
        }
    }

    /// Requests the messages on a text.
    #[track_caller]
    pub(crate) fn pull(&mut self, uri: &str, known: Option<&Value>) -> Value {
        let mut params = json!({ "textDocument": { "uri": uri } });
        if let Some(known) = known {
            params["previousResultId"] = known["resultId"].clone();
        }
        self.ask("textDocument/diagnostic", &params)
    }

    /// Answers the next request of the server of a method.
    #[track_caller]
    pub(crate) fn does(&mut self, method: &str) {
        let id = self.asked(method).id;
        self.send(Response::new_ok(id, Value::Null));
    }

    /// Waits until a text is checked: a request about it is answered after that.
    pub(crate) fn settle(&mut self, uri: &str) {
        self.ask(
            "textDocument/codeLens",
            &json!({ "textDocument": { "uri": uri } }),
        );
    }

    /// Returns the last messages about a text, once it is checked; `None` if there are no new ones.
    pub(crate) fn settled(&mut self, uri: &str) -> Option<Value> {
        self.settle(uri);
        self.published(|it| it == uri).remove(uri)
    }

    /// Takes the messages about texts that have arrived so far, the last ones of each text.
    pub(crate) fn published(&mut self, of: impl Fn(&str) -> bool) -> BTreeMap<String, Value> {
        self.kept.extend(self.connection.receiver.try_iter());
        let mut published = BTreeMap::new();
        for message in std::mem::take(&mut self.kept) {
            match message {
                Message::Notification(Notification { method, mut params })
                    if method == "textDocument/publishDiagnostics"
                        && params["uri"].as_str().is_some_and(&of) =>
                {
                    let uri = params["uri"].as_str().expect("a URI").to_owned();
                    published.insert(uri, params["diagnostics"].take());
                }
                other => self.kept.push_back(other),
            }
        }
        published
    }

    /// Shuts down. No unexpected message may be left.
    pub(crate) fn leave(mut self) {
        self.ask("shutdown", &Value::Null);
        self.tell("exit", &Value::Null);
        assert_eq!(self.server.join().expect("no panic"), Shutdown::Proper);
        self.kept.extend(self.connection.receiver.try_iter());
        assert!(self.kept.is_empty(), "nobody expected {:?}", self.kept);
    }

    /// Shuts down, whatever is left.
    pub(crate) fn drop_all(mut self) {
        self.ask("shutdown", &Value::Null);
        self.tell("exit", &Value::Null);
        assert_eq!(self.server.join().expect("no panic"), Shutdown::Proper);
    }

    /// Disconnects without notice.
    pub(crate) fn vanish(self) {
        drop(self.connection);
        assert_eq!(self.server.join().expect("no panic"), Shutdown::Abrupt);
    }
}

/// Returns the URI of a file.
pub(crate) fn uri(path: &Path) -> String {
    let path = path.display().to_string().replace('\\', "/");
    // A Windows drive follows a slash, with which other paths begin.
    format!("file:///{}", path.trim_start_matches('/'))
}

/// Returns the codes of messages, `own` for those of the server itself, with their lines from 0.
pub(crate) fn codes(diagnostics: &Value) -> Vec<(String, u64)> {
    let all = diagnostics.as_array().expect("a list").iter();
    let code = |it: &Value| it["code"].as_str().unwrap_or("own").to_owned();
    all.map(|it| {
        (
            code(it),
            it["range"]["start"]["line"].as_u64().expect("a line"),
        )
    })
    .collect()
}
