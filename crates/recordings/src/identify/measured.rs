//! The contents of a recorded torque: whether the additive current is part of it (R6.21).

use std::str::FromStr;

use serde::Serialize;

use crate::trace::Channel;
use frictcomp_physics::current::Switched;

frictcomp::words! {
    /// Kind of torque in a channel.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
    #[non_exhaustive]
    pub enum TorqueKind {
        /// Torque or current as measured by the drive, including the additive current.
        Actual = "actual",
        /// Torque as commanded within the drive.
        Command = "command",
        /// Output of the speed controller, without the additive current.
        Loop = "loop",
    }
}

/// Words in names, symbols and comments of channels, without blanks and lines.
const WORDS: [(TorqueKind, &[&str]); 3] = [
    (
        TorqueKind::Loop,
        &[
            "loopout",
            "speedcontroller",
            "controllerout",
            "reglerausgang",
            "speedctrl",
        ],
    ),
    (
        TorqueKind::Actual,
        &[
            "acttorq",
            "actualtorq",
            "torqueactual",
            "actcurr",
            "actualcurr",
            "currentactual",
            "torqact",
            "actforce",
            "istwert",
            "istmoment",
            "momentist",
            "iststrom",
        ],
    ),
    (
        TorqueKind::Command,
        &[
            "cmdtorq",
            "commandedtorq",
            "settorq",
            "targettorq",
            "torquecmd",
            "torquedemand",
            "torqueset",
            "sollwert",
            "sollmoment",
            "momentsoll",
            "sollstrom",
        ],
    ),
];

impl TorqueKind {
    /// Returns the kind named by the name, symbol or comment of a channel.
    pub fn of(channel: &Channel) -> Option<Self> {
        let texts = [&channel.name, &channel.symbol, &channel.comment];
        let plain = texts.map(|text| text.to_lowercase().replace(['_', ' ', '.', '-'], ""));
        let tells = |words: &[&str]| {
            plain
                .iter()
                .any(|text| words.iter().any(|word| text.contains(word)))
        };
        let mut kinds = WORDS.iter().filter(|(_, words)| tells(words));
        let (kind, _) = kinds.next()?;
        kinds.next().is_none().then_some(*kind)
    }
}

impl FromStr for TorqueKind {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let kinds = [Self::Actual, Self::Command, Self::Loop];
        let found = kinds.into_iter().find(|kind| kind.as_str() == text);
        found.ok_or_else(|| format!("`{text}` is not one of actual, command, loop"))
    }
}

/// Statement of the user that the recording contradicts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Contradiction {
    /// The channel has the name of the speed controller's output, and is given as another torque.
    Kind(TorqueKind),
    /// The recorded state shows compensation on, and it is given as off.
    Compensation,
}

/// Known properties of a recorded torque.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Measured {
    /// Kind of torque; `None` if it is not known.
    pub kind: Option<TorqueKind>,
    /// State of friction compensation; `None` if that is not known.
    pub compensation: Option<Switched>,
    /// The rated torque in the unit of the channel, if it is known.
    pub rated: Option<f64>,
    /// A statement that the recording contradicts.
    pub contradiction: Option<Contradiction>,
}

impl Measured {
    /// Returns the properties with the user's statements about the torque.
    #[must_use]
    pub fn stated(self, kind: Option<TorqueKind>, compensation: Option<Switched>) -> Self {
        let is_loop = self.kind == Some(TorqueKind::Loop);
        let other_kind = kind.filter(|kind| is_loop && *kind != TorqueKind::Loop);
        let states = [self.compensation, compensation];
        let other_state = states == [Some(Switched::On), Some(Switched::Off)];
        Self {
            kind: kind.or(self.kind),
            compensation: compensation.or(self.compensation),
            contradiction: other_kind
                .map(Contradiction::Kind)
                .or(other_state.then_some(Contradiction::Compensation)),
            ..self
        }
    }

    /// Returns the properties common to two recordings; compensation was on if it was on in either.
    #[must_use]
    pub fn common(self, other: Self) -> Self {
        let either = [self.compensation, other.compensation];
        Self {
            kind: self.kind.filter(|_| self.kind == other.kind),
            compensation: if either.contains(&Some(Switched::On)) {
                Some(Switched::On)
            } else {
                self.compensation.and(other.compensation)
            },
            rated: self.rated.filter(|_| self.rated == other.rated),
            contradiction: self.contradiction.or(other.contradiction),
        }
    }
}

/// Drive units in the rated torque.
pub(super) const RATED_UNITS: f64 = 1000.0;

impl Default for Measured {
    /// Returns the actual torque in drive units, 0.1 % of the rated torque.
    fn default() -> Self {
        Self {
            kind: Some(TorqueKind::Actual),
            compensation: None,
            rated: Some(RATED_UNITS),
            contradiction: None,
        }
    }
}
