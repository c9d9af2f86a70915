//! The tails of slow peaks (R5.34): friction may hold an axis back far beyond its reversal, and what is left of
//! the peak then looks like an ellipse, a step or a screw.
//!
//! A tail is an exponential of the time since the reversal of its axis. Its decay is sought, its heights at
//! both ends of the axis are fitted together with the shapes.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::circle::geometry::CosineSine;
use crate::circle::geometry::Direction;
use crate::circle::geometry::PlaneAxis;

/// The decays of the tails of X and Y in s, if they have one.
pub(crate) type Decays = [Option<f64>; 2];

/// Tails of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Tails {
    decays: Decays,
    /// Heights at the reversals in µm, by axis at its largest and its smallest position.
    heights_um: [[f64; 2]; 2],
}

/// A place on a turn of known duration.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TailPlace {
    pub(crate) angle: CosineSine,
    pub(crate) direction: Direction,
    pub(crate) turn_s: f64,
}

impl Tails {
    pub(crate) fn new(decays: Decays, heights_um: [[f64; 2]; 2]) -> Self {
        Self { decays, heights_um }
    }

    /// Returns the deviation outwards in µm by the tail of an axis.
    pub(crate) fn of(&self, axis: PlaneAxis, place: TailPlace) -> f64 {
        let at = axis_number(axis);
        let columns = self.decays[at].map(|decay_s| columns(axis, decay_s, place));
        let parts = columns.unwrap_or_default().into_iter();
        let heights = self.heights_um[at].into_iter();
        parts.zip(heights).map(|(part, height)| part * height).sum()
    }

    /// Heights at the reversals of an axis in µm, at its largest and its smallest position.
    pub(crate) fn heights_um(&self, axis: PlaneAxis) -> [f64; 2] {
        self.heights_um[axis_number(axis)]
    }

    /// Returns the height of the largest tail in µm.
    pub(crate) fn tallest_um(&self) -> f64 {
        let heights = self.heights_um.iter().flatten();
        heights.fold(0.0, |most, it| most.max(it.abs()))
    }

    /// Returns the deviation outwards in µm by both tails.
    pub(crate) fn at(&self, place: TailPlace) -> f64 {
        PlaneAxis::ALL.map(|axis| self.of(axis, place)).iter().sum()
    }
}

/// Returns the index of an axis: X is the first one, Y the second.
pub(crate) fn axis_number(axis: PlaneAxis) -> usize {
    match axis {
        PlaneAxis::X => 0,
        PlaneAxis::Y => 1,
    }
}

/// Returns the effects of the tails of an axis with a height of 1 after its largest and after its smallest position.
pub(crate) fn columns(axis: PlaneAxis, decay_s: f64, place: TailPlace) -> [f64; 2] {
    let CosineSine { cos, sin } = place.angle;
    let from = match axis {
        PlaneAxis::X => 0.0,
        PlaneAxis::Y => FRAC_PI_2,
    };
    let way = place.direction.sign() * (sin.atan2(cos) - from);
    let since = way.rem_euclid(PI);
    let tail = (-since / (2.0 * PI) * place.turn_s / decay_s).exp() * since.cos();
    if way.rem_euclid(2.0 * PI) < PI {
        [tail, 0.0]
    } else {
        [0.0, tail]
    }
}
