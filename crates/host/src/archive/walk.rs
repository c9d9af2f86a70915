//! The programs below the paths that the user names, and what there is not taken (R9.77, R18.5).

use std::collections::{BTreeSet, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ignore::{DirEntry, WalkBuilder};

use super::left_out::{LeftOutFile, LeftOutFiles, WhyLeftOut};
use crate::disk::{
    EntryFilter, FolderSelection, IgnoreFiles, Input, has_extension, is_filled_by_a_tool,
    is_known_otherwise, is_program, normal,
};
use crate::error::HostError;

/// Number of entries in ignored, hidden and linked folders whose names are looked at.
const MAX_NAMES: usize = 50_000;

/// Programs found below the paths.
#[derive(Debug, Default)]
#[non_exhaustive]
pub struct FoundPrograms {
    /// The programs in a fixed order: files as the user named them, folders walked by name.
    pub inputs: Vec<Input>,
    /// The errors for paths that yielded nothing (R9.77).
    pub failures: Vec<HostError>,
    /// The files of folders that are not taken.
    pub left_out: LeftOutFiles,
}

/// A folder that is being walked.
struct Walk<'a> {
    folder: &'a Path,
    extensions: Vec<String>,
    filter: Arc<EntryFilter>,
    /// Entries that were met, taken or not.
    met: Arc<HashSet<PathBuf>>,
    links: Vec<PathBuf>,
}

/// Finds the programs. What a repository ignores is left out; a file that is named counts whatever
/// its extension. `selection` returns that of a folder.
pub fn find_programs(
    paths: &[PathBuf],
    mut selection: impl FnMut(&Path) -> FolderSelection,
) -> FoundPrograms {
    let mut found = FoundPrograms::default();
    for path in paths {
        if path.is_dir() {
            if let Err(failure) = found.walk(path, &selection(path)) {
                found.failures.push(failure);
            }
        } else {
            let input = Input::new(path);
            match input.probe() {
                Ok(()) => found.inputs.push(input),
                Err(failure) => found.failures.push(failure),
            }
        }
    }
    if paths.len() > 1 {
        found.keep_each_once();
    }
    found
}

impl FoundPrograms {
    /// Keeps the first of several names of one file, and leaves out nothing that is taken.
    fn keep_each_once(&mut self) {
        let mut seen = BTreeSet::new();
        let place = |path: &Path| {
            std::path::absolute(path).map_or_else(|_| path.to_owned(), |it| normal(&it))
        };
        self.inputs.retain(|input| match input {
            Input::File(path) => seen.insert(place(path)),
            Input::Open(_) | Input::Stdin => true,
        });
        let files = &mut self.left_out.files;
        files.retain(|file| seen.insert(place(&file.path)));
    }

    fn walk(&mut self, folder: &Path, selection: &FolderSelection) -> Result<(), HostError> {
        let (before, failed) = (self.inputs.len(), self.failures.len());
        let mut walk = Walk {
            folder,
            extensions: selection.extensions(),
            filter: Arc::new(selection.filter(folder)?),
            met: Arc::default(),
            links: Vec::new(),
        };
        walk.take(selection.options.ignore_files, self);
        let is_alone = self.inputs.len() == before && self.failures.len() == failed;
        let excluded = walk.filter.excluded().into_iter();
        let excluded = excluded
            .filter(|(path, is_folder)| *is_folder || has_extension(path, &walk.extensions));
        let excluded =
            excluded.map(|(path, _)| LeftOutFile::new(shown(&path), WhyLeftOut::Excluded));
        self.left_out.files.extend(excluded);
        walk.look_behind_links(&mut self.left_out);
        if selection.options.ignore_files == IgnoreFiles::Obeyed {
            walk.look_at_ignored(&mut self.left_out);
        }
        if is_alone {
            self.failures.push(HostError::NoPrograms {
                folder: folder.to_owned(),
                extensions: walk.extensions,
            });
        }
        Ok(())
    }
}

impl Walk<'_> {
    /// Takes the programs that no ignore file names.
    fn take(&mut self, ignore_files: IgnoreFiles, found: &mut FoundPrograms) {
        let filter = Arc::clone(&self.filter);
        let walk = WalkBuilder::new(self.folder)
            .standard_filters(ignore_files == IgnoreFiles::Obeyed)
            .sort_by_file_name(std::ffi::OsStr::cmp)
            .filter_entry(move |entry| {
                entry.depth() == 0 || filter.keeps(entry.path(), is_folder(entry))
            })
            .build();
        let mut met = HashSet::new();
        for entry in walk {
            let entry = match entry {
                Ok(entry) => entry,
                Err(error) => {
                    found.failures.push(HostError::Search {
                        folder: self.folder.to_owned(),
                        reason: error.to_string(),
                    });
                    continue;
                }
            };
            let Some(kind) = entry.file_type() else {
                continue;
            };
            if kind.is_symlink() {
                self.links.push(entry.path().to_owned());
            } else if kind.is_file() && has_extension(entry.path(), &self.extensions) {
                found.inputs.push(Input::File(shown(entry.path())));
            } else if kind.is_file() && is_program(entry.path(), None) {
                // The configuration names other extensions.
                let file = LeftOutFile::new(shown(entry.path()), WhyLeftOut::Excluded);
                found.left_out.files.push(file);
            } else if kind.is_file() {
                let file = LeftOutFile::read(shown(entry.path()), WhyLeftOut::Extension);
                found.left_out.files.push(file);
            }
            met.insert(entry.into_path());
        }
        self.met = Arc::new(met);
    }

    /// Looks for programs among what ignore files name and what is hidden. In folders, only names are looked at.
    fn look_at_ignored(&self, left_out: &mut LeftOutFiles) {
        let (met, filter) = (Arc::clone(&self.met), Arc::clone(&self.filter));
        let walk = WalkBuilder::new(self.folder)
            .standard_filters(false)
            .sort_by_file_name(std::ffi::OsStr::cmp)
            .filter_entry(move |entry| {
                let (path, is_folder) = (entry.path(), is_folder(entry));
                met.contains(path)
                    || filter.keeps(path, is_folder) && !(is_folder && is_filled_by_a_tool(path))
            })
            .build();
        let mut folder: Option<(PathBuf, WhyLeftOut)> = None;
        let mut names = 0;
        for entry in walk.filter_map(Result::ok) {
            let path = entry.path();
            if self.met.contains(path) {
                continue;
            }
            names += 1;
            if names > MAX_NAMES {
                left_out.is_cut = true;
                break;
            }
            let is_hidden = entry.file_name().to_string_lossy().starts_with('.');
            let around = folder
                .as_ref()
                .filter(|(folder, _)| path.starts_with(folder));
            if is_folder(&entry) {
                let why = if is_hidden {
                    WhyLeftOut::HiddenFolder
                } else {
                    WhyLeftOut::IgnoredFolder
                };
                if around.is_none() {
                    folder = Some((path.to_owned(), why));
                }
            } else if has_extension(path, &self.extensions) && !is_known_otherwise(path) {
                let file = match around {
                    Some((_, why)) => LeftOutFile::new(shown(path), *why),
                    None if is_hidden => LeftOutFile::read(shown(path), WhyLeftOut::Hidden),
                    None => LeftOutFile::read(shown(path), WhyLeftOut::Ignored),
                };
                left_out.files.push(file);
            }
        }
    }

    /// Looks for programs to which links lead, unless they lie below the folder, too.
    fn look_behind_links(&self, left_out: &mut LeftOutFiles) {
        let Ok(home) = self.folder.canonicalize() else {
            return;
        };
        for link in &self.links {
            let Ok(target) = link.canonicalize() else {
                continue;
            };
            if target.starts_with(&home) {
                continue;
            }
            if target.is_file() && has_extension(link, &self.extensions) {
                left_out
                    .files
                    .push(LeftOutFile::new(shown(link), WhyLeftOut::Link));
            } else if target.is_dir() {
                self.look_behind_link(link, &target, left_out);
            }
        }
    }

    fn look_behind_link(&self, link: &Path, target: &Path, left_out: &mut LeftOutFiles) {
        let filter = Arc::clone(&self.filter);
        let walk = WalkBuilder::new(target)
            .sort_by_file_name(std::ffi::OsStr::cmp)
            .filter_entry(move |entry| filter.keeps(entry.path(), is_folder(entry)))
            .build();
        for (names, entry) in walk.filter_map(Result::ok).enumerate() {
            if names > MAX_NAMES {
                left_out.is_cut = true;
                return;
            }
            let is_file = entry.file_type().is_some_and(|kind| kind.is_file());
            if is_file && has_extension(entry.path(), &self.extensions) {
                let below = entry.path().strip_prefix(target).unwrap_or(entry.path());
                let path = shown(&link.join(below));
                left_out
                    .files
                    .push(LeftOutFile::new(path, WhyLeftOut::LinkedFolder));
            }
        }
    }
}

fn is_folder(entry: &DirEntry) -> bool {
    entry.file_type().is_some_and(|kind| kind.is_dir())
}

/// Shortens `./a.nc` to `a.nc`.
fn shown(path: &Path) -> PathBuf {
    path.strip_prefix(".").unwrap_or(path).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disk::Naming;

    #[test]
    fn folders_are_walked_by_name() {
        // R9.77
        let root = tempfile::tempdir().unwrap();
        let path = |name: &str| root.path().join(name);
        std::fs::create_dir(path("sub")).unwrap();
        for name in ["b.NC", "a.mpf", "c.txt", "sub/z.cyc"] {
            std::fs::write(path(name), "").unwrap();
        }
        let paths = [path(""), path("missing.nc"), path("c.txt"), path("b.NC")];
        let found = find_programs(&paths, |_| FolderSelection::default());
        let names = |found: &FoundPrograms| -> Vec<String> {
            let inputs = found.inputs.iter();
            inputs.map(|it| it.name(Naming::FileName)).collect()
        };
        assert_eq!(names(&found), ["a.mpf", "b.NC", "z.cyc", "c.txt"]);
        assert_eq!((found.failures.len(), found.left_out.others()), (1, 0));
        let found = find_programs(&paths[..1], |_| FolderSelection {
            extensions: Some(vec!["TXT".to_owned()]),
            ..FolderSelection::default()
        });
        assert_eq!(
            (names(&found), found.left_out.others()),
            (vec!["c.txt".to_owned()], 0)
        );
        std::fs::create_dir(path("empty")).unwrap();
        let found = find_programs(&[path("empty")], |_| FolderSelection::default());
        assert!(found.failures[0].to_string().contains("no program below"));
    }
}
