//! The files of folders that are taken as programs: extensions, patterns, ignore files (R18.5).

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use ignore::gitignore::{Gitignore, GitignoreBuilder};

use super::file_kind::EXTENSIONS;
use super::paths::or_here;
use crate::error::HostError;

/// Names of folders that hold no programs of the user: revisions and packages.
const NEVER: [&str; 7] = [
    ".git",
    ".hg",
    ".svn",
    ".jj",
    "node_modules",
    "__pycache__",
    "System Volume Information",
];

/// Files that mark a folder as one that a tool fills: build caches, environments of Python.
const MARKS: [&str; 2] = ["CACHEDIR.TAG", "pyvenv.cfg"];

/// Treatment of ignore files, such as `.gitignore`, and of what is hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum IgnoreFiles {
    /// Files and folders that they name are not taken.
    #[default]
    Obeyed,
    /// Ignore files have no effect.
    PassedOver,
}

/// Selection of the files of all folders.
#[derive(Debug, Clone, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct FolderOptions {
    /// Patterns of files and folders that are not taken, as in a `.gitignore`, from the current folder or from the one
    /// that is walked.
    pub exclude: Vec<String>,
    /// Treatment of ignore files.
    pub ignore_files: IgnoreFiles,
}

/// Selection of the files of one folder, with what its configuration says.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct FolderSelection {
    /// The extensions of programs; `None` for the usual ones.
    pub extensions: Option<Vec<String>>,
    /// The options of the call.
    pub options: FolderOptions,
    /// Further patterns, from the folder of the configuration.
    pub configured: (PathBuf, Vec<String>),
}

impl FolderSelection {
    /// Returns the extensions of programs.
    pub(crate) fn extensions(&self) -> Vec<String> {
        let usual = || EXTENSIONS.map(str::to_owned).to_vec();
        self.extensions.clone().unwrap_or_else(usual)
    }

    /// Returns the filter of what lies below a folder.
    ///
    /// # Errors
    /// A pattern is malformed.
    pub(crate) fn filter(&self, folder: &Path) -> Result<EntryFilter, HostError> {
        let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let (here, root) = (absolute(Path::new(".")), absolute(folder));
        let mut patterns = Vec::new();
        if !self.options.exclude.is_empty() {
            patterns.push(matcher(&here, &self.options.exclude)?);
            patterns.push(matcher(&root, &self.options.exclude)?);
        }
        let (home, configured) = &self.configured;
        if !configured.is_empty() {
            patterns.push(matcher(&absolute(or_here(home)), configured)?);
        }
        Ok(EntryFilter {
            folder: folder.to_owned(),
            root,
            patterns,
            excluded: Mutex::default(),
        })
    }
}

fn matcher(root: &Path, patterns: &[String]) -> Result<Gitignore, HostError> {
    let mut builder = GitignoreBuilder::new(root);
    for pattern in patterns {
        // Written on Windows, read anywhere.
        let added = builder.add_line(None, &pattern.replace('\\', "/"));
        added.map_err(|_| HostError::Pattern(pattern.clone()))?;
    }
    let built = builder.build();
    built.map_err(|_| HostError::Pattern(patterns.join(", ")))
}

/// Filter of the entries below a folder.
pub(crate) struct EntryFilter {
    folder: PathBuf,
    root: PathBuf,
    patterns: Vec<Gitignore>,
    /// Entries that the patterns left out, each with whether it is a folder.
    excluded: Mutex<Vec<(PathBuf, bool)>>,
}

impl EntryFilter {
    /// Returns whether an entry is kept; what a pattern names is noted.
    pub(crate) fn keeps(&self, path: &Path, is_folder: bool) -> bool {
        if is_folder && is_never(path) {
            return false;
        }
        let is_excluded = self.is_excluded(path, is_folder);
        if is_excluded {
            let excluded = self.excluded.lock();
            let mut excluded = excluded.unwrap_or_else(PoisonError::into_inner);
            excluded.push((path.to_owned(), is_folder));
        }
        !is_excluded
    }

    /// Returns whether a pattern names an entry.
    pub(crate) fn is_excluded(&self, path: &Path, is_folder: bool) -> bool {
        if self.patterns.is_empty() {
            return false;
        }
        let below = path.strip_prefix(&self.folder).unwrap_or(path);
        let absolute = self.root.join(below);
        let mut patterns = self.patterns.iter();
        patterns.any(|it| {
            absolute.starts_with(it.path()) && it.matched(&absolute, is_folder).is_ignore()
        })
    }

    /// Returns what patterns left out, and whether it is a folder.
    pub(crate) fn excluded(&self) -> Vec<(PathBuf, bool)> {
        let mut excluded = self.excluded.lock().unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut excluded)
    }
}

/// Returns whether a folder holds no programs of the user, judged by its name.
fn is_never(folder: &Path) -> bool {
    let name = folder.file_name().unwrap_or_default();
    NEVER.iter().any(|never| name == *never)
}

/// Returns whether a tool fills a folder.
pub(crate) fn is_filled_by_a_tool(folder: &Path) -> bool {
    MARKS.iter().any(|mark| folder.join(mark).exists())
}
