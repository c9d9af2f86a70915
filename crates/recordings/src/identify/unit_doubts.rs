//! Units and scales of channels that may not be what they seem (R6.21, R6.23).

use super::finding::TraceFinding;
use super::track::Track;
use crate::trace::{Channel, Contains, Pick, Unit};
use frictcomp::diagnostic::Code;

/// Maximum speed of any axis, in mm/s: 200 m/min.
const FASTEST: f64 = 200_000.0 / 60.0;

/// Speed in mm/s that every recording of friction exceeds: 10 mm/min.
const SLOWEST: f64 = 10.0 / 60.0;

/// Speeds in mm/s that recordings of friction usually reach.
const USUAL: std::ops::Range<f64> = 5.0..1000.0;

/// µm/s per mm/s.
const UM: f64 = 1000.0;

/// 0.1 µm per mm.
const POSITION_UNITS: f64 = 10_000.0;

/// Units in which motion is recorded, the most usual first.
const UNITS: [&str; 18] = [
    "mm/s",
    "µm/s",
    "mm/min",
    "m/min",
    "m/s",
    "mm",
    "µm",
    "nm",
    "deg/s",
    "0.001deg/s",
    "rpm",
    "rad/s",
    "turn/s",
    "deg",
    "0.0001deg",
    "rad",
    "turn",
    "m",
];

/// Returns FC524 if the fastest speed is one that no axis or no recording of friction has.
pub(super) fn improbable_speed(
    channel: &Channel,
    pick: &Pick,
    track: &Track,
) -> Option<TraceFinding> {
    let speed = match (&track.velocities, &track.positions) {
        (Some(velocities), _) => {
            velocities
                .iter()
                .fold(0.0_f64, |most, it| most.max(it.abs()))
                / UM
        }
        (None, Some(positions)) => fastest(positions, track),
        (None, None) => return None,
    };
    if speed <= 0.0 || (SLOWEST..=FASTEST).contains(&speed) {
        return None;
    }
    let other = |name: &&&str| {
        Unit::parse(name).is_some_and(|unit| {
            unit.quantity == pick.unit.quantity
                && pick
                    .unit
                    .motion
                    .is_none_or(|motion| unit.motion == Some(motion))
                && USUAL.contains(&(speed * unit.factor / pick.unit.factor))
        })
    };
    let likely = UNITS.iter().find(other);
    let likely = likely.map_or(String::new(), |it| format!("; `{it}` is more likely"));
    let said = match (&channel.unit, pick.is_unit_assumed) {
        (Some(unit), false) => unit.as_str(),
        _ => pick.unit.quantity.own_unit(),
    };
    let limit = if speed > FASTEST {
        "faster than 200 m/min"
    } else {
        "slower than 10 mm/min"
    };
    Some(TraceFinding::new(
        Code::Fc524,
        format!(
            "with `{}` in {said} the fastest speed is {speed:.4} mm/s, {limit}{likely}",
            channel.name
        ),
        format!("give the unit of `{}`", channel.name),
    ))
}

/// Returns the fastest speed of positions, over a twentieth of a second.
fn fastest(positions: &[f64], track: &Track) -> f64 {
    const SPAN_S: f64 = 0.05;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 1 to some hundreds
    let span = (SPAN_S / track.step_s).ceil().clamp(1.0, 1e6) as usize;
    let pairs = positions.iter().zip(positions.iter().skip(span));
    let times = track.times_s.iter().zip(track.times_s.iter().skip(span));
    pairs
        .zip(times)
        .map(|((from, to), (begin, end))| (to - from).abs() / (end - begin))
        .fold(0.0, f64::max)
        / POSITION_UNITS
}

/// Returns the remark on the factor and the offset with which Scope draws a channel, or FC519 if
/// it is not known whether the samples contain them.
pub(super) fn scope_scale(
    channel: &Channel,
    samples: &[f64],
) -> (Option<String>, Option<TraceFinding>) {
    let Some(drawn) = &channel.drawn else {
        return (None, None);
    };
    let scale = format!(
        "Scope draws `{}` with the factor {} and the offset {}",
        channel.name, drawn.factor, drawn.offset
    );
    match drawn.contained_in(samples) {
        Contains::Scale => (Some(format!("{scale}, which are in its samples")), None),
        Contains::Raw => (
            Some(format!(
                "{scale}, which are not in its samples; these are taken as they are"
            )),
            None,
        ),
        _ => (
            None,
            Some(TraceFinding::new(
                Code::Fc519,
                format!(
                    "{scale}, and it is not known whether its samples contain them; these are taken as they are"
                ),
                "compare a sample with what the control shows, or export with the factor 1 and the offset 0",
            )),
        ),
    }
}
