//! The smallest peak-to-peak of several curves that depend linearly on a few variables (R5.37).
//!
//! The height of a curve is its largest less its smallest value. The largest of many values is replaced by
//! `t·ln Σ exp(value/t)`, which is smooth and convex, and limits by logarithmic barriers; Newton's method finds
//! the minimum, with `t` decreasing.

use super::shape::FREE;
use crate::linear::Normal;

/// A value for each variable: the outputs up to 1 mm/s.
pub(super) type FreeValues = [f64; FREE];

/// The smoothing at each stage, as a part of the largest height.
const SMOOTH: [f64; 3] = [0.03, 0.008, 0.003];

/// Newton steps of a stage.
const STEPS: usize = 6;

/// Halvings of a step that leads too far.
const HALVINGS: usize = 12;

/// Values further below the largest one than this many smoothings count as nothing.
const NEGLIGIBLE: f64 = 12.0;

/// A value that depends linearly on the variables.
#[derive(Debug, Clone, Copy)]
pub(super) struct LinearValue {
    pub(super) base: f64,
    pub(super) slopes: FreeValues,
}

impl LinearValue {
    fn at(&self, point: &FreeValues) -> f64 {
        self.base + product(&self.slopes, point)
    }

    /// Gives a variable a value, on which this no longer depends.
    fn fix(&mut self, variable: usize, value: f64) {
        self.base += self.slopes[variable] * value;
        self.slopes[variable] = 0.0;
    }
}

/// A curve: its upper values, and its lower ones negated.
#[derive(Debug, Clone)]
pub(super) struct LinearCurve {
    pub(super) sides: [Vec<LinearValue>; 2],
}

impl LinearCurve {
    fn height(&self, point: &FreeValues) -> f64 {
        let most = |side: &Vec<LinearValue>| {
            let values = side.iter().map(|it| it.at(point));
            values.fold(f64::NEG_INFINITY, f64::max)
        };
        self.sides.iter().map(most).sum()
    }
}

/// Curves, and limits that the variables must keep: values that stay below 0.
#[derive(Debug, Clone)]
pub(super) struct LinearModel {
    pub(super) curves: Vec<LinearCurve>,
    pub(super) limits: Vec<LinearValue>,
}

/// A smooth value with its first and second derivatives.
struct Smooth {
    value: f64,
    slopes: FreeValues,
    bends: Normal<FREE>,
}

impl LinearModel {
    /// Returns the largest height at a point.
    pub(super) fn worst(&self, point: &FreeValues) -> f64 {
        let heights = self.curves.iter().map(|it| it.height(point));
        heights.fold(0.0, f64::max)
    }

    /// Gives a variable a value.
    pub(super) fn fix(&mut self, variable: usize, value: f64) {
        let curves = self.curves.iter_mut().flat_map(|it| &mut it.sides);
        let values = curves.flatten().chain(&mut self.limits);
        values.for_each(|it| it.fix(variable, value));
        // A limit that holds only the fixed ones no longer matters.
        self.limits
            .retain(|it| it.slopes.iter().any(|slope| *slope != 0.0));
    }

    /// Leaves out the values that are further from the largest of their curve than a part of its height.
    pub(super) fn prune(&mut self, part: f64) {
        for curve in &mut self.curves {
            let height = curve.height(&[0.0; FREE]);
            for side in &mut curve.sides {
                let most = side.iter().map(|it| it.base).fold(f64::MIN, f64::max);
                side.retain(|it| it.base >= most - part * height);
            }
        }
    }

    /// Returns the point within the limits whose largest height is smallest. The limits must hold at 0.
    pub(super) fn minimum(&self) -> FreeValues {
        let mut point = [0.0; FREE];
        let worst = self.worst(&point);
        if worst <= 0.0 {
            return point;
        }
        for part in SMOOTH {
            let smoothing = part * worst;
            for _ in 0..STEPS {
                let Some(step) = self.newton_step(&point, smoothing) else {
                    break;
                };
                let Some(next) = self.downhill(&point, (&step, smoothing)) else {
                    break;
                };
                point = next;
            }
        }
        point
    }

    /// Returns the furthest point along a step that is lower than the one where it begins.
    fn downhill(
        &self,
        point: &FreeValues,
        (step, smoothing): (&FreeValues, f64),
    ) -> Option<FreeValues> {
        let before = self.value(point, smoothing)?;
        let mut part = 1.0;
        for _ in 0..HALVINGS {
            let next = std::array::from_fn(|at| point[at] + part * step[at]);
            if let Some(value) = self.value(&next, smoothing)
                && value < before - 1e-3 * smoothing
            {
                return Some(next);
            }
            part *= 0.5;
        }
        None
    }

    /// Returns the smooth height at a point with the barriers; `None` beyond a limit.
    fn value(&self, point: &FreeValues, smoothing: f64) -> Option<f64> {
        let heights = self.curves.iter().map(|curve| {
            let sides = curve.sides.iter();
            let of_side = |side: &Vec<LinearValue>| {
                let values: Vec<f64> = side.iter().map(|it| it.at(point)).collect();
                smooth_most(&values, smoothing)
            };
            sides.map(of_side).sum()
        });
        let heights: Vec<f64> = heights.collect();
        let mut value = smooth_most(&heights, smoothing);
        for limit in &self.limits {
            let room = -limit.at(point);
            if room <= 0.0 {
                return None;
            }
            value -= smoothing * room.ln();
        }
        Some(value)
    }

    fn newton_step(&self, point: &FreeValues, smoothing: f64) -> Option<FreeValues> {
        let curves = self.curves.iter().map(|curve| {
            let [mut upper, lower] = curve
                .sides
                .each_ref()
                .map(|side| Smooth::most_of(side, (point, smoothing)));
            upper.value += lower.value;
            for (slope, other) in upper.slopes.iter_mut().zip(lower.slopes) {
                *slope += other;
            }
            upper.bends.add_times(&lower.bends, 1.0);
            upper
        });
        let curves: Vec<Smooth> = curves.collect();
        let heights: Vec<f64> = curves.iter().map(|it| it.value).collect();
        let shares = shares(&heights, smoothing);
        let mut slopes = [0.0; FREE];
        let mut bends = Normal::new();
        for (curve, &share) in curves.iter().zip(&shares) {
            bends.add_times(&curve.bends, share);
            for (sum, slope) in slopes.iter_mut().zip(curve.slopes) {
                *sum += share * slope;
            }
        }
        for (curve, share) in curves.iter().zip(shares) {
            let weight = (share / smoothing).sqrt();
            bends.add(
                std::array::from_fn(|at| weight * (curve.slopes[at] - slopes[at])),
                0.0,
            );
        }
        for limit in &self.limits {
            let room = -limit.at(point);
            let weight = smoothing.sqrt() / room;
            bends.add(limit.slopes.map(|it| weight * it), 0.0);
            for (sum, slope) in slopes.iter_mut().zip(limit.slopes) {
                *sum += smoothing * slope / room;
            }
        }
        bends.hold_unused();
        bends.solve_for(slopes.map(|it| -it))
    }
}

impl Smooth {
    /// Returns the smooth largest of values.
    fn most_of(values: &[LinearValue], (point, smoothing): (&FreeValues, f64)) -> Self {
        let at: Vec<f64> = values.iter().map(|it| it.at(point)).collect();
        let shares = shares(&at, smoothing);
        let mut slopes = [0.0; FREE];
        let counted = || {
            values
                .iter()
                .zip(&shares)
                .filter(|(_, share)| **share > 0.0)
        };
        for (value, share) in counted() {
            for (sum, slope) in slopes.iter_mut().zip(value.slopes) {
                *sum += share * slope;
            }
        }
        let mut bends = Normal::new();
        for (value, share) in counted() {
            let weight = (share / smoothing).sqrt();
            bends.add(
                std::array::from_fn(|at| weight * (value.slopes[at] - slopes[at])),
                0.0,
            );
        }
        Self {
            value: smooth_most(&at, smoothing),
            slopes,
            bends,
        }
    }
}

fn product(one: &FreeValues, other: &FreeValues) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

fn most(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// Returns `exp` of the distance below the largest value in smoothings, and 0 where that is negligible.
fn weight(value: f64, most: f64, smoothing: f64) -> f64 {
    let below = (value - most) / smoothing;
    if below < -NEGLIGIBLE {
        0.0
    } else {
        below.exp()
    }
}

fn smooth_most(values: &[f64], smoothing: f64) -> f64 {
    let most = most(values);
    let sum: f64 = values.iter().map(|&it| weight(it, most, smoothing)).sum();
    most + smoothing * sum.ln()
}

/// Returns the derivatives of the smooth largest value: the shares of the values in it.
fn shares(values: &[f64], smoothing: f64) -> Vec<f64> {
    let most = most(values);
    let mut shares: Vec<f64> = values
        .iter()
        .map(|&it| weight(it, most, smoothing))
        .collect();
    let sum: f64 = shares.iter().sum();
    for share in &mut shares {
        *share /= sum;
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(base: f64, slopes: [f64; 2]) -> LinearValue {
        let mut all = [0.0; FREE];
        all[..2].copy_from_slice(&slopes);
        LinearValue { base, slopes: all }
    }

    #[test]
    fn the_largest_height_of_two_curves_is_levelled() {
        // R5.37: heights 4 + x and 2 − x, which are equal at −1, and a second variable that lowers both up to
        // its limit.
        let curve = |base: f64, slopes| LinearCurve {
            sides: [
                vec![value(base, slopes), value(0.1, [0.0; 2])],
                vec![value(0.0, [0.0; 2])],
            ],
        };
        let model = LinearModel {
            curves: vec![curve(4.0, [1.0, -1.0]), curve(2.0, [-1.0, -1.0])],
            limits: vec![value(-0.5, [0.0, 1.0]), value(-0.5, [0.0, -1.0])],
        };
        let least = model.minimum();
        assert!((model.worst(&least) - 2.5).abs() < 0.05, "{least:?}");
        assert!((least[0] + 1.0).abs() < 0.05 && least[1] < 0.5, "{least:?}");
    }
}
