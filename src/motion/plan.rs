//! Full look-ahead over a queue of legs: which velocity at each transition.
//!
//! First without the jerk, forth and back over all legs: the highest velocity that the
//! accelerations allow at each transition. Where it meets the bound of a transition, the path has
//! no acceleration; those transitions are the knots. Between two knots the path speeds up and
//! slows down at most once, in one profile over all legs between them. Then back and forth over
//! the knots with the jerk. A profile between knots stays below the velocities of the first step,
//! so that it keeps the bounds of all legs under it.

use super::junction::Junction;
use super::profile::{Bounds, Profile, fits, reach};

/// What the plan needs to know of a leg.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stage {
    pub(super) length: f64,
    pub(super) bounds: Bounds,
    /// The transition into it.
    pub(super) entry: Junction,
}

/// One profile over one or several legs.
#[derive(Debug, Clone)]
pub(super) struct Stretch {
    /// How many legs it spans.
    pub(super) legs: usize,
    pub(super) profile: Profile,
    /// The path velocity at its end.
    pub(super) end_velocity: f64,
}

/// A velocity this close to a bound touches it.
const TOUCH: f64 = 1e-9;

/// Plans a motion over all stages that begins with a velocity and ends at rest. `None` where the
/// stages cannot be followed from that velocity.
pub(super) fn plan(stages: &[Stage], start: f64) -> Option<Vec<Stretch>> {
    let velocities = envelope(stages, start);
    let knots = knots(stages, &velocities);
    let mut spans: Vec<Span> = knots
        .windows(2)
        .map(|pair| Span::new(stages, &velocities, (pair[0], pair[1])))
        .collect();
    let mut end = 0.0;
    for span in spans.iter_mut().rev() {
        span.end = end;
        end = span.start.min(reach(end, span.length, &span.bounds));
        span.start = end;
    }
    let first = spans.first_mut()?;
    if !fits(start, first.end.min(start), first.length, &first.bounds) {
        return None;
    }
    let mut velocity = start;
    let mut stretches = Vec::with_capacity(spans.len());
    for span in &spans {
        let bounds = Bounds {
            velocity: span.bounds.velocity.max(velocity),
            ..span.bounds
        };
        let end = span.end.min(reach(velocity, span.length, &bounds));
        stretches.push(Stretch {
            legs: span.legs,
            profile: Profile::between(velocity, end, span.length, &bounds),
            end_velocity: end,
        });
        velocity = end;
    }
    Some(stretches)
}

/// The highest velocities at the transitions, from the start to the rest at the end, that the
/// accelerations allow.
fn envelope(stages: &[Stage], start: f64) -> Vec<f64> {
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

/// The bound of the transition into a stage.
fn bound(stages: &[Stage], at: usize) -> f64 {
    let stage = &stages[at];
    let before = match at.checked_sub(1) {
        Some(before) => stages[before].bounds.velocity,
        None => f64::INFINITY,
    };
    let own = stage.bounds.velocity.min(stage.entry.velocity());
    own.min(before)
}

/// The velocity that a stage's acceleration makes of another one.
fn gained(velocity: f64, stage: &Stage) -> f64 {
    (velocity * velocity + 2.0 * stage.bounds.acceleration * stage.length).sqrt()
}

/// The transitions in which the path has no acceleration.
fn knots(stages: &[Stage], velocities: &[f64]) -> Vec<usize> {
    let inner = (1..stages.len()).filter(|&at| {
        stages[at].entry.is_fixed() || velocities[at] >= bound(stages, at) * (1.0 - TOUCH)
    });
    let ends = std::iter::once(0).chain(inner);
    ends.chain(std::iter::once(stages.len())).collect()
}

/// The legs between two knots.
struct Span {
    legs: usize,
    length: f64,
    bounds: Bounds,
    /// The highest velocities at its ends.
    start: f64,
    end: f64,
}

impl Span {
    fn new(stages: &[Stage], velocities: &[f64], (from, to): (usize, usize)) -> Self {
        let mut span = Self {
            legs: to - from,
            length: 0.0,
            bounds: Bounds {
                velocity: 0.0,
                acceleration: f64::INFINITY,
                jerk: f64::INFINITY,
            },
            start: velocities[from],
            end: velocities[to],
        };
        let mut touched = f64::INFINITY;
        for (at, stage) in stages.iter().enumerate().take(to).skip(from) {
            let (start, end) = (velocities[at], velocities[at + 1]);
            let squares = f64::midpoint(start * start, end * end);
            let apex = (squares + stage.bounds.acceleration * stage.length).sqrt();
            if apex >= stage.bounds.velocity {
                touched = touched.min(stage.bounds.velocity);
            }
            span.length += stage.length;
            let bounds = &mut span.bounds;
            bounds.velocity = bounds.velocity.max(apex);
            bounds.acceleration = bounds.acceleration.min(stage.bounds.acceleration);
            bounds.jerk = bounds.jerk.min(stage.bounds.jerk);
        }
        span.bounds.velocity = span.bounds.velocity.min(touched);
        span
    }
}
