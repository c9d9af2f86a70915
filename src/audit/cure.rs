//! The end of a hazard at which it is mended.

use std::fmt;

use serde::{Serialize, Serializer};

/// The programs to mend: the end of each hazard that fewer programs have (R10.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Cure {
    /// There is no hazard.
    None,
    /// Those that leave the axis away from its start-up state: a command before the end.
    Leavers,
    /// Those that inherit it: a command before the first motion.
    Inheritors,
}

impl Cure {
    /// The word of the records.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Leavers => "leavers",
            Self::Inheritors => "inheritors",
        }
    }
}

impl fmt::Display for Cure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl Serialize for Cure {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.as_str())
    }
}

/// A subject to mend in a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Mending {
    /// The position of the axis and kind in [`ProgramAudit::axes`](super::ProgramAudit::axes).
    pub at: usize,
    /// End of the hazards to mend: [`Cure::Leavers`] or [`Cure::Inheritors`].
    pub cure: Cure,
}
