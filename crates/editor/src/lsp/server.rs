//! The loop that listens to the client and to its workers (R12.1).
//!
//! It does no work itself: checks and answers are made on other threads, from copies of the texts that
//! do not change.

use std::collections::BTreeSet;
use std::io;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, Sender, select, unbounded};
use gen_lsp_types::{
    CodeLensRefreshRequest, DiagnosticRefreshRequest, DidChangeConfigurationParams,
    DidChangeTextDocumentParams, DidChangeWatchedFilesParams, DidCloseTextDocumentParams,
    DidOpenTextDocumentParams, InitializeParams, InlayHintRefreshRequest, Notification as _,
    PublishDiagnosticsNotification, PublishDiagnosticsParams, Uri,
};
use lsp_server::{
    Connection, ErrorCode, Message, Notification, ReqQueue, Request, RequestId, Response,
};
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::analysis::{Analysis, AnalysisJob};
use super::asked::{self, ServerRequest};
use super::capabilities::offer;
use super::checks::{Checks, Outdated};
use super::client::{LspClient, project};
use super::delivery::{CheckedFor, Delivery};
use super::documents::{Documents, Kind, OpenDocument, is_of_a_user};
use super::lanes::{Lanes, RoutedRequest};
use super::log::log;
use super::messages::{ByText, Translator};
use super::project_calls::ProjectCalls;
use super::refusal::Refusal;
use super::requests::{Handler, Needs, handler};
use super::uri::path_of;
use super::users::{EditedText, Users};
use super::view::RequestView;
use super::worker::{Cancel, Worker};
use frictcomp_host::SharedMap;

/// Time without events after which the server looks for due work.
const IDLE: Duration = Duration::from_secs(3600);

/// Questions that wait for a check; more are refused.
const MOST_WAITING: usize = 1000;

/// Form of the end of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Shutdown {
    /// The client requested the shutdown, and then the exit.
    Proper,
    /// The client disconnected, or requested the exit without a shutdown.
    Abrupt,
}

/// Work that is done.
enum FinishedWork {
    /// A text was checked; `None` if it has changed meanwhile.
    Checked(Option<Box<Analysis>>),
    /// A question was answered.
    Answered(Response),
}

impl From<Response> for FinishedWork {
    fn from(response: Response) -> Self {
        Self::Answered(response)
    }
}

/// A request that waits for the check of a text.
struct Waiting {
    id: RequestId,
    uri: Uri,
    handler: Handler,
    params: Value,
}

/// Serves one client until it disconnects.
///
/// # Errors
/// The system cannot start a thread.
pub fn serve(connection: &Connection) -> io::Result<Shutdown> {
    let (id, params) = match initialize(connection) {
        Ok(first) => first,
        Err(shutdown) => return Ok(shutdown),
    };
    let mut server = LspServer::new(connection, &params)?;
    server.send(Response::new_ok(id, offer(&server.client, &server.calls)));
    Ok(server.listen())
}

/// Waits for the client to send its capabilities. A client that disconnects before then ends the session
/// without an error.
fn initialize(connection: &Connection) -> Result<(RequestId, InitializeParams), Shutdown> {
    loop {
        let Ok(message) = connection.receiver.recv() else {
            return Err(Shutdown::Proper);
        };
        let refused = match message {
            Message::Request(request) if request.method == "initialize" => {
                match serde_json::from_value(request.params) {
                    Ok(params) => return Ok((request.id, params)),
                    Err(error) => Refusal::from(error).of(request.id),
                }
            }
            Message::Request(request) => {
                let first = "the first request must be `initialize`".to_owned();
                Response::new_err(request.id, ErrorCode::ServerNotInitialized as i32, first)
            }
            Message::Notification(it) if it.method == "exit" => return Err(Shutdown::Abrupt),
            Message::Notification(_) | Message::Response(_) => continue,
        };
        // A client that is gone closes the other channel, too.
        let _ = connection.sender.send(refused.into());
    }
}

/// The server of one client.
struct LspServer<'c> {
    connection: &'c Connection,
    client: Arc<LspClient>,
    documents: Documents,
    calls: ProjectCalls,
    analyses: SharedMap<String, Arc<Analysis>>,
    users: Users,
    /// Texts edited since the running check began, which it may have read as they were.
    edited: Vec<EditedText>,
    delivery: Delivery,
    checks: Checks,
    checking: Worker<AnalysisJob>,
    lanes: Lanes,
    done: Receiver<FinishedWork>,
    waiting: Vec<Waiting>,
    /// Questions of the client on their way, and what the server asked the client.
    queue: ReqQueue<Cancel, ServerRequest>,
    is_shut_down: bool,
}

impl<'c> LspServer<'c> {
    fn new(connection: &'c Connection, params: &InitializeParams) -> io::Result<Self> {
        let (client, wrong) = LspClient::new(params);
        let (sender, done) = unbounded();
        let here = || std::env::current_dir().ok();
        let project = project(params);
        let calls = ProjectCalls::new(project.clone());
        let folder = project.or_else(here).unwrap_or_default();
        let server = Self {
            connection,
            client: Arc::new(client),
            documents: Documents::new(folder),
            calls,
            analyses: SharedMap::default(),
            users: Users::default(),
            edited: Vec::new(),
            delivery: Delivery::default(),
            checks: Checks::default(),
            lanes: Lanes::new(&sender)?,
            checking: checking(sender)?,
            done,
            waiting: Vec::new(),
            queue: ReqQueue::default(),
            is_shut_down: false,
        };
        for wrong in wrong {
            server.send(log(wrong));
        }
        Ok(server)
    }

    fn listen(&mut self) -> Shutdown {
        loop {
            let now = Instant::now();
            while let Some(uri) = self.checks.due(now) {
                self.begin_check(&uri);
            }
            let is_settled = self.checks.are_done() && !self.is_shut_down;
            if is_settled && self.delivery.take_outdated() {
                self.refresh::<DiagnosticRefreshRequest>();
            }
            let wait = self.checks.wait(now).unwrap_or(IDLE);
            select! {
                recv(self.connection.receiver) -> message => match message {
                    Ok(Message::Request(request)) => self.request(request),
                    Ok(Message::Notification(it)) if it.method == "exit" => return self.shutdown(),
                    Ok(Message::Notification(notification)) => self.notification(notification),
                    Ok(Message::Response(response)) => self.response(response),
                    Err(_) => return Shutdown::Abrupt,
                },
                recv(self.done) -> done => match done {
                    Ok(FinishedWork::Checked(analysis)) => self.checked(analysis),
                    Ok(FinishedWork::Answered(response)) => self.answered(response),
                    Err(_) => return Shutdown::Abrupt,
                },
                default(wait) => {}
            }
        }
    }

    fn shutdown(&self) -> Shutdown {
        if self.is_shut_down {
            Shutdown::Proper
        } else {
            Shutdown::Abrupt
        }
    }

    fn send(&self, message: impl Into<Message>) {
        // A client that is gone closes the other channel, too, which ends the loop.
        let _ = self.connection.sender.send(message.into());
    }

    // Questions of the client.

    fn request(&mut self, request: Request) {
        let Request { id, method, params } = request;
        let refuse = |code: ErrorCode, why: String| Response::new_err(id.clone(), code as i32, why);
        if self.is_shut_down {
            let why = "the server was asked to shut down".to_owned();
            return self.send(refuse(ErrorCode::InvalidRequest, why));
        }
        if !self.queue.incoming.is_completed(&id) {
            let why = "another request of this id is not answered yet".to_owned();
            return self.send(refuse(ErrorCode::InvalidRequest, why));
        }
        if method == "shutdown" {
            self.is_shut_down = true;
            self.checks.stop();
            return self.send(Response::new_ok(id, ()));
        }
        if method == "initialize" {
            let why = "the server is initialized already".to_owned();
            return self.send(refuse(ErrorCode::InvalidRequest, why));
        }
        let Some((needs, handler)) = handler(&method) else {
            let why = format!("there is no method `{method}`");
            return self.send(refuse(ErrorCode::MethodNotFound, why));
        };
        self.queue.incoming.register(id.clone(), Cancel::default());
        let uri = params.pointer("/textDocument/uri").and_then(Value::as_str);
        let uri = uri.map(Uri::from);
        match uri.filter(|uri| needs == Needs::Check && !self.is_checked(uri)) {
            Some(_) if self.waiting.len() >= MOST_WAITING => {
                self.queue.incoming.complete(&id);
                let why = "too many requests wait for this text".to_owned();
                self.send(refuse(ErrorCode::ServerCancelled, why));
            }
            Some(uri) => self.waiting.push(Waiting {
                id,
                uri,
                handler,
                params,
            }),
            None => self.ask(id, (needs, handler), params),
        }
    }

    /// Returns whether nothing new is to be expected about a text.
    fn is_checked(&self, uri: &Uri) -> bool {
        self.documents.get(uri).is_none() || !self.checks.is_awaited(&uri.0)
    }

    fn ask(&mut self, id: RequestId, (needs, handler): (Needs, Handler), params: Value) {
        let cancel = Cancel::default();
        self.queue.incoming.register(id.clone(), cancel.clone());
        let view = RequestView {
            client: Arc::clone(&self.client),
            documents: self.documents.clone(),
            analyses: self.analyses.clone(),
            shown: self.delivery.shown().clone(),
            calls: self.calls.clone(),
            cancel,
        };
        let question = RoutedRequest {
            id,
            handler,
            params,
            view,
        };
        self.lanes.send(needs, question);
    }

    fn answered(&mut self, response: Response) {
        // A cancelled request has its answer already.
        if self.queue.incoming.complete(&response.id).is_some() {
            self.send(response);
        }
    }

    fn cancel(&mut self, params: &Value) {
        let id = match params.get("id") {
            Some(Value::Number(id)) => id
                .as_i64()
                .and_then(|id| i32::try_from(id).ok())
                .map(RequestId::from),
            Some(Value::String(id)) => Some(RequestId::from(id.clone())),
            _ => None,
        };
        let Some(id) = id else { return };
        self.waiting.retain(|waiting| waiting.id != id);
        if let Some(cancel) = self.queue.incoming.complete(&id) {
            cancel.set();
            let code = ErrorCode::RequestCanceled as i32;
            self.send(Response::new_err(id, code, "cancelled".to_owned()));
        }
    }

    // Notifications of the client.

    fn notification(&mut self, notification: Notification) {
        let Notification { method, params } = notification;
        let told = match method.as_str() {
            "initialized" => {
                self.ask_client();
                Ok(())
            }
            "$/cancelRequest" => {
                self.cancel(&params);
                Ok(())
            }
            "textDocument/didOpen" => read(params).map(|it| self.opened(it)),
            "textDocument/didChange" => read(params).map(|it| self.changed(it)),
            "textDocument/didClose" => read(params).map(|it| self.closed(it)),
            "workspace/didChangeWatchedFiles" => read(params).map(|it| self.files_changed(&it)),
            "workspace/didChangeConfiguration" => read(params).map(|it| self.settings_changed(&it)),
            "textDocument/didSave" => {
                self.calls.forget();
                Ok(())
            }
            // Notifications that can be ignored: `$/setTrace`.
            _ => Ok(()),
        };
        if let Err(error) = told {
            self.send(log(format!("`{method}` cannot be read: {error}")));
        }
    }

    fn opened(&mut self, params: DidOpenTextDocumentParams) {
        if !is_of_a_user(&params.text_document.uri) {
            return;
        }
        let languages = &self.client.settings.languages;
        let document = self.documents.open(params.text_document, languages);
        self.analyses.remove(&document.uri.0);
        self.users.forget(&document.uri.0);
        let translator = translator(&self.client, &self.documents);
        self.publish(self.delivery.opened(translator, &document.uri.0));
        self.expect_check(&document, Outdated::Now);
        self.expect_users(&document);
    }

    fn changed(&mut self, params: DidChangeTextDocumentParams) {
        let text = params.text_document;
        let uri = text.text_document_identifier.uri;
        let changes = params.content_changes;
        let encoding = self.client.encoding;
        match self
            .documents
            .change((&uri, text.version), changes, encoding)
        {
            Some(document) => {
                self.expect_check(&document, Outdated::ByTyping);
                self.expect_users(&document);
            }
            None if !is_of_a_user(&uri) => {}
            None => self.send(log(format!("`{}` was changed, but is not open", uri.0))),
        }
    }

    fn closed(&mut self, params: DidCloseTextDocumentParams) {
        let uri = params.text_document.uri;
        let Some(document) = self.documents.close(&uri) else {
            if is_of_a_user(&uri) {
                self.send(log(format!("`{}` was closed, but is not open", uri.0)));
            }
            return;
        };
        self.analyses.remove(&uri.0);
        self.users.forget(&uri.0);
        self.checks.forget(&uri.0);
        let translator = translator(&self.client, &self.documents);
        let messages = self.delivery.closed(translator, &uri.0);
        self.publish(messages);
        self.expect_users(&document);
        self.answer_waiting(&uri);
    }

    fn files_changed(&mut self, params: &DidChangeWatchedFilesParams) {
        self.calls.forget();
        let events = params.changes.iter();
        let changed: Vec<_> = events.filter_map(|it| path_of(&it.uri.0)).collect();
        // A new file may be what was not found before.
        let has_new = !changed.iter().all(|path| self.users.are_of(path));
        let running = self.checks.running().map(str::to_owned);
        let texts: BTreeSet<String> = if has_new {
            self.users.all().cloned().collect()
        } else {
            let users = changed.iter().flat_map(|path| self.users.of(path));
            users.cloned().collect()
        };
        // A check that runs may have read the files as they were.
        for uri in texts.into_iter().chain(running) {
            self.checks.expect(&uri, Outdated::ByOthers);
        }
    }

    fn settings_changed(&mut self, params: &DidChangeConfigurationParams) {
        if self.client.gives_settings() {
            let request = asked::settings(&mut self.queue.outgoing);
            self.send(request);
        } else {
            self.take_settings(&params.settings);
        }
    }

    fn take_settings(&mut self, given: &Value) {
        let before = self.client.settings.clone();
        let client = Arc::make_mut(&mut self.client);
        let wrong = client.settings.take(given);
        for wrong in wrong {
            self.send(log(wrong));
        }
        if self.client.settings != before {
            let documents = self.documents.clone();
            for document in documents.iter() {
                self.expect_check(document, Outdated::ByOthers);
            }
        }
    }

    // Questions of the server.

    /// Requests what a client gives once it is ready: its settings, and news of files.
    fn ask_client(&mut self) {
        if self.client.watches_files() {
            let request = asked::news_of_files(&mut self.queue.outgoing);
            self.send(request);
        }
        if self.client.gives_settings() {
            let request = asked::settings(&mut self.queue.outgoing);
            self.send(request);
        }
    }

    fn response(&mut self, response: Response) {
        let Some(asked) = self.queue.outgoing.complete(response.id) else {
            return self.send(log("an answer matches no request".to_owned()));
        };
        match (asked, response.response_result) {
            (ServerRequest::Settings, Ok(Value::Array(given))) => {
                given
                    .first()
                    .into_iter()
                    .for_each(|given| self.take_settings(given));
            }
            (asked, Err(error)) => {
                self.send(log(format!("{}: {}", asked.refused(), error.message)));
            }
            (_, Ok(_)) => {}
        }
    }

    // Checks.

    /// Schedules another check of a text, if it is one that is checked.
    fn expect_check(&mut self, document: &OpenDocument, why: Outdated) {
        if document.kind != Kind::Other {
            self.checks.expect(&document.uri.0, why);
        }
    }

    /// Schedules another check of the texts whose checks read a text, or may look for it.
    fn expect_users(&mut self, document: &OpenDocument) {
        let edited = EditedText::from(document);
        for uri in self.users.concerned(&edited) {
            self.checks.expect(&uri, Outdated::ByOthers);
        }
        if self.checks.running().is_some() && !self.edited.contains(&edited) {
            self.edited.push(edited);
        }
    }

    fn begin_check(&mut self, uri: &str) {
        let Some(document) = self.documents.get(&Uri::from(uri)) else {
            return;
        };
        self.edited.clear();
        let job = AnalysisJob {
            document: Arc::clone(document),
            disk: self.documents.disk(),
            max_blocks: self.client.settings.max_blocks,
            cancel: self.checks.begin(uri),
        };
        self.checking.send(job);
    }

    fn checked(&mut self, analysis: Option<Box<Analysis>>) {
        let Some(uri) = self.checks.end() else { return };
        let uri = Uri::from(uri);
        let (Some(analysis), Some(document)) = (analysis, self.documents.get(&uri)) else {
            return;
        };
        let translator = translator(&self.client, &self.documents);
        let messages = translator.messages(document, &analysis);
        let earlier = self.analyses.get(&uri.0).map(|earlier| earlier.version);
        let why = if earlier == Some(analysis.version) {
            CheckedFor::Others
        } else {
            CheckedFor::Itself
        };
        self.users.note(document, &analysis);
        let is_outdated = |it: &EditedText| self.users.concerned(it).contains(&uri.0);
        if self.edited.iter().any(is_outdated) {
            self.checks.expect(&uri.0, Outdated::ByOthers);
        }
        self.analyses.insert(uri.0.clone(), Arc::new(*analysis));
        let messages = self.delivery.checked(translator, (&uri.0, why), messages);
        self.publish(messages);
        self.answer_waiting(&uri);
        if why == CheckedFor::Others {
            // The text itself did not change, so the client has no reason to ask again.
            if self.client.refreshes_inlay_hints() {
                self.refresh::<InlayHintRefreshRequest>();
            }
            if self.client.refreshes_code_lenses() {
                self.refresh::<CodeLensRefreshRequest>();
            }
        }
    }

    /// Tells the client to ask again for what it shows.
    fn refresh<R: gen_lsp_types::Request<Params = ()>>(&mut self) {
        let outgoing = &mut self.queue.outgoing;
        let request = outgoing.register(R::METHOD.to_string(), (), ServerRequest::Refresh);
        self.send(request);
    }

    fn answer_waiting(&mut self, uri: &Uri) {
        if !self.is_checked(uri) {
            return;
        }
        let ready = |waiting: &mut Waiting| waiting.uri == *uri;
        let ready: Vec<Waiting> = self.waiting.extract_if(.., ready).collect();
        for Waiting {
            id,
            handler,
            params,
            ..
        } in ready
        {
            self.ask(id, (Needs::Check, handler), params);
        }
    }

    fn publish(&self, messages: ByText) {
        for (uri, diagnostics) in messages {
            let uri = Uri(uri);
            let version = self.documents.get(&uri).map(|document| document.version);
            let analysis = self.analyses.get(&uri.0).map(|analysis| analysis.version);
            let params = PublishDiagnosticsParams {
                version: version.filter(|version| Some(*version) == analysis),
                uri,
                diagnostics,
            };
            let method = PublishDiagnosticsNotification::METHOD.to_string();
            self.send(Notification::new(method, params));
        }
    }
}

fn translator<'a>(client: &'a LspClient, documents: &'a Documents) -> Translator<'a> {
    Translator { client, documents }
}

fn read<P: DeserializeOwned>(params: Value) -> Result<P, serde_json::Error> {
    serde_json::from_value(params)
}

/// Returns the thread of the checks.
fn checking(done: Sender<FinishedWork>) -> io::Result<Worker<AnalysisJob>> {
    Worker::new("checks", move |job: AnalysisJob| {
        // The receiver is gone with the server.
        let _ = done.send(FinishedWork::Checked(job.run().map(Box::new)));
    })
}
