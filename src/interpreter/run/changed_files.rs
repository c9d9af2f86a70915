//! Files that a program renames, deletes or writes (R2.108). They stay as they are when it ends.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

/// The files that are not those of the archive any more.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct ChangedFiles {
    /// Their names without folders, in lower case.
    names: BTreeSet<String>,
    /// Whether any file may have changed: the program computes a name.
    any: bool,
    /// The files to which `#MSG SAVE` may write, where the program named one.
    messages: BTreeSet<String>,
    /// What `#FILE EXIST` looked for last and is not here.
    #[serde(default)]
    missing: MissingFile,
}

/// A file that is looked for and not here.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
enum MissingFile {
    #[default]
    Nothing,
    /// The one of this name, without its folder, in lower case.
    Named(String),
    /// Any one: the program computes its name.
    Any,
}

impl ChangedFiles {
    /// A file is changed; `None` for one whose name is not known.
    pub(crate) fn change(&mut self, name: Option<&str>) {
        match name {
            Some(name) => _ = self.names.insert(base_name(name)),
            None => self.any = true,
        }
    }

    /// Whether a program is not that of the archive.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.any || !self.names.is_empty() && self.names.contains(&base_name(name))
    }

    /// Messages are written to a file from here on.
    pub(crate) fn write_messages_to(&mut self, name: &str) {
        self.messages = BTreeSet::from([base_name(name)]);
    }

    /// A message is written.
    pub(crate) fn write_message(&mut self) {
        self.names.extend(self.messages.iter().cloned());
    }

    /// `#FILE EXIST` looked for a file that is not here; `None` for one whose name is not known.
    pub(crate) fn miss(&mut self, name: Option<&str>) {
        self.missing = name.map_or(MissingFile::Any, |name| MissingFile::Named(base_name(name)));
    }

    /// `#FILE EXIST` found its file.
    pub(crate) fn find(&mut self) {
        self.missing = MissingFile::Nothing;
    }

    /// Whether the program asked whether a file that is not here exists.
    pub(crate) fn is_guarded(&self, name: &str) -> bool {
        match &self.missing {
            MissingFile::Nothing => false,
            MissingFile::Named(missing) => *missing == base_name(name),
            MissingFile::Any => true,
        }
    }

    /// The files of another way may be changed, too.
    pub(crate) fn join(&mut self, other: &Self) {
        self.names.extend(other.names.iter().cloned());
        self.any |= other.any;
        self.messages.extend(other.messages.iter().cloned());
        if self.missing != other.missing {
            self.missing = MissingFile::Nothing;
        }
    }
}

fn base_name(path: &str) -> String {
    let name = path.trim().rsplit(['/', '\\']).next().unwrap_or_default();
    name.to_ascii_lowercase()
}
