//! The program that a block calls.

use std::collections::BTreeMap;

use super::index::LabelName;
use crate::interpreter::values::cause::{MissingProgram, Unknown};
use crate::interpreter::values::value::Value;
use crate::syntax::ast::{CallForm, CallScope};
use crate::text::Span;

/// A word that may call a program: G, M, T or D with its number, where that is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct FunctionWord {
    pub(crate) letter: u8,
    pub(crate) number: Option<i64>,
}

impl FunctionWord {
    /// A G function.
    pub(crate) fn g(number: u32) -> Self {
        Self {
            letter: b'G',
            number: Some(i64::from(number)),
        }
    }

    /// The D word with the number of a T word.
    pub(crate) fn of_data(self) -> Self {
        Self {
            letter: b'D',
            ..self
        }
    }
}

/// Program configured for a word.
pub(crate) enum Configured {
    /// Nothing.
    None,
    /// A program.
    Program(String),
    /// A program, or none; the name depends on a value that only the machine knows.
    Unknown(Unknown),
}

/// A call whose program has not been looked for yet.
#[derive(Debug, Clone)]
pub(crate) struct WantedCall {
    pub(crate) scope: CallScope,
    pub(crate) name: String,
    pub(crate) own: BTreeMap<u32, Value>,
    pub(crate) span: Span,
    /// Span of the name, if the block itself has it.
    pub(crate) named: Option<Span>,
    /// Whether it is a cycle.
    pub(crate) form: CallForm,
    /// Set for a modal cycle: whether it waits for motion.
    pub(crate) repeat: Option<bool>,
    /// The part of the program, where it is not all of it.
    pub(crate) part: Option<CalledPart>,
    /// The G function that is called, where no program is known for it (R2.94).
    pub(crate) word: Option<u32>,
}

impl WantedCall {
    /// A call of a program without parameters.
    pub(crate) fn program(scope: CallScope, name: String, span: Span) -> Self {
        Self {
            scope,
            name,
            own: BTreeMap::new(),
            span,
            named: None,
            form: CallForm::Plain,
            repeat: None,
            part: None,
            word: None,
        }
    }

    /// G80 and the like, which call a program of the machine that is not known (R2.94).
    pub(crate) fn of_word(number: u32, span: Span) -> Self {
        Self {
            word: Some(number),
            ..Self::program(CallScope::Global, format!("G{number}"), span)
        }
    }

    /// The called program, if it is missing.
    pub(crate) fn missing(&self) -> MissingProgram {
        let named = || MissingProgram::Named(self.name.as_str().into());
        self.word.map_or_else(named, MissingProgram::OfG)
    }
}

/// The part of a program that `L SEQUENCE` calls.
#[derive(Debug, Clone)]
pub(crate) struct CalledPart {
    pub(crate) first: LabelName,
    pub(crate) last: Option<LabelName>,
    /// Whether the call itself ends the part, too.
    pub(crate) end_tag: bool,
    pub(crate) passes: u64,
    /// Whether it belongs to the program being executed.
    pub(crate) here: bool,
}
