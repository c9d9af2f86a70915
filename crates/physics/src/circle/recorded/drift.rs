//! The shift of a recorded circle from turn to turn (R5.28).

use std::f64::consts::TAU;

use super::cut::Run;
use super::fit::Fit;
use crate::circle::linear::Normal;

/// Parts of a turn in which two turns are compared.
const PARTS: u16 = 360;

/// Parts of a block for the standard error: neighbours may be alike.
const BLOCK: u16 = 8;

/// A shift counts from so many standard errors on …
const SIGNIFICANT: f64 = 3.0;

/// … and from this size on, in mm.
const LEAST_MM: f64 = 0.0005;

/// A steady shift of both axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::circle) struct Drift {
    /// The shift in mm a turn.
    pub(in crate::circle) per_turn_mm: [f64; 2],
    /// Its standard error.
    pub(in crate::circle) error_mm: [f64; 2],
}

/// Sums over the points in one part of a turn.
#[derive(Debug, Clone, Copy, Default)]
struct Part {
    count: f64,
    angle: f64,
    outside: f64,
}

impl Part {
    fn add(&mut self, angle: f64, outside: f64) {
        self.count += 1.0;
        self.angle += angle;
        self.outside += outside;
    }

    fn means(self) -> Option<(f64, f64)> {
        (self.count > 0.0).then(|| (self.angle / self.count, self.outside / self.count))
    }
}

impl Drift {
    /// The shift between the first and the last turn of a run: what both have alike, such as glitches,
    /// backlash or a periodic error, falls out of it. `None` where there are no two turns, or where
    /// they do not show one.
    pub(super) fn over(run: &Run, fit: &Fit, points: &[[f64; 2]]) -> Option<Self> {
        let covered = run.covered();
        if covered < 2.0 * TAU - run.lacking() {
            return None;
        }
        let mut first = vec![Part::default(); usize::from(PARTS)];
        let mut last = first.clone();
        for (point, angle) in points[run.points.clone()].iter().zip(run.angles()) {
            let at = part_of(fit.angle(*point));
            let outside = fit.outside(*point);
            if angle < TAU {
                first[at].add(angle, outside);
            }
            if angle >= covered - TAU {
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
        Self::fit(&differences).filter(Self::is_carried)
    }

    fn fit(differences: &[([f64; 3], f64)]) -> Option<Self> {
        let mut normal = Normal::<3>::new();
        for &(row, value) in differences {
            normal.add(row, value);
        }
        let spreads = normal.spreads()?;
        let found = normal.solve()?;
        let model = |row: &[f64; 3]| {
            row.iter()
                .zip(found)
                .map(|(part, size)| part * size)
                .sum::<f64>()
        };
        let blocks = differences.chunks_exact(usize::from(BLOCK)).map(|block| {
            let sum: f64 = block.iter().map(|(row, value)| value - model(row)).sum();
            sum * sum / f64::from(BLOCK)
        });
        let (count, sum) = blocks.fold((0.0, 0.0), |(count, sum), it| (count + 1.0, sum + it));
        let variance = sum / f64::max(count, 1.0);
        Some(Self {
            per_turn_mm: [found[1], found[2]],
            error_mm: [1, 2].map(|at| (spreads[at] * variance).sqrt()),
        })
    }

    fn is_carried(&self) -> bool {
        let each = self.per_turn_mm.iter().zip(self.error_mm);
        each.into_iter()
            .any(|(shift, error)| shift.abs() > (SIGNIFICANT * error).max(LEAST_MM))
    }

    /// Points on which the circle stands still, as in the middle of a turn; each has its angle along
    /// the run.
    pub(super) fn removed(&self, points: &[[f64; 2]], angles: &[f64]) -> Vec<[f64; 2]> {
        let ends = [angles.first(), angles.last()].map(|it| it.copied().unwrap_or_default());
        let middle = f64::midpoint(ends[0], ends[1]);
        points
            .iter()
            .zip(angles)
            .map(|(point, angle)| {
                let turns = (angle - middle) / TAU;
                [0, 1].map(|axis| point[axis] - turns * self.per_turn_mm[axis])
            })
            .collect()
    }
}

fn part_of(angle: f64) -> usize {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 to 359
    let at = (angle.rem_euclid(TAU) / TAU * f64::from(PARTS)) as usize;
    at.min(usize::from(PARTS) - 1)
}

fn angle_of(part: u16) -> f64 {
    (f64::from(part) + 0.5) / f64::from(PARTS) * TAU
}
