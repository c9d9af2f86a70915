//! The properties of an axis that compensation depends on.

use serde::{Deserialize, Serialize};

use super::kind::{Kind, KindSet};

/// The position of an axis in the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct AxisIndex(u16);

impl AxisIndex {
    /// Creates the index from a position in the axis list.
    pub fn new(position: usize) -> Self {
        Self(u16::try_from(position).expect("a control has fewer than 65536 axes"))
    }

    /// Returns the position in the axis list.
    pub fn get(self) -> usize {
        usize::from(self.0)
    }
}

/// The properties of an axis that matter to compensation.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct AxisSetup {
    /// The name in NC programs, case-sensitive.
    pub name: String,
    /// Whether it is a spindle; spindles have no COMP.
    pub is_spindle: bool,
    /// The kinds that the axis parameters configure.
    pub configured: KindSet,
    /// The kinds that are known not to be configured, so that the control refuses to switch them on
    /// (R1.24, R1.41).
    pub unselected: KindSet,
    /// The kinds that only the program activates and that switch off at program end (R1.40).
    pub manual: KindSet,
    /// The kinds that have all values they need to work.
    pub parameterised: KindSet,
}

impl AxisSetup {
    /// Creates an axis on which the kinds are configured and parameterised. Of the other kinds,
    /// only FRICT is known not to be configured.
    pub fn new(name: impl Into<String>, configured: KindSet) -> Self {
        Self {
            name: name.into(),
            is_spindle: false,
            configured,
            unselected: KindSet::of(Kind::Frict).without(configured),
            manual: KindSet::NONE,
            parameterised: configured,
        }
    }
}
