//! The calls between the programs of the project: the tree of callers, programs by their names, and
//! the number of programs that reach one (R17.2).

use std::collections::BTreeSet;
use std::path::Path;

use gen_lsp_types::{
    BaseSymbolInformation, CallHierarchyIncomingCall, CallHierarchyIncomingCallsParams,
    CallHierarchyItem, CallHierarchyOutgoingCall, CallHierarchyOutgoingCallsParams,
    CallHierarchyPrepareParams, CodeLens, Command, Location, Range, SymbolKind, Uri,
    WorkspaceSymbol, WorkspaceSymbolParams,
};
use serde_json::{Value, json};

use super::documents::{Kind, OpenDocument};
use super::encoding::whole_line;
use super::navigation::called_at;
use super::uri::path_of;
use super::view::RequestView;
use frictcomp::text::shown_path;
use frictcomp_host::{CallGraph, Disk, FoundCall, GraphProgram, Input};

/// Number of programs that an answer names at most.
const MOST_SYMBOLS: usize = 500;

/// Number of programs that a lens names.
const MOST_NAMED: usize = 5;

/// Returns the position of the program of a URI.
fn position(graph: &CallGraph, uri: &Uri) -> Option<usize> {
    let path = path_of(&uri.0)?;
    let place = Disk::place(&path);
    let mut programs = graph.programs().iter();
    programs.position(|program| program.place.as_ref() == Some(&place))
}

fn path_of_program(program: &GraphProgram) -> Option<&Path> {
    match &program.input {
        Input::File(path) => Some(path),
        Input::Open(_) | Input::Stdin => None,
    }
}

fn item(view: &RequestView, path: &Path) -> CallHierarchyItem {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    CallHierarchyItem {
        name: name.into_owned(),
        kind: SymbolKind::File,
        tags: None,
        detail: path.parent().map(shown_path),
        uri: view.documents.uri(path),
        range: whole_line(0),
        selection_range: whole_line(0),
        data: None,
    }
}

fn item_of(view: &RequestView, program: &GraphProgram) -> Option<CallHierarchyItem> {
    path_of_program(program).map(|path| item(view, path))
}

/// Returns the program at a place: the one that is called there, otherwise that of the text.
pub(super) fn prepare(
    view: &RequestView,
    params: &CallHierarchyPrepareParams,
) -> Option<Vec<CallHierarchyItem>> {
    let place = &params.text_document_position_params;
    let document = view.document(&place.text_document.uri)?;
    if document.kind != Kind::Program {
        return None;
    }
    let path = called_at(view, place).unwrap_or_else(|| document.path.clone());
    Some(vec![item(view, &path)])
}

/// Returns the programs that call a program, with the lines of their calls.
pub(super) fn incoming(
    view: &RequestView,
    params: &CallHierarchyIncomingCallsParams,
) -> Option<Vec<CallHierarchyIncomingCall>> {
    let graph = &view.calls.project(&view.documents.disk())?.graph;
    let called = position(graph, &params.item.uri)?;
    let programs = graph.programs();
    let callers = programs[called].called_by.iter().map(|at| &programs[*at]);
    let calls = callers.filter_map(|caller| {
        Some(CallHierarchyIncomingCall {
            from: item_of(view, caller)?,
            from_ranges: lines(caller, called),
        })
    });
    Some(calls.collect())
}

/// Returns the programs that a program calls, with the lines of its calls.
pub(super) fn outgoing(
    view: &RequestView,
    params: &CallHierarchyOutgoingCallsParams,
) -> Option<Vec<CallHierarchyOutgoingCall>> {
    let graph = &view.calls.project(&view.documents.disk())?.graph;
    let programs = graph.programs();
    let caller = &programs[position(graph, &params.item.uri)?];
    let mut seen = BTreeSet::new();
    let targets = caller.calls.iter().map(|call| call.program);
    let targets = targets.filter(|program| seen.insert(*program));
    let calls = targets.filter_map(|program| {
        Some(CallHierarchyOutgoingCall {
            to: item_of(view, &programs[program])?,
            from_ranges: lines(caller, program),
        })
    });
    Some(calls.collect())
}

/// Returns the lines on which a program calls another one.
fn lines(caller: &GraphProgram, program: usize) -> Vec<Range> {
    let calls = caller.calls.iter();
    let calls = calls.filter(|call: &&FoundCall| call.program == program);
    calls
        .map(|call| whole_line(call.line.saturating_sub(1)))
        .collect()
}

/// Returns the programs of the project and their local subprograms whose names hold some letters: programs first.
pub(super) fn symbols(
    view: &RequestView,
    params: &WorkspaceSymbolParams,
) -> Option<Vec<WorkspaceSymbol>> {
    let project = view.calls.project(&view.documents.disk())?;
    let wanted = params.query.to_lowercase();
    let is_wanted = |name: &str| name.to_lowercase().contains(&wanted);
    let paths = project.graph.programs().iter().filter_map(path_of_program);
    let programs = paths.filter_map(|path| {
        let name = path.file_name()?.to_string_lossy();
        let (folder, place) = (path.parent()?, (path, whole_line(0)));
        is_wanted(&name).then(|| symbol(view, place, SymbolKind::File, (&name, folder)))
    });
    let subprograms = project.subprograms().iter();
    let subprograms = subprograms.filter(|it| is_wanted(&it.name)).map(|it| {
        let place = (it.path.as_path(), view.client.encoding.range(&it.place));
        symbol(view, place, SymbolKind::Function, (&it.name, &it.path))
    });
    Some(programs.chain(subprograms).take(MOST_SYMBOLS).collect())
}

fn symbol(
    view: &RequestView,
    (path, range): (&Path, Range),
    kind: SymbolKind,
    (name, container): (&str, &Path),
) -> WorkspaceSymbol {
    let uri = view.documents.uri(path);
    WorkspaceSymbol {
        location: Location { uri, range }.into(),
        data: None,
        base_symbol_information: BaseSymbolInformation {
            name: name.to_owned(),
            kind,
            tags: None,
            container_name: Some(shown_path(container)),
        },
    }
}

/// Returns the lens that names the number of programs from which a program is reached; its text is made when the client
/// asks for it, since the calls of the project may have to be found first.
pub(super) fn lens(view: &RequestView, document: &OpenDocument) -> Option<CodeLens> {
    view.calls.are_known().then(|| CodeLens {
        range: whole_line(0),
        command: None,
        data: Some(json!({ "reached": document.uri })),
    })
}

/// Returns the lens with its text.
pub(super) fn resolved(view: &RequestView, mut lens: CodeLens) -> CodeLens {
    let uri = lens.data.as_ref().and_then(|data| data.get("reached"));
    let uri = uri.and_then(Value::as_str).map(Uri::from);
    if let Some(uri) = uri {
        lens.command = Some(Command {
            title: reached(view, &uri),
            ..Command::default()
        });
    }
    lens
}

/// Returns the programs from which a program is reached: those at the top, which no program calls.
fn reached(view: &RequestView, uri: &Uri) -> String {
    let none = || "called by no program of the project".to_owned();
    let Some(project) = view.calls.project(&view.documents.disk()) else {
        return none();
    };
    let graph = &project.graph;
    let Some(at) = position(graph, uri) else {
        return none();
    };
    let reaching = graph.callers(at);
    let programs = graph.programs();
    let is_top = |at: &&usize| programs[**at].called_by.is_empty();
    let mut top: Vec<usize> = reaching.iter().filter(is_top).copied().collect();
    if top.is_empty() {
        // No program is uncalled: they call each other in a cycle.
        top = reaching;
    }
    let names = top.iter().take(MOST_NAMED).filter_map(|at| {
        let name = path_of_program(&programs[*at])?.file_name()?;
        Some(name.to_string_lossy().into_owned())
    });
    let names: Vec<String> = names.collect();
    let more = if top.len() > MOST_NAMED {
        ", \u{2026}"
    } else {
        ""
    };
    match top.len() {
        0 => none(),
        1 => format!("reached from {}", names.join(", ")),
        count => format!("reached from {count} programs: {}{more}", names.join(", ")),
    }
}
