//! Segments in which the torque is at a limit (R6.21).

use std::collections::BTreeSet;

use super::pair::speeds_of;
use super::segment::Segment;
use super::statistics::{count, trimmed_mean};
use super::track::AxisSamples;

/// Least number of samples at the limit that are clipping.
const FEWEST: usize = 5;

/// Multiple of the usual part of samples at the extreme of a segment that noise alone does not reach, at most half-way
/// from it to the whole.
const UNUSUAL: f64 = 3.0;

/// A segment with this part at the limit does not show its mean.
const MOSTLY: f64 = 0.5;

/// Samples of a segment at the limit.
struct AtLimit {
    segment: usize,
    count: usize,
    /// Part of the segment.
    share: f64,
    /// Samples at the next smaller value.
    beside: usize,
}

/// Returns the segments whose torque is cut off at the greatest or the least value of the recording.
pub(super) fn clipped(samples: &AxisSamples, segments: &[Segment]) -> Vec<usize> {
    let mut found: Vec<usize> = [1.0, -1.0]
        .into_iter()
        .flat_map(|sign| clipped_at(samples, segments, sign))
        .collect();
    found.extend(levelled(samples, segments));
    found.sort_unstable();
    found.dedup();
    found
}

/// Returns the segments of one direction whose mean torque is the same at the limit while that of the other direction
/// changes with the speed: noise that was added after a limit hides it.
fn levelled(samples: &AxisSamples, segments: &[Segment]) -> Vec<usize> {
    /// Speeds at the same limit.
    const SPEEDS: usize = 3;
    /// The means at a limit are the same to this part of what the other direction changes …
    const SAME: f64 = 0.1;
    /// … which itself changes by this part of the torque, and by this part of its change at these speeds.
    const CHANGES: [f64; 2] = [0.05, 0.5];
    let mean = |segment: &Segment| trimmed_mean(&samples.torques[segment.samples.clone()]);
    let means: Vec<f64> = segments.iter().map(mean).collect();
    let spread = |of: &[usize]| {
        let values = of.iter().map(|&at| means[at]);
        let [low, high] = values.fold([f64::MAX, f64::MIN], |[low, high], it| {
            [low.min(it), high.max(it)]
        });
        (high - low).max(0.0)
    };
    let along = |sign: f64| {
        let of_way = (0..segments.len()).filter(move |&at| segments[at].velocity * sign > 0.0);
        of_way.collect::<Vec<usize>>()
    };
    let largest = means.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
    let mut speeds = vec![0; segments.len()];
    for (speed, group) in speeds_of(segments).into_iter().enumerate() {
        for at in group {
            speeds[at] = speed;
        }
    }
    let [forth, back] = [1.0, -1.0].map(along);
    let average = |of: &[usize]| of.iter().map(|&at| means[at]).sum::<f64>() / count(of.len());
    // A limit is at the end to which friction drives the torque.
    let end = (average(&forth) - average(&back)).signum();
    let level = |own: &[usize], other: &[usize], end: f64| {
        let change = spread(other);
        let ends = own.iter().map(|&at| end * means[at]);
        let limit = ends.fold(f64::MIN, f64::max);
        let mut level = own.to_vec();
        level.retain(|&at| limit - end * means[at] <= SAME * change);
        let at_limit: BTreeSet<usize> = level.iter().map(|&at| speeds[at]).collect();
        let mut beside = other.to_vec();
        beside.retain(|&at| at_limit.contains(&speeds[at]));
        let is_cut = at_limit.len() >= SPEEDS
            && change > CHANGES[0] * largest
            && spread(&beside) > CHANGES[1] * change;
        if is_cut { level } else { Vec::new() }
    };
    let mut found = level(&forth, &back, end);
    found.extend(level(&back, &forth, -end));
    found
}

/// Returns the segments cut off at one end: at the greatest value, or with the sign -1 at the least.
fn clipped_at(samples: &AxisSamples, segments: &[Segment], sign: f64) -> Vec<usize> {
    let torque = |at: usize| sign * samples.torques[at];
    let limit = (0..samples.torques.len()).map(torque).fold(0.0, f64::max);
    let (mut at_limit, mut usual) = (Vec::new(), Vec::new());
    for (index, segment) in segments.iter().enumerate() {
        let (extreme, found) = extreme(index, segment, torque);
        if extreme >= limit {
            at_limit.push(found);
        } else if extreme > 0.0 {
            usual.push(found.share);
        }
    }
    let is_flat = |it: &AtLimit| it.share >= MOSTLY;
    if usual.is_empty() {
        // Every segment is at the limit: only the noise elsewhere distinguishes it from friction.
        let varies = varies_elsewhere(samples, segments, limit);
        at_limit.retain(|it| is_flat(it) && varies);
        return at_limit.into_iter().map(|it| it.segment).collect();
    }
    let usual = usual.into_iter().fold(0.0, f64::max);
    let speeds = at_limit.iter().filter(|it| is_flat(it)).count();
    let is_shared = speeds > 1
        && at_limit
            .iter()
            .filter(|it| is_flat(it))
            .any(|it| !segments[it.segment].is_as_fast_as(&segments[at_limit[0].segment]));
    let is_cut = |it: &AtLimit| {
        let unusual = (UNUSUAL * usual).min(f64::midpoint(usual, 1.0));
        let stands_out = it.share > unusual && it.count >= it.beside;
        it.count >= FEWEST && (stands_out || is_shared && is_flat(it))
    };
    let cut = at_limit.into_iter().filter(is_cut);
    cut.map(|it| it.segment).collect()
}

/// Returns the greatest value of a segment, and its samples there.
fn extreme(index: usize, segment: &Segment, torque: impl Fn(usize) -> f64) -> (f64, AtLimit) {
    let range = segment.samples.clone();
    let most = range.clone().map(&torque).fold(f64::NEG_INFINITY, f64::max);
    let [mut count, mut beside] = [0, 0];
    let mut next = f64::NEG_INFINITY;
    for value in range.clone().map(&torque) {
        if value >= most {
            count += 1;
        } else if value > next {
            (next, beside) = (value, 1);
        } else if value >= next {
            beside += 1;
        }
    }
    #[allow(clippy::cast_precision_loss)] // samples of a segment
    let share = count as f64 / range.len() as f64;
    let found = AtLimit {
        segment: index,
        count,
        share,
        beside,
    };
    (most, found)
}

/// Returns whether the torque between the segments, where it is below the limit, changes in most samples from one to
/// the next.
fn varies_elsewhere(samples: &AxisSamples, segments: &[Segment], limit: f64) -> bool {
    const ENOUGH: usize = 20;
    let is_within = |at: &usize| segments.iter().any(|it| it.samples.contains(at));
    let is_below = |at: usize| samples.torques[at].abs() < limit;
    let between = (1..samples.torques.len()).filter(|at| is_below(*at) && is_below(at - 1));
    let [mut changes, mut all] = [0, 0];
    for at in between.filter(|at| !is_within(at)) {
        all += 1;
        changes += usize::from((samples.torques[at] - samples.torques[at - 1]).abs() > 0.0);
    }
    all >= ENOUGH && 2 * changes > all
}
