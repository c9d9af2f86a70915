//! What the shape of a path suggests (R5.24).
//!
//! At a crossing an axis turns round. Friction holds it a moment at its outermost place: the path
//! bulges outwards after the crossing and comes back. Compensation that is too strong or too
//! early throws the axis back: the path is cut inwards. Backlash leaves a step; what is left of the
//! path without peaks and steps is a circle, or an ellipse.

use serde::Serialize;

use super::compare::Comparison;
use super::crossing::{Crossing, PlaneAxis};
use super::direction::Direction;
use super::figures::{Figures, PathFigures};
use super::glitch::{AxisShape, Bulge, Glitch, PathShape};
use crate::current::Switched;

/// Below this there is nothing to say.
pub const NOTICEABLE_UM: f64 = 1.0;

/// One of two bulges counts as alone if the other is less than this part of it.
const ALONE: f64 = 0.25;

/// A step is one if it is at least this part of the peak: what a slow drive leaves of a peak is
/// less.
const STEP_PART: f64 = 0.1;

/// What a shape suggests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Finding {
    /// A bulge outwards that decays: friction.
    Friction,
    /// A bulge outwards is left: the compensation is too weak.
    TooWeak,
    /// The bulge is larger than without compensation: it pushes the wrong way.
    WrongSign,
    /// A cut inwards alone: it is too strong.
    TooStrong,
    /// First inwards, then outwards: it comes too early.
    TooEarly,
    /// First outwards, then inwards: it comes too late.
    TooLate,
    /// A step outwards that stays: backlash.
    Backlash,
    /// A step inwards that stays: more backlash is compensated than there is.
    OvercompensatedBacklash,
    /// An ellipse at 45° that lies the other way in the other direction: the gains differ.
    GainMismatch,
    /// An ellipse at 45° that lies the same way in both directions: the axes are not square.
    Squareness,
    /// An ellipse along the axes: their scales differ.
    ScaleMismatch,
}

/// Where a finding was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(untagged)]
#[non_exhaustive]
pub enum FoundAt {
    /// At a crossing.
    Crossing(Crossing),
    /// At both crossings of an axis.
    Axis(PlaneAxis),
    /// In the path as a whole.
    Whole,
}

/// A piece of advice.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Diagnosis {
    /// Where.
    pub place: FoundAt,
    /// The direction of travel; `None` for what concerns both.
    pub direction: Option<Direction>,
    /// What the shape suggests.
    pub finding: Finding,
    /// How large it is.
    #[serde(rename = "size")]
    pub size_um: f64,
}

/// What figures suggest: peaks at the crossings of each direction, steps of each axis, and the
/// ellipse. `compensation` says whether friction compensation was on when the paths were made; of
/// recorded paths it may be unknown.
pub fn diagnose(figures: &Figures, compensation: Option<Switched>) -> Vec<Diagnosis> {
    let shapes: Vec<(Direction, &PathShape)> = Direction::ALL
        .into_iter()
        .filter_map(|direction| Some((direction, figures.get(direction)?.shape.as_ref()?)))
        .collect();
    let mut advice = Vec::new();
    for &(direction, shape) in &shapes {
        for glitch in &shape.glitches {
            if let Some(finding) = peak(glitch, compensation) {
                advice.push(Diagnosis {
                    place: FoundAt::Crossing(glitch.crossing),
                    direction: Some(direction),
                    finding,
                    size_um: glitch.outward_um - glitch.inward_um,
                });
            }
        }
    }
    let paths: Vec<&PathShape> = shapes.into_iter().map(|(_, shape)| shape).collect();
    for axis in PlaneAxis::ALL {
        let of_axis: Vec<&AxisShape> = paths.iter().map(|shape| shape.axis(axis)).collect();
        advice.extend(step(&of_axis).map(|(finding, size_um)| Diagnosis {
            place: FoundAt::Axis(axis),
            direction: None,
            finding,
            size_um,
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

/// What a test with compensation suggests, given the one without.
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

/// What decays at a crossing.
fn peak(glitch: &Glitch, compensation: Option<Switched>) -> Option<Finding> {
    let (outward, inward) = (glitch.outward_um, -glitch.inward_um);
    if outward.max(inward) < NOTICEABLE_UM {
        return None;
    }
    if compensation == Some(Switched::Off) {
        return (inward < ALONE * outward).then_some(Finding::Friction);
    }
    if inward < ALONE * outward {
        // Without knowing what was on, what is left is friction.
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

/// What stays after the reversals of an axis, in the mean of its paths: an error of the geometry,
/// which turns the other way in the other direction, falls out of it.
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

/// A path that peaks still bend where the steps are looked for is fitted by steps and by an ellipse
/// alike: an ellipse that is not larger than such a step is one of neither.
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
    })
}
