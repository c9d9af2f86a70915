//! The open texts by the files that they use, so that a changed file is looked up and not searched for
//! (R12.16).

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::analysis::Analysis;
use super::documents::{Kind, OpenDocument};

/// The URIs of texts.
type Uris = BTreeSet<String>;

/// Files that the checks of the open texts have read or looked for.
#[derive(Debug, Default)]
pub(super) struct Users {
    /// The texts whose checks read a file.
    readers: BTreeMap<PathBuf, Uris>,
    /// The texts whose checks called a program of that name, in lower case and without its extension.
    callers: BTreeMap<String, Uris>,
    /// Files of each text.
    noted: BTreeMap<String, Noted>,
}

/// A text that was opened, changed or closed.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct EditedText {
    uri: String,
    path: PathBuf,
    kind: Kind,
}

impl From<&OpenDocument> for EditedText {
    fn from(document: &OpenDocument) -> Self {
        Self {
            uri: document.uri.0.clone(),
            path: document.path.clone(),
            kind: document.kind,
        }
    }
}

#[derive(Debug, Default)]
struct Noted {
    files: Vec<PathBuf>,
    names: Vec<String>,
}

impl Users {
    /// Replaces the files that the check of a text read and looked for.
    pub(super) fn note(&mut self, document: &OpenDocument, analysis: &Analysis) {
        let uri = &document.uri.0;
        self.forget(uri);
        let files = analysis.reads.clone();
        let called = files.iter().filter(|path| **path != document.path);
        let missed = analysis.missed.iter().map(|name| stem_of_call(name));
        let names: BTreeSet<String> = called.map(|path| stem(path)).chain(missed).collect();
        for path in &files {
            let readers = self.readers.entry(path.clone()).or_default();
            readers.insert(uri.clone());
        }
        for name in &names {
            let callers = self.callers.entry(name.clone()).or_default();
            callers.insert(uri.clone());
        }
        let names = names.into_iter().collect();
        self.noted.insert(uri.clone(), Noted { files, names });
    }

    /// Removes a closed text.
    pub(super) fn forget(&mut self, uri: &str) {
        let Noted { files, names } = self.noted.remove(uri).unwrap_or_default();
        for path in files {
            remove(&mut self.readers, &path, uri);
        }
        for name in names {
            remove(&mut self.callers, &name, uri);
        }
    }

    /// Returns whether a check read a file.
    pub(super) fn are_of(&self, path: &Path) -> bool {
        self.readers.contains_key(path)
    }

    /// Returns the texts whose checks read a file.
    pub(super) fn of(&self, path: &Path) -> impl Iterator<Item = &String> {
        self.readers.get(path).into_iter().flatten()
    }

    /// Returns all texts that were checked.
    pub(super) fn all(&self) -> impl Iterator<Item = &String> {
        self.noted.keys()
    }

    /// Returns the other texts whose checks may change when a text is opened, changed or closed: those that read it,
    /// and if it has no file yet, those that may look for it.
    pub(super) fn concerned(&self, edited: &EditedText) -> Uris {
        let mut concerned: Uris = self.of(&edited.path).cloned().collect();
        if !edited.path.is_file() {
            match edited.kind {
                Kind::Program | Kind::Other => {
                    let callers = self.callers.get(&stem(&edited.path));
                    concerned.extend(callers.into_iter().flatten().cloned());
                }
                // They may be in any folder above a program.
                Kind::List | Kind::Configuration => concerned.extend(self.all().cloned()),
            }
        }
        concerned.remove(&edited.uri);
        concerned
    }
}

fn remove<K: Ord>(index: &mut BTreeMap<K, Uris>, key: &K, uri: &str) {
    if let Some(uris) = index.get_mut(key) {
        uris.remove(uri);
        if uris.is_empty() {
            index.remove(key);
        }
    }
}

/// Returns the name of a file without its extension, in lower case: the control ignores case.
fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default();
    stem.to_string_lossy().to_lowercase()
}

/// Returns the stem of a name in a call, which may be a path of the control.
fn stem_of_call(name: &str) -> String {
    stem(Path::new(&name.replace('\\', "/")))
}
