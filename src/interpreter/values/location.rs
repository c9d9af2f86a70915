//! Locations of values, of which expressions read some (R2.84), and causes for unknown ones: the words in messages, and
//! the advice on them (R2.50).

use std::collections::BTreeSet;
use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::diagnostic::{Advice, Budget};
use crate::interpreter::values::externals::SetAt;
use crate::interpreter::values::value::{Slot, Value, numeric, rounded};
use crate::language::{ControlError, is_command};
use crate::syntax::ast::Owner;
use crate::syntax::{Fault, Subscript, VariableName};
use crate::text::Span;

/// Cause of unknown values that only the machine knows (R2.50).
///
/// A saved state contains the causes without data as words, like states before schema 4.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Unknown {
    /// The switch of a skip level (R2.90).
    SkipLevel(u8),
    /// The signal of a probe (R2.91).
    #[serde(rename = "the signal of the probe")]
    Probe,
    /// A program that is missing (R2.83, R2.95).
    Program(MissingProgram),
    /// A variable that the program set and the PLC may have changed (R2.99).
    Changed(Arc<ChangedVariable>),
    /// The remedy class of `#ERROR` that is left out (R2.100).
    #[serde(rename = "#ERROR")]
    RemedyClass,
    /// The reaction of the control to a missing jump label.
    #[serde(rename = "a missing jump label")]
    MissingLabel,
    /// Effect of `$CONTINUE` in a `$SWITCH` outside a loop (R2.40).
    #[serde(rename = "`$CONTINUE` in a `$SWITCH`")]
    ContinueInSwitch,
    /// Refusal of a block by the control, with the number of its error where that is public (R2.114).
    Refused(Option<u32>),
    /// Acceptance by the control of variables that no `#VAR` declares (R2.102).
    #[serde(rename = "a missing declaration")]
    Undeclared,
    /// The last digits of a computed number (R2.112; PM/206929163).
    #[serde(rename = "the rounding of a computed number")]
    Rounding,
    /// The number of passes of a loop (R14.3).
    #[serde(rename = "a loop that is repeated")]
    Passes,
    /// The ways past the budget of ways, which are not followed (R14.4).
    #[serde(rename = "ways that are not followed")]
    Ways,
    /// Behaviour of the control past the budget of work (R2.60).
    #[serde(rename = "the budget of work")]
    Work,
    /// The effect of a block search on the commands that it passes (R2.96).
    #[serde(rename = "the block search")]
    Search,
    /// Skipping of an optional section while the control moves backward (R2.109).
    #[serde(rename = "an optional section")]
    OptionalSection,
    /// A modal cycle that may be in force, by the name of its program (R2.13).
    Cycle(Arc<str>),
    /// The code of a macro that several programs define (R10.11).
    Macro(Arc<str>),
    /// A parameter, a variable or other text of a program.
    #[serde(untagged)]
    Text(UnknownText),
}

/// A program that only the machine has.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum MissingProgram {
    /// The program of a name.
    Named(Arc<str>),
    /// The program that a G function calls, by its number (R2.94).
    OfG(u32),
}

/// A variable that the program set and the PLC may have changed, with the value and the block that set it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ChangedVariable {
    /// The name of the variable.
    pub name: Arc<str>,
    /// The value, as a program writes it.
    pub value: Arc<str>,
    /// The path of the file.
    pub file: Arc<str>,
    /// The line of the block, from 1.
    pub line: u32,
}

/// Text of a program whose value is not known.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(from = "Arc<str>", into = "Arc<str>")]
pub struct UnknownText {
    text: Arc<str>,
    meaning: TextMeaning,
}

/// Meaning of an unknown text. It is as wide as a word: reading a word that was written in parts stalls the processor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u64)]
enum TextMeaning {
    /// A parameter, a variable or an address.
    Value,
    /// A variable that outlives programs.
    Inherited,
    /// A `#` command.
    Command,
    NotUnderstood,
}

impl From<Arc<str>> for UnknownText {
    fn from(text: Arc<str>) -> Self {
        let meaning = match text.as_bytes() {
            [b'#', ..] if is_command(&text) => TextMeaning::Command,
            text if text.contains(&b' ') => TextMeaning::NotUnderstood,
            [b'V', b'.', b'S', b'.', ..] => TextMeaning::Inherited,
            [b'V' | b'v', b'.', ..]
            | [b'A'..=b'Z']
            | [b'P' | b'p', b'0'..=b'9', ..]
            | [b'@', b'P' | b'p', b'0'..=b'9', ..] => TextMeaning::Value,
            _ => TextMeaning::NotUnderstood,
        };
        Self { text, meaning }
    }
}

impl From<UnknownText> for Arc<str> {
    fn from(text: UnknownText) -> Self {
        text.text
    }
}

impl Unknown {
    /// Classifies text of a program: a parameter, a variable, an address, a command, or what is not understood.
    pub fn text(text: impl Into<Arc<str>>) -> Self {
        Self::Text(text.into().into())
    }

    /// Returns a variable after the PLC may have changed the value that the program set.
    pub(crate) fn changed(name: &str, value: String, at: &SetAt) -> Self {
        Self::Changed(Arc::new(ChangedVariable {
            name: name.into(),
            value: value.into(),
            file: at.file.clone(),
            line: at.line,
        }))
    }

    /// Returns its words in a message, with the reason why it is not known, as seen from a file.
    pub(crate) fn seen_from(&self, file: &str) -> String {
        match self {
            Self::SkipLevel(_) => format!("{self}, a switch of the machine"),
            Self::Probe => format!("{self}, which only the machine knows"),
            Self::Program(MissingProgram::Named(name)) => {
                format!("the program `{name}`, which is missing")
            }
            Self::Program(word) => format!("the program of `{word}`, which is missing"),
            Self::Changed(changed) => changed.seen_from(file),
            Self::RemedyClass => format!("what the control does at `{self}`"),
            Self::MissingLabel | Self::Undeclared | Self::ContinueInSwitch => {
                format!("what the control does at {self}")
            }
            Self::Refused(_) => format!("whether the control refuses a block by {self}"),
            Self::Rounding => format!("{self}, which the control may do otherwise"),
            Self::Passes => "how often a loop is repeated".to_owned(),
            Self::Search => "whether the block search executes what it passes".to_owned(),
            Self::OptionalSection => "whether the PLC moves the program backward".to_owned(),
            Self::Cycle(name) => format!("whether the modal cycle `{name}` is in force"),
            Self::Macro(name) => {
                format!("what programs before this one define `{name}` as")
            }
            Self::Ways | Self::Work => self.to_string(),
            Self::Text(UnknownText { text, meaning }) => {
                let why = match meaning {
                    TextMeaning::Value => "which only the machine knows",
                    TextMeaning::Inherited => "which a program before this one may have left",
                    TextMeaning::Command => "whose result only the machine knows",
                    TextMeaning::NotUnderstood => "which frictcomp does not know",
                };
                format!("`{text}`, {why}")
            }
        }
    }

    /// Returns the advice by which a user makes it known.
    pub(crate) fn advice(&self) -> Advice {
        match self {
            Self::SkipLevel(level) => Advice::SetSkip(*level),
            Self::Probe => "set the state afterwards, for example with `X[COMP ON FRICT]`".into(),
            Self::Program(MissingProgram::Named(name)) => format!("give frictcomp `{name}`, or say in `[machine.external_keeps]` that it keeps parameters").into(),
            Self::Program(word) => format!("FC325 says how to describe `{word}`").into(),
            Self::Changed(changed) => Advice::SetVariable(changed.name.to_string()),
            Self::RemedyClass => "`RC=0` lets the program go on, `RC=2` stops it".into(),
            Self::ContinueInSwitch => "write `$BREAK`; `\"R2.40\"` in `[reading]` of frictcomp.toml decides".into(),
            Self::MissingLabel => "write the label that the jump looks for".into(),
            Self::Refused(number) => number.and_then(ControlError::of).map_or("", |row| row.cure).into(),
            Self::Undeclared => "declare the variable between `#VAR` and `#ENDVAR`".into(),
            Self::Rounding => "compare with a tolerance, `ABS[P1 - 0.3] < 0.001`, or round with `ROUND`".into(),
            Self::Passes => "give the values that decide how often the loop is repeated".into(),
            Self::Ways => Advice::RaiseBudget(Budget::Ways),
            Self::Work => Advice::RaiseBudget(Budget::Work),
            Self::Search => "`\"R2.96\"` in `[reading]` of frictcomp.toml decides".into(),
            Self::OptionalSection => "switch compensation outside of the section".into(),
            Self::Cycle(name) => format!("FC901 or FC902 shows what decides whether `{name}` is in force").into(),
            Self::Macro(name) => format!("define `{name}` in the program that uses it").into(),
            Self::Text(UnknownText { text, meaning }) => match meaning {
                TextMeaning::Value | TextMeaning::Inherited => Advice::SetVariable(text.to_string()),
                TextMeaning::Command => format!("to check one case, assign the value in a block after `{text}`").into(),
                TextMeaning::NotUnderstood => format!("FC210, FC207 or FC902 shows where `{text}` first occurs").into(),
            },
        }
    }

    /// Returns whether a block shows it.
    pub(crate) fn is_shown_in(&self, text: &str) -> bool {
        match self {
            Self::Text(of) => text.contains(&*of.text),
            Self::Changed(changed) => text.contains(&*changed.name),
            Self::Cycle(name) | Self::Macro(name) => text.contains(&**name),
            Self::RemedyClass => text.contains("#ERROR"),
            Self::ContinueInSwitch => text.contains("$CONTINUE"),
            _ => false,
        }
    }

    /// Returns its words where it decides something: `` `V.E.A` ``, a missing jump label.
    pub(crate) fn quoted(&self) -> String {
        match self {
            Self::Text(_) | Self::RemedyClass | Self::Cycle(_) => format!("`{self}`"),
            _ => self.to_string(),
        }
    }
}

impl fmt::Display for Unknown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SkipLevel(level) => write!(f, "skip level {level}"),
            Self::Probe => f.write_str("the signal of the probe"),
            Self::Program(name) => write!(f, "program {name}"),
            Self::Changed(changed) => {
                let ChangedVariable {
                    name,
                    value,
                    file,
                    line,
                } = &**changed;
                write!(f, "{name}, which {file}:{line} set to {value}")
            }
            Self::RemedyClass => f.write_str("#ERROR"),
            Self::MissingLabel => f.write_str("a missing jump label"),
            Self::ContinueInSwitch => f.write_str("`$CONTINUE` in a `$SWITCH`"),
            Self::Refused(Some(number)) => write!(f, "error {number}"),
            Self::Refused(None) => f.write_str("an error"),
            Self::Undeclared => f.write_str("a missing declaration"),
            Self::Rounding => f.write_str("the rounding of a computed number"),
            Self::Passes => f.write_str("a loop that is repeated"),
            Self::Ways => f.write_str("ways that are not followed"),
            Self::Work => f.write_str("the budget of work"),
            Self::Search => f.write_str("the block search"),
            Self::OptionalSection => f.write_str("an optional section"),
            Self::Cycle(name) => f.write_str(name),
            Self::Macro(name) => write!(f, "macro {name}"),
            Self::Text(text) => f.write_str(&text.text),
        }
    }
}

impl fmt::Debug for Unknown {
    /// Writes its words as a text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.to_string())
    }
}

impl fmt::Display for MissingProgram {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Named(name) => f.write_str(name),
            Self::OfG(number) => write!(f, "G{number}"),
        }
    }
}

impl ChangedVariable {
    fn seen_from(&self, file: &str) -> String {
        let Self {
            name, value, line, ..
        } = self;
        let place = if *self.file == *file {
            format!("line {line}")
        } else {
            format!("{}:{line}", self.file)
        };
        format!("`{name}`, which {place} set to {value} and the PLC may have changed")
    }
}

/// A location of memory, or several of which one is meant.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub(crate) enum Location {
    Parameter(Owner, u32),
    /// A variable, or an element of an array.
    Variable(VariableName),
    /// Some element of an array.
    Elements(VariableName),
    /// Some P parameter.
    Parameters,
}

impl Location {
    /// Returns the parameter or variable of a name.
    pub(crate) fn named(name: VariableName) -> Self {
        match name.parameter_index() {
            Some(index) => Self::Parameter(Owner::Program, index),
            None => Self::Variable(name),
        }
    }

    /// Returns the name under which the user gives its value.
    pub(crate) fn name(&self) -> VariableName {
        match self {
            Self::Parameter(Owner::Program, index) => VariableName::parameter(*index),
            Self::Parameter(Owner::Call, index) => VariableName::own_parameter(*index),
            Self::Variable(name) | Self::Elements(name) => name.clone(),
            Self::Parameters => VariableName::read("P"),
        }
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parameter(Owner::Program, index) => write!(f, "P{index}"),
            Self::Parameter(Owner::Call, index) => write!(f, "@P{index}"),
            Self::Variable(name) | Self::Elements(name) => write!(f, "{name}"),
            Self::Parameters => f.write_str("P"),
        }
    }
}

/// The location that an expression denotes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Denoted {
    pub(crate) location: Location,
    /// The value that decides which of several locations it is.
    pub(crate) decided_by: Option<Unknown>,
}

impl Denoted {
    /// Returns one of several locations.
    pub(crate) fn any_of(location: Location, decided_by: Unknown) -> Self {
        Self {
            location,
            decided_by: Some(decided_by),
        }
    }

    /// Returns the name of the variable, where it is one that is known.
    pub(crate) fn variable(&self) -> Option<&VariableName> {
        match &self.location {
            Location::Variable(name) => Some(name),
            _ => None,
        }
    }

    /// Returns the location with the value that it has after an assignment.
    pub(crate) fn assigned(self, value: Value) -> (Location, Value) {
        let value = self.decided_by.map_or(value, Value::Unknown);
        (self.location, value)
    }

    /// Pops the number and the subscripts of a parameter (R2.72).
    pub(crate) fn pop_parameter(
        owner: Owner,
        subscripts: usize,
        span: Span,
        stack: &mut Vec<Slot>,
    ) -> Result<Self, Box<Fault>> {
        let from = stack.len().saturating_sub(subscripts + 1);
        let mut numbers = Vec::with_capacity(subscripts + 1);
        let mut unknown = None;
        for slot in stack.drain(from..) {
            let value = slot?;
            let number = numeric(&value, span)?.map(|it| rounded(it).unwrap_or(i64::MAX));
            numbers.push(number);
            if let Value::Unknown(cause) = value {
                unknown = unknown.or(Some(cause));
            }
        }
        let index = numbers.first().copied().flatten();
        let index = index.map(|index| u32::try_from(index).unwrap_or(u32::MAX));
        Ok(match (index, unknown) {
            (Some(index), Some(cause)) => {
                Self::any_of(Location::Elements(VariableName::parameter(index)), cause)
            }
            (None, cause) => {
                let cause = cause.unwrap_or_else(|| Unknown::text("P"));
                Self::any_of(Location::Parameters, cause)
            }
            (Some(index), None) if subscripts == 0 => Location::Parameter(owner, index).into(),
            (Some(index), None) => {
                let numbers = numbers[1..].iter().flatten();
                let subscripts = numbers.map(|number| Subscript::Number(*number)).collect();
                Location::Variable(VariableName::parameter(index).at(subscripts)).into()
            }
        })
    }
}

impl From<Location> for Denoted {
    fn from(location: Location) -> Self {
        Self {
            location,
            decided_by: None,
        }
    }
}

/// Number of different values kept as read; with more, everything counts as read.
const MAX_READS: usize = 256;

/// Values read since a loop was examined.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Reads {
    targets: BTreeSet<Location>,
    too_many: bool,
}

impl Reads {
    pub(crate) fn note(&mut self, target: Location) {
        if self.targets.len() < MAX_READS {
            self.targets.insert(target);
        } else {
            self.too_many = true;
        }
    }

    pub(crate) fn has(&self, target: &Location) -> bool {
        self.too_many || self.targets.contains(target)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_names_the_block_that_set_a_variable() {
        // R2.99
        let at = SetAt {
            file: "a (1).nc".into(),
            line: 3,
        };
        let changed = Unknown::changed("V.E.N[2]", "\"A, which b.nc:2 set to B\"".to_owned(), &at);
        assert_eq!(
            changed.seen_from("b.nc"),
            "`V.E.N[2]`, which a (1).nc:3 set to \"A, which b.nc:2 set to B\" and the PLC may have changed"
        );
        assert!(changed.seen_from("a (1).nc").contains("which line 3 set"));
    }

    #[test]
    fn only_a_name_can_be_given_a_value() {
        // R2.50
        let advice = |text: &str| Unknown::text(text).advice();
        for name in ["P5", "@P1", "V.E.A[P1,2]", "V.S.A", "M"] {
            assert_eq!(advice(name), Advice::SetVariable(name.to_owned()));
        }
        for other in ["P5 / 0", "V.E.A, which a.nc:3 set to 1", "#BLA"] {
            assert!(matches!(advice(other), Advice::Words(_)), "{other}");
        }
    }

    #[test]
    fn states_of_every_schema_are_read() {
        // R9.30
        for (saved, known) in [
            ("\"V.S.A\"", Unknown::text("V.S.A")),
            ("\"#ERROR\"", Unknown::RemedyClass),
            ("\"the signal of the probe\"", Unknown::Probe),
            ("{\"SkipLevel\":2}", Unknown::SkipLevel(2)),
            (
                "{\"Program\":{\"OfG\":80}}",
                Unknown::Program(MissingProgram::OfG(80)),
            ),
        ] {
            assert_eq!(serde_json::to_string(&known).expect("text"), saved);
            let read: Unknown = serde_json::from_str(saved).expect(saved);
            assert_eq!(read, known);
        }
    }
}
