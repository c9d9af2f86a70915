//! The remaining glitch of a list over the whole range for which it was tuned, not only at the
//! circles of the search (R5.29).

use std::iter;

use serde::Serialize;

use super::reversal::{AxisAlone, phase_at};
use super::task::Task;
use crate::circle::geometry::PlaneAxis;
use crate::circle::geometry::{Circle, CircleError};
use crate::circle::simulated::Method;
use crate::simulation::DriveParameters;

/// Accelerations at which a result is checked.
pub(super) const CHECKED: usize = 25;

/// Accelerations that are searched are at most this factor apart.
const APART: f64 = 1.5;

/// Places of the reversal of an axis within its CNC cycle, 0 to 1. The glitch jumps where the reversal passes
/// from one cycle to the next, so that the largest one is at an end.
pub(super) const PLACES: [f64; 4] = [0.01, 0.34, 0.67, 0.99];

/// Difference of friction between the directions, as a share.
const UNEVEN: f64 = 0.1;

/// Deviation of the machine from the plant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Deviating {
    /// No deviation.
    Nothing,
    /// A contact half as stiff.
    HalfStiff,
    /// A contact twice as stiff.
    DoubleStiff,
    /// 10 % more friction forwards, 10 % less backwards.
    Forwards,
    /// The opposite.
    Backwards,
}

impl Deviating {
    pub(super) const ALL: [Self; 5] = [
        Self::Nothing,
        Self::HalfStiff,
        Self::DoubleStiff,
        Self::Forwards,
        Self::Backwards,
    ];

    /// Returns the drive that deviates from `drive` in this way.
    pub(super) fn of(self, drive: &DriveParameters) -> DriveParameters {
        match self {
            Self::Nothing => drive.clone(),
            Self::HalfStiff => drive.with_contact(0.5),
            Self::DoubleStiff => drive.with_contact(2.0),
            Self::Forwards => drive.uneven(UNEVEN),
            Self::Backwards => drive.uneven(-UNEVEN),
        }
    }
}

/// Remaining glitch of a list at one acceleration, in µm: the largest over the axes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct RemainingGlitch {
    /// The acceleration v²/R at the reversal in mm/s².
    #[serde(rename = "acceleration")]
    pub acceleration_mm_per_s2: f64,
    /// Glitch without compensation.
    #[serde(rename = "glitch_off")]
    pub glitch_off_um: f64,
    /// Glitch with compensation, at the worst of four places of the reversal within its CNC cycle.
    #[serde(rename = "glitch_on")]
    pub glitch_on_um: f64,
    /// Glitch with compensation, and a contact half as stiff.
    #[serde(rename = "glitch_stiffness_half")]
    pub glitch_half_stiff_um: f64,
    /// Glitch with compensation, and a contact twice as stiff.
    #[serde(rename = "glitch_stiffness_double")]
    pub glitch_double_stiff_um: f64,
    /// Glitch with compensation, and friction that differs by ±10 % between the directions.
    #[serde(rename = "glitch_uneven10")]
    pub glitch_uneven_um: f64,
}

impl RemainingGlitch {
    /// Returns whether compensation makes it worse, by more than the place of the reversal in its cycle does.
    pub fn is_worse(&self) -> bool {
        const PLACE: f64 = 1.02;
        self.glitch_on_um > PLACE * self.glitch_off_um
    }

    /// Returns the largest with compensation, on the plant and on those that deviate from it.
    pub(super) fn robust_um(&self) -> f64 {
        self.glitch_on_um
            .max(self.glitch_half_stiff_um)
            .max(self.glitch_double_stiff_um)
            .max(self.glitch_uneven_um)
    }

    /// Returns the larger values of both.
    pub(super) fn or(self, other: Self) -> Self {
        Self {
            acceleration_mm_per_s2: self.acceleration_mm_per_s2,
            glitch_off_um: self.glitch_off_um.max(other.glitch_off_um),
            glitch_on_um: self.glitch_on_um.max(other.glitch_on_um),
            glitch_half_stiff_um: self.glitch_half_stiff_um.max(other.glitch_half_stiff_um),
            glitch_double_stiff_um: self
                .glitch_double_stiff_um
                .max(other.glitch_double_stiff_um),
            glitch_uneven_um: self.glitch_uneven_um.max(other.glitch_uneven_um),
        }
    }
}

/// Reversals that are simulated for one row of the check.
#[derive(Debug, Clone, Copy)]
struct Trial {
    deviating: Deviating,
    place: f64,
    is_on: bool,
}

impl Trial {
    /// Returns the reversals of a row. A drive that is the same in both directions reverses alike in both.
    fn all() -> impl Iterator<Item = Self> {
        let of = |deviating, place, is_on| Self {
            deviating,
            place,
            is_on,
        };
        let on = Deviating::ALL
            .into_iter()
            .flat_map(move |deviating| PLACES.map(|place| of(deviating, place, true)));
        iter::once(of(Deviating::Nothing, PLACES[0], false)).chain(on)
    }
}

impl Task {
    /// Returns the circles of a search: those of the task, and others between them.
    pub(super) fn searched(&self) -> Vec<Circle> {
        let sorted = self.by_acceleration();
        let mut searched = self.circles.clone();
        for pair in sorted.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|it| it.acceleration_mm_per_s2());
            let parts = ((to / from).ln() / APART.ln()).ceil().max(1.0);
            let mut part = 1.0;
            while part < parts {
                let acceleration = from * (to / from).powf(part / parts);
                searched.push(pair[1].with_acceleration(acceleration));
                part += 1.0;
            }
        }
        searched
    }

    /// Returns the circles on which a result is checked.
    pub(super) fn checked(&self) -> Vec<Circle> {
        self.over_the_range(CHECKED)
    }

    /// Circles evenly over the range on a logarithmic scale; one if it has only one acceleration.
    pub(super) fn over_the_range(&self, count: usize) -> Vec<Circle> {
        let sorted = self.by_acceleration();
        let [Some(first), Some(last)] = [sorted.first(), sorted.last()] else {
            return Vec::new();
        };
        let [from, to] = [first, last].map(Circle::acceleration_mm_per_s2);
        if from >= to {
            return vec![*first];
        }
        let at = |number: usize| {
            #[allow(clippy::cast_precision_loss)] // a few dozen
            let part = number as f64 / (count - 1) as f64;
            let acceleration = from * (to / from).powf(part);
            let next = sorted.iter().find(|it| {
                it.acceleration_mm_per_s2() >= acceleration * (1.0 - f64::EPSILON.sqrt())
            });
            next.unwrap_or(last).with_acceleration(acceleration)
        };
        (0..count).map(at).collect()
    }

    fn by_acceleration(&self) -> Vec<Circle> {
        let mut sorted = self.circles.clone();
        let by = |circle: &Circle| circle.acceleration_mm_per_s2();
        sorted.sort_by(|one, other| by(one).total_cmp(&by(other)));
        sorted
    }

    /// Returns the number of reversals that [`check_reversal`](Self::check_reversal) distinguishes for one
    /// circle.
    pub(super) fn reversals_of_a_check() -> usize {
        Trial::all().count()
    }

    /// Returns the glitch at one of the reversals of a check, with the compensation of the axis.
    pub(super) fn check_reversal(
        &self,
        axis: PlaneAxis,
        (circle, number): (Circle, usize),
        compensation: Option<&Method>,
    ) -> Result<f64, CircleError> {
        let trial = Trial::all().nth(number).unwrap_or(Trial {
            deviating: Deviating::Nothing,
            place: PLACES[0],
            is_on: true,
        });
        let drive = trial.deviating.of(self.drive(axis));
        let alone = AxisAlone {
            axis,
            drive: &drive,
            model: self.model,
            reading: self.reading,
            phase: phase_at(trial.place, axis, &circle),
        };
        alone.glitch_um(circle, compensation.filter(|_| trial.is_on))
    }

    /// Returns the glitch at the reversal of an axis on a machine that deviates.
    pub(super) fn deviating_um(
        &self,
        axis: PlaneAxis,
        (circle, deviating): (Circle, Deviating),
        compensation: &Method,
    ) -> Result<f64, CircleError> {
        let alone = AxisAlone {
            axis,
            drive: &deviating.of(self.drive(axis)),
            model: self.model,
            reading: self.reading,
            phase: 0.0,
        };
        alone.glitch_um(circle, Some(compensation))
    }

    /// Returns the row of a circle from the glitches at its reversals, in their order.
    pub(super) fn row(circle: Circle, glitches: &[f64]) -> RemainingGlitch {
        let mut row = RemainingGlitch {
            acceleration_mm_per_s2: circle.acceleration_mm_per_s2(),
            ..RemainingGlitch::default()
        };
        for (trial, &glitch) in Trial::all().zip(glitches) {
            let value = match (trial.is_on, trial.deviating) {
                (false, _) => &mut row.glitch_off_um,
                (true, Deviating::Nothing) => &mut row.glitch_on_um,
                (true, Deviating::HalfStiff) => &mut row.glitch_half_stiff_um,
                (true, Deviating::DoubleStiff) => &mut row.glitch_double_stiff_um,
                (true, Deviating::Forwards | Deviating::Backwards) => &mut row.glitch_uneven_um,
            };
            *value = value.max(glitch);
        }
        row
    }
}
