//! Learning: from recorded circles with a list to the next list (R16.4).

mod folder;
mod recorded;

use std::path::Path;

use super::error::CommissionError;
use crate::disk::{Disk, FileRegistry, Replaces, read_text};
use crate::error::HostError;
use crate::machines::{find_plant, read_value_list};
use crate::outputs::OutputFiles;
use crate::simulations::learn;
use crate::watch::Watch;
use crate::workers::memory_for_simulation;
use folder::LearningFolder;
use frictcomp::comp::CncBuild;
use frictcomp::lists::{FrictionList, Points};
use frictcomp::text::shown_path;
use frictcomp_physics::circle::{Learner, LearningProgress, PlaneAxis, Ranges};
use frictcomp_physics::current::Reading;
use frictcomp_physics::simulation::{FrictionModel, Plant};
use frictcomp_recordings::commission::{
    LearnReport, LearnedAxis, LearningFile, MOST_CURRENT, NextStep, Prediction,
};
use frictcomp_recordings::trace::ChannelSelection;
use frictcomp_recordings::value_lists::{LearnedFrom, render_learned};
use recorded::Learned;

/// A folder of rounds in which lists are learned, and how its recordings are read.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Learning<'a> {
    /// The folder.
    pub folder: &'a Path,
    /// The lists with which it begins; without them it has begun.
    pub first: Option<FirstLists<'a>>,
    /// The plant that gives the direction of a step, a preset or a file.
    pub plant: &'a str,
    /// The friction model of the simulation.
    pub model: FrictionModel,
    /// The reading of the documents of the current.
    pub reading: Reading,
    /// The channels of the circles.
    pub channels: [ChannelSelection; 2],
    /// The CNC cycle in s, if it is known.
    pub cycle_s: Option<f64>,
    /// The build for which lists are written, if it is known.
    pub build: Option<CncBuild>,
    /// The files that are read.
    pub registry: &'a FileRegistry,
}

/// The lists with which learning begins, of X and of Y.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct FirstLists<'a> {
    /// The measured friction, which bounds all lists.
    pub friction: [&'a Path; 2],
    /// The lists of the first round; by default those of the friction.
    pub lists: Option<[&'a Path; 2]>,
}

impl Learning<'_> {
    /// Judges the recorded rounds, and writes the lists of the next one if the last one is recorded and a gain is
    /// possible. The best lists go to the files in `best`, where one is given.
    ///
    /// # Errors
    /// The folder is not one of learning, a recording cannot be used, or a file cannot be written.
    pub fn step(
        &self,
        best: [Option<&Path>; 2],
        outputs: &mut OutputFiles,
        watch: &Watch,
    ) -> Result<LearnReport, HostError> {
        memory_for_simulation()?;
        let plant = find_plant(self.plant, self.registry)?;
        let opened = LearningFolder::open(self.folder, self.registry)?;
        let is_new = opened.is_none();
        let mut folder = match opened {
            Some(folder) if self.first.is_none() => folder,
            Some(_) => return Err(CommissionError::Begun(self.folder.to_owned()).into()),
            None => self.begin(outputs)?,
        };
        let learned = self.learned(&folder)?;
        let is_recorded = learned.rounds[0].len() == folder.file.rounds.len();
        let is_over = is_recorded && learned.progress.iter().all(LearningProgress::is_over);
        if is_recorded {
            folder.keep_recordings();
        }
        if is_recorded && !is_over {
            self.next_round((&mut folder, &learned), &plant, (outputs, watch))?;
        }
        if is_recorded || is_new {
            folder.write(outputs)?;
        }
        write_best(best, (&folder, &learned), outputs)?;
        Ok(report(plant, &folder, &learned, is_over))
    }

    /// Writes the lists of the next round: a step from the best one, or the best one itself for an axis that is done.
    fn next_round(
        &self,
        (folder, learned): (&mut LearningFolder, &Learned),
        plant: &Plant,
        (outputs, watch): (&mut OutputFiles, &Watch),
    ) -> Result<(), HostError> {
        let mut texts = [String::new(), String::new()];
        let mut predictions = [None; 2];
        for (at, axis) in PlaneAxis::ALL.into_iter().enumerate() {
            let (rounds, progress) = (&learned.rounds[at], &learned.progress[at]);
            let of_axis = self.learner(axis, plant, &folder.file);
            let proposal = if progress.is_over() {
                None
            } else {
                learn(&of_axis, rounds, watch).map_err(CommissionError::from)?
            };
            let Some(proposal) = proposal else {
                texts[at] = read_text(&folder.list(progress.best, at))?;
                continue;
            };
            let from = LearnedFrom {
                axis: axis.as_str(),
                round: rounds.len() + 1,
                plant: &plant.name,
                predicted_um: proposal.predicted_um,
            };
            texts[at] = render_learned(&proposal.list, from, self.build);
            predictions[at] = Some(Prediction::of(proposal.predicted_um, proposal.contact));
        }
        folder.add_round(&texts, predictions, outputs)
    }

    /// Returns an axis of the plant, with the limits of its lists.
    fn learner(&self, axis: PlaneAxis, plant: &Plant, file: &LearningFile) -> Learner {
        let (drive, friction) = match axis {
            PlaneAxis::X => (&plant.x, &file.friction[0]),
            _ => (&plant.y, &file.friction[1]),
        };
        Learner {
            axis,
            drive: drive.clone(),
            model: self.model,
            reading: self.reading,
            ranges: Ranges::default(),
            points: Points::of_build(self.build),
            friction: (friction.list.clone(), MOST_CURRENT),
        }
    }

    /// Returns the values of a list.
    fn list(&self, path: &Path) -> Result<FrictionList, HostError> {
        Ok(read_value_list(path, self.registry, &Disk::default())?.list)
    }
}

/// Writes the best list of each axis for which a file is given.
fn write_best(
    best: [Option<&Path>; 2],
    (folder, learned): (&LearningFolder, &Learned),
    outputs: &mut OutputFiles,
) -> Result<(), HostError> {
    for (at, progress) in learned.progress.iter().enumerate() {
        let Some(path) = best[at] else {
            continue;
        };
        if progress.verdicts.is_empty() {
            return Err(CommissionError::NoBestList.into());
        }
        let text = read_text(&folder.list(progress.best, at))?;
        let mut file = outputs.create("the best list", path, Replaces::Lists)?;
        file.bytes(text.as_bytes())?;
    }
    Ok(())
}

/// Returns the result of a call.
fn report(plant: Plant, folder: &LearningFolder, learned: &Learned, is_over: bool) -> LearnReport {
    let circles = learned.rounds[0].first().map(|it| it.circles.iter());
    let feeds = circles.into_iter().flatten();
    let axes = [0, 1].map(|at: usize| {
        let progress = &learned.progress[at];
        let best = (!progress.verdicts.is_empty()).then_some(progress.best);
        LearnedAxis {
            axis: PlaneAxis::ALL[at].as_str(),
            rounds: progress.verdicts.clone(),
            best_round: best.map(|it| it + 1),
            list: best.map(|it| shown_path(&folder.list(it, at))),
            is_over: progress.is_over(),
        }
    });
    let last = folder.file.rounds.len() - 1;
    LearnReport {
        plant,
        feeds: feeds.map(|it| it.circle.feed_mm_per_min).collect(),
        axes,
        predictions: folder.file.rounds.iter().map(|it| it.predictions).collect(),
        next: if is_over {
            NextStep::Done
        } else {
            NextStep::Record {
                folder: shown_path(&folder.round(last)),
                lists: [0, 1].map(|at| shown_path(&folder.list(last, at))),
            }
        },
    }
}
