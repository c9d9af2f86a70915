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

impl Setting {
    /// Whether a name is that of a variable or a parameter, which can have a value (R2.33, R2.34).
    pub fn is_for(name: &str) -> bool {
        let number = name.strip_prefix('@').unwrap_or(name);
        let number = number.strip_prefix(['P', 'p']);
        if let Some(number) = number {
            return number.starts_with(|it: char| it.is_ascii_digit());
        }
        name.strip_prefix("V.")
            .or_else(|| name.strip_prefix("v."))
            .is_some_and(|rest| rest.starts_with(|it: char| it.is_ascii_alphabetic()))
    }
}
