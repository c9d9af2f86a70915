//! Systems of linear equations: any of them by [`solve_linear`], and the normal equations of fits with a few unknowns,
//! whose positive matrix needs no search for pivots.

/// The normal equations of a fit with `N` unknowns.
#[derive(Debug, Clone)]
pub(crate) struct Normal<const N: usize> {
    matrix: [[f64; N]; N],
    right: [f64; N],
}

/// Least pivot as a part of its row's diagonal; a smaller one leaves an unknown undetermined.
const LEAST_PIVOT: f64 = 1e-12;

impl<const N: usize> Normal<N> {
    pub(crate) fn new() -> Self {
        Self {
            matrix: [[0.0; N]; N],
            right: [0.0; N],
        }
    }

    /// Takes an equation: the unknowns times `row` make `value`.
    pub(crate) fn add(&mut self, row: [f64; N], value: f64) {
        for (at, sums) in self.matrix.iter_mut().enumerate() {
            if row[at] == 0.0 {
                continue;
            }
            for (sum, factor) in sums.iter_mut().zip(row) {
                *sum += row[at] * factor;
            }
            self.right[at] += row[at] * value;
        }
    }

    /// Holds unknowns without an equation at 0.
    pub(crate) fn hold_unused(&mut self) {
        for at in 0..N {
            if self.matrix[at][at] == 0.0 {
                self.matrix[at][at] = 1.0;
            }
        }
    }

    /// Returns the unknowns of the same equations with other values, given as their sums with each row.
    pub(crate) fn solve_for(&self, right: [f64; N]) -> Option<[f64; N]> {
        let matrix = self.matrix;
        Self { matrix, right }.solve()
    }

    /// Adds the equations of another fit a number of times.
    pub(crate) fn add_times(&mut self, other: &Self, times: f64) {
        for (sums, row) in self.matrix.iter_mut().zip(&other.matrix) {
            for (sum, it) in sums.iter_mut().zip(row) {
                *sum += times * it;
            }
        }
        for (sum, it) in self.right.iter_mut().zip(other.right) {
            *sum += times * it;
        }
    }

    /// Returns the square root of the diagonal at an unknown: its effect on all values.
    pub(crate) fn scale(&self, unknown: usize) -> f64 {
        self.matrix[unknown][unknown].sqrt()
    }

    /// Returns the variances of the unknowns for values of the variance 1, one independent of the other.
    pub(crate) fn spreads(&self) -> Option<[f64; N]> {
        let mut spreads = [0.0; N];
        for (at, spread) in spreads.iter_mut().enumerate() {
            let mut unit = [0.0; N];
            unit[at] = 1.0;
            *spread = self.solve_for(unit)?[at];
        }
        Some(spreads)
    }

    /// Returns the unknowns, by elimination; `None` if the equations do not determine them. The matrix is positive, so
    /// that its diagonal gives the pivots.
    pub(crate) fn solve(mut self) -> Option<[f64; N]> {
        let diagonal: [f64; N] = std::array::from_fn(|at| self.matrix[at][at]);
        for (at, whole) in diagonal.into_iter().enumerate() {
            let pivot = self.matrix[at][at];
            let is_firm = pivot > LEAST_PIVOT * whole;
            if !is_firm {
                return None;
            }
            for below in at + 1..N {
                let factor = self.matrix[below][at] / pivot;
                for column in at..N {
                    self.matrix[below][column] -= factor * self.matrix[at][column];
                }
                self.right[below] -= factor * self.right[at];
            }
        }
        let mut unknowns = [0.0; N];
        for at in (0..N).rev() {
            let known: f64 = (at + 1..N)
                .map(|column| self.matrix[at][column] * unknowns[column])
                .sum();
            unknowns[at] = (self.right[at] - known) / self.matrix[at][at];
        }
        unknowns.iter().all(|it| it.is_finite()).then_some(unknowns)
    }
}

/// Solves a system of linear equations, the right side in the last column of each row; `None` if
/// it has no single solution.
pub fn solve_linear(rows: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let solved = solve_systems(rows)?;
    Some(solved.into_iter().map(|row| row[0]).collect())
}

/// Returns the inverse of a square matrix, if it has one.
pub fn inverse(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let unit = |at: usize| (0..matrix.len()).map(move |it| if it == at { 1.0 } else { 0.0 });
    let rows = matrix.iter().enumerate();
    solve_systems(
        rows.map(|(at, row)| row.iter().copied().chain(unit(at)).collect())
            .collect(),
    )
}

/// Solves systems of linear equations with one matrix, their right sides in the columns after it: a row
/// of results for each unknown.
fn solve_systems(mut rows: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
    let size = rows.len();
    let scale: Vec<f64> = (0..size).map(|at| rows[at][at].abs().max(1e-300)).collect();
    for column in 0..size {
        let pivot = (column..size)
            .max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs()))?;
        rows.swap(column, pivot);
        let head = rows[column][column];
        if !head.is_finite() || head.abs() <= 1e-13 * scale[column] {
            return None;
        }
        let above = rows[column].clone();
        for (at, row) in rows.iter_mut().enumerate() {
            if at == column || row[column] == 0.0 {
                continue;
            }
            let factor = row[column] / head;
            for (value, above) in row.iter_mut().zip(&above).skip(column) {
                *value -= factor * above;
            }
        }
    }
    let solved = rows.into_iter().enumerate();
    Some(
        solved
            .map(|(at, row)| row[size..].iter().map(|it| it / row[at]).collect())
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_through_its_points_is_found() {
        let mut normal = Normal::new();
        for x in [-2.0, -1.0, 0.0, 1.0, 3.0] {
            normal.add([1.0, x, x * x], 4.0 - 3.0 * x + 0.5 * x * x);
        }
        let found = normal.solve().unwrap();
        for (found, expected) in found.into_iter().zip([4.0, -3.0, 0.5]) {
            assert!((found - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn what_is_not_determined_is_not_guessed() {
        let mut normal = Normal::new();
        for x in [1.0, 2.0, 3.0] {
            normal.add([x, 2.0 * x], x);
        }
        assert_eq!(normal.solve(), None);
    }
}
