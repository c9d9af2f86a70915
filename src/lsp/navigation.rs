//! Symbols, definitions, references, folding and renaming, where nobody else offers them (R12.6).

use gen_lsp_types::{
    DefinitionParams, DocumentSymbol, DocumentSymbolParams, FoldingRange, FoldingRangeParams,
    Location, Position, Range, ReferenceParams, RenameParams, SymbolKind, TextDocumentIdentifier,
    TextDocumentPositionParams, TextEdit, WorkspaceEdit,
};

use super::actions::as_edit;
use super::documents::{Document, Kind};
use super::outline::{Mention, Name, Outline, Role, definitions};
use super::uri::uri_of;
use super::view::View;

/// An open program with its outline, where navigation is wanted.
fn outlined<'a>(view: &'a View, text: &TextDocumentIdentifier) -> Option<(&'a Document, Outline)> {
    let document = view.document(&text.uri)?;
    let is_wanted = document.kind == Kind::Program && view.client.settings.navigates();
    is_wanted.then(|| (document, Outline::of(document.text())))
}

/// The outline with the name at a place.
fn at<'a>(
    view: &'a View,
    place: &TextDocumentPositionParams,
) -> Option<(&'a Document, Outline, Name)> {
    let (document, outline) = outlined(view, &place.text_document)?;
    let offset = document.offset(place.position, view.client.encoding);
    let name = outline.at(offset)?.name.clone();
    Some((document, outline, name))
}

fn range(view: &View, document: &Document, mention: &Mention) -> Range {
    document.range(mention.span, view.client.encoding)
}

fn location(view: &View, document: &Document, mention: &Mention) -> Location {
    Location {
        uri: document.uri.clone(),
        range: range(view, document, mention),
    }
}

/// The subprograms and labels of a program.
#[allow(deprecated, reason = "the type has a field that is left empty")]
pub(super) fn symbols(view: &View, params: &DocumentSymbolParams) -> Option<Vec<DocumentSymbol>> {
    let (document, outline) = outlined(view, &params.text_document)?;
    let defined = outline
        .mentions
        .iter()
        .filter(|it| it.role == Role::Definition);
    let symbols = defined.filter_map(|mention| {
        let (name, kind) = match &mention.name {
            Name::Program(name) => (name, SymbolKind::Function),
            Name::Label(_, name) => (name, SymbolKind::Constant),
            Name::File(_) => return None,
        };
        let range = range(view, document, mention);
        Some(DocumentSymbol {
            name: name.clone(),
            detail: None,
            kind,
            tags: None,
            deprecated: None,
            range,
            selection_range: range,
            children: None,
        })
    });
    Some(symbols.collect())
}

/// Where a name comes from: a subprogram, a label, or the file beside this one.
pub(super) fn definition(view: &View, params: &DefinitionParams) -> Option<Location> {
    let (document, outline, name) = at(view, &params.text_document_position_params)?;
    if let Name::File(name) = &name {
        let path = document.path.parent()?.join(name.replace('\\', "/"));
        let start = Position {
            line: 0,
            character: 0,
        };
        return path.is_file().then(|| Location {
            uri: uri_of(&path).into(),
            range: Range { start, end: start },
        });
    }
    let mention = definitions(&outline).get(&name).copied()?;
    Some(location(view, document, mention))
}

/// Where a name is used.
pub(super) fn references(view: &View, params: &ReferenceParams) -> Option<Vec<Location>> {
    let (document, outline, name) = at(view, &params.text_document_position_params)?;
    let all = outline.all(&name);
    let is_wanted = |it: &&Mention| it.role == Role::Use || params.context.include_declaration;
    let found = all.filter(is_wanted);
    Some(found.map(|it| location(view, document, it)).collect())
}

/// The lines that can be folded.
pub(super) fn folding(view: &View, params: &FoldingRangeParams) -> Option<Vec<FoldingRange>> {
    let (_, outline) = outlined(view, &params.text_document)?;
    let folds = outline.folds.iter().map(|fold| FoldingRange {
        start_line: fold.first,
        end_line: fold.last,
        ..FoldingRange::default()
    });
    Some(folds.collect())
}

/// Gives a label or a local subprogram another name, wherever it stands. `None` if neither stands at
/// the place, or if the new name cannot be one.
pub(super) fn rename(view: &View, params: &RenameParams) -> Option<WorkspaceEdit> {
    let (document, outline, name) = at(view, &params.text_document_position_params)?;
    let new = &params.new_name;
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
    let is_taken = || {
        outline.mentions.iter().any(|it| match (&it.name, &name) {
            (Name::Program(one), Name::Program(_)) => one == new,
            (Name::Label(section, one), Name::Label(here, _)) => section == here && one == new,
            _ => false,
        })
    };
    let fits = match &name {
        Name::Program(_) => is_word(new),
        Name::Label(_, old) => is_word(new) && is_number(new) == is_number(old),
        Name::File(_) => false,
    };
    if !fits || is_taken() {
        return None;
    }
    let edits = outline.all(&name).map(|mention| TextEdit {
        range: range(view, document, mention),
        new_text: new.clone(),
    });
    let text = TextDocumentIdentifier::new(document.uri.clone());
    Some(as_edit(view, vec![(text, edits.collect())]))
}
