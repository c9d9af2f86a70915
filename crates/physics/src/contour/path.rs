//! The commanded path as points, and the distance of a place from it (R11.3).

use std::collections::VecDeque;

use super::options::MOST_AXES;

/// A place of all axes in mm; those that are not driven are 0.
pub(super) type Places = [f64; MOST_AXES];

/// Points that are closer together are one, in mm.
const SAME: f64 = 1e-7;

/// Largest angle between two steps in one direction, in rad.
const STRAIGHT: f64 = 1e-9;

/// The cosine of the largest angle by which a curve turns from point to point; anything else is a
/// corner.
const CORNER_COSINE: f64 = 0.955;

#[derive(Debug, Clone, Copy)]
struct PathPoint {
    place: Places,
    /// The change of the direction of the path with the distance here, by axis.
    bend: Places,
    /// Direction of the last turn: 1 to the left, -1 to the right.
    side: f64,
    /// Whether the path has a corner here, in any plane.
    is_corner: bool,
}

/// Distance of a place from the path.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Distance {
    /// Distance in the plane, in mm: positive on the outside of the curve.
    pub(super) plane: f64,
    /// Vector from the nearest point of the path to the place, by axis.
    pub(super) normal: Places,
    /// The length of that in mm: the deviation in space (R11.27).
    pub(super) space: f64,
}

/// The part of the commanded path that is needed.
#[derive(Debug, Clone)]
pub(super) struct CommandedPath {
    points: VecDeque<PathPoint>,
    /// Number of points before the commanded one among which the nearest may be.
    back: u64,
    /// The number of the first of the points.
    first: u64,
    /// Length of the longest step so far, in mm.
    longest: f64,
}

fn minus(one: &Places, other: &Places) -> Places {
    std::array::from_fn(|axis| one[axis] - other[axis])
}

fn dot(one: &Places, other: &Places) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

impl CommandedPath {
    /// Creates a path that places follow within this many cycles.
    pub(super) fn new(back: u64) -> Self {
        Self {
            points: VecDeque::new(),
            back,
            first: 0,
            longest: 0.0,
        }
    }

    /// Forgets the path: the next point is the first one.
    pub(super) fn restart(&mut self) {
        self.first = self.last() + 1;
        self.points.clear();
        self.longest = 0.0;
    }

    /// Returns the number of the last point.
    fn last(&self) -> u64 {
        let count = u64::try_from(self.points.len()).unwrap_or(u64::MAX);
        (self.first + count).saturating_sub(1)
    }

    fn at(&self, number: u64) -> Option<&PathPoint> {
        let position = number.checked_sub(self.first)?;
        self.points.get(usize::try_from(position).ok()?)
    }

    /// Moves on to a place, and returns the number of the point that represents it.
    pub(super) fn push(&mut self, place: Places) -> u64 {
        let Some(last) = self.points.back() else {
            self.points.push_back(PathPoint {
                place,
                bend: Places::default(),
                side: 1.0,
                is_corner: false,
            });
            return self.last();
        };
        let step = minus(&place, &last.place);
        let square = dot(&step, &step);
        if square < SAME * SAME {
            return self.last();
        }
        self.longest = self.longest.max(square.sqrt());
        let mut side = last.side;
        let mut bend = Places::default();
        let mut is_corner = false;
        if let Some(before) = self.points.len().checked_sub(2).map(|at| &self.points[at]) {
            let came = minus(&last.place, &before.place);
            let cross = came[0] * step[1] - came[1] * step[0];
            let turn = cross.atan2(came[0] * step[0] + came[1] * step[1]);
            if turn.abs() > STRAIGHT && turn.abs() < 3.0 {
                side = turn.signum();
            }
            let (before, after) = (dot(&came, &came).sqrt(), dot(&step, &step).sqrt());
            is_corner = dot(&came, &step) < CORNER_COSINE * before * after;
            let mean = f64::midpoint(before, after);
            bend = std::array::from_fn(|axis| (step[axis] / after - came[axis] / before) / mean);
        }
        if let Some(last) = self.points.back_mut() {
            last.bend = bend;
            last.side = side;
            last.is_corner = is_corner;
        }
        self.points.push_back(PathPoint {
            place,
            bend: Places::default(),
            side,
            is_corner: false,
        });
        self.last()
    }

    /// Forgets the points long before one.
    pub(super) fn forget_before(&mut self, number: u64) {
        while self.points.len() > 2 && self.first + self.back < number {
            self.points.pop_front();
            self.first += 1;
        }
    }

    /// Returns the distance of a place from the path near the point that was commanded. `near` is the number of the
    /// nearest point a cycle before, and becomes the current one.
    pub(super) fn distance(&self, place: &Places, (near, commanded): (&mut u64, u64)) -> Distance {
        let lowest = self.first;
        let highest = self.last().saturating_sub(1);
        if self.points.len() < 2 {
            let error = self.points.front().map(|only| minus(place, &only.place));
            let normal = error.unwrap_or_default();
            return Distance {
                plane: 0.0,
                normal,
                space: dot(&normal, &normal).sqrt(),
            };
        }
        // It never goes back along the path: where a path returns over itself, the place would be
        // found on the stretch that was passed before. After a corner the next step may be further
        // away and the one after it nearer, so every step within the lag is compared.
        let from = commanded.saturating_sub(self.back).clamp(lowest, highest);
        let mut at = (*near).clamp(from, highest);
        let mut best = self.project(at, place);
        let mut number = at + 1;
        while number <= highest {
            let next = self.project(number, place);
            if next.square < best.square {
                (at, best) = (number, next);
            }
            number += 1 + self.further(&next, &best);
        }
        *near = at;
        self.signed(at, &best)
    }

    /// Returns the number of steps after a foot that are too short to come nearer than the best one.
    fn further(&self, foot: &Foot, best: &Foot) -> u64 {
        let steps = (foot.square.sqrt() - best.square.sqrt()) / self.longest;
        // The foot may be at the beginning of its step, and a step ends where the next one begins.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        // at most the points kept
        let further = (steps - 1.001).max(0.0) as u64;
        further
    }

    /// Returns the foot of a place on the step that begins at a point.
    fn project(&self, number: u64, place: &Places) -> Foot {
        let (Some(from), Some(to)) = (self.at(number), self.at(number + 1)) else {
            return Foot::default();
        };
        let step = minus(&to.place, &from.place);
        let length = dot(&step, &step);
        let offset = minus(place, &from.place);
        let share = (dot(&offset, &step) / length).clamp(0.0, 1.0);
        let error: Places = std::array::from_fn(|axis| offset[axis] - share * step[axis]);
        Foot {
            square: dot(&error, &error),
            share,
            error,
        }
    }

    fn signed(&self, number: u64, foot: &Foot) -> Distance {
        let (Some(from), Some(to)) = (self.at(number), self.at(number + 1)) else {
            return Distance::default();
        };
        let step = minus(&to.place, &from.place);
        // Where the path ends or turns back, a place beyond its end is not a deviation from it.
        let square = dot(&step, &step);
        let along = dot(&foot.error, &step) / square;
        let mut normal: Places = std::array::from_fn(|axis| foot.error[axis] - along * step[axis]);
        // A curve bulges beyond the chord from point to point.
        if !from.is_corner && !to.is_corner {
            let bulge = foot.share * (1.0 - foot.share) * square / 4.0;
            for (axis, normal) in normal.iter_mut().enumerate() {
                *normal += bulge * (from.bend[axis] + to.bend[axis]);
            }
        }
        let space = dot(&normal, &normal).sqrt();
        let length = step[0].hypot(step[1]);
        if length < SAME {
            return Distance {
                plane: normal[0].hypot(normal[1]),
                normal,
                space,
            };
        }
        let left = (step[0] * normal[1] - step[1] * normal[0]) / length;
        Distance {
            plane: -left * from.side,
            normal,
            space,
        }
    }
}

/// The foot of a place on a step of the path.
#[derive(Debug, Clone, Copy, Default)]
struct Foot {
    square: f64,
    share: f64,
    error: Places,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(x: f64, y: f64) -> Places {
        let mut place = Places::default();
        (place[0], place[1]) = (x, y);
        place
    }

    #[test]
    fn outside_of_a_circle_is_positive_in_either_sense() {
        // R11.3
        for sense in [1.0, -1.0] {
            let mut path = CommandedPath::new(60);
            let at =
                |angle: f64, radius: f64| place(radius * angle.cos(), sense * radius * angle.sin());
            for step in 0..200 {
                path.push(at(f64::from(step) * 0.002, 50.0));
            }
            for deviation in [0.01, -0.02, 0.0] {
                let mut near = 0;
                let found = path.distance(&at(0.1511, 50.0 + deviation), (&mut near, 80));
                assert!((found.plane - deviation).abs() < 1e-6, "{}", found.plane);
            }
        }
    }

    #[test]
    fn a_path_that_returns_over_itself_is_followed_in_its_order() {
        let mut path = CommandedPath::new(60);
        let out = (0..100).map(|step| place(f64::from(step) * 0.1, 0.0));
        let back = (0..100).map(|step| place(9.9 - f64::from(step) * 0.1, 0.0));
        let points: Vec<Places> = out.chain(back).collect();
        let numbers: Vec<u64> = points.iter().map(|point| path.push(*point)).collect();
        let mut near = 0;
        for (point, number) in points.iter().zip(numbers) {
            let found = path.distance(point, (&mut near, number));
            assert!(found.plane.abs() < 1e-9);
        }
        assert!(near >= 196, "{near}");
    }

    #[test]
    fn a_corner_is_passed_however_slowly_the_path_leaves_it() {
        let mut path = CommandedPath::new(60);
        let mut points = Vec::new();
        for step in 0..=100 {
            let rest = f64::from(100 - step) / 100.0;
            points.push(place(10.0 - rest * rest * rest, 0.0));
        }
        for step in 1..=300 {
            let gone = f64::from(step) / 300.0;
            let mut point = place(10.0, 0.0);
            point[2] = -6.0 * gone * gone * gone;
            points.push(point);
        }
        let numbers: Vec<u64> = points.iter().map(|point| path.push(*point)).collect();
        let mut near = 0;
        for (at, number) in numbers.iter().enumerate() {
            // The axes lag by five cycles and have overshot the corner.
            let mut actual = points[at.saturating_sub(5)];
            actual[0] += if at > 100 { 0.0138 } else { 0.0 };
            let found = path.distance(&actual, (&mut near, *number));
            assert!(found.normal[2].abs() < 1e-6, "{at}: {}", found.normal[2]);
        }
    }

    #[test]
    fn the_nearest_point_is_sought_and_not_the_commanded_one() {
        let mut path = CommandedPath::new(60);
        for step in 0..100 {
            path.push(place(f64::from(step) * 0.1, 0.0));
        }
        let mut near = 0;
        let found = path.distance(&place(3.25, -0.004), (&mut near, 60));
        assert!((found.plane - 0.004).abs() < 1e-9);
        assert_eq!(near, 32);
    }
}
