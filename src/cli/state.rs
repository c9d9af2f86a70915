//! The state file: what one run leaves and the next one starts with (9.4).

use std::fs::{File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::Deserialize;

use super::failure::Failure;
use super::files::read_bytes;
use super::outputs::Outputs;
use super::unfinished::target;
use crate::session::{STATE_SCHEMA, SavedState, StateError};

/// How long a second run waits for the first (R9.31).
const PATIENCE: Duration = Duration::from_secs(5);

/// How often it looks.
const PAUSE: Duration = Duration::from_millis(25);

/// What every state file has, whatever its version.
#[derive(Deserialize)]
struct Schema {
    schema: u32,
}

/// A state file that no other run touches until this is dropped.
#[derive(Debug)]
pub(super) struct StateFile {
    path: PathBuf,
    /// Holds the lock; the file itself stays, since removing it would let two runs lock two files.
    _lock: File,
}

impl StateFile {
    /// Claims the files that hold the state and the lock.
    pub(super) fn claim(path: &Path, outputs: &mut Outputs) {
        outputs.claim("--state", path);
        outputs.claim("the lock of --state", &suffixed(path, ".lock"));
    }

    /// Locks the state file, whether it exists already or not.
    pub(super) fn lock(path: &Path) -> Result<Self, Failure> {
        Self::lock_within(path, PATIENCE)
    }

    fn lock_within(path: &Path, patience: Duration) -> Result<Self, Failure> {
        // A link stays a link: the file that it names is replaced.
        let path = target(path).map_err(|error| Failure::writing(path, &error))?;
        let beside = suffixed(&path, ".lock");
        for path in [&path, &beside] {
            if path.exists() && !path.is_file() {
                return Err(Failure::new(format!(
                    "`{}` cannot hold a state, it is not a regular file",
                    path.display()
                )));
            }
        }
        let lock = File::options()
            .create(true)
            .truncate(false)
            .write(true)
            .open(&beside)
            .map_err(|error| Failure::writing(&beside, &error))?;
        let start = Instant::now();
        loop {
            match lock.try_lock() {
                Ok(()) => return Ok(Self { path, _lock: lock }),
                Err(TryLockError::WouldBlock) if start.elapsed() < patience => {
                    std::thread::sleep(PAUSE);
                }
                Err(TryLockError::WouldBlock) => {
                    return Err(Failure::new(format!(
                        "another run uses the state file `{}`",
                        path.display()
                    ))
                    .with_help("wait until it has ended, or give each run a state file"));
                }
                Err(TryLockError::Error(error)) => return Err(Failure::writing(&beside, &error)),
            }
        }
    }

    /// The axes that the last run left; none where the file cannot be read, which is said when it
    /// is loaded.
    pub(super) fn axes(path: &Path) -> Vec<String> {
        let text = read_bytes(path).unwrap_or_default();
        let saved: Option<SavedState> = serde_json::from_slice(&text).ok();
        let axes = saved.map(|saved| saved.axes).unwrap_or_default();
        axes.into_iter().map(|axis| axis.axis).collect()
    }

    /// What the last run left; `None` before the first.
    pub(super) fn load(&self) -> Result<Option<SavedState>, Failure> {
        let text = match read_bytes(&self.path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(Failure::reading(&self.path, &error)),
        };
        let damaged = |error| self.unusable(&format!("it is damaged ({error})"));
        // A later version may have keys that this one does not know: its number comes first.
        let Schema { schema } = serde_json::from_slice(&text).map_err(damaged)?;
        if schema > STATE_SCHEMA {
            return Err(self.refused(&StateError::Schema { found: schema }));
        }
        serde_json::from_slice(&text).map(Some).map_err(damaged)
    }

    /// The failure for a state that the session does not take. The file stays as it is.
    pub(super) fn refused(&self, error: &StateError) -> Failure {
        self.unusable(&error.to_string())
    }

    fn unusable(&self, reason: &str) -> Failure {
        Failure::new(format!(
            "the state file `{}` cannot be used: {reason}",
            self.path.display()
        ))
        .with_help("name another file, or remove this one to begin from a start of the control")
    }

    /// Replaces the state when the outputs take their place. Whenever the tool is killed, the old or
    /// the new file is there, whole.
    pub(super) fn save(&self, state: &SavedState, outputs: &mut Outputs) -> Result<(), Failure> {
        let mut text = serde_json::to_vec_pretty(state)
            .map_err(|error| Failure::writing(&self.path, &error.into()))?;
        text.push(b'\n');
        outputs.begin(&self.path)?.bytes(&text)
    }
}

fn suffixed(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    name.into()
}

#[cfg(test)]
mod tests {
    use super::super::console::{Color, Console};
    use super::super::ledger::Ledger;
    use super::*;

    fn state() -> SavedState {
        let machine = crate::machine::Machine::enabled(["X"]);
        crate::session::Session::new(machine, crate::session::SessionOptions::default()).save()
    }

    #[test]
    fn a_state_is_replaced_in_one_step() {
        // R9.31
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.json");
        let file = StateFile::lock(&path).unwrap();
        assert!(file.load().unwrap().is_none());
        let console = Console::new(Color::Never, None);
        let mut outputs = Outputs::new(&Ledger::default(), console);
        file.save(&state(), &mut outputs).unwrap();
        outputs.finish().unwrap();
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
    fn a_damaged_file_stays_as_it_is() {
        // R9.30
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.json");
        std::fs::write(&path, "{\"schema\":").unwrap();
        let failure = StateFile::lock(&path).unwrap().load().unwrap_err();
        assert!(failure.message.contains("damaged"), "{}", failure.message);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "{\"schema\":");
    }

    #[test]
    fn two_runs_are_kept_apart() {
        // R9.31
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.json");
        let first = StateFile::lock(&path).unwrap();
        let second = StateFile::lock_within(&path, Duration::from_millis(60));
        assert!(second.unwrap_err().message.contains("another run"));
        drop(first);
        assert!(StateFile::lock_within(&path, Duration::ZERO).is_ok());
    }
}
