//! Words that call a program: G80 to G89, G800 and on, M, T and D words (R2.14, R2.75).

use std::collections::BTreeMap;

use super::refused::PossibleRefusal;
use crate::diagnostic::Code;
use crate::interpreter::coordinates::modal::is_named_m;
use crate::interpreter::programs::file_names::{FileName, file_names};
use crate::interpreter::programs::wanted::{Configured, FunctionWord, WantedCall};
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::outcome::BlockOutcome;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::value::Value;
use crate::language::{CoordinateEffect, GFunction};
use crate::readings::Question;
use crate::syntax::ast::{CallScope, GCall, Hash};
use crate::syntax::{Fault, VariableName};
use crate::text::Span;

impl Executor {
    /// An M, T or D word. A number that is not known offline may be any number.
    pub(crate) fn function_word(
        &mut self,
        word: FunctionWord,
        span: Span,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) {
        let FunctionWord { letter, number } = word;
        if letter == b'M' {
            match number {
                Some(number) if !is_named_m(number) => {
                    let called = self.call_word(word, span, at, outcome);
                    if !called && !self.machine.harmless.has_function(letter, number) {
                        self.state
                            .control
                            .modal
                            .note_transformed(&format!("M{number}"));
                    }
                    return;
                }
                Some(_) | None => {}
            }
        }
        if !self.calls_by_words() {
            return;
        }
        self.call_word(word, span, at, outcome);
        if letter == b'T' && self.machine.programs.data_with_tool {
            // P-CHAN-00014: T selects the tool data, too.
            let calls = outcome.implicit.take();
            self.call_word(word.of_data(), span, at, outcome);
            outcome.implicit = calls;
        }
    }

    /// Calls the program of a word. Returns whether it has one.
    fn call_word(
        &mut self,
        word: FunctionWord,
        span: Span,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) -> bool {
        match self.configured(word) {
            Configured::None => return false,
            Configured::Program(name) => {
                self.scratch.plc_acts |= word.letter == b'M';
                self.check_implicit(word.letter, span, at, outcome);
                let wanted = WantedCall::program(CallScope::Global, name, at.in_block(span));
                outcome.calls.push(wanted);
            }
            Configured::Unknown(cause) => {
                self.unknown_call("which program is called", &cause, span, at);
            }
        }
        true
    }

    /// FC328: a second implicit call in the block (R2.104).
    fn check_implicit(
        &mut self,
        letter: u8,
        span: Span,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) {
        if outcome.implicit.replace(letter).is_some() {
            let what = "two words of this block call programs";
            let refusal = PossibleRefusal::asked(22008, Question::TwoCalls);
            self.may_refuse(refusal, what, span, at);
        }
    }

    /// A G function outside the groups: whether it calls a program.
    pub(crate) fn g_program(
        &mut self,
        number: u32,
        span: Span,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) -> bool {
        if self.calls_by_words() && self.call_word(FunctionWord::g(number), span, at, outcome) {
            return true;
        }
        let function = GFunction::known(number);
        if function.is_some_and(GFunction::is_call) {
            let done = self.call_without_program(number, span, at, outcome);
            if let Err(fault) = done {
                self.scratch.complain(*fault, at);
            }
            return true;
        }
        if self.machine.harmless.has_function(b'G', i64::from(number)) {
            return false;
        }
        let Some(function) = function else {
            self.warn_unknown_g(number, span, at);
            self.pass_over_implicit(number);
            return false;
        };
        if function.coordinates == CoordinateEffect::Unfollowed {
            self.state
                .control
                .modal
                .note_transformed(&format!("G{number}"));
        }
        false
    }

    pub(crate) fn g_call(
        &mut self,
        call: &GCall,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) -> Result<(), Box<Fault>> {
        let mut own = BTreeMap::new();
        for (place, operand) in (1..).zip(&call.arguments) {
            if let Some(operand) = operand {
                own.insert(place, self.value(*operand, at)?);
            }
        }
        match self.configured(FunctionWord::g(call.number)) {
            Configured::Program(name) => {
                self.check_implicit(b'G', call.span, at, outcome);
                let wanted = WantedCall::program(CallScope::Global, name, at.in_block(call.span));
                outcome.calls.push(WantedCall { own, ..wanted });
            }
            Configured::Unknown(cause) => {
                self.unknown_call("which program is called", &cause, call.span, at);
            }
            Configured::None => {
                return self.call_without_program(call.number, call.span, at, outcome);
            }
        }
        Ok(())
    }

    /// A word whose program is not known calls one of the machine, which may change anything, unless the
    /// configuration says that it changes nothing but positions (R2.94). Where the channel list is read it calls none
    /// (R2.104).
    fn call_without_program(
        &mut self,
        number: u32,
        span: Span,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) -> Result<(), Box<Fault>> {
        let is_harmless = self.machine.harmless.has_function(b'G', i64::from(number));
        if is_harmless {
            self.pass_over_implicit(number);
            self.pass_over(&format!("G{number}"), span, at);
        } else if !self.machine.channel.is_whole {
            let wanted = WantedCall::of_word(number, at.in_block(span));
            outcome.calls.push(wanted);
        } else {
            let what = format!(
                "the channel list names no program for `G{number}`, which the control refuses"
            );
            return Err(Fault::refused(Code::PErr20131, span, what));
        }
        Ok(())
    }

    /// FC210: a G function that is in no public list; once per word and program (R2.94).
    fn warn_unknown_g(&mut self, number: u32, span: Span, at: &BlockContext<'_>) {
        let word = format!("G{number}");
        if !self.state.is_new_word(&word) {
            return;
        }
        let message = format!(
            "`{word}` is not known to frictcomp; every compensation keeps its state, and axis positions are unknown \
             from here on"
        );
        let help = format!(
            "if it moves no axis and no origin, set `harmless = [\"{word}\"]` in `[machine]` of frictcomp.toml"
        );
        let fault = Fault::new(Code::Fc210, at.in_block(span), message).with_help(help);
        self.scratch.diagnostics.push(at.diagnostic(fault));
    }

    /// `#FILE NAME [ G80="part.nc" M6 "change.nc" ]` (PM/207504523).
    pub(crate) fn name_programs(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let messages = hash.brackets.after("MSG", at.text);
        if let Some(file) = messages.and_then(|file| file.quoted(at.text)) {
            self.state.control.files.write_messages_to(file);
        }
        for (word, name) in file_names(hash, at.text) {
            let value = match name {
                FileName::Written(name) => Value::Text(name.into()),
                FileName::Elsewhere(name) => self.state.control.named_elsewhere(name),
            };
            self.state.control.named.insert(word, value);
            self.scratch.wrote = true;
        }
    }
}

impl ControlState {
    /// The text of a variable, or the cause why it is unknown.
    fn named_elsewhere(&mut self, name: &str) -> Value {
        match self.memory.variable(&VariableName::read(name)) {
            Some(value @ Value::Text(_)) => value,
            _ => Value::Unknown(Unknown::text(name)),
        }
    }
}
