//! The ends of a recorded path, on which the machine speeds up or slows down (R16.10).

use std::f64::consts::TAU;

/// The time in s over which the speed is measured …
const OVER_S: f64 = 0.025;

/// … or this number of samples, if they take longer.
const OVER_SAMPLES: usize = 8;

/// An end is at rest if the speed there is below this part of that in the middle …
const RESTS: f64 = 0.9;

/// … and the ramp ends where it reaches this part.
const REACHED: f64 = 0.97;

/// The time after a ramp that is left out as well: by then the loops of a drive have settled (R5.22).
const SETTLING_S: f64 = 0.3;

/// The angle that is at least left out at an end at rest, in radians.
pub(super) const LEAST: f64 = 40.0 * TAU / 360.0;

/// Returns the angles left out at the beginning and at the end of a path, in radians, from the angle of each point in
/// the direction of travel and its time in s; 0 where the path begins or ends in motion. Without times the samples are
/// taken as equally spaced.
pub(super) fn run_in(angles: &[f64], times_s: Option<&[f64]>) -> [f64; 2] {
    let Some(path) = TimedPath::of(angles, times_s) else {
        return [0.0; 2];
    };
    let mut backwards = TimedPath {
        over_s: path.over_s,
        points: Vec::with_capacity(path.points.len()),
    };
    if let Some((end_s, whole)) = path.points.last() {
        let back = path.points.iter().rev();
        backwards.points = back
            .map(|(time, angle)| (end_s - time, whole - angle))
            .collect();
    }
    let Some(speed) = path.speed() else {
        return [0.0; 2];
    };
    [path, backwards].map(|it| it.ramp(speed))
}

/// Time in s and angle in radians of each point.
struct TimedPath {
    points: Vec<(f64, f64)>,
    /// The time over which the speed is measured.
    over_s: f64,
}

impl TimedPath {
    fn of(angles: &[f64], times_s: Option<&[f64]>) -> Option<Self> {
        #[allow(clippy::cast_precision_loss)] // rows of a file
        let time = |at: usize| times_s.map_or(at as f64, |it| it[at]);
        let points = angles.iter().enumerate();
        let points: Vec<(f64, f64)> = points.map(|(at, it)| (time(at), *it)).collect();
        let [first, .., last] = &points[..] else {
            return None;
        };
        #[allow(clippy::cast_precision_loss)] // rows of a file
        let step_s = (last.0 - first.0) / (points.len() - 1) as f64;
        #[allow(clippy::cast_precision_loss)] // a few
        let of_samples = OVER_SAMPLES as f64 * step_s;
        let over_s = if times_s.is_some() {
            of_samples.max(OVER_S)
        } else {
            of_samples
        };
        (step_s.is_finite() && step_s > 0.0).then_some(Self { points, over_s })
    }

    /// Returns the speed from a point on in rad/s, and the point at which its measurement ends.
    fn speed_from(&self, from: usize) -> Option<(f64, usize)> {
        let (begin_s, begin) = self.points[from];
        let until = self.points[from..].partition_point(|it| it.0 < begin_s + self.over_s);
        let (end_s, end) = self.points.get(from + until)?;
        (*end_s > begin_s).then(|| ((end - begin) / (end_s - begin_s), from + until))
    }

    /// Returns the median of the speed in the middle half of the path.
    fn speed(&self) -> Option<f64> {
        let whole = self.points.last()?.1;
        let from = self.points.partition_point(|it| it.1 < whole / 4.0);
        let to = self.points.partition_point(|it| it.1 < whole * 0.75);
        let mut speeds = Vec::new();
        let mut at = from;
        while at < to {
            let Some((speed, end)) = self.speed_from(at) else {
                break;
            };
            speeds.push(speed);
            at = end;
        }
        let middle = speeds.len() / 2;
        (!speeds.is_empty()).then(|| *speeds.select_nth_unstable_by(middle, f64::total_cmp).1)
    }

    /// Returns the angle up to which the speed still rises, with what the loops then take to settle; 0 for a path that
    /// begins in motion.
    fn ramp(&self, speed: f64) -> f64 {
        let Some((first, _)) = self.speed_from(0) else {
            return 0.0;
        };
        if first >= RESTS * speed {
            return 0.0;
        }
        let mut from = 0;
        while let Some((now, end)) = self.speed_from(from) {
            if now >= REACHED * speed {
                return (self.points[end].1 + SETTLING_S * speed).max(LEAST);
            }
            from += 1;
        }
        LEAST
    }
}
