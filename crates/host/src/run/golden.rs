//! Agreed results of programs, each in a file next to its program.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::disk::{FileRegistry, Input, OpenText, Replaces, folder, read_bytes};
use crate::error::HostError;
use crate::outputs::OutputFiles;

/// A kind of agreed result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GoldenKind {
    /// Extension after the name of the program, `timeline`.
    pub extension: &'static str,
    /// Name of the writer of the files, used in errors.
    pub writer: &'static str,
}

/// The results of one kind, in the folders given by the user.
#[derive(Debug, Clone)]
pub struct GoldenResults {
    kind: GoldenKind,
    trees: Vec<PathBuf>,
}

/// A program with the file of its agreed result.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct GoldenFile {
    /// The program with an agreed result.
    pub program: Input,
    /// The file next to it.
    pub path: PathBuf,
}

/// Comparison of a result with the agreed one.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum GoldenDrift {
    /// Same result as agreed.
    AsAgreed,
    /// No agreed result yet.
    Missing {
        /// The current result.
        now: String,
    },
    /// Different result.
    Drifted {
        /// The agreed result.
        before: String,
        /// The current result.
        now: String,
    },
}

/// Result for the files of one folder.
#[derive(Debug)]
#[non_exhaustive]
pub struct UpdatedFolder<'a, E> {
    /// The folder.
    pub folder: &'a Path,
    /// Number of its files that belong to the programs.
    pub files: usize,
    /// The files that drifted and were written.
    pub written: Vec<PathBuf>,
    /// Failures because of which the folder was left out.
    pub failures: Vec<E>,
}

impl GoldenResults {
    /// Returns the results next to programs, and in folders of programs.
    pub fn of(kind: GoldenKind, paths: &[PathBuf]) -> Self {
        let tree = |path: &PathBuf| {
            let tree = if path.is_dir() { path } else { folder(path) };
            tree.canonicalize().ok()
        };
        Self {
            kind,
            trees: paths.iter().filter_map(tree).collect(),
        }
    }

    /// Returns the file next to a program: `a.nc.timeline` for `a.nc`, so that `a.nc` and `a.spf` do not
    /// collide.
    ///
    /// # Errors
    /// The program is standard input, which has no folder.
    pub fn beside(&self, program: &Input) -> Result<GoldenFile, HostError> {
        let (Input::File(path) | Input::Open(OpenText { path, .. })) = program else {
            return Err(HostError::NothingBeside(self.kind.extension));
        };
        let mut name = path.as_os_str().to_owned();
        name.push(".");
        name.push(self.kind.extension);
        Ok(GoldenFile {
            program: program.clone(),
            path: name.into(),
        })
    }

    /// Compares the current result with the agreed one. `now` returns the current result, and is given
    /// the agreed one.
    ///
    /// # Errors
    /// The file cannot be read, or is a link that leads out of the folders (R9.77); or the current result
    /// is not available.
    pub fn compare<E: From<HostError>>(
        &self,
        agreed: &GoldenFile,
        now: impl FnOnce(Option<&str>) -> Result<String, E>,
    ) -> Result<GoldenDrift, E> {
        self.stay_inside(&agreed.path)?;
        let before = read_agreed(&agreed.path)?;
        let now = now(before.as_deref())?;
        Ok(match before {
            None => GoldenDrift::Missing { now },
            Some(before) if before == now => GoldenDrift::AsAgreed,
            Some(before) => GoldenDrift::Drifted { before, now },
        })
    }

    /// Writes the files that drifted, folder by folder as the iterator advances: all of a folder or
    /// none (R9.77). `now` returns the result of a program, and is given the agreed one.
    ///
    /// # Errors
    /// A file is one of the inputs.
    pub fn update<'a, E: From<HostError>>(
        &'a self,
        files: &'a [GoldenFile],
        registry: &'a FileRegistry,
        mut now: impl FnMut(&Input, Option<&str>) -> Result<String, E> + 'a,
    ) -> Result<impl Iterator<Item = UpdatedFolder<'a, E>>, HostError> {
        let mut all = OutputFiles::new(registry);
        for file in files {
            all.claim(self.kind.writer, &file.path, Replaces::Results);
        }
        all.check()?;
        let mut folders: BTreeMap<&Path, Vec<&GoldenFile>> = BTreeMap::new();
        for file in files {
            folders.entry(folder(&file.path)).or_default().push(file);
        }
        Ok(folders.into_iter().map(move |(folder, files)| {
            let mut updated = UpdatedFolder {
                folder,
                files: files.len(),
                written: Vec::new(),
                failures: Vec::new(),
            };
            let mut outputs = OutputFiles::part_of(&all);
            for file in files {
                let drift = self.compare(file, |agreed| now(&file.program, agreed));
                let done = drift.and_then(|drift| Ok(self.write(file, drift, &mut outputs)?));
                updated.failures.extend(done.err());
            }
            if updated.failures.is_empty() {
                let done = outputs.finish(|path| updated.written.push(path.to_owned()));
                updated.failures.extend(done.err().map(E::from));
            }
            updated
        }))
    }

    /// Writes one file if it drifted.
    fn write(
        &self,
        file: &GoldenFile,
        drift: GoldenDrift,
        outputs: &mut OutputFiles,
    ) -> Result<(), HostError> {
        let (GoldenDrift::Missing { now } | GoldenDrift::Drifted { now, .. }) = drift else {
            return Ok(());
        };
        let mut output = outputs.create(self.kind.writer, &file.path, Replaces::Results)?;
        let written = output.write_all(now.as_bytes());
        written.map_err(HostError::Output)?;
        output.sync()
    }

    /// Refuses a link to a file that the user did not name: it would be shown in a
    /// difference, or overwritten.
    fn stay_inside(&self, agreed: &Path) -> Result<(), HostError> {
        let is_link = std::fs::symlink_metadata(agreed).is_ok_and(|it| it.is_symlink());
        let inside = |path: PathBuf| self.trees.iter().any(|tree| path.starts_with(tree));
        if is_link && !agreed.canonicalize().is_ok_and(inside) {
            return Err(HostError::LeadsOut(agreed.to_owned()));
        }
        Ok(())
    }
}

/// Returns the agreed result; `None` where there is none yet. Line ends may be those of any system.
fn read_agreed(path: &Path) -> Result<Option<String>, HostError> {
    match read_bytes(path) {
        Ok(bytes) => {
            let text = String::from_utf8_lossy(&bytes);
            Ok(Some(text.replace("\r\n", "\n")))
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(HostError::read(path, error)),
    }
}
