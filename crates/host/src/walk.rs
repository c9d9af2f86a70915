//! The programs below the paths that the user names.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use ignore::WalkBuilder;

use super::error::HostError;
use super::file_kind::{EXTENSIONS, has_extension};
use super::input::Input;

/// Programs found below the paths.
#[derive(Debug, Default)]
#[non_exhaustive]
pub struct FoundPrograms {
    /// The programs in a fixed order: files as the user named them, folders walked by name.
    pub inputs: Vec<Input>,
    /// The errors for paths that yielded nothing (R9.77).
    pub failures: Vec<HostError>,
    /// Files of folders whose extension is not that of a program.
    pub passed_over: u64,
}

/// Finds the programs. What a repository ignores is passed over; a file that is named counts whatever
/// its extension. `extensions` returns those of the programs in a folder.
pub fn find_programs(
    paths: &[PathBuf],
    mut extensions: impl FnMut(&Path) -> Option<Vec<String>>,
) -> FoundPrograms {
    let mut found = FoundPrograms::default();
    for path in paths {
        if path.is_dir() {
            let extensions = extensions(path);
            let extensions = extensions.unwrap_or_else(|| EXTENSIONS.map(str::to_owned).to_vec());
            found.walk(path, &extensions);
        } else {
            let input = Input::new(path);
            match input.probe() {
                Ok(()) => found.inputs.push(input),
                Err(failure) => found.failures.push(failure),
            }
        }
    }
    let mut seen = BTreeSet::new();
    found.inputs.retain(|input| seen.insert(input.clone()));
    found
}

impl FoundPrograms {
    fn walk(&mut self, folder: &Path, extensions: &[String]) {
        let (before, failed) = (self.inputs.len(), self.failures.len());
        let walk = WalkBuilder::new(folder)
            .sort_by_file_name(std::ffi::OsStr::cmp)
            .build();
        for entry in walk {
            let entry = match entry {
                Ok(entry) => entry,
                Err(error) => {
                    self.failures.push(HostError::Search {
                        folder: folder.to_owned(),
                        reason: error.to_string(),
                    });
                    continue;
                }
            };
            if !entry.file_type().is_some_and(|kind| kind.is_file()) {
                continue;
            }
            if has_extension(entry.path(), extensions) {
                self.inputs.push(Input::File(shown(entry.path())));
            } else {
                self.passed_over += 1;
            }
        }
        if self.inputs.len() == before && self.failures.len() == failed {
            self.failures.push(HostError::NoPrograms {
                folder: folder.to_owned(),
                extensions: extensions.to_vec(),
            });
        }
    }
}

/// Shortens `./a.nc` to `a.nc`.
fn shown(path: &Path) -> PathBuf {
    path.strip_prefix(".").unwrap_or(path).to_owned()
}

#[cfg(test)]
mod tests {
    use super::super::input::Naming;
    use super::*;

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
        let found = find_programs(&paths, |_| None);
        let names = |found: &FoundPrograms| -> Vec<String> {
            let inputs = found.inputs.iter();
            inputs.map(|it| it.name(Naming::FileName)).collect()
        };
        assert_eq!(names(&found), ["a.mpf", "b.NC", "z.cyc", "c.txt"]);
        assert_eq!((found.failures.len(), found.passed_over), (1, 1));
        let found = find_programs(&paths[..1], |_| Some(vec!["TXT".to_owned()]));
        assert_eq!(
            (names(&found), found.passed_over),
            (vec!["c.txt".to_owned()], 3)
        );
        std::fs::create_dir(path("empty")).unwrap();
        let found = find_programs(&[path("empty")], |_| None);
        assert!(found.failures[0].to_string().contains("no program below"));
    }
}
