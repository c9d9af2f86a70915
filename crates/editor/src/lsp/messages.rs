//! Messages as the protocol has them (R12.2).

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use gen_lsp_types::{
    Code as MessageCode, CodeDescription, Diagnostic as Message, DiagnosticRelatedInformation,
    DiagnosticSeverity, DiagnosticTag, Location, Message as MessageText, Range, Uri,
};

use super::analysis::Analysis;
use super::client::LspClient;
use super::documents::{Documents, OpenDocument};
use super::encoding::whole_line;
use super::pages::page_uri;
use frictcomp::diagnostic::{Advice, Code, Diagnostic, Severity};
use frictcomp::text::Place;
use frictcomp_host::SharedMap;

/// The source that an editor shows with a message.
const SOURCE: &str = "frictcomp";

/// Text before advice.
const HELP: &str = "\nhelp: ";

/// Text of a message on a main program that reaches it.
const REACHED_FROM: &str = "reached from this program";

/// Number of main programs that a message names.
const MAX_PROGRAMS: usize = 20;

/// Messages of a check, by the URIs of the texts that they are about.
pub(super) type ByText = BTreeMap<String, Vec<Message>>;

/// Messages on each text, by their URIs; a copy is cheap.
pub(super) type MessagesByUri = SharedMap<String, Arc<[Message]>>;

/// Makes messages for a client.
#[derive(Clone, Copy)]
pub(super) struct Translator<'a> {
    /// The client.
    pub(super) client: &'a LspClient,
    /// Open documents.
    pub(super) documents: &'a Documents,
}

impl Translator<'_> {
    /// Returns the messages of a check, on the text itself and on others.
    pub(super) fn messages(self, document: &OpenDocument, analysis: &Analysis) -> ByText {
        let mut messages = ByText::new();
        let own = messages.entry(document.uri.0.clone()).or_default();
        own.extend(self.failure(analysis));
        own.extend(Self::shortened(analysis));
        for said in &analysis.said {
            let (uri, message) = self.message(said);
            messages.entry(uri.0).or_default().push(message);
        }
        messages
    }

    /// Returns the message on a text that could not be checked: without it the text would look
    /// clean.
    fn failure(self, analysis: &Analysis) -> Option<Message> {
        let failure = analysis.failure.as_ref()?;
        let help = failure.help.iter().map(|help| format!("\nhelp: {help}"));
        let text = format!(
            "not checked: {}{}",
            failure.message,
            help.collect::<String>()
        );
        let mut message = own(DiagnosticSeverity::Error, text);
        let related = analysis
            .said
            .iter()
            .map(|said| self.related(&said.place, &said.message));
        message.related_information = Some(related.collect());
        Some(message)
    }

    /// Returns the remark that only the first blocks were checked (R12.7).
    fn shortened(analysis: &Analysis) -> Option<Message> {
        let run = analysis.run.as_ref()?;
        let blocks = run.blocks;
        run.is_cut.then(|| {
            let text = format!(
                "only the first {blocks} executed blocks are checked here; `frictcomp check` checks more"
            );
            own(DiagnosticSeverity::Information, text)
        })
    }

    /// Returns a message, and the text that it is about.
    pub(super) fn message(self, said: &Diagnostic) -> (Uri, Message) {
        let help = said.advice.iter().map(|advice| format!("{HELP}{advice}"));
        let labels = said.labels.iter();
        let labels = labels.map(|label| self.related(&label.place, &label.text));
        let lists = said
            .advice
            .iter()
            .filter_map(|advice| self.list_line(advice));
        let programs = said.reached_from.programs().iter();
        let programs = programs.map(|file| self.reached_from(file));
        let related: Vec<_> = labels.chain(lists).chain(programs).collect();
        let message = Message {
            range: self.client.encoding.range(&said.place),
            severity: Some(match said.severity {
                Severity::Error => DiagnosticSeverity::Error,
                Severity::Warning => DiagnosticSeverity::Warning,
                Severity::Info => DiagnosticSeverity::Information,
            }),
            code: Some(MessageCode::String(said.code.as_str().to_owned())),
            code_description: Some(CodeDescription {
                href: page_uri(said.code, &self.client.settings),
            }),
            source: Some(SOURCE.to_owned()),
            message: format!("{}{}", said.message, help.collect::<String>()).into(),
            tags: (said.code == Code::Fc402).then(|| vec![DiagnosticTag::Unnecessary]),
            related_information: (!related.is_empty()).then_some(related),
            data: None,
        };
        (self.uri(&said.place.file), message)
    }

    /// Returns the URI of a file name in messages.
    pub(super) fn uri(self, file: &str) -> Uri {
        self.documents.uri(&Documents::path(file))
    }

    fn related(self, place: &Place, text: &str) -> DiagnosticRelatedInformation {
        DiagnosticRelatedInformation {
            location: self.location(&place.file, self.client.encoding.range(place)),
            message: text.to_owned(),
        }
    }

    /// Returns a main program that reaches a message in a called program (R17.1).
    fn reached_from(self, file: &str) -> DiagnosticRelatedInformation {
        DiagnosticRelatedInformation {
            location: self.location(file, whole_line(0)),
            message: REACHED_FROM.to_owned(),
        }
    }

    /// Returns the line of a list whose setting the advice is about.
    fn list_line(self, advice: &Advice) -> Option<DiagnosticRelatedInformation> {
        let Advice::ConfigureInList { file, line, .. } = advice else {
            return None;
        };
        Some(DiagnosticRelatedInformation {
            location: self.location(file, whole_line(line.saturating_sub(1))),
            message: "P-AXIS-00522 is set to 0 here".to_owned(),
        })
    }

    fn location(self, file: &str, range: Range) -> Location {
        let uri = self.uri(file);
        Location { uri, range }
    }
}

/// Returns a message of the server itself, at the first line.
fn own(severity: DiagnosticSeverity, text: String) -> Message {
    Message {
        range: whole_line(0),
        severity: Some(severity),
        source: Some(SOURCE.to_owned()),
        message: text.into(),
        ..Message::default()
    }
}

/// Returns the key by which two messages on a text are the same (R17.3). It ignores advice, which depends
/// on the main program.
fn cause(message: &Message) -> String {
    let said = match &message.message {
        MessageText::String(text) => text.split(HELP).next(),
        MessageText::MarkupContent(_) => None,
    };
    format!("{:?} {:?} {said:?}", message.range, message.code)
}

/// Adds the main programs of the same message of another check (R17.1). A message of a main program
/// says more than that of the called program alone.
fn reach(known: &mut Message, message: &Message) {
    let is_reached = |it: &Message| {
        let mut related = it.related_information.iter().flatten();
        related.any(|it| it.message == REACHED_FROM)
    };
    if !is_reached(known) {
        known.clone_from(message);
        return;
    }
    let programs = message.related_information.iter().flatten();
    for program in programs.filter(|it| it.message == REACHED_FROM) {
        let related = known.related_information.get_or_insert_default();
        let named = related.iter().filter(|it| it.message == REACHED_FROM);
        if named.count() < MAX_PROGRAMS && !related.contains(program) {
            related.push(program.clone());
        }
    }
}

/// Diagnostics published to the client, by text. A check reports on its own text and on others; a text
/// shows its own first, then those of other checks, each once.
#[derive(Debug, Default)]
pub(super) struct PublishedDiagnostics {
    by_check: BTreeMap<String, ByText>,
    /// Messages of checks of other texts on a text, with the number of those checks.
    by_others: BTreeMap<String, BTreeMap<MessageKey, (Message, usize)>>,
    shown: MessagesByUri,
}

/// Key of a message: its place, its cause, and the rest that distinguishes it from others.
type MessageKey = (u32, u32, String, String);

impl PublishedDiagnostics {
    /// Replaces the messages of the check of a text, and returns the texts whose messages have
    /// changed.
    pub(super) fn put(&mut self, check: &str, messages: ByText) -> ByText {
        let mut concerned = self.take(check);
        for (uri, messages) in &messages {
            concerned.insert(uri.clone());
            if uri != check {
                let said = self.by_others.entry(uri.clone()).or_default();
                for message in messages {
                    let known = said.entry(key(message));
                    known.or_insert_with(|| (message.clone(), 0)).1 += 1;
                }
            }
        }
        self.by_check.insert(check.to_owned(), messages);
        self.changed(concerned)
    }

    /// Removes the messages of the check of a closed text, and returns the texts whose messages
    /// have changed.
    pub(super) fn remove(&mut self, check: &str) -> ByText {
        let concerned = self.take(check);
        let changed = self.changed(concerned.clone());
        for uri in concerned {
            if self.shown.get(&uri).is_some_and(|it| it.is_empty()) {
                self.shown.remove(&uri);
            }
        }
        changed
    }

    /// Messages on each text.
    pub(super) fn shown(&self) -> &MessagesByUri {
        &self.shown
    }

    /// Removes the messages of a check; returns the texts that they were about.
    fn take(&mut self, check: &str) -> BTreeSet<String> {
        let earlier = self.by_check.remove(check).unwrap_or_default();
        for (uri, messages) in earlier.iter().filter(|(uri, _)| *uri != check) {
            let said = self.by_others.entry(uri.clone()).or_default();
            for message in messages {
                if let Entry::Occupied(mut known) = said.entry(key(message)) {
                    known.get_mut().1 -= 1;
                    if known.get().1 == 0 {
                        known.remove();
                    }
                }
            }
            if said.is_empty() {
                self.by_others.remove(uri);
            }
        }
        earlier.into_keys().collect()
    }

    fn changed(&mut self, concerned: BTreeSet<String>) -> ByText {
        let mut changed = ByText::new();
        for uri in concerned {
            let own = self.by_check.get(&uri).and_then(|check| check.get(&uri));
            let own = own.into_iter().flatten();
            let own = own.map(|message| (cause(message), message));
            let others = self.by_others.get(&uri).into_iter().flatten();
            let others = others.map(|((_, _, cause, _), (message, _))| (cause.clone(), message));
            let mut now: Vec<Message> = Vec::new();
            let mut known = BTreeMap::new();
            for (cause, message) in own.chain(others) {
                match known.entry(cause) {
                    Entry::Vacant(vacant) => {
                        vacant.insert(now.len());
                        now.push(message.clone());
                    }
                    Entry::Occupied(at) => reach(&mut now[*at.get()], message),
                }
            }
            if self.shown.get(&uri).map(AsRef::as_ref) != Some(now.as_slice()) {
                self.shown.insert(uri.clone(), now.as_slice().into());
                changed.insert(uri, now);
            }
        }
        changed
    }
}

fn key(message: &Message) -> MessageKey {
    let start = message.range.start;
    let rest = (&message.message, &message.related_information);
    let rest = format!("{rest:?}");
    (start.line, start.character, cause(message), rest)
}
