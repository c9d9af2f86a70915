//! States of a channel in which the control refuses words and commands (R2.111), and the modes among them that nothing
//! else follows.

use serde::{Deserialize, Serialize};

use super::motion::OnOff;

/// A state of the channel in which the control refuses some words and commands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum ChannelState {
    /// G41, G42.
    CutterRadius,
    /// After G40, where the next motion takes the tool radius back (PM/524821515).
    LeavingRadius,
    /// G151, `#SPLINE ON`.
    ProgrammedSpline,
    /// `#HSC ON [OPMODE 2]`.
    FastSpline,
    /// Either of them.
    Spline,
    /// G151 after `#SPLINE TYPE BSPLINE`.
    BSpline,
    /// `#HSC ON`.
    HighSpeed,
    /// G261, `#CONTOUR MODE ON`.
    Contouring,
    /// `#CS`, `#ACS`.
    Frame,
    /// `#TRAFO`, `#RTCP`.
    Kinematics,
    /// `#PTP ON`.
    PointToPoint,
    /// G21 to G23.
    Mirror,
    /// A coupling group is active.
    Coupling,
}

/// The states in which the control refuses a word or command, each with the number of the error; the first one counts.
pub(crate) type RefusedIn = &'static [(ChannelState, u32)];

impl ChannelState {
    /// The state, in the words of a message.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::CutterRadius => "under G41 or G42",
            Self::LeavingRadius => "after G40, before the next motion",
            Self::ProgrammedSpline | Self::Spline => "under a spline",
            Self::FastSpline => "in the spline mode of `#HSC`",
            Self::BSpline => "under a B spline",
            Self::HighSpeed => "while `#HSC` is active",
            Self::Contouring => "while contours are rounded",
            Self::Frame => "while a coordinate system is active",
            Self::Kinematics => "while a kinematic transformation is active",
            Self::PointToPoint => "while `#PTP` is active",
            Self::Mirror => "while coordinates are mirrored",
            Self::Coupling => "while a coupling group is active",
        }
    }
}

/// A mode that counts only for what the control refuses, and for what leaving G41 moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Mode {
    /// `#PTP ON` (PM/524821515).
    PointToPoint,
    /// `#SPLINE TYPE BSPLINE` (PM/207203723).
    BSpline,
    /// `#PUNCH ON`, `#NIBBLE ON`: each motion triggers the stroke (PM/207668235).
    Punching,
    /// G164: the centre of a circle is not corrected (PM/206551563).
    FixedCentre,
    /// G138, G139, G236: the motion after G40 takes the tool radius back (PM/524821515).
    LeavesWithMotion,
}

/// The modes in force, or that may be, a bit each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Modes(u8);

impl Default for Modes {
    /// Those at program start: G139 (tccncprogramming/15556736651).
    fn default() -> Self {
        Self(1 << Mode::LeavesWithMotion as u8)
    }
}

impl Modes {
    /// Those that the end of a cycle restores, because G functions switch them (P-CHAN-00210).
    const BY_FUNCTIONS: u8 = 1 << Mode::FixedCentre as u8 | 1 << Mode::LeavesWithMotion as u8;
    /// Those in which the control refuses circles.
    const OF_CIRCLES: u8 = 1 << Mode::FixedCentre as u8 | 1 << Mode::BSpline as u8;

    pub(crate) fn has(self, mode: Mode) -> bool {
        self.0 & 1 << mode as u8 != 0
    }

    pub(crate) fn switch(&mut self, mode: Mode, switch: OnOff) {
        match switch {
            OnOff::On => self.0 |= 1 << mode as u8,
            OnOff::Off => self.0 &= !(1 << mode as u8),
        }
    }

    /// Returns the members of either set.
    pub(crate) fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Takes those that G functions switch from another set.
    pub(crate) fn restore(&mut self, saved: Self) {
        self.0 = self.0 & !Self::BY_FUNCTIONS | saved.0 & Self::BY_FUNCTIONS;
    }

    /// Whether the control refuses some circles in one of them.
    #[inline]
    pub(crate) fn limit_circles(self) -> bool {
        self.0 & Self::OF_CIRCLES != 0
    }
}
