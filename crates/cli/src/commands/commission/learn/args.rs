//! The arguments of `frictcomp commission learn`.

use std::path::PathBuf;

use clap::Args;

use crate::args::{
    CircleChannelArgs, CncBuildArgs, CurrentReadingArgs, CycleArgs, ModelArgs, PerAxis, ResultArgs,
};
use crate::output::HtmlArgs;
use frictcomp::lists::Points;
use frictcomp_physics::circle::{Learner, PlaneAxis, Ranges};
use frictcomp_physics::simulation::Plant;
use frictcomp_recordings::commission::MOST_CURRENT;
use frictcomp_report::learn::LearningFile;

/// Learn value lists from recorded circles, round by round
///
/// The folder holds `round-1`, `round-2` and so on, each with the lists `X.lis` and `Y.lis` and the circles that were
/// recorded with them: at least six feeds, each recorded twice. The recordings judge the lists; a
/// reference plant gives only the direction of the next step. Run it after each round: it judges the lists
/// and writes those of the next round. `learning.json` keeps the rounds with the SHA-256 of lists and recordings.
#[derive(Debug, Args)]
pub(crate) struct LearnArgs {
    /// The folder of the rounds
    #[arg(value_name = "FOLDER")]
    pub(super) folder: PathBuf,
    /// The drives that give the direction of a step: `stiff`, `mid`, `soft`, or a TOML file
    #[arg(long, value_name = "PLANT")]
    pub(super) plant: String,
    /// For the first round: the measured friction as `identify` or `commission run` wrote it, one list for both axes or `X=LIST` and
    /// `Y=LIST`; no list adds more than 1.3 times this
    #[arg(long, value_name = "LIST")]
    pub(super) friction: Vec<PerAxis>,
    /// The lists of the first round, for example from `tune`; by default those of `--friction`
    #[arg(long, value_name = "LIST", requires = "friction")]
    pub(super) value_list: Vec<PerAxis>,
    #[command(flatten)]
    pub(super) model: ModelArgs,
    #[command(flatten)]
    pub(super) cycle: CycleArgs,
    #[command(flatten)]
    pub(super) reading: CurrentReadingArgs,
    #[command(flatten)]
    pub(super) channels: CircleChannelArgs,
    #[command(flatten)]
    pub(super) build: CncBuildArgs,
    /// Write the best list so far of every axis, or of `X=FILE`, to this file
    #[arg(long, value_name = "FILE")]
    pub(super) write_list: Vec<PerAxis>,
    #[command(flatten)]
    pub(super) result: ResultArgs,
    #[command(flatten)]
    pub(super) html: HtmlArgs,
}

impl LearnArgs {
    /// Returns an axis of the plant, with the limits of its lists.
    pub(super) fn learner(&self, axis: PlaneAxis, plant: &Plant, file: &LearningFile) -> Learner {
        let (drive, friction) = match axis {
            PlaneAxis::X => (&plant.x, &file.friction[0]),
            _ => (&plant.y, &file.friction[1]),
        };
        Learner {
            axis,
            drive: drive.clone(),
            model: self.model.model(),
            reading: self.reading.reading,
            ranges: Ranges::default(),
            points: Points::of_build(self.build.cnc_build),
            friction: (friction.list.clone(), MOST_CURRENT),
        }
    }
}
