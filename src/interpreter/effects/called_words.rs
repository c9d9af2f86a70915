//! Programs that words call, and the unknown state where the program is not known (R2.14, R2.75).

use crate::diagnostic::Code;
use crate::interpreter::coordinates::modal::is_named_m;
use crate::interpreter::programs::wanted::{FunctionWord, WantedCall};
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::journal::RegionCall;
use crate::interpreter::run::outcome::BlockOutcome;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::value::Value;
use crate::language::{CoordinateEffect, GFunction};
use crate::syntax::Fault;
use crate::syntax::ast::CallScope;
use crate::text::Span;

/// Program configured for a word.
pub(crate) enum Configured {
    /// Nothing.
    None,
    /// A program.
    Program(String),
    /// A program, or none; the name depends on a value that only the machine knows.
    Unknown(Unknown),
}

impl Interpreter {
    /// The program for a word, `G80`, `M6`, else for its letter.
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

    /// The programs that words with a letter call.
    pub(crate) fn programs_of_words(&self, letter: u8) -> Vec<String> {
        let letter = char::from(letter);
        let configured = self.machine.programs.words.iter();
        let configured = configured.map(|(word, name)| (word, name.clone()));
        let named = self.state.control.named.iter();
        let named = named.filter_map(|(word, name)| match name {
            Value::Text(name) => Some((word, name.to_string())),
            Value::Number(_) | Value::Unknown(_) => None,
        });
        let all = configured.chain(named);
        let all = all.filter(|(word, name)| word.starts_with(letter) && !name.is_empty());
        all.map(|(_, name)| name).collect()
    }

    /// Whether any word calls a program.
    #[inline]
    pub(crate) fn calls_by_words(&self) -> bool {
        !self.machine.programs.words.is_empty() || !self.state.control.named.is_empty()
    }

    /// A word with an unknown number: it may call any program.
    pub(crate) fn unknown_word(&mut self, letter: &str, span: Span, at: &BlockContext<'_>) {
        let cause = Unknown::text(letter);
        self.havoc_by_call(&cause);
        if let Some(unit) = self.state.control.frames.running().map(|frame| frame.unit) {
            self.look_through_words(letter.as_bytes()[0], span, unit, &cause);
        }
        self.state.control.modal.note_transformed(letter);
        if self.scratch.unread.get() {
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

    /// FC210: calls in the block of a jump, a program end or a return. Whether the control makes them is not
    /// documented, so that everything that a program could change is unknown (R2.52).
    pub(crate) fn pass_over_calls(&mut self, outcome: &mut BlockOutcome, at: &BlockContext<'_>) {
        let calls = std::mem::take(&mut outcome.calls);
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
        self.scratch.diagnostics.push(at.diagnostic(fault));
    }

    /// FC902: `what` depends on a value that only the machine knows.
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

    /// A harmless implicit call without a program, or an unknown function (R2.82, R2.94): it may have moved axes.
    pub(crate) fn pass_over_implicit(&mut self, number: u32) {
        self.state.control.modal.havoc_positions();
        self.perhaps_move_all();
        self.state
            .control
            .modal
            .note_transformed(&format!("G{number}"));
    }

    /// A call that may be of any local subprogram: looks for what the control refuses there.
    pub(crate) fn look_through_locals(&mut self, span: Span, unit: usize, cause: &Unknown) {
        let calling = self.programs.unit_mut(unit);
        if calling.open_calls.insert(b'L') {
            let names = calling.index.local_names().map(str::to_owned).collect();
            self.look_through(names, CallScope::Local, span, unit, cause);
        }
    }

    /// A word with an unknown number, which may call any program that one of its letter calls.
    fn look_through_words(&mut self, letter: u8, span: Span, unit: usize, cause: &Unknown) {
        if self.programs.unit_mut(unit).open_calls.insert(letter) {
            let names = self.programs_of_words(letter);
            self.look_through(names, CallScope::Global, span, unit, cause);
        }
    }

    fn look_through(
        &mut self,
        names: Vec<String>,
        scope: CallScope,
        span: Span,
        unit: usize,
        cause: &Unknown,
    ) {
        let calls = names.into_iter().map(|name| RegionCall {
            call: WantedCall::program(scope, name, span),
            cause: cause.clone(),
            unit,
            region: None,
        });
        self.pending.extend(calls);
    }

    /// A word in a region that may or may not be executed.
    pub(crate) fn havoc_function(&mut self, word: FunctionWord, unit: usize, cause: &Unknown) {
        let mut configured = vec![self.configured(word)];
        let has_program = !matches!(configured[0], Configured::None);
        let gives_data = word.letter == b'T' && self.machine.programs.data_with_tool;
        if gives_data {
            configured.push(self.configured(word.of_data()));
        }
        if word.letter == b'D' || gives_data {
            self.state.control.modal.select_tool_data(None);
        }
        for configured in configured {
            match configured {
                Configured::None => {}
                Configured::Unknown(_) => self.havoc_all(cause),
                Configured::Program(name) => self.pending.push(RegionCall {
                    call: WantedCall::program(CallScope::Global, name, Span::default()),
                    cause: cause.clone(),
                    unit,
                    region: None,
                }),
            }
        }
        let letter = char::from(word.letter);
        match (letter, word.number) {
            (_, Some(number)) => {
                let number = u32::try_from(number).unwrap_or(u32::MAX);
                let function = GFunction::known(number).filter(|_| letter == 'G');
                let known = match letter {
                    'M' => is_named_m(i64::from(number)),
                    'G' => function.is_some_and(|it| it.coordinates == CoordinateEffect::None),
                    _ => true,
                };
                let harmless = &self.machine.harmless;
                let is_harmless = harmless.has_function(word.letter, i64::from(number));
                if function.is_some_and(GFunction::is_call) {
                    if is_harmless {
                        self.pass_over_implicit(number);
                    } else if !has_program {
                        self.pending.push(RegionCall {
                            call: WantedCall::of_word(number, Span::default()),
                            cause: cause.clone(),
                            unit,
                            region: None,
                        });
                    }
                    return;
                }
                if is_harmless {
                    return;
                }
                if letter == 'G' && function.is_none() {
                    self.pass_over_implicit(number);
                } else if !known {
                    let word = format!("{letter}{number}");
                    self.state.control.modal.note_transformed(&word);
                }
            }
            ('M', None) => {
                self.havoc_all(cause);
                self.look_through_words(b'M', Span::default(), unit, cause);
            }
            ('G', None) => {
                self.havoc_all(cause);
                self.look_through_words(b'G', Span::default(), unit, cause);
            }
            (_, None) => {}
        }
    }
}
