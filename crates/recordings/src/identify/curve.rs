//! The friction curve through the pairs (R6.15).

use frictcomp_physics::linear::solve_linear;
use serde::{Deserialize, Serialize};

use super::pair::Pair;
use super::statistics::count;

/// Friction over speed.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum FrictionCurve {
    /// Coulomb, Stribeck and viscous friction.
    Fit(Fit),
    /// Straight lines through the pairs: speeds in mm/s, friction in drive units.
    Lines(Vec<[f64; 2]>),
}

/// `f(v) = Fc + (Fs - Fc)·exp(-(v/vs)^δ) + fv·v`, the friction in drive units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Fit {
    /// Coulomb friction Fc.
    pub coulomb: f64,
    /// Breakaway friction Fs.
    pub breakaway: f64,
    /// Stribeck velocity vs in mm/s.
    pub stribeck: f64,
    /// Exponent δ.
    pub shape: f64,
    /// Viscous friction fv in drive units per mm/s.
    pub viscous: f64,
    /// The weighted squares of the residuals, per degree of freedom.
    pub chi_square: f64,
}

/// The least error of a pair, as a part of the friction.
const LEAST_ERROR: f64 = 0.002;

/// A fit with larger residuals is not used.
pub(super) const WORST_CHI_SQUARE: f64 = 2.0;

/// Standard errors beyond which residuals weigh less (Huber).
const HUBER: f64 = 1.345;

/// Steps of vs on its logarithmic grid.
const STEPS: u32 = 80;

impl FrictionCurve {
    /// Returns the friction at a speed in mm/s. Below the slowest and above the fastest point of lines the value is
    /// held.
    pub fn at(&self, speed: f64) -> f64 {
        match self {
            Self::Fit(fit) => fit.at(speed),
            Self::Lines(points) => along(points, speed),
        }
    }
}

/// Returns the value of straight lines, held outside.
pub(crate) fn along(points: &[[f64; 2]], x: f64) -> f64 {
    let after = points.partition_point(|point| point[0] < x);
    match (after.checked_sub(1).map(|at| points[at]), points.get(after)) {
        (Some([x0, y0]), Some([x1, y1])) => y0 + (y1 - y0) * (x - x0) / (x1 - x0),
        (Some([_, y]), None) | (None, Some(&[_, y])) => y,
        (None, None) => 0.0,
    }
}

impl Fit {
    /// Returns the friction at a speed in mm/s.
    pub fn at(&self, speed: f64) -> f64 {
        let fading = (-(speed / self.stribeck).powf(self.shape)).exp();
        self.coulomb + (self.breakaway - self.coulomb) * fading + self.viscous * speed
    }
}

/// Points with their errors, of one sign.
struct SignedPoints {
    speeds: Vec<f64>,
    values: Vec<f64>,
    errors: Vec<f64>,
}

/// Returns the best fit through the pairs; `None` if there are fewer of them than parameters.
pub(super) fn fit(pairs: &[Pair]) -> Option<Fit> {
    if pairs.len() < 4 {
        return None;
    }
    // If the torque opposes the speed, all of it is inverted.
    let sign = pairs.iter().map(|pair| pair.friction).sum::<f64>().signum();
    let points = SignedPoints {
        speeds: pairs.iter().map(|pair| pair.speed).collect(),
        values: pairs.iter().map(|pair| sign * pair.friction).collect(),
        errors: pairs
            .iter()
            .map(|pair| pair.error.hypot(LEAST_ERROR * pair.friction).max(1e-9))
            .collect(),
    };
    let (slowest, fastest) = (points.speeds[0], points.speeds[points.speeds.len() - 1]);
    let (low, high) = (slowest / 3.0, fastest);
    let mut best: Option<Fit> = None;
    for shape in [1.0, 2.0] {
        let try_at = |logarithm: f64| points.solve(logarithm.exp(), shape);
        let (from, to) = (low.ln(), high.ln());
        let step = (to - from) / f64::from(STEPS);
        let on_grid = (0..=STEPS).map(|at| from + f64::from(at) * step);
        let Some((at, start)) = on_grid
            .filter_map(|at| try_at(at).map(|fit| (at, fit)))
            .min_by(|one, other| one.1.chi_square.total_cmp(&other.1.chi_square))
        else {
            continue;
        };
        let found = refined(at, start, step, try_at);
        if best.is_none_or(|best| found.chi_square < best.chi_square) {
            best = Some(found);
        }
    }
    let mut best = best?;
    best.coulomb *= sign;
    best.breakaway *= sign;
    best.viscous *= sign;
    Some(best)
}

/// Returns the best place between the neighbours of a place on the grid, by the golden section.
fn refined(at: f64, start: Fit, step: f64, try_at: impl Fn(f64) -> Option<Fit>) -> Fit {
    const GOLDEN: f64 = 0.618_033_988_75;
    let (mut low, mut high) = (at - step, at + step);
    let mut best = start;
    for _ in 0..40 {
        let [left, right] = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        let (Some(one), Some(other)) = (try_at(left), try_at(right)) else {
            break;
        };
        if one.chi_square < other.chi_square {
            high = right;
        } else {
            low = left;
        }
        for found in [one, other] {
            if found.chi_square < best.chi_square {
                best = found;
            }
        }
    }
    best
}

impl SignedPoints {
    /// Returns the linear parameters for one vs: Fc above 0, Fs not below Fc, fv not below 0; repeated with less weight
    /// for outliers.
    fn solve(&self, stribeck: f64, shape: f64) -> Option<Fit> {
        let rows: Vec<[f64; 3]> = self
            .speeds
            .iter()
            .map(|&speed| [1.0, (-(speed / stribeck).powf(shape)).exp(), speed])
            .collect();
        let mut weights: Vec<f64> = self
            .errors
            .iter()
            .map(|error| 1.0 / (error * error))
            .collect();
        let mut found = None;
        for _ in 0..4 {
            let [coulomb, more, viscous] = self.least_squares(&rows, &weights)?;
            let mut squares = 0.0;
            for (at, row) in rows.iter().enumerate() {
                let model = coulomb * row[0] + more * row[1] + viscous * row[2];
                let off = ((self.values[at] - model) / self.errors[at]).abs();
                let huber = if off > HUBER { HUBER / off } else { 1.0 };
                weights[at] = huber / (self.errors[at] * self.errors[at]);
                squares += huber * off * off;
            }
            let freedom = count(rows.len().saturating_sub(4).max(1));
            found = Some(Fit {
                coulomb,
                breakaway: coulomb + more,
                stribeck,
                shape,
                viscous,
                chi_square: squares / freedom,
            });
        }
        found
    }

    /// Fits weighted least squares with Fs - Fc and fv not negative: the best of all choices of those that are 0.
    fn least_squares(&self, rows: &[[f64; 3]], weights: &[f64]) -> Option<[f64; 3]> {
        const CHOICES: [&[usize]; 4] = [&[0, 1, 2], &[0, 1], &[0, 2], &[0]];
        let mut best: Option<(f64, [f64; 3])> = None;
        for choice in CHOICES {
            let Some(found) = self.solve_some(rows, weights, choice) else {
                continue;
            };
            if found[0] <= 0.0 || found[1] < 0.0 || found[2] < 0.0 {
                continue;
            }
            let squares: f64 = rows
                .iter()
                .enumerate()
                .map(|(at, row)| {
                    let model: f64 = (0..3).map(|it| found[it] * row[it]).sum();
                    weights[at] * (self.values[at] - model).powi(2)
                })
                .sum();
            if best.is_none_or(|(least, _)| squares < least) {
                best = Some((squares, found));
            }
        }
        best.map(|(_, found)| found)
    }

    fn solve_some(&self, rows: &[[f64; 3]], weights: &[f64], choice: &[usize]) -> Option<[f64; 3]> {
        let size = choice.len();
        let mut matrix = vec![vec![0.0; size + 1]; size];
        for (at, row) in rows.iter().enumerate() {
            for (i, &one) in choice.iter().enumerate() {
                for (j, &other) in choice.iter().enumerate() {
                    matrix[i][j] += weights[at] * row[one] * row[other];
                }
                matrix[i][size] += weights[at] * row[one] * self.values[at];
            }
        }
        let solved = solve_linear(matrix)?;
        let mut found = [0.0; 3];
        for (&at, value) in choice.iter().zip(solved) {
            found[at] = value;
        }
        Some(found)
    }
}
