//! Full look-ahead over a queue of segments: the velocity at each transition.
//!
//! First without the jerk, forward and backward over all segments: the highest velocity that the
//! accelerations allow at each transition. Where it meets the bound of a transition, the path has
//! no acceleration; those transitions are the knots. Between two knots the path speeds up and
//! slows down at most once, in one profile over all segments between them. Then back and
//! forth over the knots with the jerk, and knots that the path no longer touches are dropped. A
//! profile between knots stays below the velocities of the first step, so that it keeps the bounds
//! of all segments that it spans.

use std::ops::Range;

use super::junction::Junction;
use super::profile::{Bounds, VelocityProfile, fits, reach};

/// Inputs of the plan from a segment.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlanInput {
    pub(super) length: f64,
    pub(super) bounds: Bounds,
    /// The transition into it.
    pub(super) entry: Junction,
}

/// One profile over one or several segments.
#[derive(Debug, Clone)]
pub(super) struct ProfileSpan {
    /// Number of its segments.
    pub(super) segments: usize,
    pub(super) profile: VelocityProfile,
    /// The path velocities at its ends.
    pub(super) start_velocity: f64,
    pub(super) end_velocity: f64,
    bounds: Bounds,
}

impl ProfileSpan {
    fn new(start: f64, end: f64, span: &Interval, bounds: Bounds) -> Self {
        Self {
            segments: span.segments,
            profile: VelocityProfile::between(start, end, span.length, &bounds),
            start_velocity: start,
            end_velocity: end,
            bounds,
        }
    }

    /// Cuts the stretch in two after one of its segments, given by their lengths: the last one at which
    /// the path has neither acceleration nor jerk. The motion does not change.
    pub(super) fn cut(&self, lengths: impl Iterator<Item = f64>) -> Option<(Self, Self)> {
        let (steady, velocity) = self.profile.steady();
        let mut way = 0.0;
        let ends = (1..self.segments).zip(lengths).map(|(segments, length)| {
            way += length;
            (segments, way)
        });
        let (segments, way) = ends.filter(|(_, way)| steady.contains(way)).last()?;
        let part = |segments, length, [start, end]: [f64; 2]| {
            let bounds = Bounds {
                velocity,
                ..self.bounds
            };
            Self::new(
                start,
                end,
                &Interval {
                    segments,
                    length,
                    bounds,
                    start: 0.0,
                    end: 0.0,
                },
                bounds,
            )
        };
        Some((
            part(segments, way, [self.start_velocity, velocity]),
            part(
                self.segments - segments,
                self.profile.length() - way,
                [velocity, self.end_velocity],
            ),
        ))
    }
}

/// A velocity this close to a bound touches it.
const TOUCH: f64 = 1e-9;

/// Number of rounds in which binding knots are put back, before every knot is kept.
const ROUNDS: usize = 24;

/// Number of rounds in which they are put back alone; then more and more of their neighbours are put back, too.
const ONE_BY_ONE: usize = 6;

/// Plans a motion over all stages that begins with a velocity and ends at rest. `None` if the
/// stages cannot be followed from that velocity.
pub(super) fn plan(stages: &[PlanInput], start: f64) -> Option<Vec<ProfileSpan>> {
    let velocities = highest(stages, start);
    let envelope = Envelope { stages, velocities };
    let knots = envelope.knots();
    let mut slack = envelope.slack(&knots, start);
    for round in 0..ROUNDS {
        if slack.is_empty() {
            break;
        }
        let fewer: Vec<usize> = knots
            .iter()
            .copied()
            .filter(|at| slack.binary_search(at).is_err())
            .collect();
        let Some(stretches) = envelope.stretches(&fewer, start) else {
            break;
        };
        let binding = envelope.broken(&slack, &fewer, &stretches);
        if binding.is_empty() {
            return Some(stretches);
        }
        let last = binding.len() - 1;
        let spread = if round < ONE_BY_ONE {
            0
        } else {
            1 << (round - ONE_BY_ONE).min(16)
        };
        slack.retain(|at| match binding.binary_search(at) {
            Ok(_) => false,
            // In later rounds knots next to those that bind are put back, too.
            Err(next) => {
                let near = [next.saturating_sub(1), next.min(last)];
                near.iter().all(|it| binding[*it].abs_diff(*at) > spread)
            }
        });
    }
    envelope.stretches(&knots, start)
}

/// The stages with the highest velocities at their transitions.
struct Envelope<'a> {
    stages: &'a [PlanInput],
    velocities: Vec<f64>,
}

impl Envelope<'_> {
    fn bound(&self, at: usize) -> f64 {
        bound(self.stages, at)
    }

    /// Returns the transitions in which the path has no acceleration.
    fn knots(&self) -> Vec<usize> {
        let inner = (1..self.stages.len()).filter(|&at| {
            touches(self.stages, &self.velocities, at) || self.stages[at].entry.is_fixed()
        });
        let ends = std::iter::once(0).chain(inner);
        ends.chain(std::iter::once(self.stages.len())).collect()
    }

    /// Returns the knots that the path passes so slowly, with the jerk, that their bounds do not matter; to have no
    /// acceleration there would only cost time.
    fn slack(&self, knots: &[usize], start: f64) -> Vec<usize> {
        let spans = self.spans(knots);
        let mut velocity = start;
        let mut slack = Vec::new();
        for (span, &at) in spans.iter().zip(&knots[1..]) {
            velocity = span.end.min(reach(velocity, span.length, &span.bounds));
            let inner = at < self.stages.len() && !self.stages[at].entry.is_fixed();
            if inner && velocity < self.bound(at) * (1.0 - TOUCH) {
                slack.push(at);
            }
        }
        slack
    }

    /// Returns the segments between the knots, with the velocities that the rest of the path allows.
    fn spans(&self, knots: &[usize]) -> Vec<Interval> {
        let mut spans: Vec<Interval> = knots
            .windows(2)
            .map(|pair| Interval::new(self.stages, &self.velocities, pair[0]..pair[1]))
            .collect();
        let mut end = 0.0;
        for span in spans.iter_mut().rev() {
            span.end = end;
            end = span.start.min(reach(end, span.length, &span.bounds));
            span.start = end;
        }
        spans
    }

    /// Returns the profiles from knot to knot.
    fn stretches(&self, knots: &[usize], start: f64) -> Option<Vec<ProfileSpan>> {
        let spans = self.spans(knots);
        let first = spans.first()?;
        if !fits(start, first.end.min(start), first.length, &first.bounds) {
            return None;
        }
        let mut velocity = start;
        let stretches = spans.iter().map(|span| {
            let bounds = Bounds {
                velocity: span.bounds.velocity.max(velocity),
                ..span.bounds
            };
            let end = span.end.min(reach(velocity, span.length, &bounds));
            let start = std::mem::replace(&mut velocity, end);
            ProfileSpan::new(start, end, span, bounds)
        });
        Some(stretches.collect())
    }

    /// Returns whether a profile has its highest velocity in one of the stages next to a transition at which it is too
    /// fast.
    fn peaks_beside(&self, at: usize, way: f64, profile: &VelocityProfile) -> bool {
        let (steady, top) = profile.steady();
        let (before, after) = (&self.stages[at - 1], &self.stages[at]);
        let ways = [
            (before, way - before.length..=way),
            (after, way..=way + after.length),
        ];
        ways.into_iter().any(|(stage, ways)| {
            let meets = steady.start() <= ways.end() && ways.start() <= steady.end();
            meets && top > stage.bounds.velocity * (1.0 + TOUCH)
        })
    }

    /// Returns the transitions that were not knots and are passed too fast.
    fn broken(&self, passed: &[usize], knots: &[usize], stretches: &[ProfileSpan]) -> Vec<usize> {
        let mut broken = Vec::new();
        let mut passed = passed.iter().copied().peekable();
        for (pair, stretch) in knots.windows(2).zip(stretches) {
            let (mut way, mut passed_to) = (0.0, pair[0]);
            while let Some(at) = passed.next_if(|&at| at < pair[1]) {
                way += self.stages[passed_to..at]
                    .iter()
                    .map(|stage| stage.length)
                    .sum::<f64>();
                passed_to = at;
                let bound = self.bound(at) * (1.0 + TOUCH);
                let profile = &stretch.profile;
                if profile.top_velocity() > bound
                    && (profile.velocity_after(way) > bound || self.peaks_beside(at, way, profile))
                {
                    broken.push(at);
                }
            }
        }
        broken
    }
}

/// Returns the highest velocities at the transitions, from the start to the rest at the end, that the accelerations
/// allow.
fn highest(stages: &[PlanInput], start: f64) -> Vec<f64> {
    let mut velocities = vec![0.0; stages.len() + 1];
    for (at, stage) in stages.iter().enumerate().rev() {
        let ahead = velocities[at + 1];
        velocities[at] = bound(stages, at).min(gained(ahead, stage));
    }
    velocities[0] = start;
    for (at, stage) in stages.iter().enumerate() {
        velocities[at + 1] = velocities[at + 1].min(gained(velocities[at], stage));
    }
    velocities
}

/// Returns the bound of the transition into a stage.
fn bound(stages: &[PlanInput], at: usize) -> f64 {
    let stage = &stages[at];
    let before = match at.checked_sub(1) {
        Some(before) => stages[before].bounds.velocity,
        None => f64::INFINITY,
    };
    let own = stage.bounds.velocity.min(stage.entry.velocity());
    own.min(before)
}

/// Returns whether the highest velocity of a transition is its bound.
fn touches(stages: &[PlanInput], velocities: &[f64], at: usize) -> bool {
    velocities[at] >= bound(stages, at) * (1.0 - TOUCH)
}

/// Returns the velocity reached from another one with a stage's acceleration.
fn gained(velocity: f64, stage: &PlanInput) -> f64 {
    (velocity * velocity + 2.0 * stage.bounds.acceleration * stage.length).sqrt()
}

/// The segments between two knots.
struct Interval {
    segments: usize,
    length: f64,
    bounds: Bounds,
    /// The highest velocities at its ends.
    start: f64,
    end: f64,
}

impl Interval {
    fn new(stages: &[PlanInput], velocities: &[f64], knots: Range<usize>) -> Self {
        let (from, to) = (knots.start, knots.end);
        let mut span = Self {
            segments: to - from,
            length: 0.0,
            bounds: Bounds {
                velocity: 0.0,
                acceleration: f64::INFINITY,
                jerk: f64::INFINITY,
                curve_jerk: f64::INFINITY,
                ramps: stages[from].bounds.ramps,
            },
            start: velocities[from],
            end: velocities[to],
        };
        let mut touched = f64::INFINITY;
        for (at, stage) in stages.iter().enumerate().take(to).skip(from) {
            let (start, end) = (velocities[at], velocities[at + 1]);
            let squares = f64::midpoint(start * start, end * end);
            let apex = (squares + stage.bounds.acceleration * stage.length).sqrt();
            // Next to a knot that was dropped, the plan is compared with the bound afterwards.
            let is_beside = [at, at + 1]
                .into_iter()
                .any(|at| from < at && at < to && touches(stages, velocities, at));
            if apex >= stage.bounds.velocity && !is_beside {
                touched = touched.min(stage.bounds.velocity);
            }
            span.length += stage.length;
            let bounds = &mut span.bounds;
            let highest = if is_beside {
                apex.min(stage.bounds.velocity)
            } else {
                apex
            };
            bounds.velocity = bounds.velocity.max(highest);
            bounds.acceleration = bounds.acceleration.min(stage.bounds.acceleration);
            bounds.jerk = bounds.jerk.min(stage.bounds.jerk);
        }
        span.bounds.velocity = span.bounds.velocity.min(touched);
        span
    }
}
