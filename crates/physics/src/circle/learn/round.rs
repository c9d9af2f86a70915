//! The recordings of an axis with one value list.

use thiserror::Error;

use crate::circle::crossing::PlaneAxis;
use crate::circle::recorded::RecordedCircle;
use crate::circle::reference::Circle;
use crate::circle::waveform::Waveform;
use crate::current::{AdditiveCurrent, Reading};
use frictcomp::lists::FrictionList;

/// Both reversals of an axis on a circle: at its largest and at its smallest position.
type OppositeReversals = [Waveform; 2];

/// One axis on one circle, recorded twice with the same list.
#[derive(Debug, Clone)]
pub struct LearnedCircle {
    /// The commanded circle.
    pub circle: Circle,
    /// The recordings.
    pub recorded: RecordedTwice,
}

/// The reversals of an axis in two recordings, each the mean over the directions of travel.
#[derive(Debug, Clone)]
pub struct RecordedTwice([OppositeReversals; 2]);

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
        /// A whole number is off by half a unit, and so is the friction.
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

/// The output of a list at a velocity in µm/s, scaled.
pub(super) fn output_at(list: &FrictionList, input: f64) -> f64 {
    AdditiveCurrent::new(list, Reading::default()).steady(input)
}

impl RecordedTwice {
    /// The reversals of an axis in two recordings, each of them a turn in one direction or in each; `None` if
    /// a circle has no glitches.
    pub fn of(axis: PlaneAxis, recordings: [&[&RecordedCircle]; 2]) -> Option<Self> {
        let [first, second] = recordings.map(|turns| reversals(axis, turns));
        Some(Self([first?, second?]))
    }

    /// The heights of both reversals in µm in each recording.
    pub fn heights_um(&self) -> [[f64; 2]; 2] {
        self.0
            .each_ref()
            .map(|recording| recording.each_ref().map(Waveform::height_um))
    }

    /// The mean of both recordings at each reversal.
    pub(super) fn mean(&self) -> OppositeReversals {
        let [first, second] = &self.0;
        [0, 1].map(|at: usize| Waveform::mean(&[&first[at], &second[at]]))
    }
}

/// The mean over all turns at both reversals of an axis.
fn reversals(axis: PlaneAxis, turns: &[&RecordedCircle]) -> Option<OppositeReversals> {
    let mut found: [Vec<Waveform>; 2] = [Vec::new(), Vec::new()];
    for turn in turns {
        for reversals in turn.reversals_of(axis)? {
            for (waveforms, of_turn) in found.iter_mut().zip(reversals) {
                waveforms.push(of_turn);
            }
        }
    }
    let mean = |waveforms: &Vec<Waveform>| Waveform::mean(&waveforms.iter().collect::<Vec<_>>());
    (!turns.is_empty()).then(|| found.each_ref().map(mean))
}

impl LearnedCircle {
    /// The larger height of both reversals in µm, of the mean of both recordings.
    pub fn height_um(&self) -> f64 {
        let [first, second] = self.recorded.mean();
        first.height_um().max(second.height_um())
    }
}

impl LearnedRound {
    /// The largest glitch in µm over the circles.
    pub fn worst_um(&self) -> f64 {
        self.circles
            .iter()
            .map(LearnedCircle::height_um)
            .fold(0.0, f64::max)
    }

    /// The spread in µm: the root mean square by which both recordings differ at a reversal.
    pub fn spread_um(&self) -> f64 {
        let mut squares = 0.0;
        let mut count = 0.0;
        for circle in &self.circles {
            let [first, second] = circle.recorded.heights_um();
            for (one, other) in first.iter().zip(second) {
                squares += (one - other).powi(2);
                count += 1.0;
            }
        }
        f64::sqrt(squares / f64::max(count, 1.0))
    }
}
