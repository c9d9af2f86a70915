//! The effective value of a parameter and its origin, which may be another parameter of the list: `P-AXIS-00008.0` (R3.40).

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::keywords::{is_known, known_keys};
use super::line::{Entry, Given};
use crate::diagnostic::{Code, Diagnostic};
use crate::text::Span;

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
    /// Documented default; no list sets the parameter.
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
    /// Returns whether the user assumes it.
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
    /// Unit for the axis' type, empty for plain numbers.
    pub unit: &'static str,
    /// Origin of the value.
    pub origin: Origin,
}

/// A value `P-AXIS-00008.0`: a parameter and the indices in its key.
struct Reference {
    number: String,
    indices: Vec<u32>,
}

impl Reference {
    /// Reads a reference; `None` for any other value.
    fn parse(word: &str) -> Option<Self> {
        let mut parts = word.split('.');
        let number = parts.next()?.to_ascii_uppercase();
        let (room, digits) = number.strip_prefix("P-")?.split_once('-')?;
        let is_number = digits.len() == 5 && digits.bytes().all(|byte| byte.is_ascii_digit());
        if !is_number || !matches!(room, "AXIS" | "CHAN" | "COMP" | "STUP") {
            return None;
        }
        let indices: Result<Vec<u32>, _> = parts.map(str::parse).collect();
        Some(Self {
            number,
            indices: indices.ok()?,
        })
    }

    /// Returns the entry of the parameter. An omitted index is 0.
    fn find(&self, entries: &[Entry]) -> Result<usize, &'static str> {
        let mut keys = known_keys()
            .filter(|key| key.number == self.number)
            .peekable();
        if keys.peek().is_none() {
            return Err("whose key is not known to frictcomp");
        }
        let at = |index: usize| self.indices.get(index).copied().unwrap_or(0);
        let is_meant = |entry: &Entry, pattern: &str| {
            entry.pattern == pattern && entry.indices.iter().enumerate().all(|(i, &it)| it == at(i))
        };
        keys.find_map(|key| {
            let mut entries = entries.iter();
            entries.position(|entry| is_meant(entry, key.pattern))
        })
        .ok_or("which no line of this list gives")
    }
}

/// Gives every known entry that refers to another one the value of that one. Removes and returns
/// those whose reference cannot be resolved, each reported with FC124.
pub(super) fn resolve(entries: &mut Vec<Entry>, diagnostics: &mut Vec<Diagnostic>) -> Vec<Entry> {
    let begins = |entry: &Entry| matches!(entry.word().value.as_bytes(), [b'P' | b'p', b'-', ..]);
    let referring = (0..entries.len())
        .filter(|&at| is_known(&entries[at].pattern) && begins(&entries[at]))
        .collect::<Vec<_>>();
    let mut broken = Vec::new();
    for at in referring {
        match follow(entries, at) {
            Ok(Some(value)) => entries[at].meant = value,
            Ok(None) => {}
            // A circle is reported at the first of its members.
            Err((_, passed)) if passed.iter().any(|it| broken.contains(it)) => broken.push(at),
            Err((why, _)) => {
                let entry = &entries[at];
                let word = entry.word();
                let message = format!(
                    "`{}` refers to `{}`, {why}; the value is not used",
                    entry.key(),
                    word.value
                );
                diagnostics.push(
                    Diagnostic::new(Code::Fc124, word.place(), message)
                        .with_help("write the value itself"),
                );
                broken.push(at);
            }
        }
    }
    let mut unresolved = Vec::new();
    for at in broken.into_iter().rev() {
        unresolved.push(entries.remove(at));
    }
    unresolved
}

/// Returns the span of the value that an entry refers to; `None` for an entry without a reference.
fn follow(entries: &[Entry], first: usize) -> Result<Option<Span>, (&'static str, Vec<usize>)> {
    let mut passed = vec![first];
    loop {
        let last = &entries[*passed.last().unwrap_or(&first)];
        let Some(reference) = Reference::parse(last.word().value) else {
            return Ok((passed.len() > 1).then_some(last.meant));
        };
        let next = match reference.find(entries) {
            Ok(next) => next,
            Err(why) => return Err((why, passed)),
        };
        if passed.contains(&next) {
            return Err(("which leads back to itself", passed));
        }
        passed.push(next);
    }
}
