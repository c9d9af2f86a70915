//! The contour of a program, once its session is over (R11.24).

use super::feed::FeedReached;
use super::figures::{ContourSummary, Deviations, Due};
use super::obstacle::ContourObstacle;
use super::options::ContourOptions;
use super::per_run::PerRun;
use super::reversals::{ContourReversal, GlitchFigure};
use crate::motion::{AssumedLimits, Transitions};
use frictcomp::diagnostic::Diagnostic;
use frictcomp::timeline::ReadingsInForce;

/// The contour of a program: its figures, the reversals of its axes, and what they rest on.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ContourReport {
    /// The axes, their drives and their lists.
    pub options: ContourOptions,
    /// The deviations of each run from the path.
    pub deviations: PerRun<Deviations>,
    /// The cost of missing compensation.
    pub due: Due,
    /// The programmed and the reached feed.
    pub feed: FeedReached,
    /// The share of the cutting time, from 0 to 1, that runs below 80 % of F because of assumed limits (R11.23): it
    /// would not if the moving axes had no limits other than those of the configuration.
    pub slow_share_by_assumed: f64,
    /// The assumed limits of the axes that the program moves.
    pub assumed_limits: Vec<AssumedLimits>,
    /// The treatment of the transitions between feed moves.
    pub transitions: Transitions,
    /// The obstacles to a verdict on the whole contour.
    pub obstacles: Vec<ContourObstacle>,
    /// The reversals of each axis, those of the plane first.
    pub axes: Vec<ContourSummary>,
    /// The machine time in s that was driven.
    pub machine_time_s: f64,
    /// The machine time in s in which positions were not those of the machine (R11.8).
    pub time_not_of_the_machine_s: f64,
    /// Whether a budget stopped a program, as an endless loop does (FC910): the rest is not known.
    pub is_cut_short: bool,
    /// Whether a drive was unstable; the contour ends there.
    pub is_unstable: bool,
    /// Number of motions left out because their target or their feed is not known.
    pub left_out: u64,
    /// The errors that the session reported.
    pub errors: Vec<Diagnostic>,
    /// The messages about the trace.
    pub remarks: Vec<Diagnostic>,
    /// The readings of open questions on which the contour rests (R15.3).
    pub rests_on: ReadingsInForce,
}

/// What the reversals of a contour show of compensation (R18.20).
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ContourCompensation<'a> {
    /// Axes that reverse without it while cutting.
    Missing {
        /// Those whose cost is measured, or all if none is.
        axes: Vec<&'a ContourSummary>,
        /// Whether the cost is measured.
        is_measured: bool,
    },
    /// The reversal with the largest glitch, where compensation makes it larger.
    Worsening(&'a ContourReversal),
    /// The reversal with the largest glitch, where every reversal that was driven is compensated.
    Complete(&'a ContourReversal),
    /// No axis reverses while cutting.
    NoReversal,
    /// No path was driven while cutting.
    NothingCut,
}

impl ContourReport {
    /// Returns what the reversals that were driven show of compensation.
    pub fn compensation(&self) -> ContourCompensation<'_> {
        let is_measured = |axis: &&ContourSummary| {
            let dearest = axis.dearest.as_ref();
            dearest.is_some_and(|it| it.figure == GlitchFigure::Measured)
        };
        let missing: Vec<_> = self
            .axes
            .iter()
            .filter(|axis| axis.uncompensated > 0)
            .collect();
        if !missing.is_empty() {
            let measured: Vec<_> = missing.iter().copied().filter(is_measured).collect();
            return ContourCompensation::Missing {
                is_measured: !measured.is_empty(),
                axes: if measured.is_empty() {
                    missing
                } else {
                    measured
                },
            };
        }
        let glitch = |it: &ContourReversal| it.glitch_um.programmed;
        let worst = self.axes.iter().filter_map(|axis| axis.worst.as_ref());
        let worst = worst.max_by(|one, other| glitch(one).total_cmp(&glitch(other)));
        match worst {
            Some(worst) if worst.glitch_um.all_on > worst.glitch_um.all_off => {
                ContourCompensation::Worsening(worst)
            }
            Some(worst) => ContourCompensation::Complete(worst),
            None if self.deviations.programmed.max_at().is_some() => {
                ContourCompensation::NoReversal
            }
            None => ContourCompensation::NothingCut,
        }
    }

    /// Returns whether every motion was driven, with positions of the machine: otherwise an axis may reverse more
    /// often.
    pub fn is_whole(&self) -> bool {
        let is_beside = |it: &ContourObstacle| {
            matches!(
                it,
                ContourObstacle::AssumedLimits(_)
                    | ContourObstacle::NothingCut
                    | ContourObstacle::UnknownState(..)
            )
        };
        self.left_out == 0 && self.obstacles.iter().all(is_beside)
    }

    /// Whether anything was driven.
    pub fn has_moved(&self) -> bool {
        self.machine_time_s > 0.0
    }

    /// The errors of the session, then the messages about the trace.
    pub fn diagnostics(&self) -> impl Iterator<Item = &Diagnostic> {
        self.errors.iter().chain(&self.remarks)
    }
}
