//! The program that a block calls.

use std::collections::BTreeMap;

use super::index::LabelName;
use crate::interpreter::values::cause::MissingProgram;
use crate::interpreter::values::value::Value;
use crate::syntax::ast::{CallForm, CallScope};
use crate::text::Span;

/// A word that may call a program: G, M, T or D with its number, where that is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(in crate::interpreter) struct FunctionWord {
    pub(in crate::interpreter) letter: u8,
    pub(in crate::interpreter) number: Option<i64>,
}

impl FunctionWord {
    /// A G function.
    pub(in crate::interpreter) fn g(number: u32) -> Self {
        Self {
            letter: b'G',
            number: Some(i64::from(number)),
        }
    }

    /// The D word with the number of a T word.
    pub(in crate::interpreter) fn of_data(self) -> Self {
        Self {
            letter: b'D',
            ..self
        }
    }
}

/// A call whose program has not been looked for yet.
#[derive(Debug, Clone)]
pub(in crate::interpreter) struct WantedCall {
    pub(in crate::interpreter) scope: CallScope,
    pub(in crate::interpreter) name: String,
    pub(in crate::interpreter) own: BTreeMap<u32, Value>,
    pub(in crate::interpreter) span: Span,
    /// Span of the name, if the block itself has it.
    pub(in crate::interpreter) named: Option<Span>,
    /// Whether it is a cycle.
    pub(in crate::interpreter) form: CallForm,
    /// Set for a modal cycle: whether it waits for motion.
    pub(in crate::interpreter) repeat: Option<bool>,
    /// The part of the program, where it is not all of it.
    pub(in crate::interpreter) part: Option<CalledPart>,
    /// The G function that is called, where no program is known for it (R2.94).
    pub(in crate::interpreter) word: Option<u32>,
}

impl WantedCall {
    /// A call of a program without parameters.
    pub(in crate::interpreter) fn program(scope: CallScope, name: String, span: Span) -> Self {
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
    pub(in crate::interpreter) fn of_word(number: u32, span: Span) -> Self {
        Self {
            word: Some(number),
            ..Self::program(CallScope::Global, format!("G{number}"), span)
        }
    }

    /// The called program, if it is missing.
    pub(in crate::interpreter) fn missing(&self) -> MissingProgram {
        let named = || MissingProgram::Named(self.name.as_str().into());
        self.word.map_or_else(named, MissingProgram::OfG)
    }
}

/// The part of a program that `L SEQUENCE` calls.
#[derive(Debug, Clone)]
pub(in crate::interpreter) struct CalledPart {
    pub(in crate::interpreter) first: LabelName,
    pub(in crate::interpreter) last: Option<LabelName>,
    /// Whether the call itself ends the part, too.
    pub(in crate::interpreter) end_tag: bool,
    pub(in crate::interpreter) passes: u64,
    /// Whether it belongs to the program being executed.
    pub(in crate::interpreter) here: bool,
}
