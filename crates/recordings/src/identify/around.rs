//! Signals around reversals, and what all reversals have in common.
//!
//! Noise of an encoder is in the following error and, through its derivative, larger in the output of the
//! loops: a least-squares fit of the torque to a noisy error underestimates the error's effect. What a
//! signal does in time after *other* reversals is free of the noise of this one. Each signal is therefore
//! replaced by what the other reversals predict of it (instrumental variables, the instruments of each
//! window fitted without it).

use super::statistics::count;
use frictcomp_physics::linear::inverse;

/// A window around a reversal.
#[derive(Debug, Clone, Copy)]
pub(super) struct SignalWindow {
    pub(super) from: usize,
    pub(super) turn: usize,
    pub(super) to: usize,
}

/// Instruments for signals around reversals: time since the reversal, motion, the list.
pub(super) struct Instruments {
    /// Rows of each window.
    rows: Vec<Vec<Vec<f64>>>,
    /// Products of the instruments in each window.
    products: Vec<Vec<Vec<f64>>>,
    /// Inverse for the other windows, for each window.
    others: Vec<Vec<Vec<f64>>>,
    /// The inverse for all windows.
    all: Vec<Vec<f64>>,
}

/// Knots of time after a reversal in s; a signal is linear between them.
const KNOTS_S: [f64; 20] = [
    -0.02, -0.008, -0.004, -0.002, -0.001, 0.0, 0.001, 0.002, 0.003, 0.004, 0.006, 0.008, 0.011,
    0.015, 0.02, 0.028, 0.04, 0.06, 0.09, 0.15,
];

/// Term that keeps products of nearly equal instruments from being singular.
const NEARLY: f64 = 1e-7;

impl Instruments {
    /// Creates the instruments of windows; `known` returns the noise-free signals of a sample.
    pub(super) fn new(
        windows: &[SignalWindow],
        (step_s, signs): (f64, &[f64]),
        known: impl Fn(usize) -> Vec<f64>,
    ) -> Option<Self> {
        let row = |window: &SignalWindow, at: usize| {
            #[allow(clippy::cast_precision_loss)] // some hundred samples
            let time_s = (at as f64 - window.turn as f64) * step_s;
            let mut row = known(at);
            row.extend(shares_of_knots(time_s).map(|it| it * signs[window.turn]));
            row
        };
        let rows: Vec<Vec<Vec<f64>>> = windows
            .iter()
            .map(|it| (it.from..it.to).map(|at| row(it, at)).collect())
            .collect();
        let products: Vec<Vec<Vec<f64>>> = rows.iter().map(|rows| products_of(rows)).collect();
        let mut total = products.first()?.clone();
        for more in &products[1..] {
            add(&mut total, more, 1.0);
        }
        let others = products.iter().map(|own| {
            let mut others = total.clone();
            add(&mut others, own, -1.0);
            inverse(&steadied(others))
        });
        Some(Self {
            others: others.collect::<Option<_>>()?,
            all: inverse(&steadied(total))?,
            rows,
            products,
        })
    }

    /// Returns a signal in all windows, divided by its size.
    pub(super) fn column(
        &self,
        windows: &[SignalWindow],
        signal: impl Fn(usize) -> f64,
    ) -> SignalAround {
        let mut values: Vec<Vec<f64>> = windows
            .iter()
            .map(|it| (it.from..it.to).map(&signal).collect())
            .collect();
        let all = || values.iter().flatten();
        let size = (all().map(|it| it * it).sum::<f64>() / count(all().count())).sqrt();
        let size = if size > 0.0 { size } else { 1.0 };
        for value in values.iter_mut().flatten() {
            *value /= size;
        }
        let moments: Vec<Vec<f64>> = self
            .rows
            .iter()
            .zip(&values)
            .map(|(rows, values)| {
                let mut moments = vec![0.0; rows[0].len()];
                for (row, value) in rows.iter().zip(values) {
                    for (moment, one) in moments.iter_mut().zip(row) {
                        *moment += one * value;
                    }
                }
                moments
            })
            .collect();
        let mut total = vec![0.0; moments[0].len()];
        for one in &moments {
            for (sum, value) in total.iter_mut().zip(one) {
                *sum += value;
            }
        }
        let expected: Vec<Vec<f64>> = self
            .others
            .iter()
            .zip(&moments)
            .map(|(others, own)| {
                let rest: Vec<f64> = total.iter().zip(own).map(|(all, own)| all - own).collect();
                times(others, &rest)
            })
            .collect();
        let spread = self.products.iter().zip(&expected);
        let spread = spread.map(|(products, it)| times(products, it)).collect();
        SignalAround {
            values,
            size,
            moments,
            total,
            expected,
            spread,
        }
    }

    /// Returns the squares of the part of a signal with these moments that the instruments find.
    pub(super) fn found_in(&self, moments: &[f64]) -> f64 {
        dot(moments, &times(&self.all, moments))
    }
}

/// A signal around reversals.
pub(super) struct SignalAround {
    /// Samples of each window, divided by the size.
    pub(super) values: Vec<Vec<f64>>,
    pub(super) size: f64,
    /// Products with the instruments in each window.
    moments: Vec<Vec<f64>>,
    /// Sum of the products.
    pub(super) total: Vec<f64>,
    /// Prediction of the other windows for each window, by instrument.
    expected: Vec<Vec<f64>>,
    /// The products of the instruments with that.
    spread: Vec<Vec<f64>>,
}

impl SignalAround {
    /// Returns the product of the prediction of this signal with another signal.
    pub(super) fn expected_with(&self, other: &Self) -> f64 {
        let pairs = self.expected.iter().zip(&other.moments);
        pairs.map(|(one, other)| dot(one, other)).sum()
    }

    /// Returns the product of the predictions of both.
    pub(super) fn both_expected(&self, other: &Self) -> f64 {
        let pairs = self.expected.iter().zip(&other.spread);
        pairs.map(|(one, other)| dot(one, other)).sum()
    }
}

pub(super) fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

fn times(matrix: &[Vec<f64>], vector: &[f64]) -> Vec<f64> {
    matrix.iter().map(|row| dot(row, vector)).collect()
}

fn add(sum: &mut [Vec<f64>], more: &[Vec<f64>], factor: f64) {
    for (sum, more) in sum.iter_mut().flatten().zip(more.iter().flatten()) {
        *sum += factor * more;
    }
}

fn steadied(mut matrix: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    for (at, row) in matrix.iter_mut().enumerate() {
        row[at] = row[at] * (1.0 + NEARLY) + NEARLY * NEARLY;
    }
    matrix
}

fn products_of(rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let size = rows[0].len();
    let mut products = vec![vec![0.0; size]; size];
    for row in rows {
        for (sums, one) in products.iter_mut().zip(row).filter(|it| *it.1 != 0.0) {
            for (sum, other) in sums.iter_mut().zip(row) {
                *sum += one * other;
            }
        }
    }
    products
}

/// Returns the share of each knot at a time; they add up to 1.
fn shares_of_knots(time_s: f64) -> [f64; KNOTS_S.len()] {
    let mut shares = [0.0; KNOTS_S.len()];
    let after = KNOTS_S.partition_point(|knot| *knot <= time_s);
    if after == 0 {
        shares[0] = 1.0;
    } else if after == KNOTS_S.len() {
        shares[after - 1] = 1.0;
    } else {
        let (from, to) = (KNOTS_S[after - 1], KNOTS_S[after]);
        shares[after] = (time_s - from) / (to - from);
        shares[after - 1] = 1.0 - shares[after];
    }
    shares
}
