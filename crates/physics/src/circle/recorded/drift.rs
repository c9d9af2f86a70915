//! The shift between the first and the last turn of a recorded circle (R5.28).

use std::f64::consts::TAU;
use std::ops::Range;

use super::cut::PathRun;
use super::fit::FittedCircle;
use crate::circle::geometry::CircleDrift;

/// Parts of a turn in which two turns are compared.
const PARTS: u16 = 360;

/// Turns at constant feed that show a shift; the ends at rest are left out of the whole.
const LEAST_TURNS: f64 = 1.5;

/// Sums over the points in one part of a turn.
#[derive(Debug, Clone, Copy, Default)]
struct TurnPart {
    count: f64,
    angle: f64,
    outside: f64,
}

impl TurnPart {
    fn add(&mut self, angle: f64, outside: f64) {
        self.count += 1.0;
        self.angle += angle;
        self.outside += outside;
    }

    fn means(self) -> Option<(f64, f64)> {
        (self.count > 0.0).then(|| (self.angle / self.count, self.outside / self.count))
    }
}

/// Returns the shift between the first and the last turn of a run: what both have in common, such as glitches, backlash
/// or a periodic error, cancels out. `None` if there are not two turns, or if they do not show a shift.
pub(super) fn drift(
    (run, steady): (&PathRun, &Range<usize>),
    fit: &FittedCircle,
    points: &[[f64; 2]],
) -> Option<CircleDrift> {
    let angles = run.angles_of(steady);
    let [begin, .., end] = *angles else {
        return None;
    };
    let covered = end - begin;
    if run.covered() < 2.0 * TAU - run.lacking() || covered < LEAST_TURNS * TAU {
        return None;
    }
    // Only the angles that two turns at constant feed have in common are used.
    let [until, from] = [TAU.min(covered - TAU), TAU.max(covered - TAU)];
    let mut first = vec![TurnPart::default(); usize::from(PARTS)];
    let mut last = first.clone();
    for (point, angle) in points[steady.clone()].iter().zip(angles) {
        let angle = angle - begin;
        let at = part_of(fit.angle(*point));
        let outside = fit.outside(*point);
        if angle < until {
            first[at].add(angle, outside);
        }
        if angle >= from {
            last[at].add(angle, outside);
        }
    }
    let differences: Vec<([f64; 3], f64)> = (0..PARTS)
        .zip(first.into_iter().zip(last))
        .filter_map(|(at, (first, last))| {
            let ((from, before), (to, after)) = (first.means()?, last.means()?);
            let (sin, cos) = angle_of(at).sin_cos();
            let turns = (to - from) / TAU;
            Some(([1.0, turns * cos, turns * sin], after - before))
        })
        .collect();
    CircleDrift::shown(&differences)
}

fn part_of(angle: f64) -> usize {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 to 359
    let at = (angle.rem_euclid(TAU) / TAU * f64::from(PARTS)) as usize;
    at.min(usize::from(PARTS) - 1)
}

fn angle_of(part: u16) -> f64 {
    (f64::from(part) + 0.5) / f64::from(PARTS) * TAU
}
