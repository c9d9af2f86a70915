//! What the shape of a path suggests (R5.24).
//!
//! At a crossing an axis turns round. Friction holds it a moment at its outermost place: the path
//! bulges outwards after the crossing and comes back. Compensation that is too strong or too
//! early throws the axis back: the path is cut inwards.

use std::f64::consts::TAU;

use serde::Serialize;

use super::compare::{Comparison, Side};
use super::direction::Direction;
use super::figures::Paths;
use super::glitch::{Crossing, Glitch, glitches};
use super::profile::{ANGLES, PER_DEGREE, RadialProfile, UM_PER_M};
use crate::current::Switched;

/// Below this there is nothing to say.
pub const NOTICEABLE_UM: f64 = 1.0;

/// One of two bulges counts as alone if the other is less than this part of it.
const ALONE: f64 = 0.25;

/// A step is one if it is at least this part of the height.
const STEP_PART: f64 = 0.5;

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
    /// A step that stays: backlash.
    Backlash,
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

/// What the paths suggest, the crossings of each direction first. `compensation` says whether
/// friction compensation was on when they were made; of recorded paths it may be unknown.
pub fn diagnose(paths: &Paths, compensation: Option<Switched>) -> Vec<Diagnosis> {
    let mut advice = Vec::new();
    for (direction, profile) in paths.iter() {
        for glitch in glitches(profile, direction) {
            if let Some(finding) = at_crossing(profile, direction, &glitch, compensation) {
                let size_um = match finding {
                    Finding::Backlash => glitch.step_um.abs(),
                    _ => glitch.height_um,
                };
                advice.push(Diagnosis {
                    place: FoundAt::Crossing(glitch.crossing),
                    direction: Some(direction),
                    finding,
                    size_um,
                });
            }
        }
    }
    advice.extend(ellipses(paths));
    advice
}

/// What the paths of a test with compensation suggest, given those without.
pub fn diagnose_comparison(comparison: &Comparison) -> Vec<Diagnosis> {
    let mut advice = diagnose(&comparison.on.paths, Some(Switched::On));
    let height = |side: &Side, it: &Diagnosis| {
        let path = side.figures.get(it.direction?)?;
        let here = |glitch: &&Glitch| it.place == FoundAt::Crossing(glitch.crossing);
        path.glitch.iter().find(here).map(|glitch| glitch.height_um)
    };
    for it in &mut advice {
        if it.finding == Finding::TooWeak
            && height(&comparison.on, it) > height(&comparison.off, it)
        {
            it.finding = Finding::WrongSign;
        }
    }
    advice
}

fn at_crossing(
    profile: &RadialProfile,
    direction: Direction,
    glitch: &Glitch,
    compensation: Option<Switched>,
) -> Option<Finding> {
    if glitch.step_um.abs() >= NOTICEABLE_UM && glitch.step_um.abs() >= STEP_PART * glitch.height_um
    {
        return Some(Finding::Backlash);
    }
    let (outward, inward) = (glitch.outward_um.max(0.0), (-glitch.inward_um).max(0.0));
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
    let [most, least] = places(profile, direction, glitch.crossing);
    Some(if least < most {
        Finding::TooEarly
    } else {
        Finding::TooLate
    })
}

/// Where within 8° of a crossing the path lies farthest out and farthest in, as fixed angles in
/// the direction of travel.
fn places(profile: &RadialProfile, direction: Direction, crossing: Crossing) -> [usize; 2] {
    let width = 8 * PER_DEGREE;
    let at = usize::from(crossing.angle_deg()) * PER_DEGREE;
    let deviation = |way: usize| {
        let way = match direction {
            Direction::Ccw => way,
            Direction::Cw => 2 * width - way,
        };
        profile.deviations_m()[(at + ANGLES + way - width) % ANGLES]
    };
    let compare = |a: &usize, b: &usize| deviation(*a).total_cmp(&deviation(*b));
    let most = (0..=2 * width).max_by(compare).unwrap_or_default();
    let least = (0..=2 * width).min_by(compare).unwrap_or_default();
    [most, least]
}

/// The second harmonic of a path in µm: along the axes and at 45°.
fn second_harmonic(profile: &RadialProfile) -> [f64; 2] {
    let deviations = profile.deviations_m();
    #[allow(clippy::cast_precision_loss)] // 36000
    let count = deviations.len() as f64;
    let mut sums = [0.0; 2];
    for (at, deviation) in deviations.iter().enumerate() {
        #[allow(clippy::cast_precision_loss)] // 36000
        let (sin, cos) = (2.0 * TAU * at as f64 / count).sin_cos();
        sums[0] += deviation * cos;
        sums[1] += deviation * sin;
    }
    sums.map(|sum| 2.0 * sum / count * UM_PER_M)
}

/// A circle that lags more on one axis becomes an ellipse at 45° whose long axis turns with the
/// direction of travel; one of axes that are not square keeps it. Both need both directions.
fn ellipses(paths: &Paths) -> Vec<Diagnosis> {
    let (Some(ccw), Some(cw)) = (&paths.ccw, &paths.cw) else {
        return Vec::new();
    };
    let [ccw, cw] = [ccw, cw].map(second_harmonic);
    let found = [
        (Finding::GainMismatch, (ccw[1] - cw[1]) / 2.0),
        (Finding::Squareness, f64::midpoint(ccw[1], cw[1])),
        (Finding::ScaleMismatch, f64::midpoint(ccw[0], cw[0])),
    ];
    let noticeable = found
        .into_iter()
        .filter(|(_, size)| size.abs() >= NOTICEABLE_UM);
    noticeable
        .map(|(finding, amplitude)| Diagnosis {
            place: FoundAt::Whole,
            direction: None,
            finding,
            // From the short to the long axis.
            size_um: 2.0 * amplitude.abs(),
        })
        .collect()
}
