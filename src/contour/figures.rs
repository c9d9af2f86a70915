//! The figures of a contour.

use super::reversals::ContourReversal;
use crate::comp::State;
use crate::motion::Movement;

/// How far a run was from the path while it was cutting (R11.3).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deviations {
    /// The outermost deviation in µm: `F_max` on a circle; negative where the whole path is inside.
    pub outermost_um: f64,
    /// The innermost deviation in µm: `F_min` on a circle; positive where the whole path is outside.
    pub innermost_um: f64,
    squares: f64,
    cycles: f64,
}

impl Deviations {
    pub(super) fn push(&mut self, deviation_um: f64) {
        let is_first = self.cycles == 0.0;
        if is_first || deviation_um > self.outermost_um {
            self.outermost_um = deviation_um;
        }
        if is_first || deviation_um < self.innermost_um {
            self.innermost_um = deviation_um;
        }
        self.squares += deviation_um * deviation_um;
        self.cycles += 1.0;
    }

    /// The largest deviation to either side in µm.
    pub fn max_um(&self) -> f64 {
        self.outermost_um.abs().max(self.innermost_um.abs())
    }

    /// The root of the mean square in µm.
    pub fn rms_um(&self) -> f64 {
        if self.cycles > 0.0 {
            (self.squares / self.cycles).sqrt()
        } else {
            0.0
        }
    }
}

/// The worst reversal of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Worst {
    /// The reversal.
    pub reversal: ContourReversal,
}

/// The reversals of an axis, counted (R11.4).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ContourSummary {
    /// The axis.
    pub axis: String,
    /// Reversals in feed moves.
    pub cutting: u64,
    /// Reversals in rapid moves.
    pub rapid: u64,
    /// Reversals in feed moves without active compensation.
    pub uncompensated: u64,
    /// The glitch in µm of the one of those at which compensation would gain the most.
    pub uncompensated_um: f64,
    /// The glitch that the same reversal has with compensation, in µm.
    pub compensated_um: f64,
    /// The reversal in a feed move with the largest glitch.
    pub worst: Option<Worst>,
}

impl ContourSummary {
    pub(super) fn push(&mut self, reversal: &ContourReversal) {
        if reversal.movement == Movement::Rapid {
            self.rapid += 1;
            return;
        }
        self.cutting += 1;
        let glitch = reversal.glitch_um;
        if reversal.state != State::Active {
            self.uncompensated += 1;
            let gain = glitch.programmed - glitch.all_on;
            let known = self.uncompensated_um - self.compensated_um;
            if self.uncompensated == 1 || gain > known {
                self.uncompensated_um = glitch.programmed;
                self.compensated_um = glitch.all_on;
            }
        }
        let worst = self.worst.as_ref();
        let worst = worst.map(|worst| worst.reversal.glitch_um.programmed);
        if worst.is_none_or(|worst| glitch.programmed > worst) {
            self.worst = Some(Worst {
                reversal: reversal.clone(),
            });
        }
    }
}
