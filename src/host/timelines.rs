//! The timelines that were agreed on, each in a file beside its program.

use std::io;
use std::path::{Path, PathBuf};

use super::error::HostError;
use super::ledger::folder;
use super::read::read_bytes;

/// The timelines beside programs, in the folders that the user handed over.
#[derive(Debug, Clone)]
pub struct AgreedTimelines {
    trees: Vec<PathBuf>,
}

/// A timeline against the one that was agreed on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TimelineDrift {
    /// They are the same.
    AsAgreed,
    /// No timeline has been agreed yet.
    Missing {
        /// The timeline of today.
        now: String,
    },
    /// They differ.
    Drifted {
        /// The timeline that was agreed on.
        before: String,
        /// The timeline of today.
        now: String,
    },
}

impl AgreedTimelines {
    /// The timelines of programs and of folders of programs.
    pub fn of(paths: &[PathBuf]) -> Self {
        let tree = |path: &PathBuf| {
            let tree = if path.is_dir() { path } else { folder(path) };
            tree.canonicalize().ok()
        };
        Self {
            trees: paths.iter().filter_map(tree).collect(),
        }
    }

    /// `a.nc.timeline` beside `a.nc`, so that `a.nc` and `a.spf` do not meet.
    pub fn path(program: &Path) -> PathBuf {
        let mut name = program.as_os_str().to_owned();
        name.push(".timeline");
        name.into()
    }

    /// Compares the timeline of today with the one in a file.
    ///
    /// # Errors
    /// The file cannot be read, or is a link that leads out of the folders (R9.77).
    pub fn compare(&self, agreed: &Path, now: String) -> Result<TimelineDrift, HostError> {
        self.stay_inside(agreed)?;
        Ok(match read_agreed(agreed)? {
            None => TimelineDrift::Missing { now },
            Some(before) if before == now => TimelineDrift::AsAgreed,
            Some(before) => TimelineDrift::Drifted { before, now },
        })
    }

    /// A link may not lead to a file that the user did not hand over: it would be shown in a
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

/// The agreed timeline, `None` when there is none. Line ends may be those of any system.
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
