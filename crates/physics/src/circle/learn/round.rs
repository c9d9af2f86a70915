//! The recordings of an axis with one value list.

use thiserror::Error;

use crate::circle::figures::Waveform;
use crate::circle::geometry::Circle;
use crate::circle::geometry::Direction;
use crate::circle::geometry::PlaneAxis;
use crate::circle::recorded::RecordedCircle;
use crate::current::{AdditiveCurrent, Reading};
use frictcomp::lists::FrictionList;

/// One axis on one circle, recorded twice with the same list.
#[derive(Debug, Clone)]
pub struct LearnedCircle {
    /// The commanded circle.
    pub circle: Circle,
    /// The recordings.
    pub recorded: RecordedTwice,
}

/// The reversals of an axis in two recordings, in each direction of travel for itself (R16.12).
#[derive(Debug, Clone)]
pub struct RecordedTwice {
    /// The directions.
    directions: Vec<Direction>,
    /// Reversals at the largest and at the smallest position for each direction, each the mean of its turns.
    reversals: [Vec<Waveform>; 2],
    /// The standard deviation in µm of the noise of such a mean, which is one over 8 ms, too.
    noise_um: f64,
}

/// An axis in one round: a list, and the circles that were recorded with it.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct LearnedRound {
    /// The list.
    pub list: FrictionList,
    /// The circles, the slowest first.
    pub circles: Vec<LearnedCircle>,
}

/// A list that adds more than a multiple of the measured friction (R16.9).
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "at {speed_mm_per_s:.3} mm/s it adds {part:.2} times the measured friction; the limit is {most}"
)]
#[non_exhaustive]
pub struct TooMuchCurrent {
    /// The speed at which it adds most.
    pub speed_mm_per_s: f64,
    /// The current as a part of the friction.
    pub part: f64,
    /// The greatest part.
    pub most: f64,
}

impl TooMuchCurrent {
    /// Checks a list at its own points and at those of the measured friction, with a drive unit to spare: lists
    /// have whole numbers.
    ///
    /// # Errors
    /// The list adds more than `most` times the friction, or acts with it.
    pub fn check(list: &FrictionList, friction: &FrictionList, most: f64) -> Result<(), Self> {
        /// Tolerance for rounding, in units: a whole number is off by half a unit, and so is the friction.
        const ROUNDED: f64 = 1.0;
        let inputs = list.table.iter().chain(&friction.table).map(|it| it.input);
        let parts = inputs.filter_map(|input| {
            let [added, measured] = [list, friction].map(|it| output_at(it, input));
            let is_too_much = added > most * measured + ROUNDED || added < -ROUNDED;
            is_too_much.then_some((input, added / measured))
        });
        let strongest = parts.max_by(|one, other| one.1.abs().total_cmp(&other.1.abs()));
        match strongest {
            None => Ok(()),
            Some((input, part)) => Err(Self {
                speed_mm_per_s: input / 1000.0,
                part,
                most,
            }),
        }
    }
}

/// Returns the output of a list at a velocity in µm/s, scaled.
pub(super) fn output_at(list: &FrictionList, input: f64) -> f64 {
    AdditiveCurrent::new(list, Reading::default()).steady(input)
}

impl RecordedTwice {
    /// Returns the reversals of an axis in two recordings, each of them a circle in one direction or in each; `None` if
    /// a circle has no glitches.
    pub fn of(axis: PlaneAxis, recordings: [&[&RecordedCircle]; 2]) -> Option<Self> {
        let [first, second] = recordings.map(|circles| reversals(axis, circles));
        let [(first, of_first), (second, of_second)] = [first?, second?];
        Some(Self {
            directions: recordings[0].iter().map(|it| it.direction).collect(),
            reversals: [first, second],
            noise_um: of_first.max(of_second),
        })
    }

    /// Returns the direction of travel of each reversal.
    pub fn directions(&self) -> impl Iterator<Item = Direction> + '_ {
        self.directions.iter().flat_map(|it| [*it; 2])
    }

    /// Returns the height of each reversal in µm without its noise, with its standard error, in each recording: in each
    /// direction at the largest position and at the smallest.
    pub fn heights_um(&self) -> [Vec<(f64, f64)>; 2] {
        self.reversals.each_ref().map(|recording| {
            let heights = recording.iter().map(|it| it.without_noise(self.noise_um));
            heights.map(Option::unwrap_or_default).collect()
        })
    }

    /// Returns the mean of both recordings at each reversal.
    pub(super) fn mean(&self) -> Vec<Waveform> {
        let [first, second] = &self.reversals;
        let pairs = first.iter().zip(second);
        pairs
            .map(|(one, other)| Waveform::mean(&[one, other]))
            .collect()
    }
}

/// Returns the mean over all turns at both reversals of an axis in each direction, and the noise of such a mean in µm.
fn reversals(axis: PlaneAxis, circles: &[&RecordedCircle]) -> Option<(Vec<Waveform>, f64)> {
    let mut found = Vec::new();
    let mut noise_um = 0.0_f64;
    for circle in circles {
        let turns = circle.reversals_of(axis)?;
        #[allow(clippy::cast_precision_loss)] // a few turns
        let count = turns.len() as f64;
        noise_um = noise_um.max(circle.mean_noise_um() / count.sqrt());
        for at in [0, 1] {
            found.push(Waveform::mean(
                &turns.iter().map(|it| &it[at]).collect::<Vec<_>>(),
            ));
        }
    }
    (!found.is_empty()).then_some((found, noise_um))
}

impl LearnedCircle {
    /// Returns the largest height of all reversals in µm without noise, of the mean of both recordings.
    pub fn height_um(&self) -> f64 {
        let noise_um = self.recorded.noise_um / std::f64::consts::SQRT_2;
        let mean = self.recorded.mean().into_iter();
        let heights = mean.filter_map(|it| Some(it.without_noise(noise_um)?.0));
        heights.fold(0.0, f64::max)
    }
}

impl LearnedRound {
    /// Returns the largest glitch in µm over the circles.
    pub fn worst_um(&self) -> f64 {
        self.circles
            .iter()
            .map(LearnedCircle::height_um)
            .fold(0.0, f64::max)
    }

    /// Returns the spread in µm: the root mean square by which both recordings differ at a reversal.
    pub fn spread_um(&self) -> f64 {
        let mut squares = 0.0;
        let mut count = 0.0;
        for circle in &self.circles {
            let [first, second] = circle.recorded.heights_um();
            for (one, other) in first.iter().zip(second) {
                squares += (one.0 - other.0).powi(2);
                count += 1.0;
            }
        }
        f64::sqrt(squares / f64::max(count, 1.0))
    }
}
