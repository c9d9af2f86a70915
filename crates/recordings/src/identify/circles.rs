//! Friction from recorded circles: no constant speeds, but every speed in both directions (R6.19).

use super::doubts;
use super::finding::TraceFinding;
use super::identified::IdentifyError;
use super::measured::Measured;
use super::recorded::AxisRecording;
use super::segment::segments;
use super::statistics::{count, moving_average, samples_in};
use super::track::{AxisSamples, Track, TrackError};
use frictcomp::diagnostic::Code;
use frictcomp::lists::{DEFAULT_MAX_POINTS, FrictionList, TablePoint};
use frictcomp_physics::linear::solve_linear;

/// Friction found on circles.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OnCircles {
    /// Speeds in mm/s with the friction there in drive units, slowest first.
    pub points: Vec<[f64; 2]>,
    /// Torque of an acceleration of 1 mm/s², in drive units.
    pub inertia: f64,
    /// Part that is the same in both directions.
    pub offset: f64,
    /// Speeds in mm/s that had too few samples and are left out.
    pub left_out: Vec<f64>,
    /// Faults of the recordings.
    pub findings: Vec<TraceFinding>,
}

impl OnCircles {
    /// Returns the value list: the points, the first one held down to standstill.
    pub fn list(&self) -> FrictionList {
        let held = self.points.first().map(|point| [0.0, point[1]]);
        let points = held.into_iter().chain(self.points.iter().copied());
        FrictionList {
            position_delay: 0,
            reversal_lookahead: 0,
            scaling_factor: 1000,
            delay_cycles: 0,
            max_points: DEFAULT_MAX_POINTS,
            table: points
                .map(|[speed, friction]| TablePoint {
                    input: (speed * 1000.0).round(),
                    output: friction,
                })
                .collect(),
        }
    }
}

/// Maximum number of speeds of points.
const POINTS: u32 = 10;

/// The slowest point in mm/s.
const SLOWEST: f64 = 0.5;

/// Distance after a reversal, in mm, over which the contact is still winding up.
const WINDING: f64 = 0.05;

/// Time after a reversal, in s, over which the loops still respond to it.
const SETTLING_S: f64 = 0.05;

/// A point with fewer samples is left out.
const FEWEST: f64 = 200.0;

/// Largest part of the time at constant speed for an axis on a circle.
const MOST_STEADY: f64 = 0.5;

/// Returns the friction in recordings of an axis on circles, of which only what all of them have in common is known
/// about the torque.
///
/// # Errors
/// The recordings cannot be used, or are not what they seem.
pub fn identify_circles(recordings: &[AxisRecording]) -> Result<OnCircles, IdentifyError> {
    let measured = recordings.iter().map(|it| it.measured);
    let measured = measured.reduce(Measured::common).unwrap_or_default();
    let tracks = recordings.iter().map(|it| &it.track);
    identify_measured(tracks, &measured)
}

/// Models the torque as the friction of the direction at points of the speed, linear in between, an inertia
/// times the acceleration, and an offset, by least squares over all circles.
fn identify_measured<'a>(
    tracks: impl Iterator<Item = &'a Track>,
    measured: &Measured,
) -> Result<OnCircles, IdentifyError> {
    let compensation = doubts::check_compensation(measured)?;
    let mut findings: Vec<TraceFinding> = compensation.into_iter().collect();
    let mut rows = NormalEquations::default();
    let mut fastest = 0.0_f64;
    let mut circles = Vec::new();
    for track in tracks {
        let samples = AxisSamples::new(track)?;
        let smooth = moving_average(&samples.velocities, samples_in(0.005, samples.step_s));
        fastest = smooth.iter().fold(fastest, |most, v| most.max(v.abs()));
        doubts::check_directions(&samples, &[])?;
        let steady: usize = segments(&samples).iter().map(|it| it.samples.len()).sum();
        if count(steady) > MOST_STEADY * count(samples.times_s.len()) {
            return Err(IdentifyError::NoCircles);
        }
        findings.extend(doubts::missing_rows(&samples.times_s, samples.step_s));
        circles.push((samples, smooth));
    }
    if fastest < 2.0 * SLOWEST {
        return Err(IdentifyError::NoSegments);
    }
    rows.speeds = points(fastest);
    for (samples, smooth) in &circles {
        rows.add(samples, smooth);
    }
    let mut found = rows.solve().ok_or(IdentifyError::Track(TrackError::Short {
        samples: rows.used,
    }))?;
    if found.inertia < 0.0 {
        return Err(doubts::refused(
            Code::Fc522,
            format!(
                "the inertia would be {:.4} per mm/s\u{b2}: the torque does not accelerate the axis",
                found.inertia
            ),
            "check that torque and velocity are of one axis, have the same sign, and are recorded at the same time",
        ));
    }
    for (samples, _) in &circles {
        findings.extend(doubts::check_points(&found.points, samples, measured)?);
        findings.dedup();
    }
    found.findings = findings;
    Ok(found)
}

/// Speeds of points with equal factors between them.
fn points(fastest: f64) -> Vec<f64> {
    let factor = (fastest / SLOWEST).ln() / f64::from(POINTS - 1);
    (0..POINTS)
        .map(|at| SLOWEST * (f64::from(at) * factor).exp())
        .collect()
}

/// Sums of the least squares.
#[derive(Debug, Default)]
struct NormalEquations {
    speeds: Vec<f64>,
    /// Products of all parts with each other and with the torque.
    sums: Vec<Vec<f64>>,
    weights: Vec<f64>,
    used: usize,
}

impl NormalEquations {
    fn add(&mut self, samples: &AxisSamples, smooth: &[f64]) {
        let size = self.speeds.len() + 2;
        if self.sums.is_empty() {
            self.sums = vec![vec![0.0; size + 1]; size];
            self.weights = vec![0.0; self.speeds.len()];
        }
        let step = samples_in(0.002, samples.step_s);
        let settling = samples_in(SETTLING_S, samples.step_s);
        let mut turned = (0, samples.positions[0], 0.0_f64);
        let mut row = vec![0.0; size];
        for at in step..smooth.len() - step {
            let velocity = smooth[at];
            if velocity * turned.2 <= 0.0 {
                turned = (at, samples.positions[at], velocity);
            }
            let way = (samples.positions[at] - turned.1).abs();
            let speed = velocity.abs();
            if way < WINDING || at - turned.0 < settling || speed < self.speeds[0] {
                continue;
            }
            row.fill(0.0);
            let upper = self
                .speeds
                .partition_point(|it| *it < speed)
                .clamp(1, self.speeds.len() - 1);
            let (low, high) = (self.speeds[upper - 1], self.speeds[upper]);
            let share = ((speed - low) / (high - low)).clamp(0.0, 1.0);
            row[upper - 1] = velocity.signum() * (1.0 - share);
            row[upper] = velocity.signum() * share;
            self.weights[upper - 1] += 1.0 - share;
            self.weights[upper] += share;
            let span = samples.times_s[at + step] - samples.times_s[at - step];
            row[size - 2] = (smooth[at + step] - smooth[at - step]) / span;
            row[size - 1] = 1.0;
            for (i, one) in row.iter().enumerate() {
                for (j, other) in row.iter().enumerate() {
                    self.sums[i][j] += one * other;
                }
                self.sums[i][size] += one * samples.torques[at];
            }
            self.used += 1;
        }
    }

    /// Solves for the parts that have enough samples.
    fn solve(&self) -> Option<OnCircles> {
        let nodes = self.speeds.len();
        let is_kept = |at: usize| at >= nodes || self.weights[at] >= FEWEST;
        let kept: Vec<usize> = (0..nodes + 2).filter(|&at| is_kept(at)).collect();
        let matrix = kept.iter().map(|&i| {
            let row = kept.iter().map(|&j| self.sums[i][j]);
            row.chain([self.sums[i][nodes + 2]]).collect()
        });
        let matrix: Vec<Vec<f64>> = if self.sums.is_empty() {
            return None;
        } else {
            matrix.collect()
        };
        let found = solve_linear(matrix)?;
        let value = |part: usize| {
            let at = kept.iter().position(|&it| it == part);
            at.map(|at| found[at])
        };
        let friction = |(at, speed): (usize, &f64)| Some([*speed, value(at)?]);
        let points: Vec<[f64; 2]> = self
            .speeds
            .iter()
            .enumerate()
            .filter_map(friction)
            .collect();
        let left_out = self
            .speeds
            .iter()
            .enumerate()
            .filter(|(at, _)| !is_kept(*at));
        (count(points.len()) >= 2.0).then(|| OnCircles {
            points,
            inertia: value(nodes).unwrap_or(0.0),
            offset: value(nodes + 1).unwrap_or(0.0),
            left_out: left_out.map(|(_, speed)| *speed).collect(),
            findings: Vec::new(),
        })
    }
}
