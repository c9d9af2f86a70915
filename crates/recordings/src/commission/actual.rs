//! Check that recorded actual positions are actual ones (R16.14, R16.18).

use serde::{Deserialize, Serialize};

use super::following::{COARSEST_S, STANDSTILL, commanded, step_at_reversals};
use super::results::RecordingOutcome;
use crate::identify::{AxisRecording, count, median, moving_average, noise_of, samples_in};
use frictcomp_physics::linear::solve_linear;

/// The time in s over which noise is averaged to find what friction leaves.
const AVERAGED_S: f64 = 0.02;

/// Largest remainder of a copy, as a multiple of its averaged noise …
const OF_NOISE: f64 = 1.5;

/// … or this, in mm: the resolution of commanded positions.
const RESOLUTION_MM: f64 = 5e-5;

/// Millimetres in 0.1 µm.
const MM: f64 = 1e-4;

/// Relation of an actual position to the commanded one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct FollowedPosition {
    /// The lag in s.
    pub lag_s: f64,
    /// The part by which the actual way is longer than the commanded one.
    pub longer: f64,
    /// The root mean square in mm of what neither lag nor scale explain, averaged over 20 ms.
    pub left_mm: f64,
    /// The standard deviation in mm of the noise of a sample.
    pub noise_mm: f64,
    /// The time in s over which each sample is an average, if its noise shows one.
    pub averaged_s: Option<f64>,
    /// The time in s for which it is held on average while it moves fast, if that is more than a sample.
    pub held_s: Option<f64>,
    /// Additional lag in the positive direction compared with the negative one, long after a reversal, in mm.
    pub step_mm: Option<f64>,
}

impl FollowedPosition {
    /// Compares the actual positions of an axis with the commanded ones from a time in s on; `None` if one of them was
    /// not recorded, or the axis hardly moves.
    pub fn of(recording: &AxisRecording, from_s: f64) -> Option<Self> {
        let track = &recording.track;
        let errors: Vec<f64> = recording
            .following_errors
            .iter()
            .map(|it| it * MM)
            .collect();
        let positions = track.positions.as_ref()?;
        let velocities = commanded(track);
        if errors.len() != positions.len() || velocities.len() != positions.len() {
            return None;
        }
        let from = track.times_s.partition_point(|it| *it < from_s);
        let moves = |at: &usize| velocities[*at].abs() > STANDSTILL;
        let moving: Vec<usize> = (from..errors.len()).filter(moves).collect();
        let middle = positions.get(*moving.first()?)? * MM;
        let causes = |at: usize| [1.0, velocities[at], positions[at] * MM - middle];
        let mut rows = vec![vec![0.0; 4]; 3];
        for &at in &moving {
            let causes = causes(at);
            for (row, cause) in rows.iter_mut().zip(causes) {
                for (sum, other) in row.iter_mut().zip(causes.iter().chain([&errors[at]])) {
                    *sum += cause * other;
                }
            }
        }
        let answer = solve_linear(rows)?;
        let left: Vec<f64> = (from..errors.len())
            .map(|at| {
                let causes = causes(at);
                let expected = causes.iter().zip(&answer).map(|(one, it)| one * it);
                errors[at] - expected.sum::<f64>()
            })
            .collect();
        let noise_mm = noise_of(&left);
        let averaged_s = averaged_samples(&left).map(|it| count(it) * track.step_s);
        let averaged = moving_average(&left, samples_in(AVERAGED_S, track.step_s).max(1));
        let squares: f64 = moving.iter().map(|at| averaged[at - from].powi(2)).sum();
        Some(Self {
            lag_s: answer[1],
            longer: -answer[2],
            left_mm: (squares / count(moving.len())).sqrt(),
            noise_mm,
            averaged_s,
            held_s: held_samples(positions, &errors, &velocities).map(|it| it * track.step_s),
            step_mm: step_at_reversals(track, &recording.following_errors),
        })
    }

    /// States that the actual positions do not change with every sample, if so.
    pub fn is_held(&self) -> Option<String> {
        self.held_s.filter(|it| *it > COARSEST_S).map(|held_s| {
            format!(
                "its actual position changes every {:.1} ms only, which does not show what a reversal does; record every \
                 ms, in the full resolution",
                held_s * 1000.0
            )
        })
    }

    /// States that the actual positions are the commanded ones, if they show nothing but noise (R16.14).
    pub fn is_commanded(&self, step_s: f64) -> Option<String> {
        let averaged = self.noise_mm / count(samples_in(AVERAGED_S, step_s).max(1)).sqrt();
        let least = (OF_NOISE * averaged).max(RESOLUTION_MM);
        (self.left_mm < least).then(|| {
            format!(
                "its actual positions are the commanded ones: apart from noise of {:.2} µm they differ by {:.2} µm, and \
                 friction leaves more",
                self.noise_mm * 1000.0,
                self.left_mm * 1000.0
            )
        })
    }
}

/// Returns the mean number of samples for which an actual position is held in fast motion, if that is more than one.
fn held_samples(commanded: &[f64], errors: &[f64], velocities: &[f64]) -> Option<f64> {
    /// The part of the greatest speed that is fast.
    const FAST: f64 = 0.5;
    /// Smaller differences, in mm, are those of numbers.
    const SAME_MM: f64 = 1e-6;
    const SEVERAL: f64 = 1.2;
    let fastest = velocities
        .iter()
        .fold(0.0_f64, |most, it| most.max(it.abs()));
    let is_fast = |at: &usize| velocities[*at].abs() > FAST * fastest;
    let actual = |at: usize| commanded[at] * MM - errors[at];
    let fast: Vec<usize> = (1..errors.len()).filter(is_fast).collect();
    let changes = fast
        .iter()
        .filter(|at| (actual(**at) - actual(**at - 1)).abs() > SAME_MM);
    let held = count(fast.len()) / count(changes.count());
    (held > SEVERAL && held.is_finite()).then_some(held)
}

/// Returns the number of samples over which each one is an average. Such a sample differs from the one before by a new
/// value and by the one that drops out, so that differences as many samples apart are opposed, and no others are.
pub(super) fn averaged_samples(values: &[f64]) -> Option<usize> {
    /// Number of samples over which differences are taken, so that the averaged noise exceeds that of rounding.
    const OVER: usize = 4;
    const LONGEST: usize = 100;
    /// Number of standard deviations of the differences above which one is motion.
    const MOTION: f64 = 4.0;
    const OPPOSED: f64 = -0.03;
    const ERRORS: f64 = 8.0;
    /// A vibration is opposed at other times, too.
    const ALONE: f64 = 0.5;
    let mut differences: Vec<f64> = values
        .windows(OVER + 1)
        .map(|it| it[OVER] - it[0])
        .collect();
    if differences.len() < 10 * LONGEST {
        return None;
    }
    let sizes: Vec<f64> = differences.iter().map(|it| it.abs()).collect();
    let most = MOTION * 1.4826 * median(&sizes)?;
    for it in &mut differences {
        *it = if it.abs() > most { 0.0 } else { *it };
    }
    let whole: f64 = differences.iter().map(|it| it * it).sum();
    let alike: Vec<f64> = (0..=LONGEST + OVER)
        .map(|lag| {
            let later = &differences[lag..];
            later
                .iter()
                .zip(&differences)
                .map(|(one, it)| one * it)
                .sum::<f64>()
                / whole
        })
        .collect();
    let beside = |lag: usize| alike[lag] - f64::midpoint(alike[lag - OVER], alike[lag + OVER]);
    let opposed = |lag: &usize| beside(*lag);
    let least = |one: &usize, other: &usize| opposed(one).total_cmp(&opposed(other));
    let lags = 2 * OVER..=LONGEST;
    let lag = lags.clone().min_by(least)?;
    let other = lags
        .filter(|it| it.abs_diff(lag) > 2 * OVER)
        .min_by(least)?;
    let limit = OPPOSED.min(-ERRORS / count(differences.len()).sqrt());
    (beside(lag) < limit && beside(other) > ALONE * beside(lag)).then_some(lag)
}

/// Returns the time in s over which the positions of an axis are averages in a stage: a recorder averages in all of its
/// recordings, and what one of them shows alone is chance.
fn averaged_in(recorded: &[&RecordingOutcome], axis: usize) -> Option<f64> {
    const SAME: f64 = 0.1;
    let times: Vec<f64> = recorded
        .iter()
        .filter_map(|it| it.averaged_s(axis))
        .collect();
    let middle_s = median(&times)?;
    let agree = times
        .iter()
        .filter(|it| (*it / middle_s - 1.0).abs() <= SAME);
    (2 * agree.count() > recorded.len()).then_some(middle_s)
}

/// States how the circles or strokes of a round were recorded otherwise than those off, for each axis: averaged, later,
/// in another scale, or with a step at each reversal (R16.14, R16.18). They are not compared then.
pub(super) fn recorded_otherwise(
    names: &[&str],
    off: &[&RecordingOutcome],
    on: &[&RecordingOutcome],
) -> Vec<String> {
    const LATER_S: f64 = 0.001;
    const SCALE: f64 = 0.0005;
    const STEP_MM: f64 = 0.0015;
    /// Slow loops leave this part of a glitch for long.
    const LASTING: f64 = 0.03;
    let outcomes = off.iter().chain(on);
    let largest_mm = outcomes.fold(0.0_f64, |most, it| most.max(it.largest_glitch())) / 1000.0;
    let step_mm = STEP_MM.max(LASTING * largest_mm);
    let unit = on.first().map_or("µm", |it| it.unit());
    let mut against = Vec::new();
    for (at, name) in names.iter().enumerate().take(2) {
        let of = |recorded: &[&RecordingOutcome]| -> Vec<FollowedPosition> {
            recorded.iter().filter_map(|it| it.followed(at)).collect()
        };
        let [before, after] = [of(off), of(on)];
        let middle = |all: &[FollowedPosition], value: fn(&FollowedPosition) -> Option<f64>| {
            median(&all.iter().filter_map(value).collect::<Vec<_>>())
        };
        let both = |value: fn(&FollowedPosition) -> Option<f64>| {
            middle(&before, value).zip(middle(&after, value))
        };
        let stages = [("off", off), ("on", on)].map(|(state, all)| {
            averaged_in(all, at)
                .map(|over_s| format!("over {:.0} ms in the recordings {state}", over_s * 1000.0))
        });
        let averages = stages
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join(" and ");
        if !averages.is_empty() {
            against.push(format!(
                "the positions of {name} are averages {averages}, which hides what a reversal leaves: record every \
                 sample as it is"
            ));
        }
        if let Some((off_s, on_s)) =
            both(|it| Some(it.lag_s)).filter(|(off, on)| (on - off).abs() > LATER_S)
        {
            against.push(format!(
                "{name} follows its command after {:.1} ms in the recordings off and {:.1} ms in those on: positions are \
                 averaged or late in one of them, its loops were changed, or they are of another machine; record both \
                 alike",
                off_s * 1000.0,
                on_s * 1000.0
            ));
        }
        if let Some((off, on)) =
            both(|it| Some(it.longer)).filter(|(off, on)| (on - off).abs() > SCALE)
        {
            against.push(format!(
                "the way of {name} is {:+.2} % longer than commanded in the recordings off and {:+.2} % in those on: \
                 another scale; record both alike",
                off * 100.0,
                on * 100.0
            ));
        }
        if let Some((off, on)) =
            both(|it| it.step_mm).filter(|(off, on)| (on - off).abs() > step_mm)
        {
            against.push(format!(
                "the positions of {name} step by {:.1} {unit} where it reverses in the recordings off and by {:.1} \
                 {unit} in those on: backlash in one of them, or its compensation was changed; record both alike",
                off * 1000.0,
                on * 1000.0
            ));
        }
    }
    against
}

/// Names two axes that were recorded at different times, or in different scales (R16.18).
pub fn recorded_apart(names: [&str; 2], followed: [FollowedPosition; 2]) -> Vec<String> {
    const APART_S: f64 = 0.0015;
    const SCALE: f64 = 0.001;
    let mut notes = Vec::new();
    let [x, y] = followed;
    if (x.lag_s - y.lag_s).abs() > APART_S {
        notes.push(format!(
            "{} follows its command after {:.1} ms and {} after {:.1} ms: recorded at different times, or their loops \
             differ",
            names[0],
            x.lag_s * 1000.0,
            names[1],
            y.lag_s * 1000.0
        ));
    }
    for (name, it) in names.iter().zip(followed) {
        if it.longer.abs() > SCALE {
            notes.push(format!(
                "the way of {name} is {:+.2} % longer than commanded: its scale is not that of the command",
                it.longer * 100.0
            ));
        }
    }
    notes
}
