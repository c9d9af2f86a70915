//! Programs that words call, and the unknown state where the program is not known (R2.14, R2.75).

use crate::diagnostic::Code;
use crate::interpreter::programs::wanted::{Configured, FunctionWord};
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::outcome::BlockOutcome;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::value::Value;
use crate::syntax::Fault;
use crate::text::Span;

impl Executor {
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

    /// Whether any word calls a program.
    #[inline]
    pub(crate) fn calls_by_words(&self) -> bool {
        !self.machine.programs.words.is_empty() || !self.state.control.named.is_empty()
    }

    /// A word with an unknown number: it may call any program.
    pub(crate) fn unknown_word(&mut self, letter: &str, span: Span, at: &BlockContext<'_>) {
        let cause = Unknown::text(letter);
        self.havoc_by_call(&cause);
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
}
