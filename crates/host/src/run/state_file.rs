//! The state file: the state that one run leaves and the next one starts with (9.4).

use std::fmt::Display;
use std::fs::{File, TryLockError};
use std::hash::Hasher as _;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use fnv::FnvHasher;
use serde::Deserialize;

use crate::disk::read_bytes;
use crate::error::HostError;
use crate::outputs::{OutputFiles, target};
use frictcomp::session::{STATE_SCHEMA, SavedState, StateError};
use frictcomp::text::shown_json;

/// Time for which a second run waits for the first (R9.31).
const PATIENCE: Duration = Duration::from_secs(5);

/// Time between attempts.
const PAUSE: Duration = Duration::from_millis(25);

/// Text between the content of a state file and the digits of its checksum.
const SEAL: &[u8] = b",\n  \"checksum\": \"";

/// The first schema whose files have a checksum.
const SEALED_SCHEMA: u32 = 3;

/// Part of a state file that every version has.
#[derive(Deserialize)]
struct Schema {
    schema: u32,
}

/// A state file that is locked against other runs until this is dropped.
#[derive(Debug)]
pub struct StateFile {
    path: PathBuf,
    /// Holds the lock.
    _lock: File,
    /// The lock file, if this run created it.
    made: Option<PathBuf>,
}

impl Drop for StateFile {
    /// Removes a lock without a state.
    fn drop(&mut self) {
        if !self.path.exists() {
            self.take_away_lock();
        }
    }
}

impl StateFile {
    /// Returns the file that is locked in place of a state file, which is replaced while it is in use.
    pub fn lock_path(path: &Path) -> PathBuf {
        suffixed(path, ".lock")
    }

    /// Locks the state file, whether it exists already or not. Waits some seconds for a run that has
    /// locked it.
    ///
    /// # Errors
    /// Another run has locked it, or it cannot be written.
    pub fn lock(path: &Path) -> Result<Self, HostError> {
        Self::lock_within(path, PATIENCE)
    }

    fn lock_within(path: &Path, patience: Duration) -> Result<Self, HostError> {
        // A link stays a link: the file that it names is replaced.
        let file = target(path).map_err(|error| HostError::write(path, error))?;
        let beside = Self::lock_path(&file);
        for path in [path, &beside] {
            if path.exists() && !path.is_file() {
                return Err(HostError::StateNotRegular(path.to_owned()));
            }
        }
        let path = path.to_owned();
        let start = Instant::now();
        loop {
            let made = (!beside.exists()).then(|| beside.clone());
            let lock = File::options()
                .create(true)
                .truncate(false)
                .write(true)
                .open(&beside)
                .map_err(|error| HostError::write(&beside, error))?;
            match lock.try_lock() {
                // The run that had it may have removed it.
                Ok(()) if !is_at(&lock, &beside) && start.elapsed() < patience => {}
                Ok(()) => {
                    return Ok(Self {
                        path,
                        _lock: lock,
                        made,
                    });
                }
                Err(TryLockError::WouldBlock) if start.elapsed() < patience => {
                    std::thread::sleep(PAUSE);
                }
                Err(TryLockError::WouldBlock) => return Err(HostError::StateInUse(path)),
                Err(TryLockError::Error(error)) => {
                    if let Some(made) = made {
                        let _ = std::fs::remove_file(made);
                    }
                    return Err(HostError::write(&beside, error));
                }
            }
        }
    }

    /// Returns the axes that the last run left; none where the file cannot be read, which is reported when it
    /// is loaded.
    pub fn axes(path: &Path) -> Vec<String> {
        let axes = Self::read(path).map_or_else(|_| Vec::new(), |saved| saved.axes);
        axes.into_iter().map(|axis| axis.axis).collect()
    }

    /// Returns the state that the last run left; `None` before the first.
    ///
    /// # Errors
    /// It cannot be read, is damaged, or comes from a later version.
    pub fn load(&self) -> Result<Option<SavedState>, HostError> {
        match Self::read(&self.path) {
            Err(HostError::Read { reason, .. }) if reason.kind() == io::ErrorKind::NotFound => {
                Ok(None)
            }
            read => read.map(Some).inspect_err(|_| self.take_away_lock()),
        }
    }

    /// Reads the state in a file, which is not locked: it is replaced in one step, so it is always complete.
    ///
    /// # Errors
    /// It cannot be read, is damaged, or comes from a later version.
    pub fn read(path: &Path) -> Result<SavedState, HostError> {
        let text = read_bytes(path).map_err(|error| HostError::read(path, error))?;
        let damaged = |error: &dyn Display| unusable(path, &format!("it is damaged ({error})"));
        // A later version may have unknown keys: its number is read first.
        let Schema { schema } = serde_json::from_slice(&text).map_err(|error| damaged(&error))?;
        if schema > STATE_SCHEMA {
            let later = StateError::Schema { found: schema };
            return Err(unusable(path, &later.to_string()));
        }
        let content = match split_seal(&text) {
            Some(content) if seal(content) == text => [content, b"\n}"].concat(),
            None if schema < SEALED_SCHEMA => text,
            _ => return Err(damaged(&"its checksum does not match its content")),
        };
        serde_json::from_slice(&content).map_err(|error| damaged(&error))
    }

    /// Returns the error for a state that the session rejects. The file stays as it is.
    pub fn refused(&self, error: &StateError) -> HostError {
        self.take_away_lock();
        unusable(&self.path, &error.to_string())
    }

    /// Removes a lock that this run created (R9.94). A run that waits for it creates another one.
    fn take_away_lock(&self) {
        if let Some(made) = &self.made {
            let _ = std::fs::remove_file(made);
        }
    }

    /// Replaces the state when the outputs are put in place. Whenever the tool is killed, the old or
    /// the new file is there, complete.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn save(&self, state: &SavedState, outputs: &mut OutputFiles) -> Result<(), HostError> {
        let text = serde_json::to_string_pretty(state)
            .map_err(|error| HostError::write(&self.path, error.into()))?;
        // A reader of the file sees what it contains (R9.76).
        let text = shown_json(&text);
        let content = text.strip_suffix("\n}").unwrap_or(&text);
        outputs.begin(&self.path)?.bytes(&seal(content.as_bytes()))
    }
}

/// Returns whether an open file is still the one at a path.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let number = |found: std::fs::Metadata| (found.dev(), found.ino());
    let open = file.metadata().map(number);
    open.is_ok_and(|open| std::fs::metadata(path).is_ok_and(|there| number(there) == open))
}

/// Returns whether there is a file at the path: an open one cannot be moved.
#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}

/// Returns the text of a state file: its content without the closing brace, then its checksum, a 64-bit
/// FNV-1a hash, which differs for any two contents that differ in one byte (R9.92).
fn seal(content: &[u8]) -> Vec<u8> {
    let mut hasher = FnvHasher::default();
    hasher.write(content);
    let checksum = format!("{:016x}\"\n}}\n", hasher.finish());
    [content, SEAL, checksum.as_bytes()].concat()
}

/// Returns the content before the checksum, if there is one.
fn split_seal(text: &[u8]) -> Option<&[u8]> {
    memchr::memmem::rfind(text, SEAL).and_then(|at| text.get(..at))
}

fn unusable(path: &Path, reason: &str) -> HostError {
    HostError::State {
        path: path.to_owned(),
        reason: reason.to_owned(),
    }
}

fn suffixed(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    name.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disk::FileRegistry;

    fn state() -> SavedState {
        let machine = frictcomp::machine::Machine::enabled(["X"]);
        frictcomp::session::Session::new(machine, frictcomp::session::SessionOptions::default())
            .save()
    }

    #[test]
    fn a_state_is_replaced_in_one_step() {
        // R9.31
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.json");
        let file = StateFile::lock(&path).unwrap();
        assert!(file.load().unwrap().is_none());
        let mut outputs = OutputFiles::new(&FileRegistry::default());
        file.save(&state(), &mut outputs).unwrap();
        outputs.finish(|_| ()).unwrap();
        drop(file);
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.ends_with("}\n"), "{text}");
        let file = StateFile::lock(&path).unwrap();
        assert_eq!(file.load().unwrap(), Some(state()));
        drop(file);
        let names = std::fs::read_dir(folder.path()).unwrap().count();
        assert_eq!(names, 2, "the state and its lock");
    }

    #[test]
    fn what_cannot_be_seen_is_escaped_and_read_back() {
        // R9.76
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.json");
        let hidden = "a\u{0}\t\n\u{1b}[31m\u{7f}\u{85}\u{9b}\u{202e}\u{2028}\u{feff}\"\\z";
        let mut saved = state();
        saved.macros.insert(hidden.to_owned(), hidden.to_owned());
        saved.lost_parameters = Some(frictcomp::interpreter::Unknown::text(hidden));
        let file = StateFile::lock(&path).unwrap();
        let mut outputs = OutputFiles::new(&FileRegistry::default());
        file.save(&saved, &mut outputs).unwrap();
        outputs.finish(|_| ()).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let is_raw = |letter: char| letter != '\n' && !(' '..='~').contains(&letter);
        assert_eq!(text.find(is_raw), None, "{text:?}");
        assert_eq!(file.load().unwrap(), Some(saved));
    }

    #[test]
    fn a_damaged_file_stays_as_it_is() {
        // R9.30
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.json");
        std::fs::write(&path, "{\"schema\":").unwrap();
        let error = StateFile::lock(&path).unwrap().load().unwrap_err();
        assert!(error.to_string().contains("damaged"), "{error}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "{\"schema\":");
        // R9.94
        assert!(!StateFile::lock_path(&path).exists());
    }

    #[test]
    fn every_changed_bit_is_damage() {
        // R9.92
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.json");
        let file = StateFile::lock(&path).unwrap();
        let mut outputs = OutputFiles::new(&FileRegistry::default());
        file.save(&state(), &mut outputs).unwrap();
        outputs.finish(|_| ()).unwrap();
        let whole = std::fs::read(&path).unwrap();
        for bit in 0..whole.len() * 8 {
            let mut flipped = whole.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            std::fs::write(&path, &flipped).unwrap();
            assert!(file.load().is_err(), "bit {bit} of {}", whole.len() * 8);
        }
        std::fs::write(&path, &whole).unwrap();
        assert_eq!(file.load().unwrap(), Some(state()));
    }

    #[test]
    fn two_runs_are_kept_apart() {
        // R9.31
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.json");
        let first = StateFile::lock(&path).unwrap();
        let second = StateFile::lock_within(&path, Duration::from_millis(60));
        assert!(second.unwrap_err().to_string().contains("another run"));
        drop(first);
        assert!(StateFile::lock_within(&path, Duration::ZERO).is_ok());
    }
}
