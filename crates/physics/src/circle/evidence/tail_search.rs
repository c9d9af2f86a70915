//! The search for the tails of slow peaks in recorded paths (R5.34).

use super::series::{AngleSeries, beyond_noise};
use super::shapes::{Additions, PathMotion, Shapes};
use super::tails::{Decays, axis_number};
use crate::circle::geometry::CosineSine;
use crate::circle::geometry::Direction;
use crate::circle::geometry::{Crossing, PlaneAxis};
use crate::circle::geometry::{PER_DEGREE, RadialProfile, UM_PER_M};

/// The fastest decay whose tail is sought, in s.
const FASTEST_S: f64 = 0.03;

/// The slowest one, as a part of the time from one reversal of the axis to the next.
const SLOWEST: f64 = 0.35;

/// Ratio of a decay to the one that is tried before.
const RATIO: f64 = 1.25;

/// Rounds in which the best decay is sharpened.
const SHARPENED: u32 = 5;

/// A peak has a tail only if it is so many times as large as what the shapes leave of the rest …
const FAR: f64 = 5.0;

/// … as noise …
const OF_NOISE: f64 = 8.0;

/// … and has this size, in µm.
const LEAST_PEAK_UM: f64 = 1.0;

/// Limits of the height of a tail at the reversal, as parts of the peak.
const HEIGHTS: [f64; 2] = [0.15, 2.5];

/// Number of variances that a tail explains at least.
const EXPLAINS: f64 = 16.0;

/// Returns the shapes of paths with the tails of their peaks, if they have any.
pub(crate) fn fit(
    paths: &[(Direction, &RadialProfile)],
    (series, rough): (&[AngleSeries], &[AngleSeries]),
    noise_um: f64,
) -> Option<Shapes> {
    let mut shapes = Shapes::fit(series, Additions::default())?;
    let Some(turn_s) = series
        .iter()
        .map(|it| it.turn_s)
        .collect::<Option<Vec<_>>>()
    else {
        return Some(shapes);
    };
    let slowest = SLOWEST / 2.0 * turn_s.iter().copied().fold(f64::INFINITY, f64::min);
    let rest = beyond_noise(&shapes.left, noise_um);
    let least = LEAST_PEAK_UM.max(OF_NOISE * noise_um).max(FAR * rest);
    let mut peaks = PlaneAxis::ALL.map(|axis| (axis, peak_um(paths, axis, &shapes)));
    peaks.sort_by(|one, other| other.1.abs().total_cmp(&one.1.abs()));
    let mut decays = Decays::default();
    for (axis, peak) in peaks.into_iter().filter(|(_, peak)| peak.abs() >= least) {
        let at = axis_number(axis);
        let with = |series: &[AngleSeries], decay_s: f64| {
            let mut tried = decays;
            tried[at] = Some(decay_s);
            let added = Additions {
                decays: tried,
                ..Additions::default()
            };
            Shapes::fit(series, added)
        };
        let sought = best(slowest, |decay_s| Some(with(rough, decay_s)?.squares()));
        let Some((fitted_s, found)) = sought.and_then(|it| Some((it, with(series, it)?))) else {
            continue;
        };
        if is_tail(&found, (axis, peak), shapes.squares()) {
            decays[at] = Some(fitted_s);
            shapes = found;
        }
    }
    Some(shapes)
}

/// Returns the decay with which the squares of what is left are the least.
fn best(slowest_s: f64, squares: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let mut best: Option<(f64, f64)> = None;
    let take = |decay_s: f64, best: &mut Option<(f64, f64)>| {
        if let Some(found) = squares(decay_s)
            && best.is_none_or(|(_, least)| found < least)
        {
            *best = Some((decay_s, found));
        }
    };
    let mut decay_s = FASTEST_S;
    while decay_s < slowest_s {
        take(decay_s, &mut best);
        decay_s *= RATIO;
    }
    let mut ratio = RATIO;
    for _ in 0..SHARPENED {
        ratio = ratio.sqrt();
        let (middle, _) = best?;
        for near in [middle * ratio, middle / ratio] {
            if near < slowest_s {
                take(near, &mut best);
            }
        }
    }
    Some(best?.0)
}

/// Returns whether a tail that was fitted is one: it explains more than its noise, and has the sign and the size of the
/// peak. What an axis leaves as it slows down before a reversal is fitted by tails of the opposite sign.
fn is_tail(found: &Shapes, (axis, peak): (PlaneAxis, f64), squares_before: f64) -> bool {
    let heights = found.tails().heights_um(axis);
    let largest = heights.into_iter().fold(0.0, larger);
    let is_sized = (HEIGHTS[0]..=HEIGHTS[1]).contains(&(largest / peak));
    is_sized && squares_before - found.squares() > EXPLAINS * found.variance()
}

/// Returns the one of two deviations that is farther from zero.
fn larger(one: f64, other: f64) -> f64 {
    if other.abs() > one.abs() { other } else { one }
}

/// Returns the largest deviation after the reversals of an axis from the fitted shapes, in µm.
fn peak_um(paths: &[(Direction, &RadialProfile)], axis: PlaneAxis, shapes: &Shapes) -> f64 {
    /// Degrees after a crossing in which a peak is sought.
    const WITHIN: i32 = 14 * PER_DEGREE;
    let crossings = || Crossing::ALL.into_iter().filter(|it| it.axis() == axis);
    let mut most = 0.0;
    for &(direction, profile) in paths {
        for crossing in crossings() {
            for (_, point) in profile.fixed(crossing, direction, 0..=WITHIN) {
                let angle = CosineSine {
                    cos: point.cos,
                    sin: point.sin,
                };
                let course = PathMotion {
                    direction,
                    turn_s: profile.turn_s(),
                    radius_mm: profile.radius_m() * 1000.0,
                };
                let shape = shapes.at(angle, course);
                most = larger(most, point.deviation * UM_PER_M - shape);
            }
        }
    }
    most
}
