//! The turns on a circle in a whole recording (R5.26).

use std::f64::consts::TAU;
use std::ops::Range;

use super::ends::{LEAST, run_in};
use super::fit::FittedCircle;
use super::limits::WIDEST_GAP_DEG;
use super::trace::RecordedTrace;
use crate::circle::geometry::Direction;

/// The distance back after which a path has turned round, in radians: more than noise and
/// standstill cause.
const TURNED_ROUND: f64 = 5.0 * TAU / 360.0;

/// Permitted part missing at the ends of a turn, in radians.
const LACKING: f64 = TAU / 360.0;

/// A few points.
const FEW: f64 = 3.0;

/// The part of a path on which the peak of a crossing is, before and after it, in radians.
const PEAK: [f64; 2] = [TAU * 2.0 / 360.0, TAU * 14.0 / 360.0];

/// A turn with at most this multiple of the smallest deviation is as good as the best one.
const AS_GOOD: f64 = 1.05;

/// The least angle from the first whole turn to the last one.
const ROOM: f64 = TAU / 8.0;

/// Angle from one crossing to the next, and from a crossing to the place between two, in radians.
const QUARTER: f64 = TAU / 4.0;
const BETWEEN: f64 = TAU / 8.0;

/// Deviations below this make no difference between turns, in mm.
const ROUND_MM: f64 = 1e-6;

/// A path along the circle without turning round.
#[derive(Debug, Clone)]
pub(super) struct PathRun {
    pub(super) direction: Direction,
    /// Points.
    pub(super) points: Range<usize>,
    /// The angle since its first point in the direction of travel, in radians.
    angles: Vec<f64>,
    /// The angles at both ends on which the machine speeds up or slows down (R16.10).
    run_in: [f64; 2],
    /// The angle from X+ to its first point, in radians.
    begin: f64,
}

/// Returns the runs on the circle, in the order of time: the parts that do not leave it and do not turn round.
pub(super) fn runs(fit: &FittedCircle, trace: &RecordedTrace) -> Vec<PathRun> {
    let points = &trace.points_mm;
    let mut runs = Vec::new();
    let tolerance = fit.tolerance();
    let is_on = |point: &[f64; 2]| fit.outside(*point).abs() <= tolerance;
    let mut from = 0;
    while from < points.len() {
        let rest = &points[from..];
        let Some(first) = rest.iter().position(is_on) else {
            break;
        };
        let length = rest[first..].iter().position(|point| !is_on(point));
        let begin = from + first;
        let end = length.map_or(points.len(), |length| begin + length);
        split(fit, points, begin..end, &mut runs);
        from = end;
    }
    for run in &mut runs {
        run.run_in = run_in(&run.angles, trace.times_s.get(run.points.clone()));
    }
    runs
}

/// Splits a stretch of points where it turns round.
fn split(fit: &FittedCircle, points: &[[f64; 2]], stretch: Range<usize>, runs: &mut Vec<PathRun>) {
    let offset = stretch.start;
    let angles = unwrapped(fit, &points[stretch]);
    let mut from = 0;
    // The farthest places in both directions since `from`.
    let [mut most, mut least] = [0, 0];
    let mut way = None;
    let mut push = |way: Option<Direction>, from: usize, to: usize| {
        let Some(direction) = way else { return };
        let sign = direction.sign();
        runs.push(PathRun {
            direction,
            points: offset + from..offset + to + 1,
            angles: (from..=to)
                .map(|at| sign * (angles[at] - angles[from]))
                .collect(),
            run_in: [0.0; 2],
            begin: fit.angle(points[offset + from]),
        });
    };
    for (at, &angle) in angles.iter().enumerate() {
        if angle > angles[most] {
            most = at;
        }
        if angle < angles[least] {
            least = at;
        }
        let rose = angle - angles[least] > TURNED_ROUND;
        let fell = angles[most] - angle > TURNED_ROUND;
        match way {
            None | Some(Direction::Cw) if rose => {
                push(way, from, least);
                (from, way) = (least, Some(Direction::Ccw));
                most = at;
            }
            None | Some(Direction::Ccw) if fell => {
                push(way, from, most);
                (from, way) = (most, Some(Direction::Cw));
                least = at;
            }
            Some(Direction::Ccw) => least = most,
            Some(Direction::Cw) => most = least,
            None => {}
        }
    }
    push(way, from, angles.len() - 1);
}

/// Returns the angle of each point since the first, turns counted, in radians.
fn unwrapped(fit: &FittedCircle, points: &[[f64; 2]]) -> Vec<f64> {
    let mut turned = 0.0;
    let mut last = None;
    let angle = |&point: &[f64; 2]| {
        let angle = fit.angle(point);
        if let Some(last) = last.replace(angle) {
            let way: f64 = angle - last;
            turned += way - TAU * (way / TAU).round();
        }
        turned
    };
    points.iter().map(angle).collect()
}

impl PathRun {
    /// Returns the angle that the run covers, in radians.
    pub(super) fn covered(&self) -> f64 {
        self.angles.last().copied().unwrap_or_default()
    }

    /// Returns the angles of some of the points, in radians.
    pub(super) fn angles_of(&self, points: &Range<usize>) -> &[f64] {
        &self.angles[points.start - self.points.start..points.end - self.points.start]
    }

    /// Returns the angle from one point to another, in radians.
    pub(super) fn between(&self, turn: &Range<usize>) -> f64 {
        let at = |point: usize| self.angles[point - self.points.start];
        at(turn.end - 1) - at(turn.start)
    }

    /// Returns the angles between the ends on which the machine speeds up or slows down; the whole run if no turn would
    /// be left.
    fn steady(&self) -> [f64; 2] {
        let [from, to] = [self.run_in[0], self.covered() - self.run_in[1]];
        if to - from < TAU - self.lacking() {
            return [0.0, self.covered()];
        }
        [from, to]
    }

    /// Returns the points between the ends on which the machine speeds up or slows down.
    pub(super) fn steady_points(&self) -> Range<usize> {
        let [begin, end] = self
            .steady()
            .map(|angle| self.angles.partition_point(|it| *it < angle));
        self.points.start + begin..self.points.start + end
    }

    /// Returns the points around a turn up to the ends on which the machine speeds up or slows down, or to a gap.
    pub(super) fn steady_around(&self, turn: &Range<usize>) -> Range<usize> {
        let [from, to] = self.steady();
        let at = |angle: f64| self.angles.partition_point(|it| *it < angle);
        let [mut begin, mut end] = [at(from), at(to)];
        let own = turn.start - self.points.start..turn.end - self.points.start;
        for hole in self.holes() {
            if hole < own.start {
                begin = begin.max(hole + 1);
            } else {
                end = end.min(hole + 1);
            }
        }
        self.points.start + begin.min(own.start)..self.points.start + end.max(own.end)
    }

    /// Returns the points of one full turn: of all turns at constant feed that deviate least from the circle the one
    /// next to the middle of the run. `None` if there is no full turn without a gap.
    pub(super) fn turn(&self, fit: &FittedCircle, points: &[[f64; 2]]) -> Option<Range<usize>> {
        let costs = costs(fit, &points[self.points.clone()]);
        let cost = |turn: &Range<usize>| costs[turn.end - 1] - costs[turn.start];
        let [from, to] = self.steady();
        let is_steady = |turn: &Range<usize>| {
            self.angles[turn.start] >= from && self.angles[turn.end - 1] <= to
        };
        let mut least = f64::INFINITY;
        self.each_turn(|turn| {
            if is_steady(&turn) {
                least = least.min(cost(&turn));
            }
        });
        let most = AS_GOOD * least + TAU * fit.radius * ROUND_MM.powi(4);
        let middle = self.covered() / 2.0;
        let mut best: Option<(f64, Range<usize>)> = None;
        self.each_turn(|turn| {
            let ends = self.angles[turn.start] + self.angles[turn.end - 1];
            let off = (ends / 2.0 - middle).abs();
            let is_nearer = best.as_ref().is_none_or(|(nearest, _)| off < *nearest);
            if is_steady(&turn) && is_nearer && cost(&turn) <= most {
                best = Some((off, turn));
            }
        });
        let (_, turn) = best?;
        Some(self.points.start + turn.start..self.points.start + turn.end)
    }

    /// Returns the whole turns without a gap between the ends of the run, evenly spread; the next one may begin before
    /// one ends. Each begins between two crossings, where there is room for that.
    pub(super) fn turns(&self) -> Vec<Range<usize>> {
        let [before, after] = self.run_in.map(|it| it.max(LEAST));
        let room = self.covered() - before - after - TAU;
        if room < ROOM {
            return Vec::new();
        }
        let begins = begins(before, before + room, self.begin * self.direction.sign());
        let mut begins = begins.into_iter().peekable();
        let mut turns = Vec::new();
        self.each_turn(|turn| {
            if begins
                .next_if(|it| self.angles[turn.start] >= *it)
                .is_some()
            {
                turns.push(self.points.start + turn.start..self.points.start + turn.end);
            }
        });
        turns
    }

    /// Passes on every full turn without a gap, as points of the run.
    fn each_turn(&self, mut take: impl FnMut(Range<usize>)) {
        let angles = &self.angles;
        let mut holes = self.holes().into_iter().peekable();
        let mut end = 0;
        let turn = self.covered().min(TAU) - self.step();
        for from in 0..angles.len() {
            while holes.next_if(|&hole| hole < from).is_some() {}
            while end < angles.len() && angles[end] - angles[from] < turn {
                end += 1;
            }
            if end == angles.len() {
                return;
            }
            if holes.peek().is_none_or(|&hole| hole >= end) {
                take(from..end + 1);
            }
        }
    }

    /// Returns the permitted gap at the ends of a turn: a degree, or a few points.
    pub(super) fn lacking(&self) -> f64 {
        LACKING.max(self.step())
    }

    /// Returns the largest angle from the last point of a turn to its first one: that of a few points.
    fn step(&self) -> f64 {
        #[allow(clippy::cast_precision_loss)] // points of a file
        let mean = self.covered() / (self.angles.len() - 1).max(1) as f64;
        FEW * mean
    }

    /// Returns the points followed by too wide a gap: at a crossing, a degree or a few points are too wide, for a peak
    /// is narrow there (R5.22).
    fn holes(&self) -> Vec<usize> {
        let at_crossing = LACKING.max(FEW * self.usual_step());
        let from_x = self.begin * self.direction.sign();
        let is_hole = |pair: &[f64]| {
            let way = (pair[1] - pair[0]).abs();
            let [from, to] = [pair[0], pair[1]].map(|angle| from_x + angle);
            way > WIDEST_GAP_DEG.to_radians() || (way > at_crossing && is_at_crossing(from, to))
        };
        let pairs = self.angles.windows(2).enumerate();
        let holes = pairs.filter(|(_, pair)| is_hole(pair));
        holes.map(|(at, _)| at).collect()
    }

    /// Returns the median angle from one point to the next.
    fn usual_step(&self) -> f64 {
        let pairs = self.angles.windows(2);
        let mut steps: Vec<f64> = pairs.map(|pair| (pair[1] - pair[0]).abs()).collect();
        let middle = steps.len() / 2;
        if steps.is_empty() {
            return 0.0;
        }
        *steps.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// Returns the missing part of a run without a full turn, in degrees.
    pub(super) fn missing_deg(&self) -> f64 {
        let ways = self.holes().into_iter();
        let ways = ways.map(|at| self.angles[at + 1] - self.angles[at]);
        ways.sum::<f64>().to_degrees()
    }

    /// Returns whether there is a full turn, even with gaps.
    pub(super) fn is_full(&self) -> bool {
        self.covered() >= TAU - self.lacking()
    }
}

/// Returns whether the peak of a crossing is between two angles from X+ in the direction of travel.
fn is_at_crossing(from: f64, to: f64) -> bool {
    let [before, after] = PEAK;
    let next = ((from - after) / QUARTER).floor() + 1.0;
    next * QUARTER - before < to
}

/// Returns the angles at which whole turns begin, from the first to the last that is possible: evenly spread, and
/// between two crossings if there is room. `begin` is the angle from X+ to the beginning in the direction of travel.
fn begins(from: f64, to: f64, begin: f64) -> Vec<f64> {
    let between =
        |angle: f64| ((angle + begin - BETWEEN) / QUARTER).ceil() * QUARTER + BETWEEN - begin;
    let first = between(from);
    let quarters = ((to - first) / QUARTER + 1e-9).floor();
    let [first, step, whole] = if quarters >= 1.0 {
        [first, QUARTER, quarters * QUARTER]
    } else {
        [from, to - from, to - from]
    };
    let turns = (whole / TAU).ceil().max(1.0);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // turns of a file
    let each = 0..=turns as u32;
    each.map(|at| first + (f64::from(at) * whole / turns / step).round() * step)
        .collect()
}

/// Returns the fourth powers of the deviations along the path up to each point: a part off the circle costs by its
/// length, however many points it has, and costs more than glitches do.
fn costs(fit: &FittedCircle, points: &[[f64; 2]]) -> Vec<f64> {
    let mut sum = 0.0;
    let mut last: Option<([f64; 2], f64)> = None;
    let cost = |&point: &[f64; 2]| {
        let power = fit.outside(point).powi(4);
        if let Some((before, power_before)) = last.replace((point, power)) {
            let way = (point[0] - before[0]).hypot(point[1] - before[1]);
            sum += way * f64::midpoint(power, power_before);
        }
        sum
    };
    points.iter().map(cost).collect()
}
