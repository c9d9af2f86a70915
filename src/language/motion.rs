//! Motion that words and commands cause (R10.7), the chain of coordinates: what separates positions from those of the machine
//! (R2.47, R2.82), and the functions of a control that affect the path or its velocity and that a commanded trace follows in a
//! simpler way, which is reported (R5.1).
//!
//! PM/n is page n of the TF5200 programming manual.

use serde::{Deserialize, Serialize};

/// Simplification: an effect that the control has and a commanded trace lacks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Simplification {
    /// G61, G261, `#CONTOUR MODE`: corners are rounded (PM/206307595).
    Contouring,
    /// `#HSC`: short blocks are joined to a smooth path.
    HighSpeed,
    /// `#SLOPE`: a profile of the acceleration that is not known.
    Slope,
    /// G127, G128: the highest velocity is weighted (PM/206573067).
    VelocityWeight,
    /// G130, G131, G230, G231: accelerations are weighted (PM/206590731).
    AccelerationWeight,
    /// G132 to G134, G233: ramp times are weighted (PM/206596619).
    RampWeight,
    /// `#DYN WEIGHT`: velocity, acceleration and ramp time are weighted.
    DynamicWeight,
    /// G901: the path slows down after the end of the block (PM/206238219).
    LateDeceleration,
    /// G193, G293: the feed changes linearly along the block (PM/206245643).
    FeedRamp,
    /// G13: feed is reduced in corners.
    CornerDeceleration,
    /// G11: feed is adapted to the radius of the tool (PM/206473227).
    ToolFeed,
    /// `#FGROUP`: F refers to other axes.
    FeedGroup,
    /// `#VECTOR LIMIT`: the path has its own limits.
    PathLimits,
    /// `#GEO FEED ADAPT`: feed is adapted by something other than the program.
    ForeignFeed,
    /// `X[INDP_ASYN …]`, `X[OSC …]` and the like: an axis moves by itself.
    IndependentAxis,
    /// `X[DYNAMIC …]`: the dynamics of an axis are weighted.
    AxisDynamics,
    /// `#AX LINK ON`: an axis follows another one (PM/207133579).
    Coupling,
}

impl Simplification {
    const ALL: [Self; 17] = [
        Self::Contouring,
        Self::HighSpeed,
        Self::Slope,
        Self::VelocityWeight,
        Self::AccelerationWeight,
        Self::RampWeight,
        Self::DynamicWeight,
        Self::LateDeceleration,
        Self::FeedRamp,
        Self::CornerDeceleration,
        Self::ToolFeed,
        Self::FeedGroup,
        Self::PathLimits,
        Self::ForeignFeed,
        Self::IndependentAxis,
        Self::AxisDynamics,
        Self::Coupling,
    ];

    /// Returns the name of the word or command that switches it on.
    pub fn name(self) -> &'static str {
        match self {
            Self::Contouring => "G261",
            Self::HighSpeed => "#HSC",
            Self::Slope => "#SLOPE",
            Self::VelocityWeight => "G128",
            Self::AccelerationWeight => "G131",
            Self::RampWeight => "G133",
            Self::DynamicWeight => "#DYN WEIGHT",
            Self::LateDeceleration => "G901",
            Self::FeedRamp => "G193",
            Self::CornerDeceleration => "G13",
            Self::ToolFeed => "G11",
            Self::FeedGroup => "#FGROUP",
            Self::PathLimits => "#VECTOR LIMIT",
            Self::ForeignFeed => "#GEO FEED ADAPT",
            Self::IndependentAxis => "INDP",
            Self::AxisDynamics => "DYNAMIC",
            Self::Coupling => "#AX LINK",
        }
    }

    /// Returns the difference between control and trace, as a sentence after "the trace".
    pub fn instead(self) -> &'static str {
        match self {
            Self::Contouring => {
                "rounds corners within their tolerance with its own curve, the control with polynomials (`G61`, `G261`, `#CONTOUR MODE`)"
            }
            Self::HighSpeed => {
                "joins short blocks within their tolerance with its own curve, the control with another one (`#HSC`)"
            }
            Self::Slope => {
                "keeps the acceleration profile of the channel list, because the selected one is not known (`#SLOPE`)"
            }
            Self::VelocityWeight => {
                "keeps the velocity limits of the axes, which the program weights (`G127`, `G128`)"
            }
            Self::AccelerationWeight => {
                "keeps the accelerations of the axes, which the program weights (`G130`, `G131`, `G230`, `G231`)"
            }
            Self::RampWeight => {
                "keeps the jerks of the axes, which the program weights (`G132` to `G134`, `G233`)"
            }
            Self::DynamicWeight => {
                "keeps the dynamics of the axes, which the program weights (`#DYN WEIGHT`)"
            }
            Self::LateDeceleration => {
                "slows down before the end of a block, the control after it (`G901`)"
            }
            Self::FeedRamp => {
                "changes to the new feed at once, the control along the block (`G193`, `G293`)"
            }
            Self::CornerDeceleration => "keeps F in corners, where the control reduces it (`G13`)",
            Self::ToolFeed => "keeps F where the control adapts it to the tool radius (`G11`)",
            Self::FeedGroup => "applies F to X, Y and Z, whatever `#FGROUP` selects",
            Self::PathLimits => {
                "keeps only the limits of the axes, not those of the path (`#VECTOR LIMIT`)"
            }
            Self::ForeignFeed => {
                "keeps the programmed F, which the control adapts (`#GEO FEED ADAPT`)"
            }
            Self::IndependentAxis => "leaves out independent motions of single axes",
            Self::AxisDynamics => {
                "keeps the dynamics of the axes, which the program weights (`DYNAMIC`)"
            }
            Self::Coupling => "leaves out axes that follow others (`#AX LINK ON`)",
        }
    }
}

/// A set of simplifications, a bit each; serialised as the list of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(into = "Vec<Simplification>", from = "Vec<Simplification>")]
pub struct Simplifications(u32);

impl Simplifications {
    /// Returns whether the set is empty.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns the members of the set.
    pub fn iter(self) -> impl Iterator<Item = Simplification> {
        let all = Simplification::ALL.into_iter();
        all.filter(move |it| self.0 & 1 << *it as u32 != 0)
    }

    /// Returns whether one of them is in the set.
    pub fn contains(self, one: Simplification) -> bool {
        self.0 & Self::from(one).0 != 0
    }

    /// Returns the members of either set.
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns the members of this set that are not in another.
    pub fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }
}

impl From<Simplification> for Simplifications {
    fn from(one: Simplification) -> Self {
        Self(1 << one as u32)
    }
}

impl From<Vec<Simplification>> for Simplifications {
    fn from(list: Vec<Simplification>) -> Self {
        let sets = list.into_iter().map(Self::from);
        sets.fold(Self::default(), Self::union)
    }
}

impl From<Simplifications> for Vec<Simplification> {
    fn from(set: Simplifications) -> Self {
        set.iter().collect()
    }
}

/// Duration of a simplification.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Holds {
    /// The block only.
    Once,
    /// Until the end is programmed.
    On,
    /// End of a simplification that held.
    Off,
}

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
        /// Approach to a reference point.
        Homing = "homing",
        /// Motion of the axis by itself, independently of the path or along with it.
        Independent = "independent",
        /// Motion that follows another axis.
        Coupled = "coupled",
        /// Motion by the motion word of another axis, in rotated or transformed coordinates.
        Frame = "frame",
        /// Motion not known offline.
        Unknown = "unknown",
    }
}

/// Certainty of an event over the ways that a program may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Certainty {
    /// Certain on every way.
    Certain,
    /// Possible: not known offline.
    Possible,
}

/// The axes that a form moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Moves {
    /// Axes with a word in the block.
    Words,
    /// Axes with a word in the block, or every axis where none has one.
    WordsOrAll,
    /// Those with a word in the block, and perhaps the others of X, Y and Z.
    WordsInSpace,
    /// The axis before the bracket, now.
    Own,
    /// The axis before the bracket or named in it, whenever its master moves.
    Follower,
    /// All axes that the form names, whenever one of them moves.
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
    /// Returns whether the words move their axes.
    pub(crate) fn move_axes(self) -> bool {
        !matches!(self, Self::Reference | Self::Other)
    }
}

/// Effect of a command or function on positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum ChainStep {
    /// Switch to other coordinates, and back.
    Coordinates,
    /// Choice of the kinematics of a transformation, which other commands switch on (R1.42).
    Kinematics,
    /// Suspension of all offsets, and its end (PM/208517515).
    Machine,
    /// Effect on the path only: the programmed points stay, the path to them is open (PM/207256971).
    Path,
    /// Shift of the origin, by the machine's own values or for one block.
    Origin,
}

/// Direction in which a command or function switches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum OnOff {
    On,
    Off,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_holds_what_was_put_in() {
        // R5.1
        let all: Simplifications = Simplification::ALL.to_vec().into();
        assert_eq!(all.iter().count(), Simplification::ALL.len());
        let less = all.without(Simplification::Slope.into());
        assert!(less.iter().all(|it| it != Simplification::Slope));
        assert_eq!(less.union(Simplification::Slope.into()), all);
        assert!(all.without(all).is_empty());
    }
}
