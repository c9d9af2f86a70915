//! Swings after a reversal: an axis that sticks and slips does not settle in one (R5.28).

use std::ops::RangeInclusive;

use crate::circle::geometry::Direction;
use crate::circle::geometry::{Crossing, PlaneAxis};
use crate::circle::geometry::{PER_DEGREE, RadialProfile, UM_PER_M};

/// Seconds over which the path is averaged.
const AVERAGED_S: f64 = 0.008;

/// Seconds after a crossing in which swings are counted, or degrees.
const AFTER_S: f64 = 0.3;
const AFTER_DEG: f64 = 14.0;

/// Swings that also occur before a crossing are not its own: they are counted over the same distance, but
/// not back to the crossing of the other axis.
const BEFORE_DEG: f64 = 45.0;

/// Least number of extremes; fewer are those of a peak.
const FEWEST: usize = 4;

/// Part of the largest swing below which swings do not count.
const PART: f64 = 0.1;

/// Nor swings below this, in µm.
const LEAST_UM: f64 = 0.3;

/// Number of standard deviations of the noise, averaged over eight samples, that a swing must exceed.
const OF_NOISE: f64 = 9.0 / 2.828;

/// Returns the largest swing of an axis that sticks and slips, in µm, for paths with this noise.
pub(crate) fn stick_slip(
    paths: &[(Direction, &RadialProfile)],
    axis: PlaneAxis,
    noise_um: f64,
) -> Option<f64> {
    let crossings = || Crossing::ALL.into_iter().filter(|it| it.axis() == axis);
    let found: Vec<Swings> = paths
        .iter()
        .flat_map(|&(direction, profile)| {
            crossings().map(move |crossing| Swings::of(profile, direction, crossing, noise_um))
        })
        .collect::<Option<_>>()?;
    let median = |count: fn(&Swings) -> usize| {
        let mut counts: Vec<usize> = found.iter().map(count).collect();
        counts.sort_unstable();
        counts.get(counts.len() / 2).copied()
    };
    let largest = found.iter().map(|it| it.largest_um).fold(0.0, f64::max);
    let [after, before] = [median(|it| it.after)?, median(|it| it.before)?];
    (after >= FEWEST && before < after / 2).then_some(largest)
}

/// Swings around a crossing.
struct Swings {
    /// Extremes after it.
    after: usize,
    /// Extremes before it: those of noise or of an oscillation.
    before: usize,
    /// The largest swing after it.
    largest_um: f64,
}

impl Swings {
    fn of(
        profile: &RadialProfile,
        direction: Direction,
        crossing: Crossing,
        noise_um: f64,
    ) -> Option<Self> {
        let turning = 360.0 / profile.turn_s()?;
        let degrees = (AFTER_S * turning).clamp(AFTER_DEG, 80.0);
        #[allow(clippy::cast_possible_truncation)] // at most 8000
        let angles = |degrees: f64| (degrees * f64::from(PER_DEGREE)).round() as i32;
        let width = usize::try_from(angles(AVERAGED_S * turning))
            .unwrap_or(1)
            .max(1);
        #[allow(clippy::cast_precision_loss)] // at most some hundred
        let mean = |window: &[f64]| window.iter().sum::<f64>() / window.len() as f64;
        let smooth = |ways: RangeInclusive<i32>| -> Vec<f64> {
            let points = profile.fixed(crossing, direction, ways);
            let path: Vec<f64> = points.map(|(_, it)| it.deviation * UM_PER_M).collect();
            path.windows(width).map(mean).collect()
        };
        let after = smooth(0..=angles(degrees));
        let before = smooth(-angles(degrees.min(BEFORE_DEG))..=0);
        let [low, high] = after.iter().fold([f64::MAX, f64::MIN], |[low, high], it| {
            [low.min(*it), high.max(*it)]
        });
        let least = (PART * (high - low)).max(LEAST_UM).max(OF_NOISE * noise_um);
        let (after, largest_um) = extremes(&after, least);
        Some(Self {
            after,
            before: extremes(&before, least).0,
            largest_um,
        })
    }
}

/// Returns the extremes of a path between swings of at least this size, and the largest swing.
fn extremes(path: &[f64], least: f64) -> (usize, f64) {
    let Some(&first) = path.first() else {
        return (0, 0.0);
    };
    let (mut low, mut high, mut rising) = (first, first, None);
    let (mut count, mut largest) = (0, 0.0_f64);
    for &value in path {
        (low, high) = (low.min(value), high.max(value));
        let turned = match rising {
            None => (high - low >= least).then_some(value >= high),
            Some(true) => (high - value >= least).then_some(false),
            Some(false) => (value - low >= least).then_some(true),
        };
        if let Some(up) = turned {
            count += usize::from(rising.is_some());
            largest = largest.max(high - low);
            rising = Some(up);
            (low, high) = (value, value);
        }
    }
    (count, largest)
}
