//! The circle that most of a recorded path lies on, whatever else was recorded (R5.26).
//!
//! Circles through three points of the path are tried; the best has points all around it, and the
//! most of them. Points elsewhere do not take part. The path is sampled in equal steps, so that
//! standstill and slow motion have no more weight than anything else.

use std::f64::consts::TAU;

use super::error::RecordedError;
use super::fit::FittedCircle;

/// Steps of the path along the longer side of all points.
const STEPS: f64 = 1000.0;

/// Maximum number of points of the path that are compared with each circle.
const COMPARED: usize = 1000;

/// Circles that are tried with three points at each of the distances.
const TRIES: usize = 64;

/// Distances between the three points, in parts of the path.
const DISTANCES: [f64; 6] = [0.01, 0.021, 0.047, 0.09, 0.17, 0.31];

/// Number of sectors of a turn, to determine how much of it has points.
const SECTORS: usize = 72;

/// The largest radius of a circle relative to the extent of all points: beyond it they are on a line.
const FLATTEST: f64 = 10.0;

/// Rounds in which the best circle is fitted to the points on it.
const ROUNDS: usize = 4;

/// Returns the circle in mm.
pub(super) fn search(points: &[[f64; 2]]) -> Result<FittedCircle, RecordedError> {
    let extent = extent(points);
    let way = steps_of(points, extent / STEPS);
    let stride = way.len().div_ceil(COMPARED).max(1);
    let compared: Vec<[f64; 2]> = way.iter().copied().step_by(stride).collect();
    let mut best: Option<(Rank, FittedCircle)> = None;
    for distance in DISTANCES {
        #[allow(clippy::cast_precision_loss)] // points of a file
        let between = (way.len() as f64 * distance).ceil();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // fewer than points
        let between = (between as usize).max(1);
        let starts = way.len().saturating_sub(2 * between);
        for from in (0..starts).step_by(starts.div_ceil(TRIES).max(1)) {
            let three = [way[from], way[from + between], way[from + 2 * between]];
            let circle = FittedCircle::through(three).filter(|it| it.radius < FLATTEST * extent);
            let Some(circle) = circle else { continue };
            let rank = Rank::of(&circle, &compared);
            if best.is_none_or(|(most, _)| rank > most) {
                best = Some((rank, circle));
            }
        }
    }
    let (_, mut circle) = best.ok_or(RecordedError::NoCircle)?;
    for _ in 0..ROUNDS {
        let tolerance = circle.tolerance();
        let on_it: Vec<[f64; 2]> = way
            .iter()
            .copied()
            .filter(|&point| circle.outside(point).abs() <= tolerance)
            .collect();
        match FittedCircle::of(&on_it) {
            Ok(fit) => circle = fit,
            Err(_) => break,
        }
    }
    Ok(circle)
}

/// Rank of a circle: the number of sectors with points on it, then the number of points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Rank {
    sectors: u32,
    points: usize,
}

impl Rank {
    fn of(circle: &FittedCircle, points: &[[f64; 2]]) -> Self {
        let tolerance = circle.tolerance();
        let mut sectors: u128 = 0;
        let mut count = 0;
        for &point in points {
            if circle.outside(point).abs() <= tolerance {
                count += 1;
                #[allow(clippy::cast_precision_loss)] // 72
                let sector = circle.angle(point).rem_euclid(TAU) / TAU * SECTORS as f64;
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 to 72
                let sector = (sector as usize).min(SECTORS - 1);
                sectors |= 1 << sector;
            }
        }
        Self {
            sectors: sectors.count_ones(),
            points: count,
        }
    }
}

/// Returns the longer side of the rectangle that holds all points.
fn extent(points: &[[f64; 2]]) -> f64 {
    let side = |axis: usize| {
        let values = points.iter().map(|point| point[axis]);
        let [least, most] = values.fold([f64::MAX, f64::MIN], |[least, most], value| {
            [least.min(value), most.max(value)]
        });
        most - least
    };
    side(0).max(side(1))
}

/// Returns the points at least this far from each other along the path.
fn steps_of(points: &[[f64; 2]], step: f64) -> Vec<[f64; 2]> {
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for &point in points {
        let is_far = kept
            .last()
            .is_none_or(|last| (point[0] - last[0]).hypot(point[1] - last[1]) >= step);
        if is_far {
            kept.push(point);
        }
    }
    kept
}
