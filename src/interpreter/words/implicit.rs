//! Words that call a program: G80 to G89, G800 and on, M, T and D words, and the unknown state where the program is not known
//! (R2.14, R2.75).

use std::collections::BTreeMap;

use crate::diagnostic::Code;
use crate::interpreter::block::BlockContext;
use crate::interpreter::control::ControlState;
use crate::interpreter::executor::Executor;
use crate::interpreter::motion::modal::is_named_m;
use crate::interpreter::programs::calls::{
    Configured, FileName, FunctionWord, WantedCall, file_names,
};
use crate::interpreter::values::location::Unknown;
use crate::interpreter::values::value::Value;
use crate::interpreter::words::refusal::PossibleRefusal;
use crate::language::{CoordinateEffect, GFunction};
use crate::readings::Question;
use crate::syntax::ast::{CallScope, GCall, Hash};
use crate::syntax::{Fault, VariableName};
use crate::text::Span;

impl Executor {
    /// Executes an M, T or D word. A number that is not known offline may be any number.
    pub(crate) fn function_word(&mut self, word: FunctionWord, span: Span, at: &BlockContext<'_>) {
        let FunctionWord { letter, number } = word;
        if letter == b'M' {
            match number {
                Some(number) if !is_named_m(number) => {
                    let called = self.call_word(word, span, at);
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
        self.call_word(word, span, at);
        if letter == b'T' && self.machine.programs.data_with_tool {
            // P-CHAN-00014: T selects the tool data, too.
            let calls = self.scratch.actions.implicit.take();
            self.call_word(word.of_data(), span, at);
            self.scratch.actions.implicit = calls;
        }
    }

    /// Calls the program of a word. Returns whether it has one.
    fn call_word(&mut self, word: FunctionWord, span: Span, at: &BlockContext<'_>) -> bool {
        match self.configured(word) {
            Configured::None => return false,
            Configured::Program(name) => {
                self.scratch.read.plc_acts |= word.letter == b'M';
                self.check_implicit(word.letter, span, at);
                let wanted = WantedCall::program(CallScope::Global, name, at.in_block(span));
                self.scratch.actions.calls.push(wanted);
            }
            Configured::Unknown(cause) => {
                self.unknown_call("which program is called", &cause, span, at);
            }
        }
        true
    }

    /// Reports FC328: a second implicit call in the block (R2.104).
    fn check_implicit(&mut self, letter: u8, span: Span, at: &BlockContext<'_>) {
        if self.scratch.actions.implicit.replace(letter).is_some() {
            let what = "two words of this block call programs";
            let refusal = PossibleRefusal::asked(22008, Question::TwoCalls);
            self.may_refuse(refusal, what, span, at);
        }
    }

    /// Executes a G function outside the groups, and returns whether it calls a program.
    pub(crate) fn g_program(&mut self, number: u32, span: Span, at: &BlockContext<'_>) -> bool {
        if self.calls_by_words() && self.call_word(FunctionWord::g(number), span, at) {
            return true;
        }
        let function = GFunction::known(number);
        if function.is_some_and(GFunction::is_call) {
            let done = self.call_without_program(number, span, at);
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

    pub(crate) fn g_call(&mut self, call: &GCall, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        let mut own = BTreeMap::new();
        for (place, operand) in (1..).zip(&call.arguments) {
            if let Some(operand) = operand {
                own.insert(place, self.value(*operand, at)?);
            }
        }
        match self.configured(FunctionWord::g(call.number)) {
            Configured::Program(name) => {
                self.check_implicit(b'G', call.span, at);
                let wanted = WantedCall::program(CallScope::Global, name, at.in_block(call.span));
                self.scratch
                    .actions
                    .calls
                    .push(WantedCall { own, ..wanted });
            }
            Configured::Unknown(cause) => {
                self.unknown_call("which program is called", &cause, call.span, at);
            }
            Configured::None => {
                return self.call_without_program(call.number, call.span, at);
            }
        }
        Ok(())
    }

    /// Calls a program of the machine for a word whose program is not known: it may change anything, unless the
    /// configuration says that it changes nothing but positions (R2.94). Where the channel list is read it calls none
    /// (R2.104).
    fn call_without_program(
        &mut self,
        number: u32,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        let is_harmless = self.machine.harmless.has_function(b'G', i64::from(number));
        if is_harmless {
            self.pass_over_implicit(number);
            self.pass_over(&format!("G{number}"), span, at);
        } else if !self.machine.channel.is_whole {
            let wanted = WantedCall::of_word(number, at.in_block(span));
            self.scratch.actions.calls.push(wanted);
        } else {
            let what = format!(
                "the channel list names no program for `G{number}`, which the control refuses"
            );
            return Err(Fault::refused(Code::PErr20131, span, what));
        }
        Ok(())
    }

    /// Reports FC210: a G function that is in no public list; once per word and program (R2.94).
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
        self.scratch.messages.diagnostics.push(at.diagnostic(fault));
    }

    /// Names programs for words: `#FILE NAME [ G80="part.nc" M6 "change.nc" ]` (PM/207504523).
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
    /// Returns the text of a variable, or the cause why it is unknown.
    fn named_elsewhere(&mut self, name: &str) -> Value {
        match self.memory.variable(&VariableName::read(name)) {
            Some(value @ Value::Text(_)) => value,
            _ => Value::Unknown(Unknown::text(name)),
        }
    }
}

impl Executor {
    /// Returns the program for a word, `G80`, `M6`, else for its letter.
    pub(crate) fn configured(&self, word: FunctionWord) -> Configured {
        let letter = char::from(word.letter);
        let word = word.number.map(|number| format!("{letter}{number}"));
        let words = word.into_iter().chain([letter.to_string()]);
        for word in words {
            match self.state.control.named.get(&word) {
                Some(Value::Text(name)) if name.is_empty() => return Configured::None,
                Some(Value::Text(name)) => return Configured::Program(name.to_string()),
                Some(Value::Unknown(cause)) => return Configured::Unknown(cause.clone()),
                Some(Value::Number(_)) | None => {}
            }
            if let Some(name) = self.machine.programs.word(&word) {
                return Configured::Program(name.to_owned());
            }
        }
        Configured::None
    }

    /// Returns whether any word calls a program.
    #[inline]
    pub(crate) fn calls_by_words(&self) -> bool {
        !self.machine.programs.words.is_empty() || !self.state.control.named.is_empty()
    }

    /// Executes a word with an unknown number: it may call any program.
    pub(crate) fn unknown_word(&mut self, letter: &str, span: Span, at: &BlockContext<'_>) {
        let cause = Unknown::text(letter);
        self.havoc_by_call(&cause);
        self.state.control.modal.note_transformed(letter);
        if self.scratch.read.unread.get() {
            return;
        }
        let fault = Fault::new(
            Code::Fc902,
            at.in_block(span),
            format!(
                "only the machine knows which {letter} function this is; it is passed over, \
                 everything that a program could change becomes unknown"
            ),
        );
        self.tell_once(&cause, "function", fault, at);
    }

    /// Passes over a call of which `what` depends on a value that only the machine knows.
    pub(crate) fn unknown_call(
        &mut self,
        what: &str,
        cause: &Unknown,
        span: Span,
        at: &BlockContext<'_>,
    ) {
        self.havoc_by_call(cause);
        self.tell_unknown(what, "the call is passed over", cause, span, at);
    }

    /// Reports FC210: calls in the block of a jump, a program end or a return. Whether the control makes them is not
    /// documented, so that everything that a program could change is unknown (R2.52).
    pub(crate) fn pass_over_calls(&mut self, at: &BlockContext<'_>) {
        let calls = std::mem::take(&mut self.scratch.actions.calls);
        let Some(call) = calls.first() else {
            return;
        };
        let shown = call.span.of(at.text).trim();
        self.havoc_all(&Unknown::text(shown));
        let message = format!(
            "`{shown}` is in the same block as a jump or an end; whether the control calls a program there is not \
             known, and everything that a program could change is unknown from here on"
        );
        let fault = Fault::new(Code::Fc210, call.span, message)
            .with_help("write the call in a separate block before it");
        self.scratch.messages.diagnostics.push(at.diagnostic(fault));
    }

    /// Reports FC902: `what` depends on a value that only the machine knows.
    pub(crate) fn tell_unknown(
        &mut self,
        what: &str,
        then: &str,
        cause: &Unknown,
        span: Span,
        at: &BlockContext<'_>,
    ) {
        let value = cause.seen_from(at.file);
        let message = format!(
            "{what} depends on {value}; {then}, and everything that a program could change becomes unknown"
        );
        let fault = Fault::new(Code::Fc902, at.in_block(span), message);
        self.tell_once(cause, "call", fault.with_help(cause.advice()), at);
    }

    /// Passes over a harmless implicit call without a program, or an unknown function (R2.82, R2.94): it may have moved
    /// axes.
    fn pass_over_implicit(&mut self, number: u32) {
        self.state.control.modal.havoc_positions();
        self.perhaps_move_all();
        self.state
            .control
            .modal
            .note_transformed(&format!("G{number}"));
    }
}
