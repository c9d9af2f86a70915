//! The glitches of a path where it crosses from one quadrant into the next (R5.22).

use serde::Serialize;

use super::Direction;
use super::figures::MICROMETRES;
use super::profile::{ANGLES, PER_DEGREE, Profile};

/// Half the width of the window in which a glitch is looked for, in degrees.
const WINDOW: usize = 8;

/// Where the undisturbed path is looked at on both sides, in degrees from the crossing.
const BESIDE: std::ops::Range<usize> = 8..20;

/// A crossing from one quadrant into the next: there one axis reverses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
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
    pub fn name(self) -> &'static str {
        match self {
            Self::XPlus => "X+",
            Self::YPlus => "Y+",
            Self::XMinus => "X-",
            Self::YMinus => "Y-",
        }
    }

    /// The angle in degrees from X+ counter-clockwise.
    pub fn degrees(self) -> u16 {
        match self {
            Self::XPlus => 0,
            Self::YPlus => 90,
            Self::XMinus => 180,
            Self::YMinus => 270,
        }
    }
}

/// The glitch at one crossing, in µm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Glitch {
    /// Where it is.
    pub crossing: Crossing,
    /// Peak to peak within ±8°.
    pub height: f64,
    /// The largest deviation from the undisturbed path, outwards.
    pub outward: f64,
    /// The smallest deviation from the undisturbed path; negative is inwards.
    pub inward: f64,
    /// How much farther out the path runs behind the crossing than before it: the difference of
    /// straight lines through what lies 8° to 20° away on each side, at the crossing.
    pub step: f64,
}

/// The glitches of a path, counter-clockwise from X+.
///
/// The deviations are those less the median of what the path has 8° to 20° from the crossing on
/// both sides; peak to peak that makes no difference, outwards and inwards it does.
pub(super) fn glitches(profile: &Profile, direction: Direction) -> Vec<Glitch> {
    Crossing::ALL
        .into_iter()
        .map(|crossing| glitch(profile, direction, crossing))
        .collect()
}

fn glitch(profile: &Profile, direction: Direction, crossing: Crossing) -> Glitch {
    let at = usize::from(crossing.degrees()) * PER_DEGREE;
    let deviations = profile.deviations();
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
    let [mut before, mut behind] = sides;
    let step = at_crossing(&behind) - at_crossing(&before);
    before.append(&mut behind);
    let undisturbed = median(&mut before);
    let [outward, inward] = profile.within(at, WINDOW * PER_DEGREE);
    Glitch {
        crossing,
        height: (outward - inward) * MICROMETRES,
        outward: (outward - undisturbed) * MICROMETRES,
        inward: (inward - undisturbed) * MICROMETRES,
        step: step * MICROMETRES,
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
