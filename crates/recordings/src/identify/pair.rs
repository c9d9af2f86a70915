//! Speeds in both directions: friction is half of the difference, the offset the common part (R6.12,
//! R6.13).

use std::ops::Range;

use super::segment::Segment;
use super::statistics::{count, median, resolution, samples_in, standard_error, trimmed_mean};
use super::track::AxisSamples;

/// Blocks for the standard error, in s.
const BLOCK_S: f64 = 0.1;

/// Part of both ranges of positions from which their common range is used.
const COMMON: f64 = 0.5;

/// The friction at one speed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Pair {
    /// The speed in mm/s or °/s.
    pub speed: f64,
    /// The friction in drive units, with the sign that it has at positive velocity.
    pub friction: f64,
    /// Part that is the same in both directions; `None` if only one was recorded.
    pub offset: Option<f64>,
    /// The standard error of the friction.
    pub error: f64,
    /// The friction of each visit, with its time in s.
    pub visits: Vec<Visit>,
    /// The segments that it comes from.
    pub segments: Vec<usize>,
}

/// A driven speed, in both directions if they follow each other.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Visit {
    /// The time in s.
    pub time_s: f64,
    /// The friction in drive units.
    pub friction: f64,
    /// Standard error.
    pub error: f64,
}

/// The mean torque of some samples.
#[derive(Debug, Clone, Copy)]
struct Mean {
    value: f64,
    error: f64,
}

/// The speeds of a recording.
#[derive(Debug)]
pub(super) struct PairedSpeeds {
    /// Slowest first.
    pub(super) pairs: Vec<Pair>,
    /// Part that is the same in both directions at all speeds.
    pub(super) offset: f64,
    /// Change of friction over the recording.
    pub(super) drift: Option<Drift>,
}

impl PairedSpeeds {
    /// Returns the pairs of a recording of a length in s, with their offset and their drift.
    pub(super) fn of(samples: &AxisSamples, segments: &[Segment], duration_s: f64) -> Self {
        let groups = speeds_of(segments);
        let step = resolution(&samples.torques);
        let measure = Measure { samples, step };
        let mut pairs: Vec<Pair> = groups
            .iter()
            .map(|group| measure.pair(segments, group))
            .collect();
        let drift = drift(&pairs, duration_s);
        if let Some(Drift { part, .. }) = drift.filter(|it| it.is_seen) {
            for pair in &mut pairs {
                pair.take_drift(segments, part / duration_s);
            }
        }
        let offsets: Vec<f64> = pairs.iter().filter_map(|pair| pair.offset).collect();
        // Unweighted: because of ripple, the errors at high speeds are too small.
        let offset = median(&offsets).unwrap_or(0.0);
        for pair in pairs.iter_mut().filter(|pair| pair.offset.is_none()) {
            // Only one direction: its torque without the offset of the others.
            let sign = segments[pair.segments[0]].velocity.signum();
            pair.friction = sign * (pair.friction - offset);
            for visit in &mut pair.visits {
                visit.friction = sign * (visit.friction - offset);
            }
        }
        Self {
            pairs,
            offset,
            drift,
        }
    }
}

impl Pair {
    /// Removes from the offset the change of friction from one direction to the other, while it rises by a
    /// part of it each second.
    fn take_drift(&mut self, segments: &[Segment], rate: f64) {
        let couples = couples(segments, &self.segments);
        let Some(offset) = &mut self.offset else {
            return;
        };
        let later = |&(forth, back): &(usize, usize)| {
            segments[forth].middle_s() - segments[back].middle_s()
        };
        let later = couples.iter().map(later).sum::<f64>() / count(couples.len().max(1));
        *offset -= self.friction * rate * later / 2.0;
    }
}

/// Segments with one speed, slowest first.
pub(super) fn speeds_of(segments: &[Segment]) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..segments.len()).collect();
    let speed = |index: usize| segments[index].velocity.abs();
    order.sort_by(|&one, &other| speed(one).total_cmp(&speed(other)));
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for index in order {
        match groups.last_mut() {
            Some(group) if segments[index].is_as_fast_as(&segments[group[0]]) => group.push(index),
            _ => groups.push(vec![index]),
        }
    }
    for group in &mut groups {
        group.sort_unstable();
    }
    groups
}

struct Measure<'a> {
    samples: &'a AxisSamples,
    /// Resolution of the drive.
    step: f64,
}

impl Measure<'_> {
    fn pair(&self, segments: &[Segment], group: &[usize]) -> Pair {
        let speed = group
            .iter()
            .map(|&it| segments[it].velocity.abs())
            .sum::<f64>()
            / count(group.len());
        let couples = couples(segments, group);
        let mut offsets = Vec::new();
        let mut visits = Vec::new();
        for (one, other) in &couples {
            let (forth, back) = (&segments[*one], &segments[*other]);
            let [plus, minus] = self.common(forth, back).map(|range| self.mean(range));
            offsets.push(f64::midpoint(plus.value, minus.value));
            visits.push(Visit {
                time_s: (forth.from_s + forth.to_s + back.from_s + back.to_s) / 4.0,
                friction: (plus.value - minus.value) / 2.0,
                error: plus.error.hypot(minus.error) / 2.0,
            });
        }
        let is_sided = couples.is_empty();
        if is_sided {
            visits.extend(group.iter().map(|&it| {
                let mean = self.mean(segments[it].samples.clone());
                Visit {
                    time_s: segments[it].middle_s(),
                    friction: mean.value,
                    error: mean.error,
                }
            }));
        }
        let visited = count(visits.len());
        let squares: f64 = visits.iter().map(|visit| visit.error * visit.error).sum();
        Pair {
            speed,
            friction: visits.iter().map(|visit| visit.friction).sum::<f64>() / visited,
            offset: (!is_sided).then(|| offsets.iter().sum::<f64>() / visited),
            error: squares.sqrt() / visited,
            visits,
            segments: group.to_vec(),
        }
    }

    /// Returns the samples of two segments where both were at the same positions: what depends on the position is then
    /// the same in both.
    fn common(&self, forth: &Segment, back: &Segment) -> [Range<usize>; 2] {
        let positions = &self.samples.positions;
        let ends = |segment: &Segment| {
            let (one, other) = (
                positions[segment.samples.start],
                positions[segment.samples.end - 1],
            );
            (one.min(other), one.max(other))
        };
        let ((low, high), (other_low, other_high)) = (ends(forth), ends(back));
        let (from, to) = (low.max(other_low), high.min(other_high));
        let longer = (high - low).max(other_high - other_low);
        let all = [forth.samples.clone(), back.samples.clone()];
        if to - from < COMMON * longer {
            return all;
        }
        let within = |range: &Range<usize>| {
            let is_in = |at: &usize| (from..=to).contains(&positions[*at]);
            match (range.clone().find(is_in), range.clone().rev().find(is_in)) {
                (Some(first), Some(last)) if last > first => first..last + 1,
                _ => range.clone(),
            }
        };
        [within(&all[0]), within(&all[1])]
    }

    fn mean(&self, range: Range<usize>) -> Mean {
        let torques = &self.samples.torques[range];
        let error = standard_error(torques, samples_in(BLOCK_S, self.samples.step_s));
        // A spread finer than a step of the drive is not seen unless noise hides the step.
        let unseen = self.step / 12.0_f64.sqrt();
        let is_hidden = torques
            .iter()
            .any(|it| (it - torques[0]).abs() > self.step * 0.5);
        Mean {
            value: trimmed_mean(torques),
            error: if is_hidden {
                error
            } else {
                error.hypot(unseen)
            },
        }
    }
}

/// Segments in opposite directions that follow each other, each of them once.
fn couples(segments: &[Segment], group: &[usize]) -> Vec<(usize, usize)> {
    let [forth, mut back]: [Vec<usize>; 2] = [1.0, -1.0].map(|sign| {
        let is_so = |it: &&usize| segments[**it].velocity * sign > 0.0;
        group.iter().filter(is_so).copied().collect()
    });
    let middle = |it: usize| segments[it].middle_s();
    let mut couples = Vec::new();
    for &one in &forth {
        let apart = |other: usize| (middle(other) - middle(one)).abs();
        let nearest = (0..back.len()).min_by(|&a, &b| apart(back[a]).total_cmp(&apart(back[b])));
        if let Some(nearest) = nearest {
            couples.push((one, back.remove(nearest)));
        }
    }
    couples
}

/// Change of friction over the recording, if speeds were visited more than once.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Drift {
    /// The part by which friction is larger at the end of the recording than at its beginning.
    pub part: f64,
    /// Whether the change exceeds the errors of the visits.
    pub is_seen: bool,
}

/// Returns the drift of all speeds that were visited more than once; `None` if there are too few.
fn drift(pairs: &[Pair], duration_s: f64) -> Option<Drift> {
    /// Standard errors from which a difference counts as real.
    const SIGNIFICANT: f64 = 4.0;
    let (mut product, mut square) = (0.0, 0.0);
    // For a speed in one direction, friction is not known yet.
    let paired = pairs.iter().filter(|pair| pair.offset.is_some());
    for pair in paired.filter(|pair| pair.visits.len() > 1) {
        let visits = count(pair.visits.len());
        let time = pair.visits.iter().map(|it| it.time_s).sum::<f64>() / visits;
        for visit in &pair.visits {
            let error = (visit.error / pair.friction).abs().max(1e-6);
            let apart = visit.time_s - time;
            product += apart * (visit.friction / pair.friction - 1.0) / (error * error);
            square += apart * apart / (error * error);
        }
    }
    if square <= 0.0 {
        return None;
    }
    let rate = product / square;
    Some(Drift {
        part: rate * duration_s,
        is_seen: rate.abs() > SIGNIFICANT / square.sqrt() && (rate * duration_s).abs() > 0.005,
    })
}
