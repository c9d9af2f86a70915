//! The causes that the shape of a path suggests (R5.24).
//!
//! At a crossing an axis reverses. Friction holds it for a moment at its outermost place: the path
//! bulges outwards after the crossing and comes back. Compensation that is too strong or too
//! early pushes the axis back: the path is cut inwards. Backlash leaves a step; the rest of the
//! path without peaks and steps is a circle, or an ellipse.

use serde::Serialize;

use crate::circle::evidence::CircleEvidence;
use crate::circle::evidence::{OtherShape, ShapeTerm, Term};
use crate::circle::figures::{AxisShape, Bulge, Glitch, PathShape};
use crate::circle::figures::{Figures, PathFigures};
use crate::circle::geometry::Direction;
use crate::circle::geometry::{Crossing, PlaneAxis};
use crate::circle::simulated::Comparison;
use crate::current::Switched;

/// Size below which nothing is reported.
pub const NOTICEABLE_UM: f64 = 1.0;

/// Share of a bulge up to which the other one is neglected, so that the bulge counts as alone.
const ALONE: f64 = 0.25;

/// Least step that counts, as a part of the peak: what a slow drive leaves of a peak is less.
const STEP_PART: f64 = 0.1;

/// A term of a recording with an unknown shape is this many times as large as the residual: a drift leaves
/// an eighth of what it adds to a step.
const UNKNOWN: f64 = 8.0;

/// Cause suggested by a shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Finding {
    /// A bulge outwards that decays: friction.
    Friction,
    /// A bulge outwards is left: the compensation is too weak.
    TooWeak,
    /// The bulge is larger than without compensation: it pushes the wrong way.
    WrongSign,
    /// A cut inwards alone: it is too strong.
    TooStrong,
    /// First inwards, then outwards: it is too early.
    TooEarly,
    /// First outwards, then inwards: it is too late.
    TooLate,
    /// A step outwards that stays: backlash.
    Backlash,
    /// A step inwards that stays: more backlash is compensated than there is.
    OvercompensatedBacklash,
    /// An ellipse at 45° that turns with the direction of travel: the gains differ.
    GainMismatch,
    /// An ellipse at 45° that is the same in both directions: the axes are not square.
    Squareness,
    /// An ellipse along the axes: their scales differ.
    ScaleMismatch,
    /// A step sideways where the other axis reverses: play of the guide.
    LateralPlay,
    /// An error that repeats along an axis: the screw or the encoder.
    Periodic,
    /// An oscillation in time.
    Vibration,
    /// Several swings after a reversal: the axis sticks and slips.
    StickSlip,
    /// The circle shifts from turn to turn: temperature.
    Drift,
    /// A shape that is none of these.
    OtherShape,
}

/// Place of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(untagged)]
#[non_exhaustive]
pub enum FoundAt {
    /// One crossing.
    Crossing(Crossing),
    /// Both crossings of an axis.
    Axis(PlaneAxis),
    /// The path as a whole.
    Whole,
}

/// A piece of advice.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Diagnosis {
    /// The place.
    pub place: FoundAt,
    /// The direction of travel; `None` if it concerns both.
    pub direction: Option<Direction>,
    /// Suggested cause.
    pub finding: Finding,
    /// Size in µm.
    #[serde(rename = "size")]
    pub size_um: f64,
    /// Grounds, for recorded paths.
    #[serde(flatten)]
    pub grounds: DiagnosisGrounds,
}

/// Grounds of a piece of advice about a recording, with the evidence against it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[non_exhaustive]
pub struct DiagnosisGrounds {
    /// Standard error of the size.
    #[serde(rename = "error", skip_serializing_if = "Option::is_none")]
    pub error_um: Option<f64>,
    /// Period along the axis in mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pitch_mm: Option<f64>,
    /// Frequency in Hz.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hertz: Option<f64>,
    /// Residual that neither shapes nor noise explain, root mean square.
    #[serde(rename = "unexplained", skip_serializing_if = "Option::is_none")]
    pub unexplained_um: Option<f64>,
}

/// Returns the causes that figures suggest: peaks at the crossings of each direction, steps of each axis, and
/// the ellipse. `compensation` states whether friction compensation was on when the paths were made; for
/// recorded paths it may be unknown, and nothing is named that their noise or another shape could have caused.
pub fn diagnose(figures: &Figures, compensation: Option<Switched>) -> Vec<Diagnosis> {
    let shapes: Vec<(Direction, &PathShape)> = Direction::ALL
        .into_iter()
        .filter_map(|direction| Some((direction, figures.get(direction)?.shape.as_ref()?)))
        .collect();
    let evidence = figures.evidence.as_ref();
    let mut advice = Vec::new();
    for &(direction, shape) in &shapes {
        for seen in &shape.glitches {
            let glitch = &evidence.map_or(*seen, |it| seen.less(bulge_of_noise(it)));
            if let Some(finding) = peak(glitch, compensation)
                && evidence.is_none_or(|it| is_carried(finding, glitch, it))
            {
                advice.push(Diagnosis {
                    place: FoundAt::Crossing(glitch.crossing),
                    direction: Some(direction),
                    finding,
                    size_um: size_of_peak(finding, seen),
                    grounds: DiagnosisGrounds {
                        error_um: evidence.map(|it| it.noise_um),
                        unexplained_um: evidence.map(|it| it.rest_um),
                        ..DiagnosisGrounds::default()
                    },
                });
            }
        }
    }
    drop_contradictions(&mut advice);
    let paths: Vec<&PathShape> = shapes.into_iter().map(|(_, shape)| shape).collect();
    match evidence {
        Some(evidence) => advice.extend(carried(evidence, &paths)),
        None => advice.extend(of_shapes(&paths)),
    }
    advice
}

/// Returns the bulge of noise alone in µm: the greatest of many samples.
fn bulge_of_noise(evidence: &CircleEvidence) -> f64 {
    const GREATEST: f64 = 4.0;
    GREATEST * evidence.noise_um
}

/// Returns whether a recording supports what a peak suggests: timing and strength not if there is another residual,
/// friction if it is far larger than that.
fn is_carried(finding: Finding, glitch: &Glitch, evidence: &CircleEvidence) -> bool {
    /// The ratio of the peak-to-peak value of a shape to its root mean square, doubled.
    const FAR: f64 = 6.0;
    let swings = match glitch.crossing.axis() {
        PlaneAxis::X => evidence.stick_slip_um[0],
        PlaneAxis::Y => evidence.stick_slip_um[1],
    };
    // Play bends the path where the other axis reverses.
    let play = evidence.terms.iter().filter_map(|it| match it.shape {
        ShapeTerm::Play(_) if it.is_carried() => Some(it.size_um.abs()),
        _ => None,
    });
    let play: f64 = play.sum();
    let sizes = evidence.others().map(|it| match it {
        OtherShape::Periodic { amplitude_um, .. } | OtherShape::Vibration { amplitude_um, .. } => {
            amplitude_um / 2.0_f64.sqrt()
        }
        OtherShape::Unknown => evidence.rest_um,
    });
    let other = sizes.reduce(f64::hypot).unwrap_or(evidence.rest_um);
    if !evidence.has_other_shape() && swings.is_none() {
        return glitch.outward_um - glitch.inward_um > play;
    }
    finding == Finding::Friction && glitch.outward_um > (FAR * other).max(play)
}

/// Drops advice on the timing of an axis that other advice on it contradicts.
fn drop_contradictions(advice: &mut Vec<Diagnosis>) {
    let axis = |it: &Diagnosis| match it.place {
        FoundAt::Crossing(crossing) => Some(crossing.axis()),
        _ => None,
    };
    let said: Vec<(Option<PlaneAxis>, Finding)> =
        advice.iter().map(|it| (axis(it), it.finding)).collect();
    let is_against = |one: Finding, other: Finding| {
        [
            [Finding::TooEarly, Finding::TooLate],
            [Finding::TooWeak, Finding::TooStrong],
        ]
        .iter()
        .any(|pair| pair.contains(&one) && pair.contains(&other) && one != other)
    };
    advice.retain(|it| {
        let same_axis = said.iter().filter(|(other, _)| *other == axis(it));
        !same_axis
            .into_iter()
            .any(|(_, other)| is_against(it.finding, *other))
    });
}

/// Steps and ellipses of simulated paths.
fn of_shapes(paths: &[&PathShape]) -> Vec<Diagnosis> {
    let mut advice = Vec::new();
    for axis in PlaneAxis::ALL {
        let of_axis: Vec<&AxisShape> = paths.iter().map(|shape| shape.axis(axis)).collect();
        advice.extend(step(&of_axis).map(|(finding, size_um)| Diagnosis {
            place: FoundAt::Axis(axis),
            direction: None,
            finding,
            size_um,
            grounds: DiagnosisGrounds::default(),
        }));
    }
    if let [ccw, cw] = paths[..] {
        let unsettled = paths.iter().flat_map(|shape| &shape.axes);
        let unsettled = unsettled.filter(|axis| !axis.is_settled);
        let in_doubt = unsettled.map(|axis| axis.step_um.abs()).fold(0.0, f64::max);
        advice.extend(
            ellipses(ccw.ellipse_um, cw.ellipse_um).filter(|it| it.size_um >= 2.0 * in_doubt),
        );
    }
    advice
}

/// Returns the shapes that a recording supports, and the residual.
fn carried(evidence: &CircleEvidence, paths: &[&PathShape]) -> Vec<Diagnosis> {
    let peak = |axis: PlaneAxis| {
        let peaks = paths.iter().map(|shape| shape.axis(axis).peak_um.abs());
        peaks.fold(0.0, f64::max)
    };
    let grounds = |term: &Term| DiagnosisGrounds {
        error_um: Some(term.error_um),
        unexplained_um: Some(evidence.rest_um),
        ..DiagnosisGrounds::default()
    };
    let is_worth = |term: &&Term| {
        let least = match term.shape {
            ShapeTerm::Backlash(axis) => STEP_PART * peak(axis),
            _ => 0.0,
        };
        // An unknown shape may contain as much of any term.
        let unsure = evidence.others().map(|it| match it {
            OtherShape::Unknown => UNKNOWN * evidence.rest_um,
            OtherShape::Vibration { .. } => 2.0 * evidence.rest_um,
            OtherShape::Periodic { .. } => 0.0,
        });
        let unsure = unsure.fold(0.0, f64::max);
        term.is_carried() && term.size_um.abs() >= NOTICEABLE_UM.max(least).max(unsure)
    };
    let named = evidence.terms.iter().filter(is_worth).map(|term| {
        let (place, finding) = match term.shape {
            ShapeTerm::Backlash(axis) if term.size_um > 0.0 => {
                (FoundAt::Axis(axis), Finding::Backlash)
            }
            ShapeTerm::Backlash(axis) => (FoundAt::Axis(axis), Finding::OvercompensatedBacklash),
            ShapeTerm::Play(axis) => (FoundAt::Axis(axis), Finding::LateralPlay),
            ShapeTerm::Gain => (FoundAt::Whole, Finding::GainMismatch),
            ShapeTerm::Squareness => (FoundAt::Whole, Finding::Squareness),
            ShapeTerm::Scale => (FoundAt::Whole, Finding::ScaleMismatch),
            ShapeTerm::Drift(axis) => (FoundAt::Axis(axis), Finding::Drift),
        };
        Diagnosis {
            place,
            direction: None,
            finding,
            size_um: term.size_um.abs(),
            grounds: grounds(term),
        }
    });
    named
        .chain(sticking(evidence))
        .chain(evidence.others().map(|other| left_over(other, evidence)))
        .collect()
}

/// Axes that stick and slip.
fn sticking(evidence: &CircleEvidence) -> impl Iterator<Item = Diagnosis> + '_ {
    let axes = PlaneAxis::ALL.into_iter().zip(evidence.stick_slip_um);
    axes.filter_map(|(axis, size)| {
        Some(Diagnosis {
            place: FoundAt::Axis(axis),
            direction: None,
            finding: Finding::StickSlip,
            size_um: size?,
            grounds: DiagnosisGrounds {
                error_um: Some(evidence.noise_um),
                ..DiagnosisGrounds::default()
            },
        })
    })
}

/// Returns the finding on the residual that no shape explains.
fn left_over(other: OtherShape, evidence: &CircleEvidence) -> Diagnosis {
    let rest = DiagnosisGrounds {
        unexplained_um: Some(evidence.rest_um),
        ..DiagnosisGrounds::default()
    };
    let (place, finding, size_um, grounds) = match other {
        OtherShape::Periodic {
            axis,
            pitch_mm,
            amplitude_um,
        } => (
            FoundAt::Axis(axis),
            Finding::Periodic,
            2.0 * amplitude_um,
            DiagnosisGrounds {
                pitch_mm: Some(pitch_mm),
                ..rest
            },
        ),
        OtherShape::Vibration {
            hertz,
            amplitude_um,
        } => (
            FoundAt::Whole,
            Finding::Vibration,
            2.0 * amplitude_um,
            DiagnosisGrounds {
                hertz: Some(hertz),
                ..rest
            },
        ),
        OtherShape::Unknown => (FoundAt::Whole, Finding::OtherShape, evidence.rest_um, rest),
    };
    Diagnosis {
        place,
        direction: None,
        finding,
        size_um,
        grounds,
    }
}

/// Returns the causes that a test with compensation suggests, given the one without.
pub fn diagnose_comparison(comparison: &Comparison) -> Vec<Diagnosis> {
    let mut advice = diagnose(&comparison.on.figures, Some(Switched::On));
    let height = |figures: &Figures, it: &Diagnosis| {
        let PathFigures { shape, .. } = figures.get(it.direction?)?;
        let here = |glitch: &&Glitch| it.place == FoundAt::Crossing(glitch.crossing);
        let glitch = shape.as_ref()?.glitches.iter().find(here)?;
        Some(glitch.height_um)
    };
    for it in &mut advice {
        if it.finding == Finding::TooWeak
            && height(&comparison.on.figures, it) > height(&comparison.off.figures, it)
        {
            it.finding = Finding::WrongSign;
        }
    }
    advice
}

/// Returns the size of a peak as the figures show it: of the bulge that the finding names, or of both.
fn size_of_peak(finding: Finding, glitch: &Glitch) -> f64 {
    match finding {
        Finding::Friction | Finding::TooWeak => glitch.outward_um,
        Finding::TooStrong => -glitch.inward_um,
        _ => glitch.outward_um - glitch.inward_um,
    }
}

/// Returns the finding on the decaying peak of a crossing.
fn peak(glitch: &Glitch, compensation: Option<Switched>) -> Option<Finding> {
    let (outward, inward) = (glitch.outward_um, -glitch.inward_um);
    if outward.max(inward) < NOTICEABLE_UM {
        return None;
    }
    if compensation == Some(Switched::Off) {
        return (inward < ALONE * outward).then_some(Finding::Friction);
    }
    if inward < ALONE * outward {
        // Without knowing what was on, the rest is friction.
        return Some(match compensation {
            Some(_) => Finding::TooWeak,
            None => Finding::Friction,
        });
    }
    if outward < ALONE * inward {
        return Some(Finding::TooStrong);
    }
    Some(match glitch.first {
        Bulge::Inward => Finding::TooEarly,
        Bulge::Outward => Finding::TooLate,
    })
}

/// Returns the step that remains after the reversals of an axis, as the mean of its paths: an error of
/// the geometry, which has the opposite sign in the other direction, cancels out.
fn step(paths: &[&AxisShape]) -> Option<(Finding, f64)> {
    #[allow(clippy::cast_precision_loss)] // two at most
    let count = paths.len() as f64;
    let mean = paths.iter().map(|it| it.step_um).sum::<f64>() / count;
    let peak = paths.iter().map(|it| it.peak_um.abs()).fold(0.0, f64::max);
    let least = NOTICEABLE_UM.max(STEP_PART * peak);
    let is_step = mean.abs() >= least && paths.iter().all(|it| it.is_settled);
    is_step.then_some((
        if mean > 0.0 {
            Finding::Backlash
        } else {
            Finding::OvercompensatedBacklash
        },
        mean.abs(),
    ))
}

/// Returns a path that is still bent by peaks where the steps are evaluated is fitted equally well by steps and by an
/// ellipse: an ellipse that is not larger than such a step is neither.
///
/// A circle that lags more on one axis becomes an ellipse at 45° whose long axis turns with the
/// direction of travel; one of axes that are not square keeps it. Both need both directions.
fn ellipses(ccw: [f64; 2], cw: [f64; 2]) -> impl Iterator<Item = Diagnosis> {
    let found = [
        (Finding::GainMismatch, (ccw[1] - cw[1]) / 2.0),
        (Finding::Squareness, f64::midpoint(ccw[1], cw[1])),
        (Finding::ScaleMismatch, f64::midpoint(ccw[0], cw[0])),
    ];
    let noticeable = found
        .into_iter()
        .filter(|(_, size)| size.abs() >= NOTICEABLE_UM);
    noticeable.map(|(finding, amplitude)| Diagnosis {
        place: FoundAt::Whole,
        direction: None,
        finding,
        // From the short to the long axis.
        size_um: 2.0 * amplitude.abs(),
        grounds: DiagnosisGrounds::default(),
    })
}
