//! Motion that words and commands cause (R10.7), and the chain of coordinates: what separates positions from those of the
//! machine (R2.47, R2.82).

use serde::Serialize;

crate::words! {
    /// The way in which an axis is moved.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
    #[serde(rename_all = "lowercase")]
    #[non_exhaustive]
    pub enum MotionKind {
        /// G00.
        Rapid = "rapid",
        /// G01, G02, G03 and everything else that interpolates at the path feed.
        Feed = "feed",
        /// A reference point is approached.
        Homing = "homing",
        /// The axis moves by itself, independently of the path or along with it.
        Independent = "independent",
        /// It follows another axis.
        Coupled = "coupled",
        /// Coordinates are rotated or transformed: the motion word of another axis moves it.
        Frame = "frame",
        /// Not known offline.
        Unknown = "unknown",
    }
}

/// Whether something happens on every way that a program may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Certainty {
    /// It does.
    Certain,
    /// It may: that is not known offline.
    Possible,
}

/// The axes that a form moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Moves {
    /// Those with a word in the block.
    Words,
    /// Those with a word in the block, or every axis where none has one.
    WordsOrAll,
    /// The axis before the bracket, now.
    Own,
    /// The axis before the bracket or named in it, whenever its master moves.
    Follower,
    /// All that it names, whenever one of them moves.
    Gantry,
    /// The axes that it names, or all.
    NamedOrAll,
    /// The axes of the active plane, with the motion word of one of them.
    Plane,
    /// X, Y and Z, with the motion word of one of them.
    Main,
    /// Every axis of the channel, with any motion word.
    Channel,
}

/// Effect of a word or command on the axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct MotionEffect {
    pub(crate) kind: MotionKind,
    pub(crate) moves: Moves,
    pub(crate) certainty: Certainty,
}

/// Meaning of the axis words of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum AxisWords {
    /// Coordinates to move to.
    #[default]
    Motion,
    /// G74: the axes move to an unknown position.
    Homing,
    /// A measuring motion, which ends where the probe triggers.
    Measuring,
    /// G92: offsets.
    Reference,
    /// G04 and the like: other values.
    Other,
}

impl AxisWords {
    /// Whether the words move their axes.
    pub(crate) fn move_axes(self) -> bool {
        !matches!(self, Self::Reference | Self::Other)
    }
}

/// Effect of a command or function on positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum ChainStep {
    /// It switches to other coordinates, and back.
    Coordinates,
    /// It chooses the kinematics of a transformation, which others switch on (R1.42).
    Kinematics,
    /// It switches all offsets off, and on again (PM/208517515).
    Machine,
    /// It leaves the programmed points as they are and the path to them open (PM/207256971).
    Path,
    /// It moves the origin, by the machine's own values or for one block.
    Origin,
}

/// Direction in which a command or function switches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum OnOff {
    On,
    Off,
}
