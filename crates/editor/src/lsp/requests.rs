//! The requests of clients and their handlers.

use gen_lsp_types::{
    CallHierarchyIncomingCallsRequest, CallHierarchyOutgoingCallsRequest,
    CallHierarchyPrepareRequest, CodeActionRequest, CodeLensRequest, CodeLensResolveRequest,
    CompletionRequest, DefinitionRequest, DocumentDiagnosticRequest, DocumentSymbolRequest,
    ExecuteCommandRequest, FoldingRangeRequest, HoverRequest, InlayHintRequest,
    PrepareRenameRequest, ReferencesRequest, RenameRequest, Request, TextDocumentContentRequest,
    WorkspaceSymbolRequest,
};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::contour::{self, ContourRequest};
use super::custom::{StatesRequest, TimelineRequest};
use super::refusal::Refusal;
use super::view::RequestView;
use super::{
    actions, calls, commands, completion, custom, delivery, hints, hover, lens, navigation, pages,
};

/// Answers a request whose parameters may be anything.
pub(super) type Handler = fn(&RequestView, Value) -> Result<Value, Refusal>;

/// Input of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Needs {
    /// The texts.
    Texts,
    /// A result of the check of the text.
    Check,
    /// Time: no other request may wait for it.
    Time,
    /// Time for a simulation: not even a report may wait for it.
    Simulation,
}

/// A request with its needs and its handler.
struct Known {
    method: &'static str,
    needs: Needs,
    handler: Handler,
}

/// Returns the handler of a request; `None` for an unknown method.
pub(super) fn handler(method: &str) -> Option<(Needs, Handler)> {
    let known = KNOWN.iter().find(|known| known.method == method)?;
    Some((known.needs, known.handler))
}

static KNOWN: [Known; 22] = [
    known::<HoverRequest>(Needs::Check, |view, params| {
        answer(view, params, hover::hover)
    }),
    known::<InlayHintRequest>(Needs::Check, |view, params| {
        answer(view, params, hints::inlay_hints)
    }),
    known::<CompletionRequest>(Needs::Check, |view, params| {
        answer(view, params, completion::completion)
    }),
    known::<CodeLensRequest>(Needs::Check, |view, params| {
        answer(view, params, lens::code_lenses)
    }),
    known::<CodeActionRequest>(Needs::Check, |view, params| {
        answer(view, params, actions::code_actions)
    }),
    known::<DocumentDiagnosticRequest>(Needs::Check, |view, params| {
        answer(view, params, delivery::report)
    }),
    known::<StatesRequest>(Needs::Check, |view, params| {
        answer(view, params, custom::states)
    }),
    known::<TimelineRequest>(Needs::Check, |view, params| {
        answer(view, params, custom::timeline)
    }),
    known::<ContourRequest>(Needs::Simulation, |view, params| {
        let contour = contour::contour(view, &serde_json::from_value(params)?)?;
        Ok(serde_json::to_value(contour)?)
    }),
    known::<DocumentSymbolRequest>(Needs::Texts, |view, params| {
        answer(view, params, navigation::symbols)
    }),
    known::<DefinitionRequest>(Needs::Check, |view, params| {
        answer(view, params, navigation::definition)
    }),
    known::<ReferencesRequest>(Needs::Texts, |view, params| {
        answer(view, params, navigation::references)
    }),
    known::<FoldingRangeRequest>(Needs::Texts, |view, params| {
        answer(view, params, navigation::folding)
    }),
    known::<RenameRequest>(Needs::Texts, |view, params| {
        let edit = navigation::rename(view, &serde_json::from_value(params)?)?;
        Ok(serde_json::to_value(edit)?)
    }),
    known::<PrepareRenameRequest>(Needs::Texts, |view, params| {
        answer(view, params, navigation::prepare_rename)
    }),
    known::<TextDocumentContentRequest>(Needs::Texts, |_, params| {
        let content = pages::content(&serde_json::from_value(params)?);
        Ok(serde_json::to_value(content)?)
    }),
    known::<CallHierarchyPrepareRequest>(Needs::Check, |view, params| {
        answer(view, params, calls::prepare)
    }),
    known::<CallHierarchyIncomingCallsRequest>(Needs::Time, |view, params| {
        answer(view, params, calls::incoming)
    }),
    known::<CallHierarchyOutgoingCallsRequest>(Needs::Time, |view, params| {
        answer(view, params, calls::outgoing)
    }),
    known::<WorkspaceSymbolRequest>(Needs::Time, |view, params| {
        answer(view, params, calls::symbols)
    }),
    known::<CodeLensResolveRequest>(Needs::Time, |view, params| {
        let lens = calls::resolved(view, serde_json::from_value(params)?);
        Ok(serde_json::to_value(lens)?)
    }),
    known::<ExecuteCommandRequest>(Needs::Time, |view, params| {
        let shown = commands::execute(view, serde_json::from_value(params)?)?;
        Ok(serde_json::to_value(shown)?)
    }),
];

const fn known<R: Request>(needs: Needs, handler: Handler) -> Known {
    Known {
        method: R::METHOD.as_str(),
        needs,
        handler,
    }
}

fn answer<P: DeserializeOwned, R: Serialize>(
    view: &RequestView,
    params: Value,
    how: fn(&RequestView, &P) -> R,
) -> Result<Value, Refusal> {
    let result = how(view, &serde_json::from_value(params)?);
    Ok(serde_json::to_value(result)?)
}
