//! The turns of an axis along a run of short lines (R11.29): a smooth curve through the run turns where
//! its vertices do, and nowhere else.
//!
//! Weights that keep parabolas overshoot beside a step, and a spline through vertices does, too: an
//! axis that only creeps would go back by a fraction of a µm, and friction compensation would take
//! that for a reversal. The control points of a cubic B-spline are therefore made to rise where the
//! vertices rise, to fall where they fall, and to turn once for each of their turns; the curve has at
//! most as many turns as its control points.

use std::collections::VecDeque;

/// Number of later control points that decide on one.
pub(super) const AHEAD: usize = 48;

/// Number of vertices by which the turn of a smooth curve may lie off that of its vertices.
const SHIFT: usize = 6;

/// The run as one axis sees it.
pub(super) trait RunVertices {
    /// Returns the change from a vertex to the next one; 0 where it is not known.
    fn step(&self, vertex: usize) -> f64;
    /// Returns the wanted control point.
    fn wanted(&self, vertex: usize) -> f64;
    /// Returns the number of the last vertex that is known, at most [`AHEAD`] after the one in question.
    fn last(&self) -> usize;
}

/// The course of one axis: it moves on in its direction up to the next turn.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct AxisCourse {
    /// The last control point.
    at: f64,
    /// 1, -1, or 0 before the first motion.
    direction: f64,
    /// Number of the steps that were looked at.
    seen: usize,
    /// The vertex after the last of them in the direction.
    reached: usize,
    /// The first step against the direction.
    against: Option<usize>,
    /// The control point at which the axis turns next, once it is chosen.
    turn: Option<usize>,
}

impl AxisCourse {
    /// Returns the next control point of the axis. Numbers rise by one from call to call, from 0.
    pub(super) fn next(&mut self, vertex: usize, run: &impl RunVertices) -> f64 {
        if vertex == 0 {
            *self = Self {
                at: run.wanted(0),
                ..Self::default()
            };
        }
        self.look_ahead(run);
        if self.direction == 0.0 {
            self.at = run.wanted(vertex);
            return self.at;
        }
        if let (None, Some(step)) = (self.turn, self.against) {
            self.turn = self.choose_turn(vertex, (step, run));
        }
        let end = match (self.turn, self.against) {
            (Some(turn), _) => turn,
            (None, Some(_)) => self.reached.saturating_sub(SHIFT).max(vertex),
            (None, None) => run.last(),
        };
        // Not beyond any later one before the turn, and never back.
        let later = (vertex..=end).map(|later| self.direction * run.wanted(later));
        let least = later.fold(f64::INFINITY, f64::min);
        self.at = self.direction * least.max(self.direction * self.at);
        if self.turn == Some(vertex) {
            self.direction = -self.direction;
            self.seen = self.against.unwrap_or(vertex);
            (self.turn, self.against) = (None, None);
        }
        self.at
    }

    /// Looks at the steps that are new, up to the first one against the direction.
    fn look_ahead(&mut self, run: &impl RunVertices) {
        while self.against.is_none() && self.seen < run.last() {
            let step = run.step(self.seen);
            if self.direction == 0.0 && step != 0.0 {
                self.direction = step.signum();
            }
            let along = self.direction * step;
            if along < 0.0 {
                self.against = Some(self.seen);
                break;
            }
            self.seen += 1;
            if along > 0.0 {
                self.reached = self.seen;
            }
        }
    }

    /// Returns the next turn, if it has to be chosen now: the extreme among the control points nearby.
    fn choose_turn(&self, vertex: usize, (step, run): (usize, &impl RunVertices)) -> Option<usize> {
        if vertex + SHIFT < self.reached {
            return None;
        }
        let end = match self.turn_after(step, run) {
            Some(next) => (step + SHIFT).min(usize::midpoint(step, next)),
            None => step + SHIFT,
        };
        let places = vertex..=end.min(run.last()).max(vertex);
        let wanted = |at: &usize| self.direction * run.wanted(*at);
        places.max_by(|one, other| wanted(one).total_cmp(&wanted(other)))
    }

    /// Returns the first vertex at which the axis may turn again after a step against its direction.
    fn turn_after(&self, step: usize, run: &impl RunVertices) -> Option<usize> {
        let mut reached = step;
        for step in step..run.last() {
            let against = -self.direction * run.step(step);
            if against > 0.0 {
                reached = step + 1;
            } else if against < 0.0 {
                return Some(reached);
            }
        }
        None
    }
}

/// Values by number, of which the first are forgotten.
#[derive(Debug)]
pub(super) struct Window<T> {
    values: VecDeque<T>,
    /// The number of the first of them.
    first: usize,
}

impl<T> Default for Window<T> {
    fn default() -> Self {
        Self {
            values: VecDeque::new(),
            first: 0,
        }
    }
}

impl<T> Window<T> {
    pub(super) fn clear(&mut self) {
        self.values.clear();
        self.first = 0;
    }

    pub(super) fn push(&mut self, value: T) {
        self.values.push_back(value);
    }

    /// Returns the number of the next value.
    pub(super) fn next(&self) -> usize {
        self.first + self.values.len()
    }

    /// Returns the number of the latest value, counted from 0; 0 without a value, too.
    pub(super) fn newest(&self) -> usize {
        self.next().saturating_sub(1)
    }

    pub(super) fn newest_mut(&mut self) -> Option<&mut T> {
        self.values.back_mut()
    }

    /// Returns a value, or the nearest one that is kept.
    pub(super) fn at(&self, number: usize) -> &T {
        let at = number.saturating_sub(self.first);
        &self.values[at.min(self.values.len() - 1)]
    }

    /// Forgets the values before one, except the newest.
    pub(super) fn forget_before(&mut self, number: usize) {
        while self.first < number && self.values.len() > 1 {
            self.values.pop_front();
            self.first += 1;
        }
    }
}
