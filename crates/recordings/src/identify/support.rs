//! Support points of a value list: few points whose straight lines stay close to the curve (R6.17).

use super::curve::FrictionCurve;

/// Requested number of points.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum RequestedPoints {
    /// This number of points at most.
    Points(usize),
    /// The smallest number that keeps the error below this part of the friction, but at most `most`.
    Error {
        /// The part of the Coulomb friction.
        part: f64,
        /// The greatest number of points.
        most: usize,
    },
}

/// The range of speeds that a list is made for, in mm/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SpeedRange {
    /// The slowest measured one; below it the curve is held.
    pub(super) slowest: f64,
    pub(super) fastest: f64,
}

/// Points, and the largest error of the lines between them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Support {
    pub(super) points: Vec<[f64; 2]>,
    pub(super) error: f64,
    /// The error that was asked for, if that of the lines is larger.
    pub(super) missed: Option<f64>,
}

/// Places for points.
const PLACES: u32 = 200;

/// Returns the points, ascending, the first at standstill and the last at the fastest speed. The largest error of the
/// lines is the smallest that a number of points can have (dynamic programming).
pub(super) fn support(
    curve: &FrictionCurve,
    speeds: SpeedRange,
    wanted: RequestedPoints,
) -> Support {
    let table = CandidateTable::new(curve, speeds);
    let most = match wanted {
        RequestedPoints::Points(most) | RequestedPoints::Error { most, .. } => {
            most.clamp(2, table.speeds.len())
        }
    };
    let best = table.best(most);
    let level = curve
        .at(speeds.fastest)
        .abs()
        .min(curve.at(speeds.slowest).abs());
    let enough = |points: usize| match wanted {
        RequestedPoints::Error { part, .. } => best[points].0 <= part * level,
        RequestedPoints::Points(_) => false,
    };
    let chosen = (1..most).find(|&lines| enough(lines)).unwrap_or(most - 1);
    let (error, places) = &best[chosen];
    let on_curve = Support {
        points: places
            .iter()
            .map(|&at| [table.speeds[at], table.values[at]])
            .collect(),
        error: *error,
        missed: None,
    };
    let mut balanced = table.balanced(on_curve);
    if let RequestedPoints::Error { part, .. } = wanted {
        balanced.missed = (balanced.error > part * level).then_some(part * level);
    }
    balanced
}

struct CandidateTable {
    /// Candidates for points, in mm/s, whole µm/s.
    speeds: Vec<f64>,
    values: Vec<f64>,
    /// Speeds at which errors are evaluated, with the values of the curve, ascending.
    looked: Vec<[f64; 2]>,
}

impl CandidateTable {
    fn new(curve: &FrictionCurve, SpeedRange { slowest, fastest }: SpeedRange) -> Self {
        let held = |speed: f64| curve.at(speed.max(slowest));
        let whole = |speed: f64| (speed * 1000.0).round() / 1000.0;
        let between = |steps: u32| {
            let factor = (fastest / slowest).ln() / f64::from(steps);
            (0..=steps).map(move |at| slowest * (f64::from(at) * factor).exp())
        };
        let mut speeds: Vec<f64> = vec![0.0];
        speeds.extend(between(PLACES).map(whole));
        if let FrictionCurve::Lines(points) = curve {
            speeds.extend(points.iter().map(|point| whole(point[0])));
        }
        speeds.retain(|&speed| speed <= fastest);
        speeds.push(fastest);
        speeds.sort_by(f64::total_cmp);
        // Two places within a µm/s are one; the last one stays.
        speeds.dedup_by(|after, before| {
            let is_near = *after - *before < 0.0005;
            if is_near && *before > 0.0 {
                *before = *after;
            }
            is_near
        });
        let mut looked: Vec<[f64; 2]> = vec![[0.0, held(0.0)], [slowest / 2.0, held(0.0)]];
        looked.extend(between(3 * PLACES).map(|speed| [speed, held(speed)]));
        Self {
            values: speeds.iter().map(|&speed| held(speed)).collect(),
            speeds,
            looked,
        }
    }

    /// Returns the same number of points off the curve if that makes the largest error smaller: lines between points of
    /// a bent curve are all on one side of it. The first point stays, since the value at standstill is known.
    fn balanced(&self, on_curve: Support) -> Support {
        /// Number of rounds by which nothing changes any more.
        const ROUNDS: usize = 60;
        let mut best = on_curve.clone();
        let mut points = on_curve.points;
        for _ in 0..ROUNDS {
            let spans: Vec<[f64; 2]> = points
                .windows(2)
                .map(|line| self.beside([line[0], line[1]]))
                .collect();
            let ends = |span: &[f64; 2]| span.map(f64::abs).into_iter().fold(0.0, f64::max);
            let error = spans.iter().map(ends).fold(0.0, f64::max);
            if error < best.error {
                best = Support {
                    points: points.clone(),
                    error,
                    missed: None,
                };
            }
            for at in 1..points.len() {
                let around = &spans[at - 1..spans.len().min(at + 1)];
                let [low, high] = around.iter().fold([0.0_f64; 2], |[low, high], span| {
                    [low.min(span[0]), high.max(span[1])]
                });
                points[at][1] -= f64::midpoint(low, high) / 2.0;
            }
        }
        best
    }

    /// Returns the distances of a line below and above the curve.
    fn beside(&self, [[x0, y0], [x1, y1]]: [[f64; 2]; 2]) -> [f64; 2] {
        let slope = (y1 - y0) / (x1 - x0);
        let first = self.looked.partition_point(|it| it[0] < x0);
        let within = self.looked[first..].iter().take_while(|it| it[0] <= x1);
        within.fold([0.0; 2], |[low, high], [x, y]| {
            let error = y0 + slope * (x - x0) - y;
            [low.min(error), high.max(error)]
        })
    }

    /// Returns the largest error of a line between two places.
    fn error(&self, from: usize, to: usize) -> f64 {
        let place = |at: usize| [self.speeds[at], self.values[at]];
        let [below, above] = self.beside([place(from), place(to)]);
        above.max(-below)
    }

    /// Returns for every number of lines up to one less than `most` points the smallest largest error and its places.
    /// The first one, without a line, is not used.
    fn best(&self, most: usize) -> Vec<(f64, Vec<usize>)> {
        let places = self.speeds.len();
        let mut errors = vec![0.0; places * places];
        for from in 0..places {
            for to in from + 1..places {
                errors[from * places + to] = self.error(from, to);
            }
        }
        let mut reached = vec![f64::INFINITY; places];
        reached[0] = 0.0;
        let mut before: Vec<Vec<usize>> = Vec::new();
        let mut best = vec![(f64::INFINITY, Vec::new())];
        for _ in 1..most {
            let mut next = vec![f64::INFINITY; places];
            let mut origin = vec![0; places];
            for to in 1..places {
                for from in 0..to {
                    let error = reached[from].max(errors[from * places + to]);
                    if error < next[to] {
                        next[to] = error;
                        origin[to] = from;
                    }
                }
            }
            before.push(origin);
            reached = next;
            let mut at = places - 1;
            let mut path = vec![at];
            for origin in before.iter().rev() {
                at = origin[at];
                path.push(at);
            }
            path.reverse();
            path.dedup();
            best.push((reached[places - 1], path));
        }
        best
    }
}
