//! The texts that the client has open.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use gen_lsp_types::{Position, Range, TextDocumentContentChangeEvent, TextDocumentItem, Uri};

use super::encoding::Encoding;
use super::uri::{path_of, uri_of};
use frictcomp::text::{LineIndex, Span};
use frictcomp_host::{CONFIG_NAME, Disk, OpenText, SharedMap, is_program};

/// Kind of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// An NC program.
    Program,
    /// A list of the control.
    List,
    /// A `frictcomp.toml`.
    Configuration,
    /// Any other text, which gets no messages (R12.14).
    Other,
}

/// A text that the client has open.
#[derive(Debug, Clone)]
pub(super) struct OpenDocument {
    /// URI, as the client writes it.
    pub(super) uri: Uri,
    /// The file that it replaces; for a text without one, a name in the folder of the project.
    pub(super) path: PathBuf,
    /// Kind of the text: a program, a list or a configuration.
    pub(super) kind: Kind,
    /// The version number given by the client.
    pub(super) version: i32,
    text: Arc<String>,
    lines: LineIndex,
    /// The canonical path of its file.
    place: PathBuf,
}

impl OpenDocument {
    fn new(opened: TextDocumentItem, folder: &Path, languages: &[String]) -> Self {
        let uri = opened.uri;
        let path = path_of(&uri.0).unwrap_or_else(|| folder.join(file_name(&uri.0)));
        Self {
            kind: kind(&path, opened.language_id.as_str(), languages),
            place: Disk::place(&path),
            path,
            uri,
            version: opened.version,
            lines: LineIndex::new(&opened.text),
            text: Arc::new(opened.text),
        }
    }

    /// Returns the text of the document.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// Returns the number of lines; an empty one after the last line end does not count.
    pub(super) fn line_count(&self) -> u32 {
        let lines = u32::try_from(self.lines.lines()).unwrap_or(u32::MAX);
        match self.line(lines - 1) {
            "" => lines - 1,
            _ => lines,
        }
    }

    /// Returns a line, from 0, without its end; empty past the last one.
    pub(super) fn line(&self, line: u32) -> &str {
        let number = self.lines.first().saturating_add(line);
        self.lines.line_span(&self.text, number).of(&self.text)
    }

    /// Returns the open text, which takes the place of its file.
    pub(super) fn open_text(&self) -> OpenText {
        OpenText {
            path: self.path.clone(),
            text: Arc::clone(&self.text),
        }
    }

    /// Returns the line, from 0, on which the block of a line begins: after a line that ends in `\`, a block continues
    /// on the next one.
    pub(super) fn block_line(&self, line: u32) -> u32 {
        let mut first = line;
        while first > 0 && self.line(first - 1).trim_end().ends_with('\\') {
            first -= 1;
        }
        first
    }

    /// Returns the byte offset of a position.
    pub(super) fn offset(&self, position: Position, encoding: Encoding) -> usize {
        encoding.place(&self.text, &self.lines, position)
    }

    /// Returns the range of a span.
    pub(super) fn range(&self, span: Span, encoding: Encoding) -> Range {
        Range {
            start: encoding.position(&self.text, &self.lines, span.start),
            end: encoding.position(&self.text, &self.lines, span.end),
        }
    }

    /// Applies the changes of the client in order.
    fn change(&mut self, changes: Vec<TextDocumentContentChangeEvent>, encoding: Encoding) {
        for change in changes {
            match change {
                TextDocumentContentChangeEvent::TextDocumentContentChangeWholeDocument(whole) => {
                    self.text = Arc::new(whole.text);
                }
                TextDocumentContentChangeEvent::TextDocumentContentChangePartial(part) => {
                    let (start, end) = (
                        self.offset(part.range.start, encoding),
                        self.offset(part.range.end, encoding),
                    );
                    // A range with its ends swapped means the same text.
                    let span = start.min(end)..start.max(end);
                    Arc::make_mut(&mut self.text).replace_range(span, &part.text);
                }
            }
            self.lines = LineIndex::new(&self.text);
        }
    }
}

/// The texts that the client has open. A copy is cheap, and stays as it is (R12.16).
#[derive(Debug, Clone, Default)]
pub(super) struct Documents {
    /// The texts by their URIs.
    open: SharedMap<String, Arc<OpenDocument>>,
    /// The URIs of the texts of a file; there is hardly ever more than one.
    names: SharedMap<PathBuf, BTreeSet<String>>,
    /// Contents of the texts, by the paths of their files.
    texts: SharedMap<PathBuf, Arc<String>>,
    /// The folder of the project, and of texts that have no file.
    folder: PathBuf,
}

impl Documents {
    /// Creates an empty set of texts.
    pub(super) fn new(folder: PathBuf) -> Self {
        Self {
            folder,
            ..Self::default()
        }
    }

    /// Opens a text, in place of one of the same URI; texts of these languages are programs, too.
    pub(super) fn open(
        &mut self,
        opened: TextDocumentItem,
        languages: &[String],
    ) -> Arc<OpenDocument> {
        let document = Arc::new(OpenDocument::new(opened, &self.folder, languages));
        let uri = document.uri.0.clone();
        self.close(&document.uri);
        let mut names = self.names.remove(&document.path).unwrap_or_default();
        names.insert(uri.clone());
        self.names.insert(document.path.clone(), names);
        self.texts
            .insert(document.place.clone(), Arc::clone(&document.text));
        self.open.insert(uri, Arc::clone(&document));
        document
    }

    /// Changes a text; `None` if it is not open.
    pub(super) fn change(
        &mut self,
        (uri, version): (&Uri, i32),
        changes: Vec<TextDocumentContentChangeEvent>,
        encoding: Encoding,
    ) -> Option<Arc<OpenDocument>> {
        let document = self.open.get_mut(&uri.0)?;
        // The document alone holds the text while it changes, so that it need not be copied.
        self.texts.remove(&document.place);
        let text = Arc::make_mut(document);
        text.version = version;
        text.change(changes, encoding);
        let document = Arc::clone(document);
        self.texts
            .insert(document.place.clone(), Arc::clone(&document.text));
        Some(document)
    }

    /// Closes a text; `None` if it is not open.
    pub(super) fn close(&mut self, uri: &Uri) -> Option<Arc<OpenDocument>> {
        let closed = self.open.remove(&uri.0)?;
        self.texts.remove(&closed.place);
        let mut names = self.names.remove(&closed.path).unwrap_or_default();
        names.remove(&uri.0);
        if let Some(other) = names.first().and_then(|name| self.open.get(name)) {
            self.texts
                .insert(other.place.clone(), Arc::clone(&other.text));
            self.names.insert(closed.path.clone(), names);
        }
        Some(closed)
    }

    /// Returns an open text.
    pub(super) fn get(&self, uri: &Uri) -> Option<&Arc<OpenDocument>> {
        self.open.get(&uri.0)
    }

    /// Returns all open texts.
    pub(super) fn iter(&self) -> impl Iterator<Item = &Arc<OpenDocument>> {
        self.open.iter().map(|(_, document)| document)
    }

    /// Returns the folder of the project.
    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the disk of the system with the open texts in place of their files.
    pub(super) fn disk(&self) -> Disk {
        Disk::with_placed(self.texts.clone())
    }

    /// Returns the URI of a file as the client writes it, if the client has the file open.
    pub(super) fn uri(&self, path: &Path) -> Uri {
        match self.names.get(path).and_then(BTreeSet::first) {
            Some(name) => Uri(name.clone()),
            None => Uri(uri_of(path)),
        }
    }

    /// Returns the file of a name in messages, which may be relative to the current folder.
    pub(super) fn path(name: &str) -> PathBuf {
        Disk::default()
            .absolute(Path::new(name))
            .unwrap_or_else(|| PathBuf::from(name))
    }
}

/// Returns a file name for a text that has no file.
fn file_name(uri: &str) -> String {
    let name = uri.rsplit(['/', ':']).next().unwrap_or_default();
    let usable = |letter: char| letter.is_alphanumeric() || "-_. ".contains(letter);
    name.chars().filter(|letter| usable(*letter)).collect()
}

/// Languages of programs in editors: of ISG's extension and of the one that comes with the sources.
const PROGRAM_LANGUAGES: [&str; 2] = ["isg-cnc", "frictcomp-nc"];

/// Languages of lists in editors.
const LIST_LANGUAGES: [&str; 2] = ["isg-list", "frictcomp-list"];

/// The ending of encrypted cycles, which ISG's extension gives the language of programs (R18.5).
const ENCRYPTED: &str = "ecy";

/// Returns the kind of a text by its name or its language (R12.14).
fn kind(path: &Path, language: &str, further: &[String]) -> Kind {
    let has_ending = |endings: &[&str]| {
        let extension = path.extension().unwrap_or_default();
        endings.iter().any(|it| extension.eq_ignore_ascii_case(it))
    };
    if path.file_name().is_some_and(|name| name == CONFIG_NAME) {
        Kind::Configuration
    } else if has_ending(&["lis", "tsproj", "xti"]) || LIST_LANGUAGES.contains(&language) {
        Kind::List
    } else if has_ending(&[ENCRYPTED]) {
        Kind::Other
    } else if is_program(path, None)
        || PROGRAM_LANGUAGES.contains(&language)
        || further.iter().any(|it| it == language)
    {
        Kind::Program
    } else {
        Kind::Other
    }
}

/// Returns whether texts of this URI are those of a user: files, and texts that were never saved. Versions that an
/// editor takes from git, for example, would show every message twice (R12.12).
pub(super) fn is_of_a_user(uri: &Uri) -> bool {
    let scheme = uri.0.split(':').next().unwrap_or_default();
    ["file", "untitled"]
        .iter()
        .any(|it| scheme.eq_ignore_ascii_case(it))
}

#[cfg(test)]
mod tests {
    use gen_lsp_types::{
        LanguageKind, TextDocumentContentChangePartial, TextDocumentContentChangeWholeDocument,
    };
    use proptest::prelude::*;

    use super::*;

    fn opened(uri: &str, language: &'static str, text: &str) -> OpenDocument {
        let item = TextDocumentItem {
            uri: uri.into(),
            language_id: LanguageKind::new(language),
            version: 1,
            text: text.to_owned(),
        };
        OpenDocument::new(item, Path::new("/project"), &["gcode".to_owned()])
    }

    #[test]
    fn texts_are_known_by_their_names() {
        // R12.2, R12.14
        for (uri, language, path, kind) in [
            ("file:///p/A.MPF", "plaintext", "/p/A.MPF", Kind::Program),
            ("file:///p/a.ecy", "isg-cnc", "/p/a.ecy", Kind::Other),
            ("file:///p/a.plc", "", "/p/a.plc", Kind::Program),
            ("file:///p/part", "gcode", "/p/part", Kind::Program),
            ("file:///p/Cargo.toml", "toml", "/p/Cargo.toml", Kind::Other),
            (
                "file:///p/notes.txt",
                "plaintext",
                "/p/notes.txt",
                Kind::Other,
            ),
            ("file:///p/part", "plaintext", "/p/part", Kind::Other),
            ("file:///p/a.nc", "isg-cnc", "/p/a.nc", Kind::Program),
            ("file:///p/A.LIS", "plaintext", "/p/A.LIS", Kind::List),
            ("file:///p/axis", "isg-list", "/p/axis", Kind::List),
            (
                "file:///p/frictcomp.toml",
                "toml",
                "/p/frictcomp.toml",
                Kind::Configuration,
            ),
            (
                "untitled:Untitled-1",
                "isg-cnc",
                "/project/Untitled-1",
                Kind::Program,
            ),
        ] {
            let document = opened(uri, language, "");
            assert_eq!(
                (document.path.as_path(), document.kind),
                (Path::new(path), kind)
            );
        }
    }

    #[test]
    fn versions_that_an_editor_holds_are_no_texts_of_a_user() {
        // R12.12
        let of_a_user = ["file:///p/a.nc", "untitled:Untitled-1", "FILE:///p/a.nc"];
        assert!(of_a_user.iter().all(|uri| is_of_a_user(&(*uri).into())));
        let others = [
            "git:/p/a.nc?%7B%7D",
            "vscode-vfs://github/a.nc",
            "output:x",
            "",
        ];
        assert!(!others.iter().any(|uri| is_of_a_user(&(*uri).into())));
    }

    #[test]
    fn a_block_begins_where_no_line_goes_on() {
        let document = opened(
            "file:///a.nc",
            "isg-cnc",
            "N1 X1\nN2 X[COMP \\ \n ON \\\n FRICT]\nN3",
        );
        assert_eq!(
            [0, 1, 2, 3, 4, 9].map(|line| document.block_line(line)),
            [0, 1, 1, 1, 4, 9]
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]
        #[test]
        fn changes_one_by_one_make_the_text_of_the_client(
            text in "[a-z\u{dc}\u{1f600}\r\n]{0,40}",
            edits in prop::collection::vec(
                ((0u32..9, 0u32..12), (0u32..9, 0u32..12), "[xy\n\u{dc}]{0,5}"), 0..8),
        ) {
            for encoding in [Encoding::Utf8, Encoding::Utf16] {
                let mut document = opened("file:///a.nc", "isg-cnc", &text);
                for (from, to, new) in &edits {
                    let at = |(line, character): (u32, u32)| Position { line, character };
                    let (start, end) = (at(*from), at(*to));
                    let mut expected = document.text().to_owned();
                    let (one, other) =
                        (document.offset(start, encoding), document.offset(end, encoding));
                    expected.replace_range(one.min(other)..one.max(other), new);
                    let part = TextDocumentContentChangePartial::new(
                        Range { start, end }, None, new.clone());
                    document.change(vec![part.into()], encoding);
                    prop_assert_eq!(document.text(), &expected);
                }
                let whole = TextDocumentContentChangeWholeDocument::new("whole".to_owned());
                document.change(vec![whole.into()], encoding);
                prop_assert_eq!(document.text(), "whole");
            }
        }
    }
}
