//! A recorded torque compared with the prediction of a value list (R6.20).

use std::ops::RangeInclusive;

use super::identified::IdentifyError;
use super::recorded::AxisRecording;
use super::speeds::doubts_about;
use super::statistics::{count, moving_average, noise_of, samples_in};
use super::timing::{FollowedRecording, Timing};
use super::track::{AxisSamples, Track};
use frictcomp::diagnostic::Code;
use frictcomp::lists::FrictionList;
use frictcomp_physics::current::{
    AdditiveCurrent, POSITION_UNITS_PER_MM, Reading, VELOCITY_UNITS_PER_MM_PER_S,
};
use frictcomp_physics::linear::solve_linear;

/// Fit of a value list to a recording.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Verified {
    /// Recorded friction as a part of the predicted one, over all speeds.
    pub scale: f64,
    /// The scale by ranges of speeds.
    pub ranges: Vec<ScaleRange>,
    /// The speeds of the list of which the recording has too little motion, in mm/s or °/s (R18.11).
    pub not_judged: Vec<RangeInclusive<f64>>,
    /// Part that is the same in both directions, in drive units.
    pub offset: f64,
    /// Torque of an acceleration of 1 mm/s², in drive units.
    pub inertia: f64,
    /// Timing of the list in the following error.
    pub timing: Timing,
    /// The time between two samples.
    pub step_s: f64,
    /// The CNC cycle, in which the control computes the additive current.
    pub cycle_s: f64,
    /// The standard deviation of the residual, in drive units.
    pub residual: f64,
    /// The reversals of the recording.
    pub reversals: Vec<Reversal>,
    /// The range in which both directions differ most beyond an offset, with half of the difference as a part of the
    /// predicted friction, if that is no noise.
    pub one_sided: Option<ScaleRange>,
    /// Whether only motion farther than [`CONTACT_MM`] from the last reversal counts for the scales.
    pub is_away_from_reversals: bool,
    /// Whether the recording may be of something else, or friction changes in it (R6.21).
    pub is_doubted: bool,
}

/// A range of speeds with its scale.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ScaleRange {
    /// The slowest speed of the range, in mm/s or °/s.
    pub from: f64,
    /// The fastest one.
    pub to: f64,
    /// Recorded friction as a part of the predicted one.
    pub scale: f64,
}

/// A change of direction.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Reversal {
    /// The time in s.
    pub time_s: f64,
    /// The recorded step of the torque, in drive units, without inertia.
    pub recorded: f64,
    /// The step that the list predicts.
    pub predicted: f64,
}

/// Ends of the ranges of speeds in mm/s: between speeds that people record, so that the noise of none is split.
const BOUNDS: [f64; 8] = [1.4, 3.4, 7.6, 14.0, 34.0, 76.0, 140.0, f64::INFINITY];

/// Speed in mm/s below which motion is rest.
const REST: f64 = 0.05;

/// Velocities with less noise in mm/s are commanded ones.
const QUIET: f64 = 0.002;

/// Seconds over which the velocity is averaged.
const AVERAGED_S: f64 = 0.01;

/// Seconds after a reversal in which samples do not count for the scale.
const AFTER_S: f64 = 0.05;

/// The way after a reversal in mm or degrees in which samples do not count for the scale, either: the contact
/// builds up its friction over a way, on slow circles for longer than 0.05 s (R5.36).
pub const CONTACT_MM: f64 = 0.15;

/// A range with fewer samples has no scale.
const FEWEST: usize = 100;

/// A list on a control.
#[derive(Debug, Clone, Copy)]
pub struct Predictor<'a> {
    /// The value list.
    pub list: &'a FrictionList,
    /// Reading of the documents.
    pub reading: Reading,
    /// The CNC cycle in s; without it the time between two samples.
    pub cycle_s: Option<f64>,
}

/// Compares a recording with a value list, as [`verify_followed`] does, and adds what makes the recording doubtful to its
/// findings (R6.21).
///
/// # Errors
/// The recording cannot be used, or cannot show any friction, or the axis moves in one direction only.
pub fn verify_recording(
    recording: &mut AxisRecording,
    predictor: &Predictor<'_>,
) -> Result<Verified, IdentifyError> {
    let verified = verify_followed(&recording.track, &recording.following_errors, predictor)?;
    let doubts = doubts_about(&recording.track, recording.measured)?.into_iter();
    // Definite faults come before what is not known.
    let (open, wrong): (Vec<_>, Vec<_>) = doubts.partition(|it| it.code == Code::Fc521);
    let is_doubted = !wrong.is_empty();
    recording.findings.splice(0..0, wrong);
    recording.findings.extend(open);
    Ok(Verified {
        is_doubted,
        ..verified
    })
}

/// Calls [`verify_followed`] without a following error: the timing of the list stays open.
///
/// # Errors
/// The recording cannot be used, or the axis moves in one direction only.
pub fn verify(track: &Track, predictor: &Predictor<'_>) -> Result<Verified, IdentifyError> {
    verify_followed(track, &[], predictor)
}

/// Compares a recording with the additive current that a control computes from a value list
/// (chapter 4 of the rules). Following errors are commanded less actual positions in 0.1 µm or
/// 0.0001°, one for each sample of the track, or none.
///
/// # Errors
/// The recording cannot be used, or the axis moves in one direction only.
pub fn verify_followed(
    track: &Track,
    following_errors: &[f64],
    predictor: &Predictor<'_>,
) -> Result<Verified, IdentifyError> {
    let samples = AxisSamples::new(track)?;
    let motion = PredictedMotion::of(&samples, predictor);
    if predictor.list.adds_nothing() {
        return Err(IdentifyError::NothingAdded);
    }
    let directions = |sign: f64| motion.signs.iter().any(|it| it * sign > 0.0);
    if !(directions(1.0) && directions(-1.0)) {
        return Err(IdentifyError::OneDirection);
    }
    let after = samples_in(AFTER_S, samples.step_s);
    let mut used = motion.used(after, (&samples.positions, CONTACT_MM));
    let is_away_from_reversals = used.len() >= FEWEST;
    if !is_away_from_reversals {
        // Strokes that are too short: all there is.
        used = motion.used(after, (&samples.positions, 0.0));
    }
    let whole = regress(&samples, &motion, &used, |_| 0);
    let ranges = regress(&samples, &motion, &used, range_of);
    let [Some(whole), Some(ranges)] = [whole, ranges] else {
        return Err(IdentifyError::NoSegments);
    };
    let slowest = motion.slowest(&used);
    let fastest = motion.fastest();
    let range = |at: usize, scale| ScaleRange {
        from: at.checked_sub(1).map_or(slowest, |before| BOUNDS[before]),
        to: BOUNDS[at].min(fastest),
        scale,
    };
    let one_sided = ranges.one_sided(&samples, &motion, &used);
    let one_sided = one_sided.map(|(at, part)| range(at, part));
    let scales = ranges.scales.iter().enumerate();
    let ranges = scales.filter_map(|(at, scale)| Some(range(at, (*scale)?)));
    let scale = whole.scales[0].unwrap_or(0.0);
    let rest: Vec<f64> = (0..samples.torques.len())
        .map(|at| samples.torques[at] - whole.inertia * motion.accelerations[at] - whole.offset)
        .collect();
    let squares: f64 = used
        .iter()
        .map(|&at| (rest[at] - scale * motion.predicted[at]).powi(2))
        .sum();
    let turns = motion.turns();
    let at_once: Vec<usize> = turns
        .iter()
        .copied()
        .filter(|&at| motion.turns_at_once(at))
        .collect();
    let errors: Vec<f64> = following_errors
        .iter()
        .map(|it| it / POSITION_UNITS_PER_MM)
        .collect();
    let cycle_s = predictor.cycle_s.unwrap_or(samples.step_s);
    let followed = FollowedRecording {
        samples: &samples,
        errors: &errors,
        predicted: &motion.predicted,
        velocities: &motion.velocities,
        accelerations: &motion.accelerations,
        turns: &at_once,
        signs: &motion.signs,
        cycle: cycle_s / samples.step_s,
    };
    let is_followed = errors.len() == samples.torques.len();
    let ranges: Vec<ScaleRange> = ranges.collect();
    Ok(Verified {
        scale,
        not_judged: predictor.not_judged(&ranges),
        ranges,
        offset: whole.offset,
        inertia: whole.inertia,
        timing: if is_followed {
            followed.timing()
        } else {
            Timing::Open
        },
        step_s: samples.step_s,
        cycle_s,
        residual: (squares / count(used.len())).sqrt(),
        reversals: turns
            .iter()
            .filter_map(|&at| motion.reversal(&samples, &rest, at))
            .collect(),
        one_sided,
        is_away_from_reversals,
        is_doubted: false,
    })
}

/// Maximum number of cycles between two samples.
const MOST_CYCLES: f64 = 100.0;

impl Predictor<'_> {
    /// Returns the speeds from rest to the last point of the list that no range holds.
    fn not_judged(&self, ranges: &[ScaleRange]) -> Vec<RangeInclusive<f64>> {
        let last = self.list.table.last();
        let fastest = last.map_or(0.0, |point| point.input / 1000.0);
        let begins = [REST]
            .into_iter()
            .chain(ranges.iter().map(|range| range.to));
        let ends = ranges.iter().map(|range| range.from).chain([fastest]);
        begins
            .zip(ends)
            .map(|(from, to)| from..=to.min(fastest))
            .filter(|gap| *gap.end() > 1.02 * gap.start())
            .collect()
    }

    /// Returns the additive current at each sample, of an axis with these velocities in mm/s.
    fn currents(&self, samples: &AxisSamples, velocities: &[f64]) -> Vec<f64> {
        let mut current = AdditiveCurrent::new(self.list, self.reading);
        let cycle_s = self.cycle_s.unwrap_or(samples.step_s);
        let cycle_s = cycle_s.max(samples.step_s / MOST_CYCLES);
        // A commanded velocity has no noise, and turns where it changes its sign.
        let rest = REST.min(5.0 * noise_of(&samples.velocities));
        let moving = |velocity: f64| {
            let is_moving = velocity.abs() > rest;
            if is_moving {
                velocity * VELOCITY_UNITS_PER_MM_PER_S
            } else {
                0.0
            }
        };
        let times = &samples.times_s;
        let (first, last) = (times[0], times[times.len() - 1]);
        let mut after = 0;
        let [mut positions, mut speeds, mut reached] = [const { Vec::new() }; 3];
        let mut time = first;
        // The motion at each cycle, linear between samples.
        while time <= last + 0.5 * cycle_s {
            while after + 1 < times.len() && times[after] < time {
                after += 1;
            }
            let before = after.saturating_sub(1);
            let length = times[after] - times[before];
            let share = if length > 0.0 {
                ((time - times[before]) / length).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let between =
                |values: &[f64]| values[before] + share * (values[after] - values[before]);
            positions.push(between(&samples.positions) * POSITION_UNITS_PER_MM);
            speeds.push(moving(between(velocities)));
            reached.push(time);
            time += cycle_s;
        }
        let added = current.trace(&positions, &speeds);
        let mut at = 0;
        let of_sample = |&time: &f64| {
            while at + 1 < reached.len() && reached[at + 1] <= time + 1e-3 * cycle_s {
                at += 1;
            }
            added[at].current_units
        };
        times.iter().map(of_sample).collect()
    }
}

/// The motion of an axis, and the friction that the list predicts.
struct PredictedMotion {
    velocities: Vec<f64>,
    accelerations: Vec<f64>,
    /// Speed in mm/s below which motion has no direction.
    rest: f64,
    /// The direction of each sample; at rest the last one applies.
    signs: Vec<f64>,
    predicted: Vec<f64>,
}

impl PredictedMotion {
    fn of(samples: &AxisSamples, predictor: &Predictor<'_>) -> Self {
        let velocities =
            moving_average(&samples.velocities, samples_in(AVERAGED_S, samples.step_s));
        let noise = noise_of(&samples.velocities);
        // Commanded velocities reverse where their sign changes; an average would reverse elsewhere.
        let (turning, rest) = if noise < QUIET {
            (&samples.velocities, REST.min(5.0 * noise))
        } else {
            (&velocities, REST)
        };
        let mut direction = 0.0;
        let signs: Vec<f64> = turning
            .iter()
            .map(|velocity| {
                if velocity.abs() > rest {
                    direction = velocity.signum();
                }
                direction
            })
            .collect();
        let end = velocities.len() - 1;
        let slope = |at: usize| {
            let (from, to) = (at.saturating_sub(2), (at + 2).min(end));
            (velocities[to] - velocities[from]) / (samples.times_s[to] - samples.times_s[from])
        };
        Self {
            accelerations: (0..=end).map(slope).collect(),
            predicted: predictor.currents(samples, turning),
            rest,
            signs,
            velocities,
        }
    }

    /// Returns the speed from which on there are enough samples to judge a list.
    fn slowest(&self, used: &[usize]) -> f64 {
        let mut speeds: Vec<f64> = used.iter().map(|&at| self.velocities[at].abs()).collect();
        speeds.sort_unstable_by(f64::total_cmp);
        speeds.get(FEWEST - 1).map_or(REST, |speed| speed.max(REST))
    }

    fn fastest(&self) -> f64 {
        self.velocities
            .iter()
            .fold(0.0, |most, velocity| most.max(velocity.abs()))
    }

    /// Returns the samples at which the direction changes.
    fn turns(&self) -> Vec<usize> {
        (1..self.signs.len())
            .filter(|&at| self.signs[at] * self.signs[at - 1] < 0.0)
            .collect()
    }

    /// Returns the samples in motion, without those shortly after a change of direction: some samples, and some way.
    fn used(&self, after: usize, (positions, way): (&[f64], f64)) -> Vec<usize> {
        let mut since = 0;
        let mut from = positions[0];
        let mut used = Vec::new();
        let signs = self.signs.windows(2).zip(&positions[1..]);
        for (at, (signs, position)) in (1..).zip(signs) {
            if signs[0] * signs[1] > 0.0 {
                since += 1;
            } else {
                (since, from) = (0, *position);
            }
            let is_away = since >= after && (position - from).abs() >= way;
            if is_away && self.velocities[at].abs() > REST {
                used.push(at);
            }
        }
        used
    }

    /// Returns whether the axis reverses without standstill: only then the timing is visible.
    fn turns_at_once(&self, at: usize) -> bool {
        const LONGEST: usize = 20;
        let moving = |index: usize| self.velocities[index].abs() > self.rest;
        (at.saturating_sub(LONGEST)..at).any(moving)
    }

    fn reversal(&self, samples: &AxisSamples, rest: &[f64], at: usize) -> Option<Reversal> {
        let width = samples_in(0.02, samples.step_s);
        let mean = |values: &[f64]| values.iter().sum::<f64>() / count(values.len());
        let [before, after] = [
            at.checked_sub(3 * width)?..at - 2 * width,
            at + 2 * width..at + 3 * width,
        ];
        let step = |values: &[f64]| {
            Some(mean(values.get(after.clone())?) - mean(values.get(before.clone())?))
        };
        Some(Reversal {
            time_s: samples.times_s[at],
            recorded: step(rest)?,
            predicted: step(&self.predicted)?,
        })
    }
}

/// Returns the range of a speed in mm/s.
fn range_of(speed: f64) -> usize {
    BOUNDS.partition_point(|bound| *bound < speed)
}

/// A least-squares fit of the recorded torque.
struct Regression {
    /// Scales by range; `None` with too few samples.
    scales: Vec<Option<f64>>,
    inertia: f64,
    offset: f64,
}

/// Directions that differ by more than this part of the friction beyond an offset are no noise of a recording.
const ONE_SIDED: f64 = 0.1;

impl Regression {
    /// Returns the range in which the recorded torque lies most to one side of the fit in both directions, and how much, as a
    /// part of the predicted friction. A value list is alike in both directions, and an offset at all speeds.
    fn one_sided(
        &self,
        samples: &AxisSamples,
        motion: &PredictedMotion,
        used: &[usize],
    ) -> Option<(usize, f64)> {
        let mut sums = [[(0.0, 0.0, 0_usize); 2]; BOUNDS.len()];
        for &at in used {
            let range = range_of(motion.velocities[at].abs());
            let Some(scale) = self.scales[range] else {
                continue;
            };
            let predicted = scale * motion.predicted[at];
            let fitted = predicted + self.inertia * motion.accelerations[at] + self.offset;
            let sum = &mut sums[range][usize::from(motion.signs[at] < 0.0)];
            sum.0 += samples.torques[at] - fitted;
            sum.1 += predicted.abs();
            sum.2 += 1;
        }
        let parts = sums.iter().enumerate().filter_map(|(range, sides)| {
            let is_known = sides.iter().all(|side| side.2 >= FEWEST && side.1 > 0.0);
            let [forth, back] = sides.map(|side| side.0 / side.1);
            is_known.then_some((range, f64::midpoint(forth, back)))
        });
        let most = parts.max_by(|one, other| one.1.abs().total_cmp(&other.1.abs()));
        most.filter(|(_, part)| part.abs() > ONE_SIDED)
    }
}

/// Returns the torque as the prediction times a scale, which may differ between ranges, an inertia times the
/// acceleration, and an offset.
fn regress(
    samples: &AxisSamples,
    motion: &PredictedMotion,
    used: &[usize],
    range: impl Fn(f64) -> usize,
) -> Option<Regression> {
    let ranges = BOUNDS.len();
    let size = ranges + 2;
    let mut sums = vec![vec![0.0; size + 1]; size];
    let mut weights = [0.0; BOUNDS.len()];
    let mut row = vec![0.0; size];
    for &at in used {
        row.fill(0.0);
        let range = range(motion.velocities[at].abs());
        weights[range] += 1.0;
        row[range] = motion.predicted[at];
        row[ranges] = motion.accelerations[at];
        row[ranges + 1] = 1.0;
        for (i, one) in row.iter().enumerate().filter(|(_, value)| **value != 0.0) {
            for (j, other) in row.iter().enumerate() {
                sums[i][j] += one * other;
            }
            sums[i][size] += one * samples.torques[at];
        }
    }
    let is_kept = |at: &usize| match at.checked_sub(ranges) {
        None => weights[*at] >= count(FEWEST) && sums[*at][*at] > 0.0,
        Some(0) => sums[*at][*at] > 1e-6 * count(used.len()),
        Some(_) => true,
    };
    let kept: Vec<usize> = (0..size).filter(is_kept).collect();
    let matrix = kept.iter().map(|&i| {
        let row = kept.iter().map(|&j| sums[i][j]);
        row.chain([sums[i][size]]).collect()
    });
    let found = solve_linear(matrix.collect())?;
    let value = |part: usize| Some(found[kept.iter().position(|&it| it == part)?]);
    let scales: Vec<Option<f64>> = (0..ranges).map(value).collect();
    scales.iter().any(Option::is_some).then(|| Regression {
        scales,
        inertia: value(ranges).unwrap_or(0.0),
        offset: value(ranges + 1).unwrap_or(0.0),
    })
}

impl Verified {
    /// Returns whether the list fits the recorded torque, and nothing makes the recording doubtful.
    pub fn fits(&self) -> bool {
        self.agrees() && !self.is_doubted
    }

    /// Returns whether the list has no fault, and no other list acted.
    pub fn agrees(&self) -> bool {
        self.verdict().is_empty() && !matches!(self.timing, Timing::Other(_))
    }

    /// Returns the faults of the list, each a sentence.
    pub fn verdict(&self) -> Vec<String> {
        /// Deviation of a scale from 1 within which a list is right.
        const RIGHT: f64 = 0.03;
        let mut said = Vec::new();
        if self.scale < 0.0 {
            said.push("the sign of the list is inverted".to_owned());
        }
        let part = |range: &ScaleRange| (1.0 - 1.0 / range.scale.abs()) * 100.0;
        let is_off = |range: &ScaleRange| (range.scale.abs() - 1.0).abs() > RIGHT;
        // Neighbours that are wrong in the same direction are one fault.
        let is_alike = |one: &ScaleRange, other: &ScaleRange| {
            is_off(one) == is_off(other) && (part(one) > 0.0) == (part(other) > 0.0)
        };
        for fault in self.ranges.chunk_by(is_alike) {
            let ([begin, ..], [.., end]) = (fault, fault) else {
                continue;
            };
            if !is_off(begin) {
                continue;
            }
            let parts = fault.iter().map(|range| part(range).abs());
            let [least, most] = parts.fold([f64::MAX, 0.0], |[least, most]: [f64; 2], it| {
                [least.min(it), most.max(it)]
            });
            let word = if part(begin) > 0.0 { "low" } else { "high" };
            let amount = match (format!("{least:.0}"), format!("{most:.0}")) {
                (least, most) if least == most => most,
                (least, most) => format!("{least} to {most}"),
            };
            said.push(format!(
                "the list is {amount} % {word} from {:.2} to {:.2} mm/s",
                begin.from, end.to
            ));
        }
        if let Some(range) = &self.one_sided {
            said.push(format!(
                "friction differs by direction, from {:.2} to {:.2} mm/s by {:.0} % beyond an offset, which no list holds",
                range.from,
                range.to,
                200.0 * range.scale.abs()
            ));
        }
        if let Some(word) = self.timing.early_or_late() {
            said.push(format!("the list comes {word} at reversals"));
        }
        said
    }
}
