//! The folder of `commission learn`: its beginning, rounds with lists and recordings, and the file that records them.

use std::path::{Path, PathBuf};

use super::Learning;
use crate::commission::CommissionError;
use crate::disk::{FileRegistry, Replaces, read_text, sha256_of, sha256_of_text};
use crate::error::HostError;
use crate::outputs::OutputFiles;
use crate::recordings::recordings_in;
use frictcomp::text::shown_path;
use frictcomp_physics::circle::{PlaneAxis, TooMuchCurrent};
use frictcomp_recordings::commission::{
    LearningFile, LearningRound, MOST_CURRENT, MeasuredFriction, Prediction, RecordedFile,
    ValueListUsed,
};

/// The file that records the rounds.
const FILE: &str = "learning.json";

/// The files of the lists within a round.
const LISTS: [&str; 2] = ["X.lis", "Y.lis"];

/// The axes of the lists.
const AXES: [&str; 2] = ["X", "Y"];

/// A folder of rounds.
#[derive(Debug)]
pub(super) struct LearningFolder {
    path: PathBuf,
    pub(super) file: LearningFile,
    /// The existing recordings of each round.
    pub(super) recordings: Vec<Vec<RecordedFile>>,
}

impl LearningFolder {
    /// Creates a folder without rounds.
    pub(super) fn new(path: &Path, friction: [MeasuredFriction; 2]) -> Self {
        Self {
            path: path.to_owned(),
            file: LearningFile {
                schema: LearningFile::SCHEMA,
                friction,
                rounds: Vec::new(),
            },
            recordings: Vec::new(),
        }
    }

    /// Opens the folder as it was left; `None` if it was not begun. Every file must still be the one from which later
    /// rounds were made.
    pub(super) fn open(path: &Path, registry: &FileRegistry) -> Result<Option<Self>, HostError> {
        let json = path.join(FILE);
        if !json.exists() {
            return Ok(None);
        }
        let read: Result<LearningFile, _> = serde_json::from_str(&read_text(&json)?);
        let known = |it: &LearningFile| it.schema == LearningFile::SCHEMA && !it.rounds.is_empty();
        let Some(file) = read.ok().filter(known) else {
            return Err(CommissionError::NotLearning(json).into());
        };
        let mut folder = Self {
            path: path.to_owned(),
            file,
            recordings: Vec::new(),
        };
        folder.forget_removed();
        for at in 0..folder.file.rounds.len() {
            folder.check_lists(at)?;
            let recordings = folder.recorded(at, registry)?;
            folder.check_recordings(at, &recordings)?;
            folder.recordings.push(recordings);
        }
        folder.check_copies()?;
        Ok(Some(folder))
    }

    /// Writes the file that records the rounds.
    pub(super) fn write(&self, outputs: &mut OutputFiles) -> Result<(), HostError> {
        let path = self.path.join(FILE);
        outputs
            .create(FILE, &path, Replaces::Results)?
            .json(&self.file)
    }

    /// Returns the folder of a round, by its index.
    pub(super) fn round(&self, at: usize) -> PathBuf {
        self.path.join(format!("round-{}", at + 1))
    }

    /// Returns the list of an axis in a round.
    pub(super) fn list(&self, at: usize, axis: usize) -> PathBuf {
        self.round(at).join(LISTS[axis])
    }

    /// Notes from which recordings of the last round the next one was made.
    pub(super) fn keep_recordings(&mut self) {
        if let (Some(round), Some(there)) = (self.file.rounds.last_mut(), self.recordings.last()) {
            round.recordings.clone_from(there);
        }
    }

    /// Adds a round with the texts of its lists, which do not replace any file.
    pub(super) fn add_round(
        &mut self,
        texts: &[String; 2],
        predictions: [Option<Prediction>; 2],
        outputs: &mut OutputFiles,
    ) -> Result<(), HostError> {
        let at = self.file.rounds.len();
        for (axis, text) in texts.iter().enumerate() {
            let path = self.list(at, axis);
            if path.exists() && read_text(&path)? != *text {
                return Err(CommissionError::ListThere(path).into());
            }
            let mut file = outputs.create_in_folder("the list", &path, Replaces::Lists)?;
            file.bytes(text.as_bytes())?;
        }
        self.file.rounds.push(LearningRound {
            lists: [0, 1].map(|axis: usize| ValueListUsed {
                axis: AXES[axis].to_owned(),
                file: LISTS[axis].to_owned(),
                sha256: sha256_of_text(&texts[axis]),
            }),
            predictions,
            recordings: Vec::new(),
        });
        Ok(())
    }

    /// Forgets the rounds from the first one whose folder was removed, and their recordings: the user wants them
    /// made again.
    fn forget_removed(&mut self) {
        let removed = (1..self.file.rounds.len()).find(|&at| !self.round(at).exists());
        if let Some(first) = removed {
            self.file.rounds.truncate(first);
            if let Some(last) = self.file.rounds.last_mut() {
                last.recordings.clear();
            }
        }
    }

    fn check_lists(&self, at: usize) -> Result<(), HostError> {
        for (axis, used) in self.file.rounds[at].lists.iter().enumerate() {
            let path = self.list(at, axis);
            if !path.exists() || sha256_of(&path)? != used.sha256 {
                let sha256 = used.sha256.clone();
                return Err(CommissionError::OtherList { path, sha256 }.into());
            }
        }
        Ok(())
    }

    /// Returns the recordings in the folder of a round.
    fn recorded(&self, at: usize, registry: &FileRegistry) -> Result<Vec<RecordedFile>, HostError> {
        let mut found = Vec::new();
        for path in recordings_in(&self.round(at))? {
            registry.reads("recording", &path);
            let name = path.file_name().map(|it| it.to_string_lossy().into_owned());
            found.push(RecordedFile {
                file: name.unwrap_or_default(),
                sha256: sha256_of(&path)?,
            });
        }
        Ok(found)
    }

    /// Refuses recordings that differ from those from which the next round was made (R16.9).
    fn check_recordings(&self, at: usize, there: &[RecordedFile]) -> Result<(), HostError> {
        let kept = &self.file.rounds[at].recordings;
        if kept.is_empty() || kept == there {
            return Ok(());
        }
        let other = |of: &[RecordedFile], than: &[RecordedFile]| {
            let found = of.iter().find(|it| !than.contains(it));
            found.map(|it| self.round(at).join(&it.file))
        };
        let changed = other(kept, there).or_else(|| other(there, kept));
        Err(CommissionError::ChangedRecording {
            path: changed.unwrap_or_default(),
            round: at + 2,
        }
        .into())
    }

    /// Refuses a recording that occurs twice: as two recordings of one list it would show no spread.
    fn check_copies(&self) -> Result<(), HostError> {
        let mut seen: Vec<(&RecordedFile, PathBuf)> = Vec::new();
        for (at, recordings) in self.recordings.iter().enumerate() {
            for recording in recordings {
                let path = self.round(at).join(&recording.file);
                let same = seen.iter().find(|(it, _)| it.sha256 == recording.sha256);
                if let Some((_, first)) = same {
                    let of = first.clone();
                    return Err(CommissionError::RecordedTwice { path, of }.into());
                }
                seen.push((recording, path));
            }
        }
        Ok(())
    }
}

impl Learning<'_> {
    /// Begins in the folder: copies the lists of the first round into it, each within the limit set by the friction.
    pub(super) fn begin(&self, outputs: &mut OutputFiles) -> Result<LearningFolder, HostError> {
        let Some(first) = &self.first else {
            return Err(CommissionError::NotBegun(self.folder.to_owned()).into());
        };
        let [x, y] = first.friction;
        let friction = [
            self.measured(PlaneAxis::X, x)?,
            self.measured(PlaneAxis::Y, y)?,
        ];
        let lists = first.lists.unwrap_or(first.friction);
        for (path, friction) in lists.into_iter().zip(&friction) {
            let list = self.list(path)?;
            TooMuchCurrent::check(&list, &friction.list, MOST_CURRENT).map_err(|reason| {
                let path = path.to_owned();
                CommissionError::FirstList { path, reason }
            })?;
        }
        let [x, y] = lists;
        let mut folder = LearningFolder::new(self.folder, friction);
        folder.add_round(&[read_text(x)?, read_text(y)?], [None; 2], outputs)?;
        Ok(folder)
    }

    /// Returns the measured friction of an axis.
    fn measured(&self, axis: PlaneAxis, path: &Path) -> Result<MeasuredFriction, HostError> {
        let list = self.list(path)?;
        let is_positive = list.table.iter().all(|it| it.output > 0.0) && list.scaling_factor > 0;
        if list.table.is_empty() || !is_positive {
            return Err(CommissionError::NotFriction(path.to_owned()).into());
        }
        Ok(MeasuredFriction {
            from: ValueListUsed {
                axis: axis.as_str().to_owned(),
                file: shown_path(path),
                sha256: sha256_of(path)?,
            },
            list,
        })
    }
}
