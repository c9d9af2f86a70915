//! The values of variables that only the machine knows.

use serde::{Deserialize, Serialize};

/// The user's value of a variable that only the machine knows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Setting {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
}
