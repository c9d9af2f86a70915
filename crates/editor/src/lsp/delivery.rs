//! Delivery of messages to the client: pushed, or kept until it asks for them (R12.2).
//!
//! A client that pulls gets the messages on its open texts as answers, and those on other texts pushed, so
//! that none is shown twice. It is told to ask again when something other than an open text changes the
//! messages on that text.

use std::hash::{DefaultHasher, Hash, Hasher};

use gen_lsp_types::{
    DocumentDiagnosticParams, DocumentDiagnosticReport, FullDocumentDiagnosticReport,
    RelatedFullDocumentDiagnosticReport, RelatedUnchangedDocumentDiagnosticReport,
    UnchangedDocumentDiagnosticReport, Uri,
};

use super::messages::{ByText, MessagesByUri, PublishedDiagnostics, Translator};
use super::view::RequestView;

/// Messages on their way to the client.
#[derive(Debug, Default)]
pub(super) struct Delivery {
    published: PublishedDiagnostics,
    /// Whether the client has to ask again.
    is_outdated: bool,
}

/// Reason for the check of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CheckedFor {
    /// The text is new or was changed, so that the client asks by itself.
    Itself,
    /// The same text, after a change of another one, of a file or of a setting.
    Others,
}

impl Delivery {
    /// Takes the messages of the check of a text, and returns those to push.
    pub(super) fn checked(
        &mut self,
        to: Translator<'_>,
        (uri, why): (&str, CheckedFor),
        messages: ByText,
    ) -> ByText {
        let changed = self.published.put(uri, messages);
        self.outdate(to, &changed, |it| it != uri || why == CheckedFor::Others);
        pushed(to, changed)
    }

    /// Takes back what was pushed about a text that is open now, and returns it to push.
    pub(super) fn opened(&self, to: Translator<'_>, uri: &str) -> ByText {
        let known = self.published.shown().get(uri);
        let is_pushed = to.client.pulls_diagnostics() && known.is_some_and(|it| !it.is_empty());
        let none = is_pushed.then(|| (uri.to_owned(), Vec::new()));
        none.into_iter().collect()
    }

    /// Takes away the messages of the check of a text that was closed, and returns those to push.
    pub(super) fn closed(&mut self, to: Translator<'_>, uri: &str) -> ByText {
        let mut changed = self.published.remove(uri);
        self.outdate(to, &changed, |it| it != uri);
        if to.client.pulls_diagnostics() {
            // The client has dropped what it asked for; checks of other texts may still have messages.
            let rest = self.published.shown().get(uri);
            changed.remove(uri);
            changed.extend(rest.map(|rest| (uri.to_owned(), rest.to_vec())));
        }
        pushed(to, changed)
    }

    fn outdate(&mut self, to: Translator<'_>, changed: &ByText, by_other: impl Fn(&str) -> bool) {
        let is_open = |uri: &str| to.documents.get(&uri.into()).is_some();
        self.is_outdated |= to.client.pulls_diagnostics()
            && changed.keys().any(|uri| by_other(uri) && is_open(uri));
    }

    /// Returns whether the client has to ask again; true only once per change.
    pub(super) fn take_outdated(&mut self) -> bool {
        std::mem::take(&mut self.is_outdated)
    }

    /// Returns the messages on each text.
    pub(super) fn shown(&self) -> &MessagesByUri {
        self.published.shown()
    }
}

/// Returns the messages to push: all, or for a client that pulls, those on texts that it does not have open.
fn pushed(to: Translator<'_>, mut changed: ByText) -> ByText {
    let pulls = to.client.pulls_diagnostics();
    changed.retain(|uri, _| !pulls || to.documents.get(&uri.as_str().into()).is_none());
    changed
}

/// Answers a request for the messages on an open text.
pub(super) fn report(
    view: &RequestView,
    params: &DocumentDiagnosticParams,
) -> DocumentDiagnosticReport {
    let uri: &Uri = &params.text_document.uri;
    let open = view.document(uri);
    let items = open.and_then(|_| view.shown.get(&uri.0));
    let items = items.map(|items| items.to_vec()).unwrap_or_default();
    let result_id = result_id(&items);
    if params.previous_result_id.as_ref() == Some(&result_id) {
        let unchanged = UnchangedDocumentDiagnosticReport { result_id };
        RelatedUnchangedDocumentDiagnosticReport::new(None, unchanged).into()
    } else {
        let full = FullDocumentDiagnosticReport {
            result_id: Some(result_id),
            items,
        };
        RelatedFullDocumentDiagnosticReport::new(None, full).into()
    }
}

/// Returns the id of a list of messages: lists with the same id are equal, even across servers.
fn result_id(items: &[gen_lsp_types::Diagnostic]) -> String {
    let mut hasher = DefaultHasher::new();
    format!("{items:?}").hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}
