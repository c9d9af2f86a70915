//! The glitch at a reversal (R11.26): the deviation in the direction of the axis, less
//! a straight line through both sides.

use std::collections::VecDeque;
use std::ops::ControlFlow;

use super::measured::MeasuredCycle;
use super::path::Places;
use crate::motion::Movement;

const UM_PER_MM: f64 = 1000.0;

/// Minimum length of the window before and after, in s.
const WINDOW_S: f64 = 0.3;
/// Extent to either side on a curve, in rad.
const WINDOW_TURN: f64 = 8.0 * DEGREE;
/// Extent of the sides, in rad.
const SIDE_TURN: f64 = 20.0 * DEGREE;
/// Angle in rad by which the path may turn within the window.
const MOST_TURN: f64 = 30.0 * DEGREE;
/// A path that turns by less in the time of a window is straight, in rad.
const STRAIGHT: f64 = 0.1 * DEGREE;
/// A path that turns by more in a cycle has a corner, in rad.
const CORNER: f64 = 0.3;
/// A window that ends earlier after the reversal has no figure, in s.
const SHORTEST_S: f64 = 0.1;
/// A side with fewer cycles is missing.
const FEWEST: usize = 10;
/// Limit of the cycles kept.
const MOST_MOMENTS: usize = 20_000;

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Values of a cycle that are needed here.
#[derive(Debug, Clone, Copy)]
pub(super) struct CycleValues {
    time_s: f64,
    /// The angle by which the path has turned up to here, in rad.
    turned: f64,
    /// Deviation of each run from the path, normal to it.
    errors: [Places; 3],
    /// Whether the path stops or has a corner here, or is rapid.
    breaks: bool,
}

/// The last cycles.
#[derive(Debug, Default)]
pub(super) struct Course {
    moments: VecDeque<CycleValues>,
    /// The direction of the path.
    along: Places,
    turned: f64,
}

impl Course {
    /// Takes a cycle.
    pub(super) fn push(&mut self, measured: &MeasuredCycle<'_>) -> CycleValues {
        let velocities = measured.velocities;
        let speed = velocities.iter().map(|it| it * it).sum::<f64>().sqrt();
        let mut breaks = measured.cause.movement != Movement::Feed || speed == 0.0;
        if speed > 0.0 {
            let mut along = Places::default();
            for (to, velocity) in along.iter_mut().zip(velocities) {
                *to = velocity / speed;
            }
            let steps = along.iter().zip(&self.along);
            let chord = steps.map(|(to, from)| (to - from).powi(2)).sum::<f64>();
            let turn = 2.0 * (chord.sqrt() / 2.0).min(1.0).asin();
            breaks |= turn > CORNER;
            self.turned += turn;
            self.along = along;
        }
        let moment = CycleValues {
            time_s: measured.time_s,
            turned: self.turned,
            errors: measured.distances.map(|distance| distance.normal),
            breaks,
        };
        if breaks {
            self.moments.clear();
        }
        self.moments.push_back(moment);
        let is_needed = |first: &CycleValues| {
            moment.turned - first.turned <= SIDE_TURN
                || moment.time_s - first.time_s <= 2.0 * WINDOW_S
        };
        while self.moments.len() > MOST_MOMENTS
            || self.moments.front().is_some_and(|first| !is_needed(first))
        {
            self.moments.pop_front();
        }
        moment
    }

    /// Returns the direction of the path.
    pub(super) fn direction(&self) -> Places {
        self.along
    }
}

/// The deviation around a reversal, in the direction of the axis.
#[derive(Debug)]
pub(super) struct ReversalWindow {
    normal: Places,
    time_s: f64,
    turned: f64,
    before: WindowSide,
    after: WindowSide,
    /// Cycles in which the extremes are searched for.
    inside: Vec<(f64, [f64; 3])>,
    /// End of the window after the reversal.
    ended: Option<f64>,
    /// Length of the side after it, in rad.
    reach: f64,
}

/// Cycles next to the window.
type WindowSide = Vec<(f64, [f64; 3])>;

impl ReversalWindow {
    /// Returns the window of a reversal at the last cycle of a course.
    pub(super) fn begin(course: &Course, normal: Places) -> Self {
        let last = course.moments.back();
        let mut window = Self {
            normal,
            time_s: last.map_or(0.0, |last| last.time_s),
            turned: last.map_or(0.0, |last| last.turned),
            before: WindowSide::new(),
            after: WindowSide::new(),
            inside: Vec::new(),
            ended: None,
            reach: SIDE_TURN,
        };
        let mut is_side = false;
        for moment in course.moments.iter().rev() {
            let (age, turn) = window.since(moment);
            let value = window.value(moment);
            is_side |= if is_straight(age, turn) {
                age >= WINDOW_S
            } else {
                turn >= WINDOW_TURN
            };
            if !is_side {
                window.inside.push(value);
            } else if turn <= SIDE_TURN && (turn >= WINDOW_TURN || age <= 2.0 * WINDOW_S) {
                window.before.push(value);
            } else {
                break;
            }
        }
        window
    }

    /// Returns the time from the reversal to a cycle, and the angle by which the path turns.
    fn since(&self, moment: &CycleValues) -> (f64, f64) {
        (
            (moment.time_s - self.time_s).abs(),
            (moment.turned - self.turned).abs(),
        )
    }

    fn value(&self, moment: &CycleValues) -> (f64, [f64; 3]) {
        let along = |error: Places| {
            let axes = error.iter().zip(&self.normal);
            axes.map(|(error, normal)| error * normal).sum::<f64>()
        };
        (moment.time_s - self.time_s, moment.errors.map(along))
    }

    /// Takes the next cycle; `Break` at the end of the window.
    pub(super) fn push(&mut self, moment: &CycleValues) -> ControlFlow<()> {
        if moment.breaks {
            return ControlFlow::Break(());
        }
        let (age, turn) = self.since(moment);
        if self.ended.is_none() {
            let is_wide = turn >= WINDOW_TURN || is_straight(age, turn);
            if turn >= MOST_TURN || (age >= WINDOW_S && is_wide) {
                self.ended = Some(age);
                self.reach = SIDE_TURN.max(2.0 * turn);
            } else {
                self.inside.push(self.value(moment));
                return ControlFlow::Continue(());
            }
        }
        let end = self.ended.unwrap_or(age);
        let is_beside = if is_straight(end, turn * end / age) {
            age <= 2.0 * end
        } else {
            turn <= self.reach
        };
        if !is_beside {
            return ControlFlow::Break(());
        }
        self.after.push(self.value(moment));
        ControlFlow::Continue(())
    }

    /// Returns the glitch of each run in µm; `None` if the window is too short or a side is missing.
    pub(super) fn figure(&self) -> Option<[f64; 3]> {
        let end = self.ended?;
        if end < SHORTEST_S || self.before.len() < FEWEST || self.after.len() < FEWEST {
            return None;
        }
        Some(std::array::from_fn(|run| {
            let line = self.line(run);
            let left = self
                .inside
                .iter()
                .map(|(at, values)| values[run] - line.0 - line.1 * at);
            let (least, most) = left.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), it| {
                (low.min(it), high.max(it))
            });
            (most - least) * UM_PER_MM
        }))
    }

    /// Returns the straight line through both sides: its value at the reversal, and its slope per second.
    fn line(&self, run: usize) -> (f64, f64) {
        let (mut count, mut sums) = (0.0, [0.0; 4]);
        for (at, values) in self.before.iter().chain(&self.after) {
            let value = values[run];
            count += 1.0;
            let each = [*at, at * at, value, at * value];
            for (sum, part) in sums.iter_mut().zip(each) {
                *sum += part;
            }
        }
        let [time, square, value, product] = sums;
        let scale = count * square - time * time;
        let slope = (count * product - time * value) / scale;
        ((value - slope * time) / count, slope)
    }
}

/// Returns whether a path that has turned by this angle in this time is straight.
fn is_straight(age: f64, turn: f64) -> bool {
    turn <= STRAIGHT * (age / WINDOW_S).max(1.0)
}
