//! The verdict on a contour against limits (R11.24).

use super::report::ContourReport;
use crate::motion::Cause;
use std::sync::Arc;

/// The limits of a contour.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContourLimits {
    /// The largest deviation as programmed, in µm.
    pub deviation_um: Option<f64>,
    /// Permitted cost of missing compensation, in µm.
    pub due_um: Option<f64>,
}

frictcomp::words! {
    /// Verdict on a contour.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[non_exhaustive]
    pub enum ContourVerdict {
        /// Contour that keeps the limits.
        Within = "within",
        /// Contour that exceeds a limit.
        Above = "above",
        /// Contour that is not known as a whole, or not as on the machine.
        NotJudged = "not judged",
    }
}

/// A figure of a contour that is above its limit.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ExceededLimit {
    /// The figure.
    pub figure: LimitedFigure,
    /// Value in µm.
    pub um: f64,
    /// Place of the value.
    pub at: Arc<Cause>,
    /// The limit in µm.
    pub limit_um: f64,
}

/// A figure of a contour that can have a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LimitedFigure {
    /// The largest deviation as programmed.
    Deviation,
    /// The cost of missing compensation.
    Due,
}

impl ContourLimits {
    /// Returns whether there is a limit.
    pub fn any(&self) -> bool {
        self.deviation_um.is_some() || self.due_um.is_some()
    }

    /// Returns the verdict on a contour; `None` if it can be judged and there is no limit.
    pub fn verdict(&self, contour: &ContourReport) -> Option<ContourVerdict> {
        if !contour.obstacles.is_empty() {
            return Some(ContourVerdict::NotJudged);
        }
        let verdict = if self.exceeded(contour).is_empty() {
            ContourVerdict::Within
        } else {
            ContourVerdict::Above
        };
        self.any().then_some(verdict)
    }

    /// Returns the figures of a contour that are above their limits, with their places.
    pub fn exceeded(&self, contour: &ContourReport) -> Vec<ExceededLimit> {
        let programmed = &contour.deviations.programmed;
        let due = &contour.due;
        let figures = [
            (
                LimitedFigure::Deviation,
                programmed.max_um(),
                programmed.max_at(),
                self.deviation_um,
            ),
            (LimitedFigure::Due, due.um, due.at.as_ref(), self.due_um),
        ];
        let exceeded = figures.into_iter().filter_map(|(figure, um, at, limit)| {
            let limit_um = limit.filter(|limit| um > *limit)?;
            Some(ExceededLimit {
                figure,
                um,
                at: at?.clone(),
                limit_um,
            })
        });
        exceeded.collect()
    }
}
