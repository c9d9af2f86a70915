//! Repeated runs after each save: `check --watch`, `run --watch` (R17.5).

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver};
use std::time::Duration;

use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};

use super::console::Console;
use super::failure::{Failure, shown};
use frictcomp_host::{ChangedFile, Disk};

/// Pause between a save and a run: editors write a file in several steps.
const QUIET: Duration = Duration::from_millis(100);

/// The files that are watched for saves.
pub(crate) struct FileWatch {
    watcher: RecommendedWatcher,
    events: Receiver<notify::Result<Event>>,
    watched: BTreeSet<PathBuf>,
}

impl FileWatch {
    /// Creates a watch without files.
    pub(crate) fn new() -> Result<Self, Failure> {
        let (sender, events) = mpsc::channel();
        let watcher = notify::recommended_watcher(sender).map_err(|error| cannot(&error))?;
        Ok(Self {
            watcher,
            events,
            watched: BTreeSet::new(),
        })
    }

    /// Watches the folders of files, or folders with everything below them.
    pub(crate) fn watch<'a>(
        &mut self,
        paths: impl Iterator<Item = &'a Path>,
    ) -> Result<(), Failure> {
        for path in paths {
            let place = Disk::place(path);
            let folder = if place.is_dir() {
                place
            } else {
                place.parent().map_or(PathBuf::new(), Path::to_owned)
            };
            let is_known = self.watched.iter().any(|known| folder.starts_with(known));
            if is_known || !folder.is_dir() {
                continue;
            }
            let watched = self.watcher.watch(&folder, RecursiveMode::Recursive);
            watched.map_err(|error| cannot(&error))?;
            self.watched.insert(folder);
        }
        Ok(())
    }

    /// Waits until a relevant file is saved, and returns all that were saved until the activity stopped.
    pub(crate) fn next(
        &mut self,
        counts: impl Fn(&Path) -> bool,
    ) -> Result<Vec<ChangedFile>, Failure> {
        let mut saved = BTreeSet::new();
        loop {
            let event = if saved.is_empty() {
                self.events.recv().ok()
            } else {
                self.events.recv_timeout(QUIET).ok()
            };
            match event {
                Some(Ok(event)) if is_change(event.kind) => {
                    saved.extend(event.paths.into_iter().filter(|path| counts(path)));
                }
                Some(Ok(_)) => {}
                Some(Err(error)) => return Err(cannot(&error)),
                None if saved.is_empty() => {
                    return Err(Failure::new(
                        "the system no longer reports which files are saved",
                    ));
                }
                None => return Ok(saved.into_iter().map(ChangedFile::saved).collect()),
            }
        }
    }

    /// Reports what is watched.
    pub(crate) fn say(&self) {
        let folders: Vec<String> = self
            .watched
            .iter()
            .map(|path| shown(&Disk::named(path)))
            .collect();
        let folders = folders.join("`, `");
        Console::talk(&format!("watching `{folders}`; Ctrl-C ends"));
    }
}

/// Returns whether an event changes a file; reading does not.
fn is_change(kind: EventKind) -> bool {
    !matches!(kind, EventKind::Access(_))
}

fn cannot(error: &notify::Error) -> Failure {
    Failure::new(format!("the files cannot be watched: {error}"))
        .with_help("on Linux `fs.inotify.max_user_watches` limits the folders")
}
