//! The canonical motion of a block: which axes move, along which path and how fast, without any words (R5.1).
//!
//! It is made only where [`Motions::Taken`] asks for it.

use serde::{Deserialize, Serialize};

use super::contouring::Contouring;
use crate::comp::AxisIndex;
use crate::language::Simplifications;
use crate::lists::SlopeProfile;

/// Whether blocks report their motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Motions {
    /// They do not.
    #[default]
    None,
    /// They do, see [`Motion`].
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
    /// Something that is not modelled, or not known offline, in words.
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
    /// By its coordinates on the two axes of the plane, in mm.
    Point([f64; 2]),
    /// By the radius in mm: positive for the short arc, negative for the long one.
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
    /// At least one axis moves at this part of its highest velocity: G00, and G194 with its weight
    /// (PM/206602507).
    OfAxes(f64),
    /// Not known, with the reason.
    Unknown(&'static str),
}

/// Condition for the end of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub enum BlockEnd {
    /// The path continues as fast as its corner allows.
    #[default]
    Through,
    /// G60, or G360 until G359: the axes come to rest (PM/206301707).
    ExactStop,
}
