//! One statement about a program or a list: its numbers, and the main programs that reach it in a called program (R17.1).

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use serde::ser::SerializeStruct;
use serde::{Deserialize, Serialize, Serializer};

use super::advice::{Advice, Wording};
use super::codes::Code;
use super::fix::Fix;
use crate::text::{Place, Span};

/// A second place that explains the first.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Label {
    /// The place to explain.
    pub place: Place,
    /// Text at the label, in a few words.
    pub text: String,
}

/// One statement about a program or a list.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Diagnostic {
    /// The control's number, or one of ours.
    pub code: Code,
    /// Severity, already changed by the user's `[lint]` table.
    pub severity: Severity,
    /// The message: one sentence in lower case.
    pub message: String,
    /// Place of the cause.
    pub place: Place,
    /// The axis that it is about.
    pub axis: Option<String>,
    /// Advice to the user.
    pub advice: Vec<Advice>,
    /// Changes to the text, each of which alone does what is advised.
    pub fixes: Vec<Fix>,
    /// Further places.
    pub labels: Vec<Label>,
    /// Number of executed blocks of a program to which it applied, as given in the message.
    pub times: u64,
    /// The message without the number of times, where it has one.
    pub uncounted: Option<String>,
    /// The main programs that reach its place, if that is in a called program.
    pub reached_from: ReachedFrom,
    /// The program ends that it is about (R1.58).
    pub ends: Vec<Place>,
}

impl Diagnostic {
    /// Creates a diagnostic with the code's own severity and only a message.
    pub fn new(code: Code, place: Place, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: code.severity(),
            message: message.into(),
            place,
            axis: None,
            advice: Vec::new(),
            fixes: Vec::new(),
            labels: Vec::new(),
            times: 1,
            uncounted: None,
            reached_from: ReachedFrom::default(),
            ends: Vec::new(),
        }
    }

    /// Raises its severity above that of its code; no setting lowers it.
    pub(crate) fn raised(mut self, severity: Severity) -> Self {
        self.severity = severity;
        self
    }

    /// Lowers its severity below that of its code; no setting raises it.
    pub(crate) fn lower(&mut self, severity: Severity) {
        self.severity = self.severity.min(severity);
    }

    /// Returns whether it is less severe than its code says, so that no setting raises it.
    pub(crate) fn is_lowered(&self) -> bool {
        self.severity < self.code.severity()
    }

    /// Returns whether it is more severe than its code says, so that no setting lowers or silences it.
    pub fn is_raised(&self) -> bool {
        self.severity > self.code.severity()
    }

    /// Sets the axis that it is about.
    pub fn with_axis(mut self, axis: impl Into<String>) -> Self {
        self.axis = Some(axis.into());
        self
    }

    /// Adds a piece of advice.
    pub fn with_help(mut self, advice: impl Into<Advice>) -> Self {
        self.advice.push(advice.into());
        self
    }

    /// Adds a change that does what is advised.
    pub fn with_fix(mut self, fix: Fix) -> Self {
        self.fixes.push(fix);
        self
    }

    /// Suggests the known words that may be meant by `found`, the text at its place; only a single
    /// one is offered as a change (R1.60).
    pub(crate) fn with_near(self, found: &str, near: &[&str]) -> Self {
        if near.is_empty() {
            return self;
        }
        let mut place = self.place.clone();
        let start = place.span.of(&place.text).find(found);
        let said = self.with_help(Advice::did_you_mean(near));
        let (Some(start), [near]) = (start, near) else {
            return said;
        };
        let start = place.span.start as usize + start;
        place.span = Span::new(start, start + found.len());
        said.with_fix(Fix::guess(place, *near))
    }

    /// Adds to the message how often it applied.
    pub(crate) fn count(&mut self, times: u64) {
        let counted = format!("{} ({times} times)", self.message);
        self.uncounted = Some(std::mem::replace(&mut self.message, counted));
        self.times = times;
    }

    /// Returns the message without its count, by which equal messages are recognised (R17.3).
    pub fn uncounted(&self) -> &str {
        self.uncounted.as_ref().unwrap_or(&self.message)
    }

    /// Returns the message with the main programs that reach its place, for one-line formats
    /// (R17.1).
    pub fn line(&self) -> Cow<'_, str> {
        if self.reached_from.is_empty() {
            Cow::Borrowed(&self.message)
        } else {
            Cow::Owned(format!("{} ({})", self.message, self.reached_from))
        }
    }

    /// Returns the advice in words.
    pub fn help(&self) -> Vec<String> {
        self.advice.iter().map(Advice::to_string).collect()
    }

    /// Replaces its advice by a host's wording.
    pub fn reword(&mut self, wording: Option<Wording>) {
        let Some(wording) = wording else {
            return;
        };
        for advice in &mut self.advice {
            if let Some(words) = wording(advice) {
                *advice = words.into();
            }
        }
    }

    /// Adds another place.
    pub fn with_label(mut self, place: Place, text: impl Into<String>) -> Self {
        self.labels.push(Label {
            place,
            text: text.into(),
        });
        self
    }
}

/// A program end in a record.
#[derive(Serialize)]
struct EndRecord<'a> {
    file: &'a str,
    line: u32,
}

/// The keys of a diagnostic record (chapter 9.2), without those for the program and block that it
/// belongs to.
impl Serialize for Diagnostic {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (start, end) = (self.place.start(), self.place.end());
        let mut object = serializer.serialize_struct("Diagnostic", 14)?;
        object.serialize_field("code", &self.code)?;
        object.serialize_field("severity", &self.severity)?;
        object.serialize_field("file", &self.place.file)?;
        object.serialize_field("line", &start.line)?;
        object.serialize_field("column", &start.column)?;
        object.serialize_field("end_line", &end.line)?;
        object.serialize_field("end_column", &end.column)?;
        object.serialize_field("axis", &self.axis)?;
        object.serialize_field("message", &self.message)?;
        object.serialize_field("help", &self.advice)?;
        if !self.ends.is_empty() {
            let ends = self.ends.iter().map(|place| {
                let line = place.start().line;
                let file = &*place.file;
                EndRecord { file, line }
            });
            object.serialize_field("ends", &ends.collect::<Vec<_>>())?;
        }
        if !self.fixes.is_empty() {
            object.serialize_field("fixes", &self.fixes)?;
        }
        if !self.reached_from.is_empty() {
            object.serialize_field("reached_from", self.reached_from.programs())?;
        }
        if let Some(count) = self.reached_from.count_beyond_names() {
            object.serialize_field("reached_from_count", &count)?;
        }
        object.end()
    }
}

crate::words! {
    /// Severity of a diagnostic.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    #[cfg_attr(not(feature = "unstable"), non_exhaustive)]
    pub enum Severity {
        /// Information only.
        Info = "info",
        /// Likely a mistake, or an effect that outlives the program.
        Warning = "warning",
        /// The control stops here, or rejects the list.
        Error = "error",
    }
}

/// Number of messages listed for one file; further ones are counted (R2.85).
pub const MAX_MESSAGES: usize = 10_000;

/// Messages that are collected before they are reported: a limited number is kept, the rest are counted by code.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Collected {
    /// The messages.
    pub said: Vec<Diagnostic>,
    /// Number of further messages by code.
    pub unsaid: BTreeMap<Code, u64>,
}

impl Collected {
    /// Takes a message. One more is kept than is reported, for the place from which the rest are only counted.
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

    /// Returns whether there are no messages.
    pub fn is_empty(&self) -> bool {
        self.said.is_empty()
    }
}

impl Extend<Diagnostic> for Collected {
    fn extend<T: IntoIterator<Item = Diagnostic>>(&mut self, messages: T) {
        messages.into_iter().for_each(|message| self.push(message));
    }
}

/// Number of programs kept by name; further ones are only counted.
const MAX_NAMED: usize = 20;

/// Number of programs that a sentence names.
const MAX_IN_SENTENCE: usize = 5;

/// The main programs that reach the place of a message in a called program, in the order in which
/// they ran (R17.1). Empty if the message is about the main program itself.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ReachedFrom {
    named: Vec<Arc<str>>,
    count: usize,
}

impl ReachedFrom {
    /// Returns the files of the first 20 programs.
    pub fn programs(&self) -> &[Arc<str>] {
        &self.named
    }

    /// Returns the number of programs, including those that are not kept by name.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns whether no other program reaches the place.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Returns the number of programs if [`programs`](Self::programs) does not contain all of them.
    pub fn count_beyond_names(&self) -> Option<usize> {
        (self.count > self.named.len()).then_some(self.count)
    }

    /// Adds a program, unless it is named already.
    pub fn add(&mut self, file: &Arc<str>) {
        if self.named.contains(file) {
            return;
        }
        self.count += 1;
        if self.named.len() < MAX_NAMED {
            self.named.push(Arc::clone(file));
        }
    }

    /// Adds the programs of another message about the same cause.
    pub(crate) fn append(&mut self, other: &Self) {
        other.named.iter().for_each(|file| self.add(file));
        self.count += other.count - other.named.len();
    }
}

/// `reached from a.nc`, `reached from 7 programs: a.nc, b.nc, c.nc, d.nc, e.nc, …`.
impl fmt::Display for ReachedFrom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("reached from ")?;
        if self.count != 1 {
            write!(f, "{} programs: ", self.count)?;
        }
        for (at, file) in self.named.iter().take(MAX_IN_SENTENCE).enumerate() {
            if at > 0 {
                f.write_str(", ")?;
            }
            f.write_str(file)?;
        }
        if self.count > MAX_IN_SENTENCE {
            f.write_str(", …")?;
        }
        Ok(())
    }
}

/// A number in a message; very large and very small ones have an exponent (R9.78).
pub struct ReadableNumber(pub f64);

impl fmt::Display for ReadableNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size != 0.0 && size.is_finite() && !(1e-9..1e12).contains(&size) {
            write!(f, "{:e}", self.0)
        } else {
            // Adding 0 turns -0 into 0.
            write!(f, "{}", self.0 + 0.0)
        }
    }
}

/// A number with a fixed number of decimals; a value that rounds to zero has no sign.
pub struct Rounded(pub f64, pub usize);

impl fmt::Display for Rounded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = format!("{:.*}", self.1, self.0);
        let is_zero = |digits: &&str| digits.bytes().all(|it| matches!(it, b'0' | b'.'));
        let unsigned = text.strip_prefix('-').filter(is_zero);
        f.pad(unsigned.unwrap_or(&text))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_programs_are_counted() {
        // R17.1
        let mut reached = ReachedFrom::default();
        let add = |reached: &mut ReachedFrom, numbers: std::ops::Range<usize>| {
            for number in numbers {
                reached.add(&Arc::from(format!("{number}.nc")));
            }
        };
        add(&mut reached, 0..1);
        assert_eq!(reached.to_string(), "reached from 0.nc");
        let mut more = ReachedFrom::default();
        add(&mut more, 0..30);
        reached.append(&more);
        assert_eq!(
            reached.to_string(),
            "reached from 30 programs: 0.nc, 1.nc, 2.nc, 3.nc, 4.nc, …"
        );
        assert_eq!((reached.programs().len(), reached.count()), (20, 30));
        assert_eq!(reached.count_beyond_names(), Some(30));
    }

    #[test]
    fn what_is_rounded_to_zero_has_no_sign() {
        assert_eq!(Rounded(-0.0004, 3).to_string(), "0.000");
        assert_eq!(Rounded(-0.000_500_1, 3).to_string(), "-0.001");
        assert_eq!(format!("{:>8}", Rounded(-0.4, 0)), "       0");
        assert_eq!(format!("{:>8}", Rounded(-1.25, 1)), "    -1.2");
        assert_eq!(ReadableNumber(-0.0).to_string(), "0");
    }

    #[test]
    fn numbers_in_messages_stay_short() {
        // R9.78
        let shown = |number| ReadableNumber(number).to_string();
        assert_eq!(shown(1e308), "1e308");
        assert_eq!(shown(-2.5), "-2.5");
        assert_eq!(shown(1e-300), "1e-300");
        assert_eq!(shown(0.0), "0");
        assert_eq!(shown(1e9), "1000000000");
        assert_eq!(shown(f64::NAN), "NaN");
    }
}
