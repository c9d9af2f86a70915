//! A COMP command as data.

use serde::{Deserialize, Serialize};

use super::kind::KindSet;
use crate::text::Span;

/// Selection of a COMP bracket.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Selection {
    /// `ON` and the kinds after it.
    On(KindSet),
    /// `OFF` and the kinds after it.
    Off(KindSet),
    /// `OFF_ALL`.
    OffAll,
}

impl Selection {
    /// Returns the kinds that the command names; `OFF_ALL` names every kind (R1.3).
    pub fn kinds(self) -> KindSet {
        match self {
            Self::On(kinds) | Self::Off(kinds) => kinds,
            Self::OffAll => KindSet::ALL,
        }
    }
}

/// One understood COMP command, `X[COMP ON FRICT]`.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct CompCommand {
    /// The axis before the bracket.
    pub axis: String,
    /// Kinds to switch.
    pub selection: Selection,
    /// Whether the bracket contains `NO_MOVE`, which does not matter to friction compensation (R1.6).
    pub no_move: bool,
    /// From the axis name to the closing bracket.
    pub span: Span,
}
