//! Evaluation of a recording at constant speeds for the points of a value list.

use super::channel::{drop_held, late};
use super::curve::{FrictionCurve, WORST_CHI_SQUARE, fit};
use super::doubts;
use super::finding::TraceFinding;
use super::identified::{Identified, IdentifyError, IdentifyOptions};
use super::measured::Measured;
use super::pair::{Pair, PairedSpeeds};
use super::ripple::{residuals, wave};
use super::segment::segments;
use super::statistics::count;
use super::support::{SpeedRange, support};
use super::track::{AxisSamples, Track};
use super::warnings;
use frictcomp::diagnostic::Code;
use frictcomp::lists::TablePoint;

/// The codes of recordings that are not what they seem, or in which friction changes.
const DOUBTS: [Code; 8] = [
    Code::Fc516,
    Code::Fc520,
    Code::Fc521,
    Code::Fc522,
    Code::Fc523,
    Code::Fc524,
    Code::Fc525,
    Code::Fc526,
];

/// Returns the findings that make a recording of any motion doubtful (R6.21).
///
/// # Errors
/// The recording cannot show any friction.
pub(super) fn doubts_about(
    track: &Track,
    measured: Measured,
) -> Result<Vec<TraceFinding>, IdentifyError> {
    let options = IdentifyOptions {
        measured,
        ..IdentifyOptions::default()
    };
    let found = match identify(track, &options) {
        Ok(found) => found.findings,
        Err(error @ (IdentifyError::Refused(_) | IdentifyError::NoFriction { .. })) => {
            return Err(error);
        }
        // Of motion without constant speeds less can be said.
        Err(_) => {
            let samples = AxisSamples::new(track)?;
            let rows = doubts::missing_rows(&samples.times_s, samples.step_s);
            let compensation = doubts::check_compensation(&measured)?;
            [compensation, rows].into_iter().flatten().collect()
        }
    };
    let doubts = found.into_iter().filter(|it| DOUBTS.contains(&it.code));
    Ok(doubts.collect())
}

/// Identifies the friction of an axis that moves at constant speeds.
///
/// # Errors
/// The recording cannot be used for that.
pub fn identify(track: &Track, options: &IdentifyOptions) -> Result<Identified, IdentifyError> {
    let mut samples = AxisSamples::new(track)?;
    let mut segments = segments(&samples);
    if segments.is_empty() {
        return Err(IdentifyError::NoSegments);
    }
    let compensation = doubts::check_compensation(&options.measured)?;
    doubts::check_directions(&samples, &segments)?;
    let held = drop_held(&samples, &mut segments)?;
    let late = late(&samples, &segments);
    let clipped = doubts::drop_clipped(&samples, &mut segments)?;
    let directions = |sign: f64| segments.iter().any(|it| it.velocity * sign > 0.0);
    if !(directions(1.0) && directions(-1.0)) {
        return Err(IdentifyError::OneDirection);
    }
    let duration_s = track.times_s.last().unwrap_or(&0.0) - track.times_s.first().unwrap_or(&0.0);
    let residuals = residuals(&samples, &segments);
    let wave = wave(&samples, &segments);
    if let Some(wave) = wave {
        // A torque that repeats along the travel is neither friction nor weight.
        samples.take_away(|position| wave.at(position));
    }
    let PairedSpeeds {
        pairs,
        offset,
        drift,
    } = PairedSpeeds::of(&samples, &segments, duration_s);
    if pairs.iter().all(|pair| pair.offset.is_none()) {
        return Err(IdentifyError::OneDirection);
    }
    if doubts::is_still(&samples, &options.measured) {
        check_friction(&pairs)?;
    }
    let suspect = doubts::check_pairs(&pairs, &samples, &options.measured)?;
    check_friction(&pairs)?;
    let rows = doubts::missing_rows(&samples.times_s, samples.step_s);
    let tight = doubts::tight(&samples, &segments, &pairs);
    let mut findings: Vec<TraceFinding> = [compensation, held, late, clipped, rows, tight]
        .into_iter()
        .flatten()
        .collect();
    findings.extend(suspect);
    let fit = fit(&pairs);
    let curve = match fit {
        Some(fit) if fit.chi_square <= WORST_CHI_SQUARE => FrictionCurve::Fit(fit),
        _ => FrictionCurve::Lines(
            pairs
                .iter()
                .map(|pair| [pair.speed, pair.friction])
                .collect(),
        ),
    };
    let speeds = SpeedRange {
        slowest: pairs[0].speed,
        fastest: pairs[pairs.len() - 1].speed,
    };
    let support = support(&curve, speeds, options.wanted);
    let points = support.points.iter().map(|&[speed, friction]| TablePoint {
        input: (speed * 1000.0).round(),
        output: friction,
    });
    let mut identified = Identified {
        points: points.collect(),
        point_error: support.error,
        missed_error: support.missed,
        ripple: wave.map(|wave| wave.ripple()),
        drift,
        residuals,
        findings,
        segments,
        pairs,
        offset,
        fit,
        curve,
    };
    let lacks = warnings::findings(&identified, options);
    identified.findings.extend(lacks);
    // Findings that make the values doubtful come before those that only limit them.
    let is_minor = |it: &TraceFinding| !DOUBTS.contains(&it.code);
    identified.findings.sort_by_key(is_minor);
    Ok(identified)
}

/// Checks that the torque depends on the direction.
fn check_friction(pairs: &[Pair]) -> Result<(), IdentifyError> {
    let weighted =
        |value: fn(&Pair) -> f64| pairs.iter().map(value).sum::<f64>() / count(pairs.len());
    let (friction, spread) = (weighted(|it| it.friction), weighted(|it| it.error));
    if friction.abs() > 2.0 * spread && friction != 0.0 {
        return Ok(());
    }
    Err(IdentifyError::NoFriction { friction, spread })
}
