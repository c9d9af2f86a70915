//! The figures of a contour.

use std::sync::Arc;

use super::reversals::ContourReversal;
use crate::motion::{Cause, Movement};
use frictcomp::comp::State;

/// Deviations of a run from the path while it was cutting (R11.3).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Deviations {
    /// The outermost deviation in µm: `F_max` on a circle; negative if the whole path is inside.
    pub outermost_um: f64,
    /// The innermost deviation in µm: `F_min` on a circle; positive if the whole path is outside.
    pub innermost_um: f64,
    /// The block with the outermost deviation.
    pub outermost_at: Option<Arc<Cause>>,
    /// The block with the innermost deviation.
    pub innermost_at: Option<Arc<Cause>>,
    /// The largest distance from the path in space, in µm.
    largest_um: f64,
    largest_at: Option<Arc<Cause>>,
    squares: f64,
    cycles: f64,
}

impl Deviations {
    /// Takes the deviation in the plane, and that in space.
    pub(super) fn push(&mut self, [deviation_um, space_um]: [f64; 2], cause: &Arc<Cause>) {
        let is_first = self.cycles == 0.0;
        if is_first || space_um > self.largest_um {
            self.largest_um = space_um;
            self.largest_at = Some(Arc::clone(cause));
        }
        if is_first || deviation_um > self.outermost_um {
            self.outermost_um = deviation_um;
            self.outermost_at = Some(Arc::clone(cause));
        }
        if is_first || deviation_um < self.innermost_um {
            self.innermost_um = deviation_um;
            self.innermost_at = Some(Arc::clone(cause));
        }
        self.squares += space_um * space_um;
        self.cycles += 1.0;
    }

    /// Returns the largest deviation in space, in µm (R11.27).
    pub fn max_um(&self) -> f64 {
        self.largest_um
    }

    /// Returns the block with the largest deviation.
    pub fn max_at(&self) -> Option<&Arc<Cause>> {
        self.largest_at.as_ref()
    }

    /// Returns the root of the mean square in µm.
    pub fn rms_um(&self) -> f64 {
        if self.cycles > 0.0 {
            (self.squares / self.cycles).sqrt()
        } else {
            0.0
        }
    }
}

/// Cost of missing compensation (R11.24): the largest additional deviation of the path as
/// programmed compared with the one with all of it on.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Due {
    /// The difference in µm, 0 if nothing is missing.
    pub um: f64,
    /// The block that drives there.
    pub at: Option<Arc<Cause>>,
}

impl Due {
    /// Takes the distances of the axes from a place of the path as programmed, and with all of it on.
    pub(super) fn push(&mut self, [programmed, all_on]: [f64; 2], cause: &Arc<Cause>) {
        let um = programmed.abs() - all_on.abs();
        if um > self.um {
            self.um = um;
            self.at = Some(Arc::clone(cause));
        }
    }
}

/// The reversals of an axis, counted (R11.4).
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct ContourSummary {
    /// Name of the axis.
    pub axis: String,
    /// Reversals in feed moves.
    pub cutting: u64,
    /// Reversals in rapid moves.
    pub rapid: u64,
    /// Reversals in feed moves without a figure: too near to a stop, a corner or the next one (R11.26).
    pub unmeasured: u64,
    /// Reversals in feed moves without active compensation.
    pub uncompensated: u64,
    /// The one of them at which compensation would gain the most.
    pub dearest: Option<ContourReversal>,
    /// The reversal in a feed move with the largest glitch.
    pub worst: Option<ContourReversal>,
}

impl ContourSummary {
    pub(super) fn push(&mut self, reversal: &ContourReversal) {
        if reversal.movement == Movement::Rapid {
            self.rapid += 1;
            return;
        }
        self.cutting += 1;
        self.unmeasured += u64::from(!reversal.has_figure());
        let is_more = |known: &Option<ContourReversal>, of: fn(&ContourReversal) -> f64| {
            let is_more = |known: &ContourReversal| of(reversal) > of(known);
            reversal.has_figure() && known.as_ref().is_none_or(is_more)
        };
        if reversal.state != State::Active {
            self.uncompensated += 1;
            if is_more(&self.dearest, ContourReversal::gain_um) {
                self.dearest = Some(reversal.clone());
            }
        }
        if is_more(&self.worst, |it| it.glitch_um.programmed) {
            self.worst = Some(reversal.clone());
        }
    }
}
