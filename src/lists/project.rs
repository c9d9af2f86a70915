//! TwinCAT projects, which hold the control's lists as texts of elements in XML (R3.42).
//!
//! A text is taken for a list by its keys, whatever the name of its element: not all names are public. It belongs to the
//! nearest item above it.
//!
//! ```xml
//! <TreeItem>
//!   <ItemName>Axis_1</ItemName>
//!   <DefaultProgName>X</DefaultProgName>
//!   <AchsMds><![CDATA[kopf.achs_nr 1
//! Ende]]></AchsMds>
//! </TreeItem>
//! ```

use std::path::Path;
use std::sync::Arc;

use quick_xml::Reader;
use quick_xml::escape::unescape;
use quick_xml::events::{BytesStart, Event};
use thiserror::Error;

use super::kind::ListKind;
use super::line::{Entries, Given};
use crate::text::{SourceFile, Span};

/// Depth of nested elements that no project reaches.
const MAX_DEPTH: usize = 512;

/// Limit on the lists, beyond any project; further ones are not read.
const MAX_LISTS: usize = 4096;

/// The outermost elements of projects, of files that a project refers to, and of exported tree items.
const ROOTS: [&str; 3] = ["TcSmProject", "TcSmItem", "TreeItem"];

/// Elements and attributes that describe the item around them.
const ITEM_KEYS: [&str; 5] = ["Name", "ItemName", CHANNEL, INDEX, "DefaultProgName"];

/// The element with the channel of an axis, from 1; 0 for one in no channel.
const CHANNEL: &str = "DefaultChannel";

/// The element with the position of an axis in its channel, from 0.
const INDEX: &str = "DefaultIndex";

/// The name of an item that has the name of its file.
const NAME_OF_FILE: &str = "__FILENAME__";

/// Elements whose text is a list, with the kind that belongs there.
const LIST_ELEMENTS: [(&str, ListKind); 2] =
    [("AchsMds", ListKind::Axis), ("SdaMds", ListKind::Channel)];

/// Reason why a file gives no lists: its nature, in words that follow its name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{reason}")]
#[non_exhaustive]
pub(crate) struct NoProject {
    /// Nature of the file.
    pub(crate) reason: String,
    /// The place at fault.
    pub(crate) span: Span,
}

/// An item of a project: an axis, a channel, or a folder of them.
#[derive(Debug, Clone)]
pub(crate) struct ProjectItem {
    /// Name in the tree of the project.
    pub(crate) name: String,
    /// The channel of the axis, from 1.
    pub(crate) channel: Option<Given<u32>>,
    /// The position of the axis in the channel, from 0.
    pub(crate) index: Option<Given<u32>>,
    /// The name of the axis in programs.
    pub(crate) program_name: Option<Given<String>>,
}

/// A list in a project.
#[derive(Debug, Clone)]
pub(crate) struct ProjectList {
    /// The items around it, the nearest one first, as positions among all items.
    pub(crate) items: Vec<usize>,
    /// Text, with the line numbers of the file.
    pub(crate) source: Arc<SourceFile>,
    /// Kind; `None` for a list that does not concern compensation.
    pub(crate) kind: Option<ListKind>,
    /// Place and name of its element.
    pub(crate) element: Given<String>,
}

/// A reference to another file.
#[derive(Debug, Clone)]
pub(crate) struct ProjectReference {
    /// The path as written.
    pub(crate) path: Given<String>,
    /// The names of the elements around it, the outermost first.
    pub(crate) elements: Vec<String>,
    /// The items around it, as those of a list.
    pub(crate) items: Vec<usize>,
}

/// Contents of a project and of the files that it refers to.
#[derive(Debug, Clone, Default)]
pub(crate) struct Project {
    /// The items around lists and references.
    pub(crate) items: Vec<ProjectItem>,
    /// The lists in the order of reading.
    pub(crate) lists: Vec<ProjectList>,
    /// Elements that should hold a list of a kind, but do not.
    pub(crate) empty: Vec<(Given<String>, ListKind)>,
    /// Elements that should hold a number, but do not, with their names.
    pub(crate) odd: Vec<(&'static str, Given<String>)>,
}

/// Returns whether a text is XML, as TwinCAT projects are (R3.42).
pub fn is_xml(text: &str) -> bool {
    text.trim_start().starts_with('<')
}

impl Project {
    /// Adds the contents of a file; `around` are the items around the reference to it. Returns its own references.
    ///
    /// # Errors
    /// It is not well-formed XML, or not a part of a TwinCAT project.
    pub(crate) fn add(
        &mut self,
        file: &Arc<SourceFile>,
        around: &[usize],
    ) -> Result<Vec<ProjectReference>, NoProject> {
        let mut parser = Parser {
            file,
            project: self,
            references: Vec::new(),
            open: Vec::new(),
        };
        let first_list = parser.project.lists.len();
        parser.read()?;
        let mut references = parser.references;
        for list in &mut self.lists[first_list..] {
            list.items.extend(around);
        }
        for reference in &mut references {
            reference.items.extend(around);
        }
        Ok(references)
    }

    /// Returns the name of the nearest item around a list; that of its element without one.
    pub(crate) fn name_of(&self, list: &ProjectList) -> String {
        let nearest = list.items.first();
        nearest.map_or(list.element.value.clone(), |at| {
            self.items[*at].name.clone()
        })
    }
}

/// Item whose element is still open.
#[derive(Debug, Default)]
struct ItemDraft {
    name: Option<String>,
    channel: Option<Given<u32>>,
    index: Option<Given<u32>>,
    program_name: Option<Given<String>>,
}

/// The text of an element: a part of the file, or several parts as one text.
#[derive(Debug)]
enum ElementText {
    Part(Span),
    Joined { text: String, from: Span },
}

/// An open element.
#[derive(Debug)]
struct OpenElement<'a> {
    name: &'a str,
    start: usize,
    text: Option<ElementText>,
    item: Option<Box<ItemDraft>>,
    /// Numbers of lists and references before it.
    before: (usize, usize),
}

struct Parser<'a, 'p> {
    file: &'a Arc<SourceFile>,
    project: &'p mut Project,
    references: Vec<ProjectReference>,
    open: Vec<OpenElement<'a>>,
}

impl Parser<'_, '_> {
    fn read(&mut self) -> Result<(), NoProject> {
        let text = self.file.text();
        let mut reader = Reader::from_str(text);
        let mut has_root = false;
        loop {
            let position = |at: u64| usize::try_from(at).unwrap_or(text.len()).min(text.len());
            let start = position(reader.buffer_position());
            let event = reader.read_event();
            let end = position(reader.buffer_position());
            match event {
                Ok(Event::Start(element)) => {
                    Self::check_root(&mut has_root, &element)?;
                    self.begin(&element, start, end)?;
                }
                Ok(Event::Empty(element)) => {
                    Self::check_root(&mut has_root, &element)?;
                    self.begin(&element, start, end)?;
                    self.end();
                }
                Ok(Event::End(_)) => self.end(),
                Ok(Event::Text(_)) => self.add_text(Span::new(start, end), None),
                Ok(Event::CData(_)) => {
                    let span = Span::new(start + "<![CDATA[".len(), end - "]]>".len());
                    self.add_text(span, None);
                }
                Ok(Event::GeneralRef(_)) => {
                    let span = Span::new(start, end);
                    let decoded = unescape(span.of(text));
                    let decoded = decoded.map_err(|error| damaged(span, &error.to_string()))?;
                    self.add_text(span, Some(&decoded));
                }
                Ok(Event::DocType(_)) => {
                    return Err(damaged(
                        Span::new(start, end),
                        "a document type is not read",
                    ));
                }
                Ok(Event::Comment(_) | Event::Decl(_) | Event::PI(_)) => {}
                Ok(Event::Eof) => break,
                Err(error) => {
                    let at = position(reader.error_position());
                    return Err(damaged(Span::new(at, at), &error.to_string()));
                }
            }
        }
        match self.open.last() {
            Some(open) => {
                let why = format!("`<{}>` is not closed", open.name);
                Err(damaged(Span::new(open.start, open.start), &why))
            }
            None if has_root => Ok(()),
            None => Err(damaged(Span::new(0, 0), "there is no element")),
        }
    }

    /// Checks that the outermost element is one of a project.
    fn check_root(has_root: &mut bool, element: &BytesStart<'_>) -> Result<(), NoProject> {
        let name = element.local_name();
        let name: &str = name.as_ref();
        if std::mem::replace(has_root, true) || ROOTS.contains(&name) {
            return Ok(());
        }
        let what = match name {
            "EtherCATConfig" => "network information (ENI)".to_owned(),
            "EtherCATInfo" => "a device description (ESI)".to_owned(),
            "ScopeProject" => "a configuration of TwinCAT Scope".to_owned(),
            name => format!("XML with the outermost element `<{name}>`"),
        };
        Err(NoProject {
            reason: format!("{what}, not a TwinCAT project"),
            span: Span::new(0, 0),
        })
    }

    fn begin(
        &mut self,
        element: &BytesStart<'_>,
        start: usize,
        end: usize,
    ) -> Result<(), NoProject> {
        if self.open.len() >= MAX_DEPTH {
            let why = format!("its elements are nested deeper than {MAX_DEPTH}");
            return Err(damaged(Span::new(start, start), &why));
        }
        let tag = &self.file.text()[start..end];
        let length = element.name().as_ref().len();
        let name = tag.get(1..=length).unwrap_or_default();
        let name = name.rsplit(':').next().unwrap_or(name);
        self.open.push(OpenElement {
            name,
            start,
            text: None,
            item: None,
            before: (self.project.lists.len(), self.references.len()),
        });
        if tag.contains("Name=") || tag.contains("Default") || tag.contains("File=") {
            self.attributes(element, Span::new(start, end));
        }
        Ok(())
    }

    fn attributes(&mut self, element: &BytesStart<'_>, tag: Span) {
        for attribute in element.attributes().with_checks(false).flatten() {
            let key = attribute.key.local_name();
            let key: &str = key.as_ref();
            let Ok(value) = unescape(&attribute.value) else {
                continue;
            };
            if key == "File" {
                self.refer(&value, tag);
            } else if ITEM_KEYS.contains(&key) {
                let top = self.open.len() - 1;
                self.describe(top, key, value.trim(), tag);
            }
        }
    }

    fn refer(&mut self, path: &str, tag: Span) {
        let extension = Path::new(path).extension().and_then(|it| it.to_str());
        let is_part = |it: &str| {
            ["xti", "tsproj"]
                .iter()
                .any(|known| it.eq_ignore_ascii_case(known))
        };
        if extension.is_some_and(is_part) && self.references.len() < MAX_LISTS {
            let written = tag.of(self.file.text()).find(path);
            let span = written.map_or(tag, |at| {
                let start = tag.range().start + at;
                Span::new(start, start + path.len())
            });
            self.references.push(ProjectReference {
                path: Given::new(path.to_owned(), self.file, span),
                elements: self.open.iter().map(|it| it.name.to_owned()).collect(),
                items: Vec::new(),
            });
        }
    }

    /// Adds a part of the text of the innermost element, decoded where it is not the text of the file itself.
    fn add_text(&mut self, span: Span, decoded: Option<&str>) {
        let file = self.file.text();
        let part = span.of(file);
        let Some(open) = self.open.last_mut() else {
            return;
        };
        let before = match open.text.take() {
            None if decoded.is_none() && part.trim().is_empty() => return,
            None if decoded.is_none() => {
                open.text = Some(ElementText::Part(span));
                return;
            }
            None => ElementText::Joined {
                text: String::new(),
                from: span,
            },
            Some(before) => before,
        };
        let (mut text, from) = match before {
            ElementText::Part(span) => (span.of(file).to_owned(), span),
            ElementText::Joined { text, from } => (text, from),
        };
        text.push_str(decoded.unwrap_or(part));
        open.text = Some(ElementText::Joined { text, from });
    }

    /// Ends the innermost element.
    fn end(&mut self) {
        let Some(closed) = self.open.pop() else {
            return;
        };
        let file = self.file.text();
        let parent = self.open.len().checked_sub(1);
        let (text, from) = match &closed.text {
            Some(ElementText::Part(span)) => (span.of(file), *span),
            Some(ElementText::Joined { text, from }) => (text.as_str(), *from),
            None => ("", Span::new(closed.start, closed.start)),
        };
        match parent {
            Some(parent) if ITEM_KEYS.contains(&closed.name) => {
                self.describe(parent, closed.name, text.trim(), from);
            }
            _ => self.take_list(&closed, text, from),
        }
        if let Some(item) = closed.item {
            self.end_item(*item, closed.before);
        }
    }

    /// Takes the text of an element if it is a list.
    fn take_list(&mut self, closed: &OpenElement<'_>, text: &str, from: Span) {
        let wanted = LIST_ELEMENTS.iter().find(|(name, _)| *name == closed.name);
        let name = Span::new(closed.start + 1, closed.start + 1 + closed.name.len());
        let element = Given::new(closed.name.to_owned(), self.file, name);
        let may_be_one = wanted.is_some() || ListKind::is_likely(text);
        if may_be_one && self.project.lists.len() < MAX_LISTS {
            let first = self.file.lines().line(from.start);
            let source = SourceFile::new(self.file.name().clone(), text).from_line(first);
            let source = Arc::new(source);
            let entries = Entries::parse(&source);
            let kind = ListKind::detect(&entries);
            if kind.is_some() || entries.unread_kind().is_some() {
                self.project.lists.push(ProjectList {
                    items: Vec::new(),
                    source,
                    kind,
                    element,
                });
                return;
            }
        }
        if let Some((_, kind)) = wanted {
            self.project.empty.push((element, *kind));
        }
    }

    /// Takes a property of the item whose element is open.
    fn describe(&mut self, open: usize, key: &str, text: &str, span: Span) {
        if text.is_empty() {
            return;
        }
        let item = self.open[open].item.get_or_insert_default();
        let number = || text.parse().ok().map(|it| Given::new(it, self.file, span));
        match key {
            // The name of the tree counts before that of the file of the project.
            "ItemName" => item.name = Some(text.to_owned()),
            "Name" => {
                let stem = || {
                    let name: &str = self.file.name();
                    let name = name.rsplit(['/', '\\']).next().unwrap_or_default();
                    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
                };
                let name = if text == NAME_OF_FILE { stem() } else { text };
                item.name.get_or_insert_with(|| name.to_owned());
            }
            CHANNEL => item.channel = number(),
            INDEX => item.index = number(),
            _ => item.program_name = Some(Given::new(text.to_owned(), self.file, span)),
        }
        let is_odd = |name: &&str| {
            let value = if *name == CHANNEL {
                &item.channel
            } else {
                &item.index
            };
            *name == key && value.is_none()
        };
        if let Some(name) = [CHANNEL, INDEX].into_iter().find(is_odd) {
            let given = Given::new(text.to_owned(), self.file, span);
            self.project.odd.push((name, given));
        }
    }

    /// Gives the lists and references in an element to the item that it is. Without a name it describes the one around
    /// it.
    fn end_item(&mut self, item: ItemDraft, (lists, references): (usize, usize)) {
        let Some(name) = item.name else {
            if let Some(parent) = self.open.last_mut() {
                let parent = parent.item.get_or_insert_default();
                parent.channel = parent.channel.take().or(item.channel);
                parent.index = parent.index.take().or(item.index);
                parent.program_name = parent.program_name.take().or(item.program_name);
            }
            return;
        };
        if lists == self.project.lists.len() && references == self.references.len() {
            return;
        }
        let at = self.project.items.len();
        self.project.items.push(ProjectItem {
            name,
            channel: item.channel,
            index: item.index,
            program_name: item.program_name,
        });
        for list in &mut self.project.lists[lists..] {
            list.items.push(at);
        }
        for reference in &mut self.references[references..] {
            reference.items.push(at);
        }
    }
}

fn damaged(span: Span, why: &str) -> NoProject {
    NoProject {
        reason: format!("not well-formed XML: {why}"),
        span,
    }
}
