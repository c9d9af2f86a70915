//! Changes that do what a message advises, made from its data (R12.5).

use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

use gen_lsp_types::{
    CodeAction, CodeActionKind, CodeActionParams, CodeActionResponse, Diagnostic as Message,
    OptionalVersionedTextDocumentIdentifier, Range, TextDocumentEdit, TextDocumentIdentifier,
    TextEdit, WorkspaceEdit,
};

use super::documents::{Documents, Kind, OpenDocument};
use super::view::RequestView;
use frictcomp::diagnostic::{Code, Diagnostic, Fix, Safety, edits};
use frictcomp::session::allow_here;
use frictcomp::text::{LineIndex, SourceFile, shown_path};
use frictcomp_host::read_text;

/// Returns the actions at a place of a text.
pub(super) fn code_actions(
    view: &RequestView,
    params: &CodeActionParams,
) -> Option<Vec<CodeActionResponse>> {
    let document = view.document(&params.text_document.uri)?;
    let only = params.context.only.as_deref();
    let wanted =
        |kind: &CodeActionKind| only.is_none_or(|only| only.iter().any(|it| holds(it, kind)));
    let mut actions = Vec::new();
    if wanted(&CodeActionKind::QuickFix) {
        for said in messages(view, document) {
            let (_, message) = view.translator().message(said);
            if touches(message.range, params.range) {
                actions.extend(quick_fixes(view, document, (said, &message)));
            }
        }
    }
    if wanted(&CodeActionKind::SourceFixAll) {
        actions.extend(fix_all(view, document));
    }
    Some(actions.into_iter().map(Into::into).collect())
}

/// Returns whether a kind of action belongs to a wider kind.
fn holds(wide: &CodeActionKind, kind: &CodeActionKind) -> bool {
    let (wide, kind) = (wide.as_str(), kind.as_str());
    wide.is_empty()
        || kind == wide
        || kind
            .strip_prefix(wide)
            .is_some_and(|it| it.starts_with('.'))
}

fn touches(one: Range, other: Range) -> bool {
    one.start <= other.end && other.start <= one.end
}

/// Returns the messages of all checks on a document, each once.
fn messages<'a>(view: &'a RequestView, document: &OpenDocument) -> Vec<&'a Diagnostic> {
    let mut known = BTreeSet::new();
    let analyses = view.analyses_of(document).into_iter();
    let said = analyses.flat_map(|(_, analysis)| &analysis.said);
    let here = said.filter(|said| Documents::path(&said.place.file) == document.path);
    let mut is_new = |said: &&'a Diagnostic| {
        let place = (said.place.first_line, said.place.span.start);
        known.insert((place, said.code, said.message.as_str()))
    };
    here.filter(|said| is_new(said)).collect()
}

/// Returns the fixes of a message, and the comment that silences it.
fn quick_fixes(
    view: &RequestView,
    document: &OpenDocument,
    (said, message): (&Diagnostic, &Message),
) -> Vec<CodeAction> {
    let mut actions = Vec::new();
    let mut is_preferred = true;
    for fix in &said.fixes {
        let Some(edit) = workspace_edit(view, [fix]) else {
            continue;
        };
        let preferred = fix.safety == Safety::Safe && std::mem::take(&mut is_preferred);
        actions.push(CodeAction {
            title: title(document, fix),
            kind: Some(CodeActionKind::QuickFix),
            diagnostics: Some(vec![message.clone()]),
            is_preferred: preferred.then_some(true),
            edit: Some(edit),
            ..CodeAction::default()
        });
    }
    let source = SourceFile::new(said.place.file.clone(), document.text());
    // Lists and configurations have no comments to this tool.
    let is_program = document.kind == Kind::Program;
    let allow = is_program.then(|| allow_here(said, &source)).flatten();
    if let Some(edit) = allow.and_then(|allow| workspace_edit(view, [&allow])) {
        actions.push(CodeAction {
            title: format!("allow {} here", said.code),
            kind: Some(CodeActionKind::QuickFix),
            diagnostics: Some(vec![message.clone()]),
            edit: Some(edit),
            ..CodeAction::default()
        });
    }
    actions
}

/// Returns the effect of a fix in words.
fn title(document: &OpenDocument, fix: &Fix) -> String {
    let old = short(fix.place.span.of(&fix.place.text));
    let new = short(&fix.text);
    let what = match (old.as_str(), new.as_str(), &fix.also) {
        (old, "", _) => format!("remove `{old}`"),
        ("", new, None) => format!("insert `{new}`"),
        ("", new, Some(also)) => {
            let lines = [&fix.place, &also.place].map(|place| place.start().line);
            format!("insert `{new}` above lines {} and {}", lines[0], lines[1])
        }
        (old, new, _) => format!("replace `{old}` with `{new}`"),
    };
    let path = Documents::path(&fix.place.file);
    if path == document.path {
        return what;
    }
    let name = path.file_name().unwrap_or(path.as_os_str());
    format!("{what} in {}", name.to_string_lossy())
}

/// Returns the words of a text on one line, at most forty characters.
fn short(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    let words = words.join(" ");
    if words.chars().count() <= 40 {
        return words;
    }
    words.chars().take(39).chain(['\u{2026}']).collect()
}

/// Returns the code action that makes all changes of a text that are safe without a review.
fn fix_all(view: &RequestView, document: &OpenDocument) -> Option<CodeAction> {
    let fixes = safe_fixes(view, document);
    if fixes.is_empty() {
        return None;
    }
    Some(CodeAction {
        title: "apply all safe fixes of frictcomp".to_owned(),
        kind: Some(CodeActionKind::SourceFixAll),
        edit: Some(workspace_edit(view, &fixes)?),
        ..CodeAction::default()
    })
}

/// Returns the first safe change of each message about a text. A comment that silences nothing in one run may be needed
/// in another: it goes only if no run needs it (R9.82).
fn safe_fixes(view: &RequestView, document: &OpenDocument) -> Vec<Fix> {
    let name = shown_path(&document.path);
    let mut proposed: HashMap<&Fix, (Code, usize)> = HashMap::new();
    let mut runs = 0;
    for (_, analysis) in view.analyses_of(document) {
        let is_run = analysis
            .run
            .as_ref()
            .is_some_and(|run| run.states.has(&name));
        runs += usize::from(is_run);
        for said in &analysis.said {
            let mut safe = said.fixes.iter().filter(|fix| fix.safety == Safety::Safe);
            if let Some(fix) = safe.next()
                && *fix.place.file == *name
            {
                proposed.entry(fix).or_insert((said.code, 0)).1 += 1;
            }
        }
    }
    let holds = |(code, times): (Code, usize)| code != Code::Fc490 || times >= runs;
    let fixes = proposed.into_iter().filter(|(_, by)| holds(*by));
    fixes.map(|(fix, _)| fix.clone()).collect()
}

/// Changes of files, as the client makes them; `None` where nothing is changed.
fn workspace_edit<'a>(
    view: &RequestView,
    fixes: impl IntoIterator<Item = &'a Fix>,
) -> Option<WorkspaceEdit> {
    let mut by_file: HashMap<Arc<str>, Vec<&Fix>> = HashMap::new();
    for fix in fixes {
        by_file.entry(fix.place.file.clone()).or_default().push(fix);
    }
    let mut changes = Vec::new();
    for (file, fixes) in by_file {
        changes.extend(text_edits(view, &file, &fixes));
    }
    if changes.is_empty() {
        return None;
    }
    Some(as_edit(view, changes))
}

/// Returns the edits of a file; `None` if its lines have changed since the fixes were made.
fn text_edits(
    view: &RequestView,
    file: &str,
    fixes: &[&Fix],
) -> Option<(TextDocumentIdentifier, Vec<TextEdit>)> {
    let uri = view.translator().uri(file);
    let source = match view.document(&uri) {
        Some(document) => SourceFile::new(file, document.text()),
        None => SourceFile::new(file, read_text(&Documents::path(file)).ok()?),
    };
    let (text, lines): (&str, &LineIndex) = (source.text(), source.lines());
    let edits = edits(&source, fixes.iter().copied()).into_iter();
    let at = |offset: u32| view.client.encoding.position(text, lines, offset);
    let edits = edits.map(|edit| TextEdit {
        range: Range {
            start: at(edit.span.start),
            end: at(edit.span.end),
        },
        new_text: edit.text,
    });
    let edits: Vec<TextEdit> = edits.collect();
    (!edits.is_empty()).then(|| (TextDocumentIdentifier::new(uri), edits))
}

/// Returns the edits in the form that the client supports.
pub(super) fn as_edit(
    view: &RequestView,
    changes: Vec<(TextDocumentIdentifier, Vec<TextEdit>)>,
) -> WorkspaceEdit {
    if !view.client.edits_versions() {
        let changes = changes.into_iter().map(|(text, edits)| (text.uri, edits));
        return WorkspaceEdit {
            changes: Some(changes.collect()),
            ..WorkspaceEdit::default()
        };
    }
    let changes = changes.into_iter().map(|(text, edits)| {
        let version = view.document(&text.uri).map(|document| document.version);
        TextDocumentEdit {
            text_document: OptionalVersionedTextDocumentIdentifier {
                version,
                text_document_identifier: text,
            },
            edits: edits.into_iter().map(Into::into).collect(),
        }
        .into()
    });
    WorkspaceEdit {
        document_changes: Some(changes.collect()),
        ..WorkspaceEdit::default()
    }
}
