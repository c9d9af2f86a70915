//! Reads the lists that other lists name, and reports those that are missing once for each folder (R3.12).

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::assemble::AxisDraft;
use super::axis::ValueList;
use super::configuration::not_project;
use super::embedded::EmbeddedLists;
use super::files::{ListFiles, NoList, describe, folder, is_absolute, join};
use crate::diagnostic::{Code, Diagnostic};
use crate::lists::{
    AxisValues, ChannelDraft, ChannelPrograms, ChannelSettings, Entries, Given, ListKind, is_xml,
};
use crate::text::SourceFile;

/// More nested folders above a list than on any disk.
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
    /// Where these are in their files.
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
