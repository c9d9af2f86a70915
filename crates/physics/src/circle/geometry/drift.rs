//! A shift of a circle from turn to turn (R5.28).

use std::f64::consts::TAU;

use crate::linear::Normal;

/// Number of differences in a block for the standard error: neighbours may be alike.
const BLOCK: u16 = 8;

/// Number of standard errors from which a shift counts …
const SIGNIFICANT: f64 = 3.0;

/// … if it also has this size, in mm.
const LEAST_MM: f64 = 0.0005;

/// A steady shift of both axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CircleDrift {
    /// The shift in mm per turn.
    pub(crate) per_turn_mm: [f64; 2],
    /// Standard error.
    pub(crate) error_mm: [f64; 2],
}

impl CircleDrift {
    /// Returns the shift shown by differences between two turns, each with the effects of a constant and of a shift of
    /// either axis; `None` if they do not show one.
    pub(crate) fn shown(differences: &[([f64; 3], f64)]) -> Option<Self> {
        Self::fit(differences).filter(Self::is_carried)
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

    /// Points of a circle without its shift, as in the middle of a turn; each has its angle along
    /// the run.
    pub(crate) fn removed(&self, points: &[[f64; 2]], angles: &[f64]) -> Vec<[f64; 2]> {
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
