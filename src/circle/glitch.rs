//! The glitches of a path where it crosses from one quadrant into the next (R5.22).

use std::fmt;

use serde::Serialize;

use super::direction::Direction;
use super::profile::{ANGLES, PER_DEGREE, RadialProfile, UM_PER_M};

/// Half the width of the window in which a glitch is looked for, in degrees.
const WINDOW: usize = 8;

/// Where the undisturbed path is looked at on both sides, in degrees from the crossing.
const BESIDE: std::ops::Range<usize> = 8..20;

/// A crossing from one quadrant into the next: there one axis reverses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[non_exhaustive]
pub enum Crossing {
    /// At the largest X: the X axis reverses.
    #[serde(rename = "X+")]
    XPlus,
    /// At the largest Y.
    #[serde(rename = "Y+")]
    YPlus,
    /// At the smallest X.
    #[serde(rename = "X-")]
    XMinus,
    /// At the smallest Y.
    #[serde(rename = "Y-")]
    YMinus,
}

impl Crossing {
    /// All four, counter-clockwise from X+.
    pub const ALL: [Self; 4] = [Self::XPlus, Self::YPlus, Self::XMinus, Self::YMinus];

    /// `X+`, `Y+`, `X-` or `Y-`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::XPlus => "X+",
            Self::YPlus => "Y+",
            Self::XMinus => "X-",
            Self::YMinus => "Y-",
        }
    }

    /// The angle from X+ counter-clockwise.
    pub fn angle_deg(self) -> u16 {
        match self {
            Self::XPlus => 0,
            Self::YPlus => 90,
            Self::XMinus => 180,
            Self::YMinus => 270,
        }
    }
}

impl fmt::Display for Crossing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

/// The glitch at one crossing (R5.22).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Glitch {
    /// Where it is.
    pub crossing: Crossing,
    /// Peak to peak within ±8°.
    #[serde(rename = "height")]
    pub height_um: f64,
    /// The largest deviation from the undisturbed path, outwards.
    #[serde(rename = "outward")]
    pub outward_um: f64,
    /// The smallest deviation from the undisturbed path; negative is inwards.
    #[serde(rename = "inward")]
    pub inward_um: f64,
    /// How much farther out the path runs after the crossing than before it: the difference of
    /// straight lines through what lies 8° to 20° away on each side, at the crossing.
    #[serde(rename = "step")]
    pub step_um: f64,
}

/// The glitches of a path, counter-clockwise from X+.
///
/// The deviations are those less the median of what the path has 8° to 20° from the crossing on
/// both sides; peak to peak that makes no difference, outwards and inwards it does.
pub(super) fn glitches(profile: &RadialProfile, direction: Direction) -> Vec<Glitch> {
    Crossing::ALL
        .into_iter()
        .map(|crossing| glitch(profile, direction, crossing))
        .collect()
}

fn glitch(profile: &RadialProfile, direction: Direction, crossing: Crossing) -> Glitch {
    let at = usize::from(crossing.angle_deg()) * PER_DEGREE;
    let deviations = profile.deviations_m();
    let clockwise = |way: usize| deviations[(at + ANGLES - way) % ANGLES];
    let counter = |way: usize| deviations[(at + way) % ANGLES];
    let beside = BESIDE.start * PER_DEGREE..BESIDE.end * PER_DEGREE;
    let mut sides = [
        beside.clone().map(clockwise).collect::<Vec<_>>(),
        beside.map(counter).collect(),
    ];
    if direction == Direction::Cw {
        sides.swap(0, 1);
    }
    let [mut before, mut after] = sides;
    let step = at_crossing(&after) - at_crossing(&before);
    before.append(&mut after);
    let undisturbed = median(&mut before);
    let [outward, inward] = profile.within(at, WINDOW * PER_DEGREE);
    Glitch {
        crossing,
        height_um: (outward - inward) * UM_PER_M,
        outward_um: (outward - undisturbed) * UM_PER_M,
        inward_um: (inward - undisturbed) * UM_PER_M,
        step_um: step * UM_PER_M,
    }
}

/// Where the least-squares line through the deviations beside a crossing meets it.
fn at_crossing(beside: &[f64]) -> f64 {
    #[allow(clippy::cast_precision_loss)] // at most 36000
    let real = |count: usize| count as f64;
    let count = real(beside.len());
    let centre = (count - 1.0) / 2.0;
    let mean = beside.iter().sum::<f64>() / count;
    let (mut slope, mut spread) = (0.0, 0.0);
    for (at, deviation) in beside.iter().enumerate() {
        let way = real(at) - centre;
        slope += way * deviation;
        spread += way * way;
    }
    mean - slope / spread * (centre + real(BESIDE.start * PER_DEGREE))
}

/// The middle value, the mean of both middle ones of an even number; 0 of none.
fn median(values: &mut [f64]) -> f64 {
    let (middle, is_odd) = (values.len() / 2, values.len() % 2 == 1);
    if values.is_empty() {
        return 0.0;
    }
    let (below, &mut upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    if is_odd {
        return upper;
    }
    let lower = below.iter().copied().fold(f64::MIN, f64::max);
    f64::midpoint(lower, upper)
}
