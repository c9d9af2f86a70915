//! The quantity that a channel holds, by the name of its variable or by its object of the CNC (R6.3).

use std::fmt;

use super::channel::{Channel, CncObject};
use super::unit::{ChannelQuantity, split_unit};

frictcomp::words! {
    /// A quantity of an axis that a channel is recognised by.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[non_exhaustive]
    pub enum ChannelRole {
        /// The commanded position.
        Position = "position",
        /// The commanded velocity.
        Velocity = "velocity",
        /// The torque or the current that the drive measures.
        Torque = "torque",
        /// The position that the axis reached.
        ActualPosition = "actual position",
        /// The commanded less the actual position.
        FollowingError = "following error",
    }
}

/// A channel as it is recognised.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct RecognisedChannel {
    /// Quantity.
    pub role: ChannelRole,
    /// The axis, by its name or by its number in a CNC object.
    pub axis: Option<String>,
}

/// The names of variables, without separators and in lower case.
const VARIABLES: [(&str, ChannelRole); 8] = [
    ("setpos", ChannelRole::Position),
    ("cmdpos", ChannelRole::Position),
    ("setvelo", ChannelRole::Velocity),
    ("setvel", ChannelRole::Velocity),
    ("cmdvel", ChannelRole::Velocity),
    ("acttorque", ChannelRole::Torque),
    ("actpos", ChannelRole::ActualPosition),
    ("posdiff", ChannelRole::FollowingError),
];

/// The objects of an axis.
const OBJECTS: [(u32, ChannelRole); 4] = [
    (0x0A, ChannelRole::Position),
    (0x0B, ChannelRole::ActualPosition),
    (0x0C, ChannelRole::Velocity),
    (0x115, ChannelRole::Torque),
];

impl ChannelRole {
    /// Returns the role of a commanded or measured quantity.
    pub(super) fn of(quantity: ChannelQuantity) -> Option<Self> {
        match quantity {
            ChannelQuantity::Time => None,
            ChannelQuantity::Position => Some(Self::Position),
            ChannelQuantity::Velocity => Some(Self::Velocity),
            ChannelQuantity::Torque => Some(Self::Torque),
        }
    }

    /// Returns the quantity of its unit.
    pub(super) fn quantity(self) -> ChannelQuantity {
        match self {
            Self::Position | Self::ActualPosition | Self::FollowingError => {
                ChannelQuantity::Position
            }
            Self::Velocity => ChannelQuantity::Velocity,
            Self::Torque => ChannelQuantity::Torque,
        }
    }
}

impl fmt::Display for RecognisedChannel {
    /// Writes `actual position of X`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.role.as_str())?;
        self.axis
            .iter()
            .try_for_each(|axis| write!(f, " of {axis}"))
    }
}

impl Channel {
    /// Returns the quantity that the channel holds, if its name, its symbol or its object is one of those that the
    /// control or Scope gives it.
    pub fn recognised(&self) -> Option<RecognisedChannel> {
        let object = self.object.filter(|it| it.is_of_axis());
        let of_object = || {
            let element = object?.element();
            let found = OBJECTS.iter().find(|(known, _)| *known == element);
            Some((found?.1, None))
        };
        let [name, symbol] = [&self.name, &self.symbol].map(|it| variable(it));
        let (role, of_name) = name.clone().or(symbol.clone()).or_else(of_object)?;
        let of_symbol = || symbol.and_then(|it| it.1);
        let number = || object.map(|it| it.axis().to_string());
        Some(RecognisedChannel {
            role,
            axis: of_name.or_else(of_symbol).or_else(number),
        })
    }
}

/// Returns the quantity of a variable, `X.SetVelo`, `ActPosX` or `dig_drv.act_torque`, and its axis.
fn variable(text: &str) -> Option<(ChannelRole, Option<String>)> {
    let mut parts = split_unit(text).0.rsplit('.');
    let name: String = parts.next()?.split(['_', ' ', '-']).collect();
    let lower = name.to_lowercase();
    let folder = parts.next().filter(|it| is_axis_name(it));
    if let Some((_, role)) = VARIABLES.iter().find(|(word, _)| lower == *word) {
        return Some((*role, folder.map(str::to_owned)));
    }
    // The first word that fits decides: `SetVelo2` is no `SetVel` of `O2`.
    let (rest, role) = VARIABLES.iter().find_map(|(word, role)| {
        let rest = lower
            .strip_prefix(word)
            .or_else(|| lower.strip_suffix(word))?;
        Some((rest, *role))
    })?;
    is_axis_name(rest).then(|| (role, Some(rest.to_uppercase())))
}

/// Returns whether a text is the name of an axis, a letter and up to two digits.
fn is_axis_name(text: &str) -> bool {
    let (letter, digits) = text.split_at_checked(1).unwrap_or_default();
    letter.bytes().all(|it| it.is_ascii_alphabetic())
        && !letter.is_empty()
        && digits.len() <= 2
        && digits.bytes().all(|it| it.is_ascii_digit())
}

impl CncObject {
    /// The object group of axes, without the part of the platform.
    const AXES: u32 = 0x2_0300;

    /// Returns whether it is an object of an axis.
    pub fn is_of_axis(self) -> bool {
        self.group & 0xF_FFFF == Self::AXES
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_channel_is_recognised_by_its_variable_and_by_its_object() {
        // R6.3
        let said = |name: &str, symbol: &str, offset: Option<u32>| {
            let channel = Channel {
                name: name.to_owned(),
                symbol: symbol.to_owned(),
                object: offset.map(|offset| CncObject {
                    group: 0x12_0300,
                    offset,
                }),
                ..Channel::default()
            };
            channel.recognised().map(|it| it.to_string())
        };
        for (name, symbol, offset, expected) in [
            ("X.SetPos [mm]", "", None, "position of X"),
            ("SetVelo", "Axes.Y1.SetVelo", None, "velocity of Y1"),
            ("ActPosX", "", None, "actual position of X"),
            ("z_ActPos", "", None, "actual position of Z"),
            ("dig_drv.act_torque", "", Some(0x2_0115), "torque of 2"),
            ("Channel 3", "", Some(0x1_000C), "velocity of 1"),
            ("MAIN.stAxis.NcToPlc.PosDiff", "", None, "following error"),
        ] {
            assert_eq!(
                said(name, symbol, offset).as_deref(),
                Some(expected),
                "{name}"
            );
        }
        for name in ["x", "Position", "ActPosition", "SetVelo2", "Weg X", ""] {
            assert_eq!(said(name, "", None), None, "{name}");
        }
        assert_eq!(said("Channel 3", "", Some(0x1_0221)), None);
    }
}
