//! Statements about the user's programs and lists, as plain data.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::codes::Code;
use crate::source::{Position, Span};

/// How much a diagnostic weighs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing.
    Info,
    /// Likely a mistake, or an effect that outlives the program.
    Warning,
    /// The control stops here, or does not take the list.
    Error,
}

impl Severity {
    /// The word of the records: `error`, `warning`, `info`.
    pub fn word(self) -> &'static str {
        match self {
            Self::Info => "info",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// A place in a file, together with the lines that show it.
///
/// It carries its lines itself, so that a program of any length can be streamed and forgotten.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Place {
    /// The file as the user named it.
    pub file: Arc<str>,
    /// The source lines to show, joined by `\n`.
    pub text: Arc<str>,
    /// The 1-based number of the first line of `text`.
    pub first_line: u32,
    /// The bytes of `text` that are meant.
    pub span: Span,
}

impl Place {
    /// The first character that is meant.
    pub fn start(&self) -> Position {
        self.position(self.span.start)
    }

    /// One past the last character that is meant.
    pub fn end(&self) -> Position {
        self.position(self.span.end)
    }

    fn position(&self, offset: u32) -> Position {
        let before = self.text.get(..offset as usize).unwrap_or(&self.text);
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        Position {
            line: self.first_line + count(before.matches('\n').count()),
            column: count(before[line_start..].chars().count()) + 1,
        }
    }
}

/// A second place that explains the first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub place: Place,
    /// What is there, in a few words.
    pub text: String,
}

/// One statement about a program or a list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// The control's number, or one of ours.
    pub code: Code,
    /// Its weight, already changed by `[lint]` where the user did so.
    pub severity: Severity,
    /// One sentence in lower case.
    pub message: String,
    /// What is meant.
    pub place: Place,
    /// The axis that it is about.
    pub axis: Option<String>,
    /// What to do, one piece of advice each.
    pub help: Vec<String>,
    /// Further places.
    pub labels: Vec<Label>,
}

impl Diagnostic {
    /// A diagnostic with the code's own severity and nothing but a message.
    pub fn new(code: Code, place: Place, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: code.severity(),
            message: message.into(),
            place,
            axis: None,
            help: Vec::new(),
            labels: Vec::new(),
        }
    }

    /// The same with the axis that it is about.
    pub fn with_axis(mut self, axis: impl Into<String>) -> Self {
        self.axis = Some(axis.into());
        self
    }

    /// The same with one more piece of advice.
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help.push(help.into());
        self
    }

    /// The same with one more place.
    pub fn with_label(mut self, place: Place, text: impl Into<String>) -> Self {
        self.labels.push(Label {
            place,
            text: text.into(),
        });
        self
    }
}

/// How many messages about one file are said; further ones are counted (R2.85).
pub const MAX_MESSAGES: usize = 10_000;

/// Messages that are collected before they are said: as many as are said, the rest counted by code.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Collected {
    /// The messages.
    pub said: Vec<Diagnostic>,
    /// How many more there were.
    pub unsaid: std::collections::BTreeMap<Code, u64>,
}

impl Collected {
    /// Takes a message. One more is kept than is said, for the place from which on they are counted.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        if self.said.len() <= MAX_MESSAGES {
            self.said.push(diagnostic);
        } else {
            *self.unsaid.entry(diagnostic.code).or_default() += 1;
        }
    }

    /// Takes the messages of another collection.
    pub fn append(&mut self, other: &Self) {
        for diagnostic in &other.said {
            self.push(diagnostic.clone());
        }
        for (code, times) in &other.unsaid {
            *self.unsaid.entry(*code).or_default() += times;
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.said.is_empty()
    }
}

impl Extend<Diagnostic> for Collected {
    fn extend<T: IntoIterator<Item = Diagnostic>>(&mut self, messages: T) {
        messages.into_iter().for_each(|message| self.push(message));
    }
}

/// What the user's `[lint]` table says: other severities for codes of ours (R9.28).
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Levels {
    levels: std::collections::BTreeMap<Code, Option<Severity>>,
}

impl Levels {
    /// Gives a code another severity, or none, which silences it. The control's own errors keep
    /// theirs (R9.24); the return value says whether the code may be changed.
    pub fn set(&mut self, code: Code, level: Option<Severity>) -> bool {
        let ours = !code.is_controller();
        if ours {
            self.levels.insert(code, level);
        }
        ours
    }

    /// The severity of a code, `None` when it is off.
    pub fn severity(&self, code: Code) -> Option<Severity> {
        self.levels
            .get(&code)
            .copied()
            .unwrap_or(Some(code.severity()))
    }
}

/// Letters beyond which a word is no slip of the pen, and not compared.
const MAX_WORD: usize = 64;

/// A number in a message: very large and very small ones with an exponent (R9.78).
pub(crate) struct Shown(pub(crate) f64);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size != 0.0 && size.is_finite() && !(1e-9..1e12).contains(&size) {
            write!(f, "{:e}", self.0)
        } else {
            write!(f, "{}", self.0)
        }
    }
}

/// The nearest of several known words, close enough to be meant: at most a third of the letters
/// differ, swapped neighbours count once; or one is the beginning of the other.
pub(crate) fn did_you_mean<'a>(
    found: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    if found.len() > MAX_WORD {
        return None;
    }
    let found = found.to_ascii_uppercase();
    let letters = found.chars().count();
    // Of a single letter only the case can be wrong.
    let allowed = if letters > 1 { (letters / 3).max(1) } else { 0 };
    known
        .into_iter()
        .filter(|word| word.len() <= MAX_WORD)
        .filter_map(|word| {
            let upper = word.to_ascii_uppercase();
            let begins = letters.min(upper.len()) > 2
                && (found.starts_with(&upper) || upper.starts_with(&found));
            let near = letters.abs_diff(upper.chars().count()) <= allowed;
            if !near && !begins {
                return None;
            }
            let distance = strsim::damerau_levenshtein(&found, &upper);
            (distance <= allowed || begins).then_some((distance, word))
        })
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, word)| word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_messages_stay_short() {
        // R9.78
        let shown = |number| Shown(number).to_string();
        assert_eq!(shown(1e308), "1e308");
        assert_eq!(shown(-2.5), "-2.5");
        assert_eq!(shown(1e-300), "1e-300");
        assert_eq!(shown(0.0), "0");
        assert_eq!(shown(1e9), "1000000000");
        assert_eq!(shown(f64::NAN), "NaN");
    }
}
