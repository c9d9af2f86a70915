//! Symbols, definitions, references, folding and renaming, if no other extension offers them (R12.6).

use std::path::{Path, PathBuf};

use gen_lsp_types::{
    DefinitionParams, DocumentSymbol, DocumentSymbolParams, FoldingRange, FoldingRangeParams,
    Location, Position, Range, ReferenceParams, RenameParams, SymbolKind, TextDocumentIdentifier,
    TextDocumentPositionParams, TextEdit, WorkspaceEdit,
};

use super::actions::as_edit;
use super::documents::{Kind, OpenDocument};
use super::outline::{Mention, Name, NameRole, ProgramOutline, definitions};
use super::refusal::Refusal;
use super::settings::Settings;
use super::uri::uri_of;
use super::view::RequestView;

/// Returns an open program with its outline, if this kind of navigation is on.
fn outlined<'a>(
    view: &'a RequestView,
    text: &TextDocumentIdentifier,
    is_wanted: fn(&Settings) -> bool,
) -> Option<(&'a OpenDocument, ProgramOutline)> {
    let document = view.document(&text.uri)?;
    let is_wanted = document.kind == Kind::Program && is_wanted(&view.client.settings);
    is_wanted.then(|| (document, ProgramOutline::of(document.text())))
}

/// Returns the outline, and the mention of a name at a place.
fn at<'a>(
    view: &'a RequestView,
    place: &TextDocumentPositionParams,
    is_wanted: fn(&Settings) -> bool,
) -> Option<(&'a OpenDocument, ProgramOutline, Mention)> {
    let (document, outline) = outlined(view, &place.text_document, is_wanted)?;
    let offset = document.offset(place.position, view.client.encoding);
    let mention = outline.at(offset)?.clone();
    Some((document, outline, mention))
}

fn range(view: &RequestView, document: &OpenDocument, mention: &Mention) -> Range {
    document.range(mention.span, view.client.encoding)
}

fn location(view: &RequestView, document: &OpenDocument, mention: &Mention) -> Location {
    Location {
        uri: document.uri.clone(),
        range: range(view, document, mention),
    }
}

/// Returns the subprograms and labels of a program.
#[allow(deprecated, reason = "the type has a field that is left empty")]
pub(super) fn symbols(
    view: &RequestView,
    params: &DocumentSymbolParams,
) -> Option<Vec<DocumentSymbol>> {
    let (document, outline) = outlined(view, &params.text_document, Settings::outlines)?;
    let defined = outline
        .mentions
        .iter()
        .filter(|it| it.role == NameRole::Definition);
    let symbols = defined.filter_map(|mention| {
        let (name, kind) = match &mention.name {
            Name::Program(name) => (name, SymbolKind::Function),
            Name::Label(_, name) => (name, SymbolKind::Constant),
            Name::File(_) => return None,
        };
        let selection_range = range(view, document, mention);
        Some(DocumentSymbol {
            name: name.clone(),
            detail: None,
            kind,
            tags: None,
            deprecated: None,
            range: whole(document, &outline, mention).unwrap_or(selection_range),
            selection_range,
            children: None,
        })
    });
    Some(symbols.collect())
}

/// Returns the lines that a name covers: a subprogram up to the next one, a label with its block.
fn whole(document: &OpenDocument, outline: &ProgramOutline, mention: &Mention) -> Option<Range> {
    let line_of = |mention: &Mention| {
        let before = document.text().get(..mention.span.start as usize)?;
        u32::try_from(before.matches('\n').count()).ok()
    };
    let first = line_of(mention)?;
    let end = match &mention.name {
        Name::Program(_) => {
            let programs = outline.mentions.iter().filter(|it| {
                it.role == NameRole::Definition && matches!(it.name, Name::Program(_))
            });
            let next = programs.filter(|it| it.span.start > mention.span.start);
            next.min_by_key(|it| it.span.start)
                .map_or(Some(document.line_count()), line_of)?
        }
        _ => first.saturating_add(1),
    };
    let place = |line| Position { line, character: 0 };
    Some(Range {
        start: place(first),
        end: place(end),
    })
}

/// Returns the definition of a name: a subprogram, a label, or the file that a call finds.
pub(super) fn definition(view: &RequestView, params: &DefinitionParams) -> Option<Location> {
    let place = &params.text_document_position_params;
    let (document, outline, found) = at(view, place, Settings::finds_names)?;
    if let Name::File(name) = &found.name {
        let path = called(view, document, name)?;
        let start = Position {
            line: 0,
            character: 0,
        };
        return Some(Location {
            uri: uri_of(&path).into(),
            range: Range { start, end: start },
        });
    }
    let mention = definitions(&outline).get(&found.name).copied()?;
    Some(location(view, document, mention))
}

/// Returns the file of the program that is called at a place.
pub(super) fn called_at(view: &RequestView, place: &TextDocumentPositionParams) -> Option<PathBuf> {
    let (document, _, found) = at(view, place, Settings::outlines)?;
    match &found.name {
        Name::File(name) => called(view, document, name),
        Name::Program(_) | Name::Label(..) => None,
    }
}

/// Returns the file of a called program: next to the caller, otherwise the one that the check of the caller read,
/// wherever the configuration says that programs are.
fn called(view: &RequestView, document: &OpenDocument, name: &str) -> Option<PathBuf> {
    let name = name.replace('\\', "/");
    let beside = document.path.parent()?.join(&name);
    if beside.is_file() {
        return Some(beside);
    }
    let wanted = Path::new(&name).file_name()?;
    let analysis = view.analysis(&document.uri)?;
    let mut read = analysis.reads.iter();
    let is_it = |path: &&PathBuf| {
        path.file_name()
            .is_some_and(|it| it.eq_ignore_ascii_case(wanted))
    };
    read.find(is_it).cloned()
}

/// Returns the uses of a name.
pub(super) fn references(view: &RequestView, params: &ReferenceParams) -> Option<Vec<Location>> {
    let place = &params.text_document_position_params;
    let (document, outline, found) = at(view, place, Settings::finds_names)?;
    let all = outline.all(&found.name);
    let is_wanted = |it: &&Mention| it.role == NameRole::Use || params.context.include_declaration;
    let found = all.filter(is_wanted);
    Some(found.map(|it| location(view, document, it)).collect())
}

/// Returns the lines that can be folded.
pub(super) fn folding(
    view: &RequestView,
    params: &FoldingRangeParams,
) -> Option<Vec<FoldingRange>> {
    let (_, outline) = outlined(view, &params.text_document, Settings::outlines)?;
    let folds = outline.folds.iter().map(|fold| FoldingRange {
        start_line: fold.first,
        end_line: fold.last,
        ..FoldingRange::default()
    });
    Some(folds.collect())
}

/// Returns the name at a place, if it can be changed.
pub(super) fn prepare_rename(
    view: &RequestView,
    place: &TextDocumentPositionParams,
) -> Option<Range> {
    let (document, _, mention) = at(view, place, Settings::outlines)?;
    let is_file = matches!(mention.name, Name::File(_));
    (!is_file).then(|| range(view, document, &mention))
}

/// Renames a label or a local subprogram everywhere.
///
/// # Errors
/// There is no such name at the place, or the new name is not valid.
pub(super) fn rename(view: &RequestView, params: &RenameParams) -> Result<WorkspaceEdit, Refusal> {
    let refused = |why: String| Err(Refusal::Params(why));
    let place = &params.text_document_position_params;
    let Some((document, outline, found)) = at(view, place, Settings::outlines) else {
        return refused("there is no label or local subprogram here".to_owned());
    };
    let (name, new) = (&found.name, &params.new_name);
    let is_word = |text: &str| {
        let mut letters = text.chars();
        letters
            .next()
            .is_some_and(|first| first.is_ascii_alphabetic() || first == '_')
            && letters.all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
    };
    let is_number = |text: &str| {
        text.strip_prefix('N').is_some_and(|number| {
            !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())
        })
    };
    let is_taken = outline.mentions.iter().any(|it| match (&it.name, name) {
        (Name::Program(one), Name::Program(_)) => one == new,
        (Name::Label(section, one), Name::Label(here, _)) => section == here && one == new,
        _ => false,
    });
    match name {
        Name::File(name) => {
            return refused(format!("`{name}` is a file, which keeps its name"));
        }
        Name::Label(_, old) if is_number(old) && !is_number(new) => {
            return refused(format!("`{new}` is not a block number; `N100` is one"));
        }
        Name::Label(_, old) if is_number(new) && !is_number(old) => {
            return refused(format!(
                "`{new}` is a block number, not the name of a label"
            ));
        }
        Name::Program(_) | Name::Label(..) if !is_word(new) => {
            return refused(format!(
                "`{new}` is not a name: use letters, digits and `_`, with no digit first"
            ));
        }
        _ if is_taken => return refused(format!("the name `{new}` is taken already")),
        _ => {}
    }
    let edits = outline.all(name).map(|mention| TextEdit {
        range: range(view, document, mention),
        new_text: new.clone(),
    });
    let text = TextDocumentIdentifier::new(document.uri.clone());
    Ok(as_edit(view, vec![(text, edits.collect())]))
}
