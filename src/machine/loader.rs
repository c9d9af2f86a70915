//! Reads the lists that other lists name, and reports those that are missing once for each folder (R3.12).
//!
//! The control resolves relative paths from its own working folder, which is somewhere above the
//! start-up list, and Windows paths on its own disk. The library opens no files: it gives the paths
//! to try, and the host determines which of them exists. Lists within TwinCAT projects have places as item and line of the list (R3.42).

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::axis::{AxisDraft, ValueList};
use super::configuration::not_project;
use crate::diagnostic::{Code, Diagnostic, Fix};
use crate::drive_interface::{DriveReport, Presence};
use crate::lists::{
    AxisValues, ChannelDraft, ChannelPrograms, ChannelSettings, Entries, Given, ListKind, Origin,
    is_xml,
};
use crate::text::{Place, SourceFile, lines_of};

/// Limit on the nested folders above a list, beyond any disk.
const MAX_ABOVE: usize = 64;

/// Reads lists through the host and collects the messages about them.
pub(super) struct Loader<'f> {
    pub(super) files: &'f mut dyn ListFiles,
    /// The folder of the start-up list, for paths on the control's own disk.
    pub(super) startup_folder: Option<String>,
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) names: Vec<Arc<str>>,
    /// Number of named lists that do not exist.
    pub(super) missing: usize,
    /// Paths that were searched for them.
    lookups: MissingLists,
    /// The slaves of static gantries, which belong to no channel (R1.43).
    pub(super) slaves: Vec<AxisDraft>,
    /// Contents of the first channel's list.
    pub(super) channel: Option<FirstChannel>,
    /// The lists of a project, by the names under which they are asked for.
    pub(super) embedded: BTreeMap<String, Arc<SourceFile>>,
    /// Places of the lists of the project in their files.
    pub(super) project: EmbeddedLists,
}

/// The channel in which programs run.
pub(super) struct FirstChannel {
    pub(super) programs: ChannelPrograms,
    pub(super) motion: ChannelDraft,
    pub(super) settings: ChannelSettings,
}

impl<'f> Loader<'f> {
    pub(super) fn new(files: &'f mut dyn ListFiles) -> Self {
        Self {
            files,
            startup_folder: None,
            diagnostics: Vec::new(),
            names: Vec::new(),
            missing: 0,
            lookups: MissingLists::default(),
            slaves: Vec::new(),
            channel: None,
            embedded: BTreeMap::new(),
            project: EmbeddedLists::default(),
        }
    }

    /// Parses a list that was read already.
    pub(super) fn entries(&mut self, file: &Arc<SourceFile>) -> Entries {
        if !self.names.contains(file.name()) {
            self.names.push(file.name().clone());
        }
        let mut entries = Entries::parse(file);
        self.diagnostics.append(&mut entries.diagnostics);
        entries
    }

    pub(super) fn axis_list(&mut self, asked: &Given<String>) -> Option<AxisValues> {
        let entries = self.load(asked, ListKind::Axis)?;
        Some(AxisValues::from_entries(&entries, &mut self.diagnostics))
    }

    pub(super) fn value_list(&mut self, asked: &Given<String>) -> Option<ValueList> {
        let entries = self.load(asked, ListKind::Value)?;
        Some(ValueList::from_entries(&entries, &mut self.diagnostics))
    }

    /// Reads a list that another one names; reports FC123 if there is no such file (R3.14), FC125
    /// if it is a list of another kind.
    pub(super) fn load(&mut self, asked: &Given<String>, wanted: ListKind) -> Option<Entries> {
        let file = self.file(asked)?;
        self.checked(asked, &file, wanted)
    }

    /// Returns the axes of the start-up list or project that a configuration names.
    pub(super) fn axes(&mut self, asked: &Given<String>) -> Option<Vec<AxisDraft>> {
        let file = self.file(asked)?;
        if !is_xml(file.text()) {
            let entries = self.checked(asked, &file, ListKind::Startup)?;
            return Some(self.startup(&entries));
        }
        match self.project(&file) {
            Ok(axes) => Some(axes),
            Err(error) => {
                let mut said = not_project(&file, &error);
                said.place = asked.place();
                self.diagnostics.push(said);
                None
            }
        }
    }

    /// Returns the entries of a list if it is of the wanted kind.
    fn checked(
        &mut self,
        asked: &Given<String>,
        file: &Arc<SourceFile>,
        wanted: ListKind,
    ) -> Option<Entries> {
        let entries = self.entries(file);
        let is_other = ListKind::detect(&entries).is_none() && entries.unread_kind().is_some();
        if wanted.admits(&entries) && !is_other {
            self.diagnostics.extend(wanted.check_keys(&entries));
            return Some(entries);
        }
        self.diagnostics.push(mistaken(asked, wanted, &entries));
        None
    }

    /// Reads a file that another one names.
    fn file(&mut self, asked: &Given<String>) -> Option<Arc<SourceFile>> {
        match self.find(asked) {
            Ok(file) => {
                self.lookups.find(asked);
                Some(file)
            }
            Err(diagnostic) => {
                self.missing += 1;
                self.lookups.lack(asked, self.diagnostics.len());
                self.diagnostics.push(*diagnostic);
                None
            }
        }
    }

    /// Merges the messages about the lists of a missing folder.
    pub(super) fn merge_missing(&mut self) {
        std::mem::take(&mut self.lookups).merge(&mut self.diagnostics);
    }

    /// Returns the first existing file that a path may mean: relative to the folder of the list
    /// that names it, relative to each folder above, and by its last part in the folder of the
    /// start-up list.
    fn find(&mut self, asked: &Given<String>) -> Result<Arc<SourceFile>, Box<Diagnostic>> {
        if let Some(part) = self.embedded.get(&asked.value) {
            return Ok(part.clone());
        }
        let beside = folder(asked.file());
        let first = join(beside, &asked.value);
        let mut unreadable = None;
        let mut read = |files: &mut dyn ListFiles, path: &str| match files.read(path) {
            Ok(file) => Some(file),
            Err(NoList::Missing) => None,
            Err(NoList::Unreadable(why)) => {
                unreadable.get_or_insert((path.to_owned(), why));
                None
            }
        };
        let mut found = read(self.files, &first);
        let mut from = beside.to_owned();
        for _ in 0..MAX_ABOVE {
            if found.is_some() || is_absolute(&asked.value) {
                break;
            }
            match self.files.above(&from) {
                Some(above) => from = above,
                None => break,
            }
            found = read(self.files, &join(&from, &asked.value));
        }
        let startup = self.startup_folder.as_deref().unwrap_or(beside);
        let last = asked.value.rsplit(['\\', '/']).next().unwrap_or_default();
        let bare = join(startup, last);
        if found.is_none() && bare != first {
            found = read(self.files, &bare);
        }
        if let Some(file) = found {
            return Ok(file.into());
        }
        let named = format!(
            "`{}`, named in line {} of `{}`",
            asked.value,
            asked.line(),
            asked.file()
        );
        let diagnostic = |message: String| Diagnostic::new(Code::Fc123, asked.place(), message);
        if let Some((path, why)) = unreadable {
            return Err(Box::new(
                diagnostic(format!("{named}, cannot be read: {why}"))
                    .with_help(format!("check your permission to read `{path}`")),
            ));
        }
        let looked = if is_absolute(&asked.value) {
            format!("looked for `{first}`")
        } else {
            format!("looked for `{first}`, in the same way from each folder above")
        };
        let looked = if bare == first {
            looked
        } else {
            format!("{looked}, and for `{bare}`")
        };
        let mut diagnostic = diagnostic(format!("{named}, is not found")).with_help(looked);
        if asked.value.contains([' ', '\t']) && asked.value.contains(['#', '/', '*']) {
            diagnostic = diagnostic.with_help("only `(` opens a comment after a path");
        }
        Err(Box::new(diagnostic))
    }
}

/// Returns FC125 for a list where one of another kind belongs.
fn mistaken(asked: &Given<String>, wanted: ListKind, entries: &Entries) -> Diagnostic {
    let message = format!(
        "`{}` is {}, not {}",
        asked.value,
        describe(entries),
        wanted.noun()
    );
    Diagnostic::new(Code::Fc125, asked.place(), message).with_help("the list is not used")
}

/// The folders that were searched for lists, and the lists that were not found.
#[derive(Debug, Default)]
pub(super) struct MissingLists {
    /// Folders in which a list was found: the list that names it, and the folder.
    found: BTreeSet<(Arc<str>, String)>,
    lacking: Vec<Lacking>,
}

/// A list that was not found.
#[derive(Debug)]
struct Lacking {
    /// The list that names it.
    asker: Arc<str>,
    folder: String,
    /// The last part of its path.
    name: String,
    /// Index of the message about it.
    message: usize,
}

impl MissingLists {
    /// Records that a list exists.
    pub(super) fn find(&mut self, asked: &Given<String>) {
        self.found.insert(whereabouts(asked));
    }

    /// Records that a list is missing, as reported by the diagnostic with this index.
    pub(super) fn lack(&mut self, asked: &Given<String>, message: usize) {
        let (list, folder) = whereabouts(asked);
        if folder.is_empty() || is_absolute(&asked.value) {
            return;
        }
        let name = asked.value.rsplit(['\\', '/']).next().unwrap_or_default();
        self.lacking.push(Lacking {
            asker: list,
            folder,
            name: name.to_owned(),
            message,
        });
    }

    /// Merges the messages about the lists of a folder if none of them was found: the control finds
    /// the folder from its own working folder, but it does not exist here.
    pub(super) fn merge(self, diagnostics: &mut Vec<Diagnostic>) {
        let mut surplus = Vec::new();
        let mut rest = self.lacking;
        while let Some(first) = rest.first() {
            let place = (first.asker.clone(), first.folder.clone());
            let (same, others): (Vec<_>, Vec<_>) = rest
                .into_iter()
                .partition(|it| it.asker == place.0 && it.folder == place.1);
            rest = others;
            if same.len() < 2 || self.found.contains(&place) {
                continue;
            }
            let names: Vec<&str> = same.iter().map(|it| it.name.as_str()).collect();
            let first = &mut diagnostics[same[0].message];
            first.message = format!(
                "the folder `{}`, in which `{}` names {} lists, is not here",
                place.1,
                place.0,
                names.len()
            );
            first.advice.insert(
                0,
                "the control finds it from its working folder; copy it next to this list".into(),
            );
            first
                .advice
                .push(format!("the lists are {}", names.join(", ")).into());
            surplus.extend(same[1..].iter().map(|it| it.message));
        }
        surplus.sort_unstable();
        let mut at = 0;
        diagnostics.retain(|diagnostic| {
            let is_surplus = surplus.binary_search(&at).is_ok();
            debug_assert!(!is_surplus || diagnostic.code == Code::Fc123);
            at += 1;
            !is_surplus
        });
    }
}

/// Returns the list that names a path, and the folder of the path.
fn whereabouts(asked: &Given<String>) -> (Arc<str>, String) {
    (asked.file().into(), join("", folder(&asked.value)))
}

/// The reason for which a path has no list.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoList {
    /// No file at the path.
    #[error("it is not found")]
    Missing,
    /// File that exists there but cannot be read; the reason.
    #[error("{0}")]
    Unreadable(String),
}

/// Provides list files to the library, which opens none itself.
pub trait ListFiles {
    /// Reads the list at a path. A relative path has been resolved against the folder in the name
    /// of the referring list, if that name has one. Diagnostics show the name of the source, and
    /// further paths are resolved against it.
    ///
    /// # Errors
    /// It does not exist or cannot be read.
    fn read(&mut self, path: &str) -> Result<SourceFile, NoList>;

    /// Returns the folder above a folder; an empty text means the folder in which relative paths
    /// begin. `None` if there is none, or the host does not know it.
    fn above(&self, folder: &str) -> Option<String> {
        parent(folder).map(str::to_owned)
    }
}

/// A host without list files.
pub struct NoLists;

impl ListFiles for NoLists {
    fn read(&mut self, _path: &str) -> Result<SourceFile, NoList> {
        Err(NoList::Missing)
    }
}

/// Returns the folder of a path as written, without its separator; empty for a bare name.
pub(super) fn folder(path: &str) -> &str {
    match path.rfind(['/', '\\']) {
        Some(0) => "/",
        Some(at) => &path[..at],
        None => "",
    }
}

/// Returns the folder above if the path itself contains it.
fn parent(path: &str) -> Option<&str> {
    let named = !matches!(path, "" | "." | "/") && !path.ends_with("..");
    named.then(|| folder(path))
}

pub(super) fn is_absolute(path: &str) -> bool {
    path.starts_with(['/', '\\']) || path.get(1..2) == Some(":")
}

/// Returns a path relative to a folder, with `/` between its parts and without `.` parts.
pub(super) fn join(folder: &str, path: &str) -> String {
    let slashed = path.replace('\\', "/");
    if is_absolute(path) {
        return slashed;
    }
    let mut joined = folder.to_owned();
    for part in slashed.split('/').filter(|part| !matches!(*part, "" | ".")) {
        if !joined.is_empty() && !joined.ends_with('/') {
            joined.push('/');
        }
        joined.push_str(part);
    }
    joined
}

/// Returns the kind of a file with its article: `a value list`, `a program`.
pub(super) fn describe(entries: &Entries) -> &'static str {
    if let Some(kind) = ListKind::detect(entries) {
        return kind.noun();
    }
    let text = entries.source().text();
    let first = lines_of(text)
        .map(str::trim)
        .find(|line| !line.is_empty() && !line.starts_with('#'));
    let Some(first) = first else {
        return "an empty file";
    };
    let tables = ["[machine", "[[axis", "[variables", "[lint", "[check"];
    if let Some(what) = entries.unread_kind() {
        what
    } else if first.starts_with('<') {
        "an XML file"
    } else if tables.iter().any(|table| first.starts_with(table)) {
        "a `frictcomp.toml`"
    } else if is_block(first) {
        "a program"
    } else if entries.entries.is_empty() {
        "no list of the control"
    } else {
        "a list of a kind that is not known"
    }
}

/// Returns whether a list contains nothing before its `Ende` except comments, like a template.
pub(super) fn has_nothing(entries: &Entries) -> bool {
    let is_plain = entries.diagnostics.is_empty() && entries.entries.is_empty();
    is_plain && !entries.source().text().trim().is_empty()
}

/// Returns whether a line begins like an NC program: with a name, a comment or a letter with its number.
fn is_block(line: &str) -> bool {
    let word = line.split([' ', '\t', '[']).next().unwrap_or_default();
    let mut letters = word.chars();
    let number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+');
    match letters.next() {
        Some('%' | ';' | '(' | '$' | '/') => true,
        Some(first) => first.is_ascii_alphabetic() && letters.all(number),
        None => false,
    }
}

/// The lists that are parts of project files.
#[derive(Debug, Clone, Default)]
pub struct EmbeddedLists(Vec<EmbeddedList>);

/// A list within a project file.
#[derive(Debug, Clone)]
pub(super) struct EmbeddedList {
    /// The project file.
    pub(super) file: Arc<str>,
    /// The item, and the element of the list.
    pub(super) item: String,
    pub(super) element: String,
    /// The lines of the file that the list takes.
    pub(super) lines: std::ops::RangeInclusive<u32>,
}

impl EmbeddedLists {
    /// Returns the number of lists.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    pub(super) fn add(&mut self, list: EmbeddedList) {
        self.0.push(list);
    }

    fn list(&self, file: &str, line: u32) -> Option<(&EmbeddedList, u32)> {
        let mut lists = self.0.iter();
        let found = lists.find(|list| &*list.file == file && list.lines.contains(&line))?;
        Some((found, line - found.lines.start() + 1))
    }

    fn words(&self, place: &Place) -> Option<String> {
        let (list, line) = self.list(&place.file, place.start().line)?;
        let EmbeddedList { item, element, .. } = list;
        Some(format!("item `{item}`, line {line} of `{element}`"))
    }

    /// Returns whether a place is in one of these lists, where nothing is written.
    pub(super) fn holds(&self, place: &Place) -> bool {
        self.words(place).is_some()
    }

    /// Names in diagnostics the item and the line within the list, and shows the lines to change in place of fixes:
    /// nothing is written into a project.
    pub fn explain(&self, diagnostics: &mut [Diagnostic]) {
        for said in diagnostics.iter_mut().filter(|_| !self.0.is_empty()) {
            let (within, plain) = std::mem::take(&mut said.fixes)
                .into_iter()
                .partition(|fix| self.holds(&fix.place));
            said.fixes = plain;
            let within: Vec<Fix> = within;
            let lines = within.iter().filter_map(|fix| self.line_to_write(fix));
            said.advice.extend(lines.map(Into::into));
            if let Some(words) = self.words(&said.place)
                && !said.message.contains(&words)
            {
                said.message = format!("{} ({words})", said.message);
            }
            for label in &mut said.labels {
                if let Some(words) = self.words(&label.place)
                    && !label.text.ends_with(&words)
                {
                    label.text = format!("{}; {words}", label.text);
                }
            }
        }
    }

    /// Returns the line that a fix would write, in words.
    fn line_to_write(&self, fix: &Fix) -> Option<String> {
        let (_, line) = self.list(&fix.place.file, fix.place.start().line)?;
        if let Some(added) = fix.text.strip_prefix('\n') {
            return Some(format!("add `{added}` after line {line} of the list"));
        }
        let mut written = fix.place.text.to_string();
        written.replace_range(fix.place.span.range(), &fix.text);
        Some(format!(
            "write line {line} of the list as `{}`",
            written.trim()
        ))
    }

    /// Names the items and the lines within the lists in place of those of the file in what is known about a drive.
    pub fn rename_evidence(&self, drive: &mut DriveReport) {
        for presence in [&mut drive.additive_torque, &mut drive.actual_torque] {
            if let Presence::Present { evidence } | Presence::Missing { evidence } = presence {
                self.rename(&mut evidence.origin);
            }
        }
    }

    /// Names the item and the line within the list in place of those of the file.
    pub(super) fn rename(&self, origin: &mut Origin) {
        if let Origin::File { file, line } = origin
            && let Some((list, within)) = self.list(file, *line)
        {
            *file = format!("{file}, {}", list.item);
            *line = within;
        }
    }
}
