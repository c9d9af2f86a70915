//! The verdict on a contour against limits (R11.24).

use super::obstacle::ContourObstacle;
use super::program::{ContourSink, ProgramContour};

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

impl ContourLimits {
    /// Returns whether there is a limit.
    pub fn any(&self) -> bool {
        self.deviation_um.is_some() || self.due_um.is_some()
    }

    /// Returns the verdict on a contour with these obstacles; `None` if it can be judged and there is no
    /// limit.
    pub fn verdict<S: ContourSink>(
        &self,
        contour: &ProgramContour<S>,
        obstacles: &[ContourObstacle],
    ) -> Option<ContourVerdict> {
        if !obstacles.is_empty() {
            return Some(ContourVerdict::NotJudged);
        }
        let is_above = |limit: Option<f64>, um: f64| limit.is_some_and(|limit| um > limit);
        let deviates = is_above(self.deviation_um, contour.deviations().programmed.max_um());
        let verdict = if deviates || is_above(self.due_um, contour.due().um) {
            ContourVerdict::Above
        } else {
            ContourVerdict::Within
        };
        self.any().then_some(verdict)
    }
}
