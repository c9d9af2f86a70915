//! Segments in which the torque is at a limit (R6.21).

use super::segment::Segment;
use super::track::AxisSamples;

/// Fewer samples at the limit are not clipping.
const FEWEST: usize = 5;

/// Noise alone puts fewer samples at the extreme of a segment: this many times the usual part, or
/// half-way from it to the whole.
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

/// The segments whose torque is cut off at the greatest or the least value of the recording.
pub(super) fn clipped(samples: &AxisSamples, segments: &[Segment]) -> Vec<usize> {
    let mut found: Vec<usize> = [1.0, -1.0]
        .into_iter()
        .flat_map(|sign| clipped_at(samples, segments, sign))
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// The segments cut off at one end: at the greatest value, or with the sign -1 at the least.
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

/// The greatest value of a segment, and its samples there.
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

/// Whether the torque between the segments, where it is below the limit, changes in most samples
/// from one to the next.
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
