//! The gaps and oddities of a recording (R6.13, R6.15, R6.16).

use super::curve::FrictionCurve;
use super::finding::TraceFinding;
use super::identified::{Identified, IdentifyOptions};
use frictcomp::diagnostic::Code;

/// Part of a Stribeck velocity from which it is visible.
const SEEN_FROM: f64 = 1.0;

/// Speed in mm/s below which speeds are needed without a fit.
const SLOW: f64 = 0.5;

/// Minimum number of speeds for a curve.
const FEWEST: usize = 4;

/// Part of the friction from which ripple is reported.
const RIPPLE: f64 = 0.01;

/// Returns all findings, in the order of the codes.
pub(super) fn findings(found: &Identified, options: &IdentifyOptions) -> Vec<TraceFinding> {
    let checks: [fn(&Identified, &IdentifyOptions) -> Option<TraceFinding>; 8] = [
        slow_speeds,
        fast_speeds,
        periodic,
        few_speeds,
        noise,
        drifting,
        lines,
        one_sided,
    ];
    checks
        .iter()
        .filter_map(|check| check(found, options))
        .collect()
}

fn slow_speeds(found: &Identified, _: &IdentifyOptions) -> Option<TraceFinding> {
    let slowest = found.pairs[0].speed;
    let stribeck = found
        .used_fit()
        .filter(|fit| fit.breakaway.abs() > fit.coulomb.abs())
        .map(|fit| fit.stribeck);
    let wanted = stribeck.map_or(SLOW, |stribeck| stribeck * SEEN_FROM);
    // The held value below the slowest speed matters unless the curve is flat there already.
    if slowest <= wanted.min(SLOW) {
        return None;
    }
    let record = (slowest / 4.0).min(wanted / 2.0).clamp(0.1, SLOW);
    let unseen = if slowest > wanted {
        "; Fs and vs cannot be determined from it"
    } else {
        ""
    };
    Some(TraceFinding::new(
        Code::Fc511,
        format!(
            "below the slowest speed of {slowest:.3} mm/s the friction is held, not known{unseen}"
        ),
        format!(
            "record speeds down to {record:.2} mm/s: friction counts most where the axis reverses"
        ),
    ))
}

fn fast_speeds(found: &Identified, options: &IdentifyOptions) -> Option<TraceFinding> {
    let fastest = found.pairs[found.pairs.len() - 1].speed;
    (fastest < options.working_speed * 0.99).then(|| {
        TraceFinding::new(
            Code::Fc512,
            format!(
                "above the highest speed of {fastest:.3} mm/s the friction is held, but the machine works at {:.3} mm/s",
                options.working_speed
            ),
            format!("record a speed of {:.0} mm/s or more", options.working_speed.ceil()),
        )
    })
}

fn periodic(found: &Identified, _: &IdentifyOptions) -> Option<TraceFinding> {
    let ripple = found.ripple?;
    (ripple.amplitude > RIPPLE * found.level()).then(|| {
        TraceFinding::new(
            Code::Fc513,
            format!(
                "the torque repeats every {:.3} mm by ±{:.3} drive units",
                ripple.period, ripple.amplitude
            ),
            "this is not friction; compare the period with the pitch of the screw or the poles of the motor, \
             and let every segment cover some periods",
        )
    })
}

fn few_speeds(found: &Identified, _: &IdentifyOptions) -> Option<TraceFinding> {
    let speeds = found.pairs.len();
    (speeds < FEWEST).then(|| {
        let times = if speeds == 1 { "one speed" } else { "speeds" };
        let count = if speeds == 1 {
            String::new()
        } else {
            format!("{speeds} ")
        };
        TraceFinding::new(
            Code::Fc514,
            format!("{count}{times} show no friction curve, straight lines are drawn through them"),
            "record ten or more speeds from 0.1 mm/s up to the fastest feed, each back and forth",
        )
    })
}

fn noise(found: &Identified, options: &IdentifyOptions) -> Option<TraceFinding> {
    let level = found.level();
    let worst = found
        .pairs
        .iter()
        .max_by(|one, other| one.error.total_cmp(&other.error))?;
    // Two standard errors: 95 of 100 recordings stay within them.
    let part = 2.0 * worst.error / level;
    (part > options.accuracy).then(|| {
        let longer = (part / options.accuracy).powi(2).ceil();
        TraceFinding::new(
            Code::Fc515,
            format!(
                "noise leaves ±{:.1} % at {:.3} mm/s, so that {:.1} % cannot be reached",
                part * 100.0,
                worst.speed,
                options.accuracy * 100.0
            ),
            format!("record this speed {longer:.0} times as long, or more often"),
        )
    })
}

fn drifting(found: &Identified, _: &IdentifyOptions) -> Option<TraceFinding> {
    let drift = found.drift.filter(|drift| drift.is_seen)?;
    let change = if drift.part < 0.0 { "falls" } else { "rises" };
    Some(TraceFinding::new(
        Code::Fc516,
        format!(
            "friction {change} by {:.1} % over the recording; the mean in time is taken",
            drift.part.abs() * 100.0
        ),
        "warm the axis up, and record the speeds upwards and downwards again",
    ))
}

fn lines(found: &Identified, _: &IdentifyOptions) -> Option<TraceFinding> {
    let fit = found.fit?;
    matches!(found.curve, FrictionCurve::Lines(_)).then(|| {
        TraceFinding::new(
            Code::Fc517,
            format!(
                "the friction does not follow Coulomb, Stribeck and viscous friction (reduced χ² {:.1}); \
                 straight lines through the speeds are used",
                fit.chi_square
            ),
            "look at the residuals; record more speeds where they are large",
        )
    })
}

fn one_sided(found: &Identified, _: &IdentifyOptions) -> Option<TraceFinding> {
    let sided = found.pairs.iter().filter(|pair| pair.offset.is_none());
    let speeds: Vec<String> = sided.map(|pair| format!("{:.3}", pair.speed)).collect();
    (!speeds.is_empty()).then(|| {
        TraceFinding::new(
            Code::Fc518,
            format!(
                "recorded in one direction only, less the offset of the others: {} mm/s",
                speeds.join(", ")
            ),
            "move at every speed back and forth",
        )
    })
}
