//! Places where the axis moves harder than elsewhere, in both directions (R6.21).

use std::collections::BTreeMap;

use super::segment::Segment;
use super::statistics::{count, median, samples_in};
use super::track::AxisSamples;

/// Parts of the travel.
const PARTS: f64 = 20.0;

/// Seconds over which residuals are averaged.
const BLOCK_S: f64 = 0.01;

/// Minimum number of blocks in each direction for a place.
const FEWEST: f64 = 8.0;

/// Number of standard errors that is significant.
const SIGNIFICANT: f64 = 5.0;

/// Part of the friction from which a place is reported.
const PART: f64 = 0.05;

/// A place where the axis moves harder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TightSpot {
    /// Ends in mm or degrees.
    pub(super) from: f64,
    pub(super) to: f64,
    /// Least additional torque, in drive units.
    pub(super) more: f64,
}

/// Residuals of a place in one direction.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Sums {
    fn add(&mut self, value: f64) {
        self.count += 1.0;
        self.sum += value;
        self.squares += value * value;
    }

    /// Returns the mean if it is significant.
    fn significant(&self) -> Option<f64> {
        let mean = self.sum / self.count;
        let spread = (self.squares / self.count - mean * mean).max(0.0);
        // Neighbouring blocks may be alike: four of them count as one.
        let error = (4.0 * spread / self.count).sqrt();
        (self.count >= FEWEST && mean > SIGNIFICANT * error).then_some(mean)
    }
}

/// Returns the tightest place of the travel, against a friction of `level` with its sign.
pub(super) fn tight_spot(
    samples: &AxisSamples,
    segments: &[Segment],
    level: f64,
) -> Option<TightSpot> {
    let places = segments
        .iter()
        .flat_map(|it| [it.samples.start, it.samples.end - 1])
        .map(|at| samples.positions[at]);
    let [low, high] = places.fold([f64::MAX, f64::MIN], |[low, high], at| {
        [low.min(at), high.max(at)]
    });
    let width = (high - low) / PARTS;
    if width.is_nan() || width <= 0.0 {
        return None;
    }
    let mut parts: BTreeMap<u8, [Sums; 2]> = BTreeMap::new();
    let block = samples_in(BLOCK_S, samples.step_s);
    for segment in segments {
        let torques = &samples.torques[segment.samples.clone()];
        let usual = median(torques)?;
        let direction = usize::from(segment.velocity < 0.0);
        let positions = samples.positions[segment.samples.clone()].chunks(block);
        for (places, torques) in positions.zip(torques.chunks(block)) {
            let mean = torques.iter().sum::<f64>() / count(torques.len());
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 to 20
            let part = ((places[0] - low) / width).clamp(0.0, PARTS - 1.0) as u8;
            parts.entry(part).or_default()[direction]
                .add((mean - usual) * (segment.velocity * level).signum());
        }
    }
    let spot = |(part, [forth, back]): (u8, [Sums; 2])| {
        let more = forth.significant()?.min(back.significant()?);
        let from = low + f64::from(part) * width;
        (more > PART * level.abs()).then_some(TightSpot {
            from,
            to: from + width,
            more,
        })
    };
    let spots = parts.into_iter().filter_map(spot);
    spots.max_by(|one, other| one.more.total_cmp(&other.more))
}
