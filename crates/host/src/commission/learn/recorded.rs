//! The recorded circles of all rounds.

use std::ops::ControlFlow;
use std::path::PathBuf;

use super::Learning;
use super::folder::LearningFolder;
use crate::commission::CommissionError;
use crate::disk::Disk;
use crate::error::HostError;
use crate::recordings::read_turns;
use crate::workers::{in_order, processors};
use frictcomp::text::shown_path;
use frictcomp_physics::circle::{Circle, LearnedRound, LearningProgress};
use frictcomp_recordings::commission::{LearnError, LearnedCircles, RecordedTurn};

/// The recorded rounds of X and of Y, and their improvement.
pub(super) struct Learned {
    pub(super) rounds: [Vec<LearnedRound>; 2],
    pub(super) progress: [LearningProgress; 2],
}

impl Learning<'_> {
    /// Reads the recordings of each round; the last one may have none yet.
    pub(super) fn learned(&self, folder: &LearningFolder) -> Result<Learned, HostError> {
        let cycle_time_s = self.cycle_s.unwrap_or(Circle::default().cycle_time_s);
        let mut rounds = [Vec::new(), Vec::new()];
        let mut first: Option<(RecordedTurn, LearnedCircles)> = None;
        for (at, recordings) in folder.recordings.iter().enumerate() {
            if recordings.is_empty() {
                break;
            }
            let in_round = |reason: LearnError| CommissionError::Learn {
                folder: folder.round(at),
                reason,
            };
            let paths = recordings.iter().map(|it| folder.round(at).join(&it.file));
            let turns = self.turns(&paths.collect::<Vec<_>>())?;
            let reference = first.as_ref().map(|it| &it.0).or(turns.first());
            let Some(reference) = reference.cloned() else {
                break;
            };
            let circles = LearnedCircles::of(&turns, &reference, cycle_time_s).map_err(in_round)?;
            if let Some((_, other)) = &first {
                circles.same_feeds(other).map_err(in_round)?;
            }
            for (axis, circles) in circles.clone().0.into_iter().enumerate() {
                let list = self.list(&folder.list(at, axis))?;
                rounds[axis].push(LearnedRound { list, circles });
            }
            first.get_or_insert((reference, circles));
        }
        let progress = rounds.each_ref().map(|it| LearningProgress::of(it));
        Ok(Learned { rounds, progress })
    }

    /// Returns all turns of recordings, in the order of the files.
    fn turns(&self, paths: &[PathBuf]) -> Result<Vec<RecordedTurn>, HostError> {
        let mut turns = Vec::new();
        let mut failed = None;
        let read = |path: &PathBuf| {
            (
                shown_path(path),
                read_turns(path, &self.channels, None, &Disk::default()),
            )
        };
        in_order(
            paths.iter(),
            processors(),
            read,
            |(file, found)| match found {
                Ok((found, assumed)) => {
                    turns.extend(found.into_iter().map(|circle| RecordedTurn {
                        file: file.clone(),
                        circle,
                        assumed: assumed.first().cloned(),
                    }));
                    ControlFlow::Continue(())
                }
                Err(error) => {
                    failed = Some(error);
                    ControlFlow::Break(())
                }
            },
        );
        failed.map_or(Ok(turns), Err)
    }
}
