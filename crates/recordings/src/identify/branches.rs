//! Friction that depends on the direction other than by an offset (R6.25): what both directions have in common
//! changes with the speed.

use super::pair::Pair;
use super::statistics::{count, median};

/// Minimum number of speeds in both directions.
const FEWEST: usize = 4;

/// Standard errors from which a change counts.
const SIGNIFICANT: f64 = 4.0;

/// The part of the friction from which a change matters.
const MATTERS: f64 = 0.03;

/// Errors of a pair that its noise does not show, as a part of its friction.
const UNSEEN: f64 = 0.002;

/// The friction of both directions at a speed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct BranchPoint {
    /// The speed in mm/s or °/s.
    pub speed: f64,
    /// The torque at positive velocity in drive units, less the offset.
    pub forth: f64,
    /// The torque at negative velocity with the opposite sign, plus the offset.
    pub back: f64,
}

/// Friction that is not the same in both directions.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct DirectionBranches {
    /// Slowest first. The mean of both is the friction of the pair.
    pub points: Vec<BranchPoint>,
    /// The change of the common part from the slowest to the fastest speed, in drive units.
    pub change: f64,
    /// Standard error.
    pub error: f64,
}

impl DirectionBranches {
    /// Returns the branches of pairs; `None` where both directions differ by an offset at most.
    pub(super) fn of(pairs: &[Pair]) -> Option<Self> {
        let both: Vec<(&Pair, f64)> = pairs
            .iter()
            .filter_map(|pair| Some((pair, pair.offset?)))
            .collect();
        if both.len() < FEWEST {
            return None;
        }
        // Friction changes with the speed itself, or at slow speeds more than at fast ones.
        let scales: [fn(f64) -> f64; 2] = [|speed| speed, f64::ln];
        let [linear, slow] = scales.map(|scale| Line::through(&both, scale));
        let line = match (linear?, slow?) {
            (linear, slow) if linear.squares <= slow.squares => linear,
            (_, slow) => slow,
        };
        let level = both
            .iter()
            .map(|(pair, _)| pair.friction.abs())
            .fold(f64::INFINITY, f64::min);
        let is_seen = line.change.abs() > (SIGNIFICANT * line.error).max(MATTERS * level);
        if !is_seen {
            return None;
        }
        let offsets: Vec<f64> = both.iter().map(|(_, offset)| *offset).collect();
        let offset = median(&offsets)?;
        let point = |&(pair, own): &(&Pair, f64)| BranchPoint {
            speed: pair.speed,
            forth: pair.friction + own - offset,
            back: pair.friction - own + offset,
        };
        Some(Self {
            points: both.iter().map(point).collect(),
            change: line.change,
            error: line.error,
        })
    }

    /// Returns the point at which one list for both directions is farthest from them, and the distance in drive units:
    /// at positive velocity the torque is larger by it, at negative velocity smaller.
    pub fn cost(&self) -> Option<(f64, f64)> {
        let costs = self.points.iter();
        let costs = costs.map(|it| (it.speed, (it.forth - it.back) / 2.0));
        costs.max_by(|one, other| one.1.abs().total_cmp(&other.1.abs()))
    }
}

/// A straight line through the common parts over a function of the speed.
struct Line {
    /// Change from the slowest to the fastest speed.
    change: f64,
    error: f64,
    /// The weighted squares of what it leaves.
    squares: f64,
}

impl Line {
    fn through(both: &[(&Pair, f64)], scale: fn(f64) -> f64) -> Option<Self> {
        let rows = || {
            both.iter().map(|(pair, offset)| {
                let error = pair.error.hypot(UNSEEN * pair.friction);
                (scale(pair.speed), *offset, 1.0 / (error * error).max(1e-18))
            })
        };
        let weights: f64 = rows().map(|(.., weight)| weight).sum();
        let mean = |of: fn(&(f64, f64, f64)) -> f64| {
            rows().map(|row| row.2 * of(&row)).sum::<f64>() / weights
        };
        let (x, y) = (mean(|row| row.0), mean(|row| row.1));
        let square: f64 = rows().map(|row| row.2 * (row.0 - x).powi(2)).sum();
        let product: f64 = rows().map(|row| row.2 * (row.0 - x) * (row.1 - y)).sum();
        let slope = product / square;
        let squares: f64 = rows()
            .map(|row| row.2 * (row.1 - y - slope * (row.0 - x)).powi(2))
            .sum();
        let free = count(both.len() - 2);
        let ends = rows()
            .map(|row| row.0)
            .fold([f64::MAX, f64::MIN], |[low, high], x| {
                [low.min(x), high.max(x)]
            });
        let span = ends[1] - ends[0];
        let error = span * (1.0_f64.max(squares / free) / square).sqrt();
        let is_known = square > 0.0 && error.is_finite();
        is_known.then_some(Self {
            change: slope * span,
            error,
            squares,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs(offset: impl Fn(f64) -> f64) -> Vec<Pair> {
        let speeds = [0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0];
        let pair = |speed: f64| Pair {
            speed,
            friction: 30.0 + 0.2 * speed,
            offset: Some(offset(speed)),
            error: 0.1,
            visits: Vec::new(),
            segments: Vec::new(),
        };
        speeds.map(pair).to_vec()
    }

    #[test]
    fn an_offset_is_no_branch() {
        // R6.25
        assert_eq!(DirectionBranches::of(&pairs(|_| 12.0)), None);
        // Less than its uncertainty.
        let noisy = pairs(|speed| 12.0 + 0.15 * (speed * 7.0).sin());
        assert_eq!(DirectionBranches::of(&noisy), None);
        assert_eq!(DirectionBranches::of(&pairs(|_| 5.0)[..3]), None);
    }

    #[test]
    fn viscous_friction_of_one_direction_is_two_branches() {
        // R6.25: 0.2 a mm/s forth, 0.1 back.
        let found = DirectionBranches::of(&pairs(|speed| 3.0 + 0.05 * speed)).expect("branches");
        assert!((found.change - 0.05 * 49.8).abs() < 0.05, "{found:?}");
        let (speed, cost) = found.cost().expect("a cost");
        assert!((speed - 50.0).abs() < 1e-9, "{speed}");
        assert!((cost - (2.5 - 0.05 * 3.5)).abs() < 1e-9, "{cost}");
        for (point, pair) in found.points.iter().zip(pairs(|_| 0.0)) {
            assert!((point.forth.midpoint(point.back) - pair.friction).abs() < 1e-9);
        }
    }
}
