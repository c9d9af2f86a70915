//! The effective value of a parameter and its origin.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::value::Given;

/// The type of an axis, P-AXIS-00018 (`kenngr.achs_typ`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum AxisType {
    /// Translatory, list value 1.
    #[default]
    #[serde(rename = "T")]
    Linear,
    /// Rotary, list value 2.
    #[serde(rename = "R")]
    Rotary,
    /// Spindle, list value 4.
    #[serde(rename = "S")]
    Spindle,
}

impl AxisType {
    /// Returns the value in an axis list.
    pub fn list_value(self) -> &'static str {
        match self {
            Self::Linear => "1",
            Self::Rotary => "2",
            Self::Spindle => "4",
        }
    }
}

/// A text that is not an axis type.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("`{0}` is not an axis type")]
pub struct UnknownAxisType(pub String);

impl FromStr for AxisType {
    type Err = UnknownAxisType;

    /// Returns the type for a letter of the parameter descriptions: `T`, `R`, `S`.
    fn from_str(letter: &str) -> Result<Self, Self::Err> {
        match letter {
            "T" => Ok(Self::Linear),
            "R" => Ok(Self::Rotary),
            "S" => Ok(Self::Spindle),
            _ => Err(UnknownAxisType(letter.to_owned())),
        }
    }
}

/// Origin of the value of a parameter.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Origin {
    /// No list sets it; the documented default applies.
    Default,
    /// A line of a list or of `frictcomp.toml`.
    File {
        /// The file as the user would name it.
        file: String,
        /// The line, from 1.
        line: u32,
    },
    /// The user assumes it for the call.
    Assumed,
    /// The user assumes it with `enable = true` in this line of `frictcomp.toml` (R18.2).
    Enabled {
        /// The file as the user would name it.
        file: String,
        /// The line, from 1.
        line: u32,
    },
}

impl Origin {
    /// Whether the user assumes it.
    pub fn is_assumed(&self) -> bool {
        matches!(self, Self::Assumed | Self::Enabled { .. })
    }
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Default => f.write_str("default"),
            Self::File { file, line } => write!(f, "{file}:{line}"),
            Self::Assumed => f.write_str("assumed"),
            Self::Enabled { file, line } => write!(f, "`enable = true`, {file}:{line}"),
        }
    }
}

impl<T> From<&Given<T>> for Origin {
    fn from(given: &Given<T>) -> Self {
        Self::File {
            file: given.file().to_owned(),
            line: given.line(),
        }
    }
}

/// One row of the table of effective parameters.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Parameter {
    /// The number in the parameter descriptions, `P-COMP-00043`.
    pub number: &'static str,
    /// The key in a list, `frict_comp.position_delay`.
    pub key: String,
    /// The effective value, in list notation.
    pub value: String,
    /// Its unit for the axis' type, empty for plain numbers.
    pub unit: &'static str,
    /// Origin of the value.
    pub origin: Origin,
}
