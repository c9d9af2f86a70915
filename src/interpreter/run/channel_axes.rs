//! The axes of the channel and their names.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::comp::AxisIndex;

/// The changes that the program made to the names of the channel's axes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct ChannelAxes {
    pub(crate) names: BTreeMap<String, AxisNameMeaning>,
    /// Whether the meaning of every name is unknown.
    pub(crate) doubtful: bool,
}

impl ChannelAxes {
    /// Whether every name means the axis of the machine.
    #[inline]
    pub(crate) fn are_own(&self) -> bool {
        self.names.is_empty() && !self.doubtful
    }

    /// Meaning of a name; `None` where it means the axis of the machine, or none.
    pub(crate) fn meaning(&self, name: &str) -> Option<AxisNameMeaning> {
        if self.doubtful {
            return Some(AxisNameMeaning::Unknown);
        }
        self.names.get(name).copied()
    }

    /// Whether all axes that it names are below a number.
    pub(crate) fn fits(&self, count: usize) -> bool {
        self.names.values().all(|meaning| match meaning {
            AxisNameMeaning::Axis(axis) | AxisNameMeaning::Released(Some(axis)) => {
                axis.get() < count
            }
            AxisNameMeaning::Released(None) | AxisNameMeaning::Unknown => true,
        })
    }

    /// The names may or may not be those of another way through the program.
    pub(crate) fn join(&mut self, other: &Self) {
        self.doubtful |= self != other;
    }
}

/// Meaning of an axis name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum AxisNameMeaning {
    /// This axis of the machine, whatever its own name is.
    Axis(AxisIndex),
    /// An axis that the channel has given back.
    Released(Option<AxisIndex>),
    /// Some axis.
    Unknown,
}

/// Axis that a COMP command switches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Addressed {
    /// This one.
    Axis(AxisIndex),
    /// One that the channel does not have; the control refuses it.
    Absent(Option<AxisIndex>),
    /// Any of them.
    Any,
}
