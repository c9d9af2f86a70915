//! The canonical motion of a block: which axes move, along which path and how fast, without any words (R5.1). It is made only
//! where [`Motions::Taken`] asks for it.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use serde::{Deserialize, Serialize};

use crate::comp::AxisIndex;
use crate::interpreter::motion::pace::Contouring;
use crate::language::{Certainty, MotionKind, Simplifications};
use crate::lists::SlopeProfile;
use crate::text::Span;

/// Reports of motion by blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Motions {
    /// Blocks do not report their motion.
    #[default]
    None,
    /// Blocks report their motion, see [`Motion`].
    Taken,
}

/// Motion or wait that a block commands.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Motion {
    /// Axes move.
    Travel(Travel),
    /// The axes rest, in seconds; `None` where it is not known how long.
    Dwell(Option<f64>),
}

/// A motion from one place to another.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Travel {
    /// Shape of the path.
    pub form: PathForm,
    /// The axes that it moves.
    pub axes: Vec<AxisIndex>,
    /// The position of each axis of the machine before, in mm or degrees, where that is known.
    pub from: Vec<Option<f64>>,
    /// The position of each axis after it.
    pub to: Vec<Option<f64>>,
    /// Feed of the path.
    pub feed: PathFeed,
    /// Condition for the end of the block.
    pub end: BlockEnd,
    /// Rounding of the transition to the next block, where there is one (R11.21).
    pub contouring: Option<Contouring>,
    /// The profile of the acceleration, where the program selects one; else that of the channel.
    pub slope: Option<SlopeProfile>,
    /// The highest velocity at the end of the block in mm/min, E; `None` where it is the feed.
    pub end_feed_per_min: Option<f64>,
    /// The side on which the tool follows, where tool radius compensation is known to be active.
    pub tool: Option<ToolSide>,
    /// Functions on the path or its velocity that a commanded trace does not follow.
    pub simplified: Simplifications,
}

/// The side of a contour on which the tool follows it, seen in the direction of motion (PM/207729163).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ToolSide {
    /// G41.
    Left,
    /// G42.
    Right,
}

/// Shape of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum PathForm {
    /// G00: a straight line, as fast as the axes can.
    Rapid,
    /// G01: a straight line at the path feed.
    Line,
    /// G02, G03: an arc, or a helix when the third axis moves.
    Arc(Arc),
    /// Shape that is not modelled, or not known offline, in words.
    Unknown(&'static str),
}

/// A circular arc in the plane of two axes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Arc {
    /// The first and the second axis of the plane: X Y with G17, Z X with G18, Y Z with G19.
    pub axes: [AxisIndex; 2],
    /// The sense of rotation, seen against the third axis.
    pub turn: Turn,
    /// Position of the centre.
    pub centre: Centre,
}

/// The sense of rotation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Turn {
    /// G02.
    Clockwise,
    /// G03.
    CounterClockwise,
}

/// Form in which the centre of an arc is programmed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Centre {
    /// Coordinates on the two axes of the plane, in mm.
    Point([f64; 2]),
    /// Radius in mm: positive for the short arc, negative for the long one.
    Radius(f64),
}

/// Feed of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum PathFeed {
    /// G94: in mm/min, or °/min where only rotary axes move.
    PerMinute(f64),
    /// G93: the seconds that the block takes (PM/206602507).
    Seconds(f64),
    /// Share of its highest velocity at which at least one axis moves: G00, and G194 with its weight (PM/206602507).
    OfAxes(f64),
    /// Unknown feed, with the reason.
    Unknown(&'static str),
}

/// Condition for the end of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub enum BlockEnd {
    /// No stop: the path continues as fast as its corner allows.
    #[default]
    Through,
    /// G60, or G360 until G359: the axes come to rest (PM/206301707).
    ExactStop,
}

/// Places closer than this, in mm or degrees, are one: the ends of a full circle, and the end of a
/// motion and the start of the next.
pub const SAME_PLACE: f64 = 1e-6;

/// The part of the radius by which the centre of an arc may miss the places that its ends allow; it is
/// moved then, as G165 does (PM/206551563).
const CENTRE_TOLERANCE: f64 = 0.05;

/// The part of the square of the radius by which rounding may have made the radius too small for the ends.
const RADIUS_TOLERANCE: f64 = 1e-3;

/// An arc in its plane.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ArcShape {
    /// The centre.
    pub centre: [f64; 2],
    /// The radius.
    pub radius: f64,
    /// The angle at which it starts, against the first axis.
    pub start: f64,
    /// The angle that it runs through, positive against the clock.
    pub sweep: f64,
}

impl ArcShape {
    /// Returns the travel of both axes of the plane along the arc, forth and back, in the unit of the radius:
    /// four radii each on a full circle.
    pub fn travel(&self) -> [f64; 2] {
        let ends = [self.start, self.start + self.sweep];
        let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        // The first axis turns back at 0 and 180°, the second at 90° and 270°.
        [(0.0, f64::cos as fn(f64) -> f64), (FRAC_PI_2, f64::sin)].map(|(first, place)| {
            let mut turn = first + ((low - first) / PI).ceil() * PI;
            let (mut at, mut travel) = (low, 0.0);
            while turn < high {
                travel += (place(turn) - place(at)).abs();
                at = turn;
                turn += PI;
            }
            self.radius * (travel + (place(high) - place(at)).abs())
        })
    }
}

impl Arc {
    /// Returns the arc from one place of its plane to another.
    ///
    /// # Errors
    /// The reason why the ends and the centre make no arc.
    pub fn between(&self, places: [[f64; 2]; 2]) -> Result<ArcShape, &'static str> {
        let [start, end] = places;
        let chord = [end[0] - start[0], end[1] - start[1]];
        let distance = chord[0].hypot(chord[1]);
        let full = distance < SAME_PLACE;
        let middle = [
            f64::midpoint(start[0], end[0]),
            f64::midpoint(start[1], end[1]),
        ];
        let centre = match self.centre {
            Centre::Point(centre) if full => centre,
            Centre::Point(centre) => {
                // The nearest point that has the same distance to both ends.
                let offset = [centre[0] - middle[0], centre[1] - middle[1]];
                let astray = (offset[0] * chord[0] + offset[1] * chord[1]) / distance;
                let given = (centre[0] - start[0]).hypot(centre[1] - start[1]);
                if astray.abs() > CENTRE_TOLERANCE * given {
                    return Err("the centre of the circle does not fit its ends");
                }
                [
                    centre[0] - astray * chord[0] / distance,
                    centre[1] - astray * chord[1] / distance,
                ]
            }
            Centre::Radius(_) if full => return Err("`R` cannot describe a full circle"),
            Centre::Radius(radius) => {
                let height = radius * radius - distance * distance / 4.0;
                // A radius that rounding made too small gives half a circle.
                if height < -RADIUS_TOLERANCE * radius * radius {
                    return Err("the radius is less than half the distance between the ends");
                }
                let height = height.max(0.0).sqrt() * radius.signum();
                // The short arc against the clock has its centre on the left.
                let side = match self.turn {
                    Turn::Clockwise => -height,
                    Turn::CounterClockwise => height,
                };
                [
                    middle[0] - side * chord[1] / distance,
                    middle[1] + side * chord[0] / distance,
                ]
            }
        };
        let angle = |point: [f64; 2]| (point[1] - centre[1]).atan2(point[0] - centre[0]);
        let radius = (start[0] - centre[0]).hypot(start[1] - centre[1]);
        if radius < SAME_PLACE || !radius.is_finite() {
            return Err("the circle has no radius");
        }
        let turned = (angle(end) - angle(start)).rem_euclid(TAU);
        let sweep = match self.turn {
            _ if full => TAU,
            Turn::CounterClockwise => turned,
            Turn::Clockwise => TAU - turned,
        };
        Ok(ArcShape {
            centre,
            radius,
            start: angle(start),
            sweep: match self.turn {
                Turn::CounterClockwise => sweep,
                Turn::Clockwise => -sweep,
            },
        })
    }
}

/// Value of a word: absent, or a value that may be unknown.
pub(crate) type WordValue = Option<Option<f64>>;

/// The words of a block that only shape its motion.
#[derive(Clone, Debug, Default)]
pub(crate) struct Geometry {
    /// I, J, K.
    pub(crate) centre: [WordValue; 3],
    /// R.
    pub(crate) radius: WordValue,
    /// The seconds of `G04 2.5` and `#TIME 2.5`.
    pub(crate) dwell: WordValue,
    pub(crate) end: BlockEnd,
    /// E: the feed at the end of the block.
    pub(crate) end_feed: WordValue,
    /// G166: overrides do not count.
    pub(crate) at_full_speed: bool,
    /// Simplifications of the commanded trace in this block.
    pub(crate) simplified: Simplifications,
    /// Span of the first of I, J, K and R.
    pub(crate) span: Option<Span>,
    /// Number of axes that move along the circle without a word of their own.
    pub(crate) around: usize,
    /// A G function that makes the block's motion something else.
    pub(crate) foreign: Option<&'static str>,
}

/// The motion of one axis in a block.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct MovedAxis {
    /// Position of the axis in the machine.
    pub axis: AxisIndex,
    /// The words that move it.
    pub span: Span,
    /// Kind of the motion.
    pub kind: MotionKind,
    /// Certainty of the motion.
    pub certainty: Certainty,
}

impl MovedAxis {
    /// Returns the motion of an axis word.
    #[inline]
    pub(crate) fn of_word(word: &AxisWord, kind: MotionKind) -> Self {
        Self {
            axis: word.axis,
            span: word.span,
            kind,
            certainty: Certainty::Certain,
        }
    }
}

/// An axis word of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct AxisWord {
    /// Position of the axis in the machine.
    pub axis: AxisIndex,
    /// The word.
    pub span: Span,
    /// The coordinate as it is programmed, where it is known.
    pub value: Option<f64>,
    /// Position before, where it is known.
    pub from: Option<f64>,
}

/// Returns a coordinate that counts from a place; unknown if any part is, or if the sum leaves the range of numbers.
#[inline]
pub(crate) fn shifted(from: Option<f64>, value: Option<f64>, scale: Option<f64>) -> Option<f64> {
    let sum = from? + value? * scale?;
    (f64::MIN..=f64::MAX).contains(&sum).then_some(sum)
}
