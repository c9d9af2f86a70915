//! The faults of a recording: it is refused, or its fault is reported before anything else (R6.21).

use super::clipped::clipped;
use super::finding::TraceFinding;
use super::identified::IdentifyError;
use super::measured::{Contradiction, Measured, TorqueKind};
use super::pair::{Pair, speeds_of};
use super::segment::Segment;
use super::statistics::{count, samples_in, trimmed_mean};
use super::tight::tight_spot;
use super::track::AxisSamples;
use frictcomp::diagnostic::Code;
use frictcomp_physics::current::Switched;

/// Part of the clipped speeds above which nothing is identified.
const MOST_CLIPPED: f64 = 0.2;

/// Part of the rated torque below which friction is that of a compensated loop.
const LEAST_OF_RATED: f64 = 0.02;

/// Part of the rated torque above which friction is questionable; above the whole of it no axis moves for long.
const MUCH_OF_RATED: f64 = 0.5;

/// Number of standard errors that is significant.
const SIGNIFICANT: f64 = 3.0;

/// Returns a fault that rules out a list.
pub(super) fn refused(code: Code, message: String, help: &str) -> IdentifyError {
    IdentifyError::Refused(TraceFinding::new(code, message, help))
}

/// Checks that velocity and position have the same direction, and that the velocity has both signs.
pub(super) fn check_directions(
    samples: &AxisSamples,
    segments: &[Segment],
) -> Result<(), IdentifyError> {
    let every = samples_in(0.1, samples.step_s);
    let (mut along, mut way, mut back) = (0.0, 0.0, 0.0);
    for at in (every..samples.times_s.len()).step_by(every) {
        let moved = samples.positions[at] - samples.positions[at - every];
        let middle = samples.velocities[at - every / 2];
        along += moved * middle;
        way += (moved * middle).abs();
        back += (-moved * middle).max(0.0);
    }
    if samples.has_positions && along < -0.5 * way {
        return Err(refused(
            Code::Fc522,
            format!(
                "the position goes against the velocity on {:.0} % of the way: one of them has the wrong sign",
                back / way * 100.0
            ),
            "record velocity and position of the same axis, with the same sign",
        ));
    }
    let is_one_way = is_one_way(samples, segments);
    if is_one_way && samples.has_positions && back > 0.1 * way {
        return Err(unsigned_velocity(&format!(
            "the velocity never changes its sign, but on {:.0} % of the way the position goes back",
            back / way * 100.0
        )));
    }
    match two_torques(samples, segments).filter(|_| is_one_way) {
        Some((speed, [one, other])) => Err(unsigned_velocity(&format!(
            "the velocity never changes its sign, but at {speed:.3} mm/s the torque is {one:.3} and {other:.3}"
        ))),
        None => Ok(()),
    }
}

/// Returns whether all segments have one direction; without segments, whether all velocities do.
fn is_one_way(samples: &AxisSamples, segments: &[Segment]) -> bool {
    /// Largest noise around standstill, as a part of the fastest speed.
    const NOISE: f64 = 0.1;
    if !segments.is_empty() {
        let ways = |sign: f64| segments.iter().any(|it| it.velocity * sign > 0.0);
        return !(ways(1.0) && ways(-1.0));
    }
    let most = |sign: f64| {
        let signed = samples.velocities.iter().map(|it| it * sign);
        signed.fold(0.0, f64::max)
    };
    let [forth, back] = [most(1.0), most(-1.0)];
    forth.min(back) < NOISE * forth.max(back)
}

fn unsigned_velocity(message: &str) -> IdentifyError {
    refused(
        Code::Fc523,
        format!("{message}: it is an absolute value"),
        "record the velocity with its sign, or the position",
    )
}

/// Returns a speed in apparently one direction with torques that differ as in both directions.
fn two_torques(samples: &AxisSamples, segments: &[Segment]) -> Option<(f64, [f64; 2])> {
    /// A difference by this part of the greater one is not drift.
    const APART: f64 = 0.3;
    let mean = |segment: &Segment| trimmed_mean(&samples.torques[segment.samples.clone()]);
    segments.windows(2).find_map(|pair| {
        let [one, other] = [mean(&pair[0]), mean(&pair[1])];
        let is_apart = (one - other).abs() > APART * one.abs().max(other.abs());
        (is_apart && pair[0].is_as_fast_as(&pair[1]))
            .then_some((pair[0].velocity.abs(), [one, other]))
    })
}

/// Drops segments whose torque is clipped, and reports them.
pub(super) fn drop_clipped(
    samples: &AxisSamples,
    segments: &mut Vec<Segment>,
) -> Result<Option<TraceFinding>, IdentifyError> {
    let clipped = clipped(samples, segments);
    let Some(&first) = clipped.first() else {
        return Ok(None);
    };
    let all = speeds_of(segments);
    let is_cut = |group: &Vec<usize>| group.iter().any(|it| clipped.contains(it));
    let cut: Vec<&Vec<usize>> = all.iter().filter(|group| is_cut(group)).collect();
    let speed = |group: &&Vec<usize>| format!("{:.3}", segments[group[0]].velocity.abs());
    let speeds: Vec<String> = cut.iter().map(speed).collect();
    let limit = trimmed_mean(&samples.torques[segments[first].samples.clone()]).abs();
    let message = format!(
        "the torque is clipped near {limit:.1} at {} of {} speeds ({} mm/s)",
        cut.len(),
        all.len(),
        speeds.join(", ")
    );
    let help = "raise the torque limit of the drive or the range of the recorded channel, and record again";
    if count(cut.len()) > MOST_CLIPPED * count(all.len()) {
        return Err(refused(Code::Fc520, message, help));
    }
    let mut at = 0;
    segments.retain(|_| {
        at += 1;
        !clipped.contains(&(at - 1))
    });
    let message = format!("{message}; these segments are left out");
    Ok(Some(TraceFinding::new(Code::Fc520, message, help)))
}

/// Rows that are missing according to the times.
pub(super) fn missing_rows(times_s: &[f64], step_s: f64) -> Option<TraceFinding> {
    let (mut rows, mut gaps) = (0.0, 0_u32);
    for pair in times_s.windows(2) {
        let expected = ((pair[1] - pair[0]) / step_s).round();
        if pair[1] - pair[0] > 1.5 * step_s && expected >= 2.0 {
            rows += expected - 1.0;
            gaps += 1;
        }
    }
    let places = if gaps == 1 { "place" } else { "places" };
    (gaps > 0).then(|| {
        TraceFinding::new(
            Code::Fc525,
            format!(
                "{rows:.0} rows are missing at {gaps} {places}, {:.1} % of the recording; no segment goes over them",
                rows / (rows + count(times_s.len())) * 100.0
            ),
            "record again with fewer channels or a longer sample time",
        )
    })
}

/// Returns whether the torque changes so little that it contains no friction.
pub(super) fn is_still(samples: &AxisSamples, measured: &Measured) -> bool {
    let torques = samples.torques.iter();
    let [low, high] = torques.fold([f64::MAX, f64::MIN], |[low, high], it| {
        [low.min(*it), high.max(*it)]
    });
    high - low < LEAST_OF_RATED * measured.rated.unwrap_or_default()
}

/// Checks for friction that no axis has, or that shows that the recording is not what it seems.
pub(super) fn check_pairs(
    pairs: &[Pair],
    samples: &AxisSamples,
    measured: &Measured,
) -> Result<Vec<TraceFinding>, IdentifyError> {
    check_unsigned_torque(pairs, samples)?;
    let mut said = Vec::new();
    said.extend(signs(pairs, samples)?);
    said.extend(against_rated(pairs, measured)?);
    Ok(said)
}

/// Checks the points from circles in the same way.
pub(super) fn check_points(
    points: &[[f64; 2]],
    samples: &AxisSamples,
    measured: &Measured,
) -> Result<Vec<TraceFinding>, IdentifyError> {
    /// Error of points from circles, as a part of the largest friction.
    const EXACT: f64 = 0.02;
    let largest = points.iter().map(|it| it[1].abs()).fold(0.0, f64::max);
    let pair = |&[speed, friction]: &[f64; 2]| Pair {
        speed,
        friction,
        offset: Some(0.0),
        error: EXACT * largest,
        visits: Vec::new(),
        segments: Vec::new(),
    };
    let pairs: Vec<Pair> = points.iter().map(pair).collect();
    let said = [signs(&pairs, samples)?, against_rated(&pairs, measured)?];
    Ok(said.into_iter().flatten().collect())
}

/// Checks that a torque changes its sign: one that never does has the friction in the part that is equal in both
/// directions.
fn check_unsigned_torque(pairs: &[Pair], samples: &AxisSamples) -> Result<(), IdentifyError> {
    let torques = || samples.torques.iter().copied();
    let is_unsigned = torques().all(|it| it >= 0.0) || torques().all(|it| it <= 0.0);
    let both: Vec<(&Pair, f64)> = pairs
        .iter()
        .filter_map(|it| Some((it, it.offset?)))
        .collect();
    let spread = |value: fn(&(&Pair, f64)) -> f64| {
        let values = both.iter().map(value);
        let [low, high] = values.fold([f64::MAX, f64::MIN], |[low, high], it| {
            [low.min(it), high.max(it)]
        });
        (high - low).max(0.0)
    };
    let (of_offset, of_friction) = (spread(|it| it.1), spread(|it| it.0.friction));
    let error = pairs.iter().map(|it| it.error).fold(0.0, f64::max);
    if is_unsigned && of_offset > 2.0 * of_friction && of_offset > 2.0 * SIGNIFICANT * error {
        return Err(refused(
            Code::Fc523,
            format!(
                "the torque never changes its sign, and what is the same in both directions changes by \
                 {of_offset:.3} over the speeds, what differs by {of_friction:.3}: it is an absolute value"
            ),
            "record the torque or the current with its sign",
        ));
    }
    Ok(())
}

/// Checks for friction that opposes the motion at some speeds, or at all of them.
fn signs(pairs: &[Pair], samples: &AxisSamples) -> Result<Option<TraceFinding>, IdentifyError> {
    let is_so = |sign: f64| {
        move |it: &&Pair| it.friction * sign > SIGNIFICANT * it.error && it.offset.is_some()
    };
    let Some(negative) = pairs.iter().find(is_so(-1.0)) else {
        return Ok(None);
    };
    let compensated =
        "record with friction compensation off, or the torque that the drive measures";
    if let Some(positive) = pairs.iter().find(is_so(1.0)) {
        return Err(refused(
            Code::Fc521,
            format!(
                "friction is {:.3} at {:.3} mm/s and {:.3} at {:.3} mm/s: compensation was on and is not in this torque",
                positive.friction, positive.speed, negative.friction, negative.speed
            ),
            compensated,
        ));
    }
    if accelerates_rightly(samples) {
        return Err(refused(
            Code::Fc521,
            format!(
                "friction is {:.3} at {:.3} mm/s although the torque accelerates the axis the right way: \
                 more was compensated than there is, and it is not in this torque",
                negative.friction, negative.speed
            ),
            compensated,
        ));
    }
    Ok(Some(TraceFinding::new(
        Code::Fc522,
        format!(
            "friction is {:.3} at {:.3} mm/s: the sign of the torque or that of the velocity is inverted",
            negative.friction, negative.speed
        ),
        "`out` has the sign of the torque at positive velocity: check which way the drive counts both",
    )))
}

/// Returns whether the torque has the sign of the acceleration, if that is strong enough to show.
fn accelerates_rightly(samples: &AxisSamples) -> bool {
    /// A correlation that noise does not produce.
    const CLEAR: f64 = 0.2;
    let width = samples_in(0.01, samples.step_s);
    let velocities = &samples.velocities;
    let (mut product, mut squares, mut torques) = (0.0, 0.0, 0.0);
    for at in width..velocities.len().saturating_sub(width) {
        let change = velocities[at + width] - velocities[at - width];
        product += change * samples.torques[at];
        squares += change * change;
        if change.abs() > 0.0 {
            torques += samples.torques[at] * samples.torques[at];
        }
    }
    product > CLEAR * (squares * torques).sqrt() && squares > 0.0
}

/// Returns the part of the rated torque that is friction.
fn against_rated(
    pairs: &[Pair],
    measured: &Measured,
) -> Result<Option<TraceFinding>, IdentifyError> {
    let Some(rated) = measured.rated else {
        return Ok(None);
    };
    let upper = |it: &Pair| it.friction.abs() + 2.0 * it.error;
    let least = pairs
        .iter()
        .min_by(|one, other| upper(one).total_cmp(&upper(other)));
    let Some(least) = least else {
        return Ok(None);
    };
    let part = least.friction.abs() / rated;
    let told = |of: &Pair| {
        format!(
            "friction is {:.3} at {:.3} mm/s, {:.1} % of the rated torque",
            of.friction,
            of.speed,
            of.friction.abs() / rated * 100.0
        )
    };
    let friction = told(least);
    if upper(least) < LEAST_OF_RATED * rated {
        if measured.compensation == Some(Switched::Off) {
            return Ok(Some(TraceFinding::new(
                Code::Fc524,
                format!("{friction}: perhaps the torque is ten times as large"),
                "compare it with what the drive shows, and give its unit",
            )));
        }
        return Err(refused(
            Code::Fc521,
            format!(
                "{friction}: compensation was on and is not in this torque, or the unit is ten times as large"
            ),
            "record with friction compensation off, or confirm that it was, and check the unit",
        ));
    }
    let lower = |it: &Pair| it.friction.abs() - 2.0 * it.error;
    if let Some(most) = pairs.iter().find(|it| lower(it) > rated) {
        return Err(refused(
            Code::Fc524,
            format!(
                "{}: the unit is another one, such as a tenth of it",
                told(most)
            ),
            "compare it with what the drive shows, and give its unit",
        ));
    }
    Ok((part > MUCH_OF_RATED).then(|| {
        TraceFinding::new(
            Code::Fc524,
            format!("{friction}: perhaps the unit is a tenth of it"),
            "compare it with what the drive shows, and give its unit",
        )
    }))
}

/// Checks that compensation was off, or that the torque contains what it adds.
pub(super) fn check_compensation(
    measured: &Measured,
) -> Result<Option<TraceFinding>, IdentifyError> {
    let help =
        "record the actual torque of the drive, or confirm that friction compensation was off";
    if let Some(contradiction) = measured.contradiction {
        return contradicted(contradiction, measured);
    }
    match (measured.kind, measured.compensation) {
        (Some(TorqueKind::Actual), _) | (_, Some(Switched::Off)) => Ok(None),
        (Some(TorqueKind::Loop), None) => Err(refused(
            Code::Fc521,
            "the output of the speed controller lacks what compensation adds, and nothing shows that \
             compensation was off"
                .to_owned(),
            help,
        )),
        (_, Some(Switched::On)) => Err(refused(
            Code::Fc521,
            "friction compensation was on, and the torque is not known to contain what it adds".to_owned(),
            "if it is the actual torque of the drive, specify it as such; otherwise record that",
        )),
        (_, None) => Ok(Some(TraceFinding::new(
            Code::Fc521,
            "it is not known whether the torque contains what compensation adds, nor whether compensation \
             was off: if it was on, friction is larger than this"
                .to_owned(),
            "say which torque it is, or confirm that friction compensation was off",
        ))),
    }
}

/// Returns a finding on a recording that contradicts a statement about it; there is no list unless it does not matter.
fn contradicted(
    contradiction: Contradiction,
    measured: &Measured,
) -> Result<Option<TraceFinding>, IdentifyError> {
    let (message, help, is_harmless) = match contradiction {
        Contradiction::Kind(said) => (
            format!(
                "the torque was given as `{}`, but its channel is named as the output of the speed \
                 controller, which lacks what compensation adds",
                said.as_str()
            ),
            "record the actual torque of the drive, or give its channel the name that it has there",
            measured.compensation == Some(Switched::Off),
        ),
        Contradiction::Compensation => (
            "compensation was given as off, but the recorded state shows it on".to_owned(),
            "record with compensation off, or name the state of this axis",
            measured.kind == Some(TorqueKind::Actual),
        ),
    };
    if is_harmless {
        return Ok(Some(TraceFinding::new(Code::Fc521, message, help)));
    }
    Err(refused(Code::Fc521, message, help))
}

/// Returns a place where the axis moves harder in both directions.
pub(super) fn tight(
    samples: &AxisSamples,
    segments: &[Segment],
    pairs: &[Pair],
) -> Option<TraceFinding> {
    let least = pairs
        .iter()
        .min_by(|one, other| one.friction.abs().total_cmp(&other.friction.abs()))?;
    let spot = tight_spot(samples, segments, least.friction)?;
    Some(TraceFinding::new(
        Code::Fc526,
        format!(
            "from {:.1} to {:.1} mm friction is larger by {:.3} or more in both directions, {:.0} % of the least",
            spot.from,
            spot.to,
            spot.more,
            spot.more / least.friction.abs() * 100.0
        ),
        "look for a tight spot of the guide or the screw; record where the axis moves freely",
    ))
}
