//! Blocks that the control may refuse (R2.114): a warning, and the ways on which the error ends the program.

use super::reported::StopScope;
use crate::diagnostic::Code;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::values::cause::Unknown;
use crate::language::Flushes;
use crate::readings::{Alternative, Question};
use crate::syntax::Fault;
use crate::text::Span;

/// An error by which the control may refuse a block.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PossibleRefusal {
    /// Its number, where that is public.
    number: Option<u32>,
    /// The question whose readings decide.
    question: Option<Question>,
}

impl From<u32> for PossibleRefusal {
    fn from(number: u32) -> Self {
        Some(number).into()
    }
}

impl From<Option<u32>> for PossibleRefusal {
    fn from(number: Option<u32>) -> Self {
        Self {
            number,
            question: None,
        }
    }
}

impl PossibleRefusal {
    /// One about which readings decide.
    pub(crate) fn asked(number: impl Into<Option<u32>>, question: Question) -> Self {
        Self {
            number: number.into(),
            question: Some(question),
        }
    }
}

impl Executor {
    /// FC328: the control may refuse the block with an error; once a program for each text.
    #[cold]
    pub(crate) fn may_refuse(
        &mut self,
        refusal: impl Into<PossibleRefusal>,
        what: &str,
        span: Span,
        at: &BlockContext<'_>,
    ) {
        let refusal = refusal.into();
        let asked = (Unknown::Refused(refusal.number), StopScope::Block);
        self.may_refuse_with(refusal, what, asked, span, at);
    }

    /// FC328: something flushes the channel where the control may refuse that (R2.111).
    pub(crate) fn check_flush(
        &mut self,
        flushes: Flushes,
        name: &str,
        span: Span,
        at: &BlockContext<'_>,
    ) {
        let modal = &self.state.control.modal;
        let (number, under) = match flushes {
            Flushes::Radius | Flushes::Both if modal.transformed.contains("G41") => {
                (20651, "G41 or G42")
            }
            Flushes::Spline | Flushes::Both if modal.is_spline() => (120_434, "a spline"),
            _ => return,
        };
        let what = format!("`{name}` flushes the channel under {under}");
        // The control has one answer for each command, and for each variable, which is synchronous or not.
        let scope = StopScope::Alike(what.as_str().into());
        let asked = (Unknown::Refused(Some(number)), scope);
        let refusal = PossibleRefusal {
            question: name.starts_with("V.E.").then_some(Question::ReadFlushes),
            ..number.into()
        };
        self.may_refuse_with(refusal, &what, asked, span, at);
    }

    /// FC328 for a variable that no `#VAR` declares: the control has one answer for all of them (R2.102).
    #[cold]
    pub(crate) fn miss_declaration(&mut self, name: &str, span: Span, at: &BlockContext<'_>) {
        let what = format!("`{name}` is written without a declaration in `#VAR`");
        let asked = (Unknown::Undeclared, StopScope::Rest);
        let refusal = PossibleRefusal::asked(None, Question::Undeclared);
        self.may_refuse_with(refusal, &what, asked, span, at);
    }

    fn may_refuse_with(
        &mut self,
        PossibleRefusal { number, question }: PossibleRefusal,
        what: &str,
        asked: (Unknown, StopScope),
        span: Span,
        at: &BlockContext<'_>,
    ) {
        let span = at.in_block(span);
        if let Some(question) = question {
            self.state.rests_on.insert(question);
            match self.machine.readings.of(question) {
                Some(Alternative::First) => return,
                Some(Alternative::Second) => {
                    let message = format!("{what}; the selected reading refuses it");
                    let fault = Fault::new(Code::Fc306, span, message).with_cure(number);
                    return self.scratch.complain(fault, at);
                }
                None => {}
            }
        }
        if self.state.is_new_word(what) {
            let error = number.map_or_else(String::new, |number| format!(" ({number})"));
            let message = format!("{what}; the control may refuse it{error}");
            let fault = Fault::new(Code::Fc328, span, message).with_cure(number);
            self.say_before_parting(at.diagnostic(fault));
        }
        self.perhaps_stop(asked, span, at);
    }
}
