//! `#ERROR`: an error that the program reports itself, and whether that ends it (R2.100; PM/207457163).

use std::sync::Arc;

use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::effects::plc::Doubt;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::block_scratch::AfterError;
use crate::interpreter::run::event::EndedBy;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::options::StopPolicy;
use crate::interpreter::run::outcome::BlockOutcome;
use crate::interpreter::run::step::ControlStep;
use crate::interpreter::unknown::branching::MachineQuestion;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::functions::numeric;
use crate::interpreter::values::plain::{Asking, ConditionSubject, Writer, reads, text_of};
use crate::interpreter::ways::possible_state::ways_of;
use crate::interpreter::ways::question::ConditionKind;
use crate::interpreter::ways::set::WaySet;
use crate::interpreter::ways::words::limit_to;
use crate::readings::{Alternative, Question};
use crate::syntax::Fault;
use crate::syntax::ast::{Expression, Hash, Operand};
use crate::text::Span;

/// The remedy class of a system error, after which the control is restarted, or reset (tf5200, 15557035659).
const SYSTEM_ERROR: f64 = 7.0;

/// What is known of the remedy class.
enum RemedyClass {
    Known(f64),
    /// It is left out, and no default is documented.
    LeftOut,
    /// Only the machine knows the value that decides.
    Unknown(Expression, Doubt),
}

/// The blocks to which it applies whether an error ends the program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum StopScope {
    /// This block; each other one asks anew.
    Block,
    /// This block and all later ones.
    Rest,
    /// This block and all later ones that are refused for the same reason, in the words of FC328.
    Alike(Arc<str>),
}

impl Executor {
    /// The program reports an error of its own. With the class 0 it goes on.
    pub(crate) fn report_error(
        &mut self,
        hash: &Hash,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) -> Result<(), Box<Fault>> {
        match self.remedy_class(hash, at)? {
            RemedyClass::Known(0.0) => self.pass_over("#ERROR", hash.span, at),
            RemedyClass::Known(class) => {
                let class_text = match hash.arguments.first() {
                    Some(_) => format!("`RC={class}`"),
                    None => "no `RC`".to_owned(),
                };
                let said = error_with(&class_text, hash.span, at);
                self.scratch.diagnostics.push(said);
                let after = if class == SYSTEM_ERROR {
                    AfterError::ResetOrRestart
                } else {
                    AfterError::Reset
                };
                self.end_with(after, at, outcome);
            }
            RemedyClass::LeftOut => {
                let message =
                    "whether the program ends here is not documented: `#ERROR` has no `RC`";
                if self.state.is_new_word(message) {
                    let fault = Fault::new(Code::Fc902, hash.span, message).with_help(
                        "`RC=0` lets the program go on, `RC=2` stops it; without it, \
                         `\"R2.100\"` in `[reading]` of frictcomp.toml decides",
                    );
                    self.say_before_parting(at.diagnostic(fault));
                }
                let question = MachineQuestion {
                    kind: ConditionKind::Stop,
                    span: hash.span,
                    texts: vec!["`#ERROR`".into()],
                    cause: Unknown::RemedyClass,
                    // The control has one answer for all of them.
                    reads: Some(Asking::of_unknown(Writer::Nothing, Unknown::RemedyClass)),
                    kept: None,
                };
                let ways = self.part_at_end(question, at);
                if self.perhaps_end(ways, AfterError::Reset, at) {
                    self.end_with(AfterError::Reset, at, outcome);
                }
            }
            RemedyClass::Unknown(expression, doubt) => {
                let (text, span) = text_of(at.block, at.text, expression);
                let reads = reads(at.block, at.text, expression, &self.externals);
                let question = MachineQuestion {
                    kind: ConditionKind::Branch,
                    span,
                    texts: vec![format!("{text} != 0").into()],
                    cause: doubt.cause(),
                    reads: reads.map(|asking| asking.about(ConditionSubject::RemedyClass)),
                    kept: doubt.kept_answer(|value| usize::from(value.number() == Some(0.0))),
                };
                let said = error_with("an `RC` that is not 0", hash.span, at);
                if self.refused_where(question, said, AfterError::ResetOrRestart, at) {
                    self.end_with(AfterError::ResetOrRestart, at, outcome);
                }
            }
        }
        Ok(())
    }

    /// An error ends the program where the first answer to a question is given. Returns whether it ends on all ways.
    pub(crate) fn refused_where(
        &mut self,
        question: MachineQuestion,
        mut said: Diagnostic,
        after: AfterError,
        at: &BlockContext<'_>,
    ) -> bool {
        let ways = self.part_at_end(question, at);
        let [ends, _] = &ways;
        if !ends.is_never() {
            limit_to(&mut said, &ways_of(ends, &self.state.conditions));
            self.scratch.of_some_ways.push(said);
        }
        self.perhaps_end(ways, after, at)
    }

    /// Reports a message about all ways that lead to a block after which they part.
    pub(crate) fn say_before_parting(&mut self, mut said: Diagnostic) {
        let reach = &self.state.track.reach;
        if !reach.is_always() {
            limit_to(&mut said, &ways_of(reach, &self.state.conditions));
        }
        self.scratch.of_some_ways.push(said);
    }

    fn remedy_class(
        &mut self,
        hash: &Hash,
        at: &BlockContext<'_>,
    ) -> Result<RemedyClass, Box<Fault>> {
        let Some(&class) = hash.arguments.first() else {
            self.state.rests_on.insert(Question::RemedyClass);
            return Ok(match self.machine.readings.of(Question::RemedyClass) {
                Some(Alternative::First) => RemedyClass::Known(0.0),
                Some(Alternative::Second) => RemedyClass::Known(2.0),
                None => RemedyClass::LeftOut,
            });
        };
        let (value, doubt) = self.asked_value(class, at)?;
        Ok(match (doubt, class) {
            (Some(doubt), Operand::Expression(expression)) => {
                RemedyClass::Unknown(expression, doubt)
            }
            _ => RemedyClass::Known(numeric(&value, hash.span)?.unwrap_or_default()),
        })
    }

    /// An error ends the program at the block, or it goes on, which only the machine knows: both ways are followed.
    pub(crate) fn perhaps_stop(
        &mut self,
        (error, scope): (Unknown, StopScope),
        span: Span,
        at: &BlockContext<'_>,
    ) {
        if self.scratch.unread.get() {
            return;
        }
        let asking = || Asking::of_unknown(Writer::Nothing, error.clone());
        let reads = match scope {
            StopScope::Block => None,
            StopScope::Rest => Some(asking()),
            StopScope::Alike(reason) => Some(asking().about(ConditionSubject::Refusal(reason))),
        };
        let question = MachineQuestion {
            kind: ConditionKind::Stop,
            span,
            texts: vec![error.to_string().into()],
            reads,
            cause: error,
            kept: None,
        };
        let ways = self.part_at_end(question, at);
        self.perhaps_end(ways, AfterError::Reset, at);
    }

    /// The program ends here on some ways that lead to the block, and goes on on the others. Returns whether it ends on
    /// all ways.
    pub(crate) fn perhaps_end(
        &mut self,
        [ends, goes_on]: [WaySet; 2],
        after: AfterError,
        at: &BlockContext<'_>,
    ) -> bool {
        if ends.is_never() {
            return false;
        }
        if goes_on.is_never() {
            return true;
        }
        self.stop_on(&ends, after, at);
        if self.options.stop != StopPolicy::KeepGoing {
            self.state.go_on_with(goes_on);
        }
        false
    }

    fn end_with(&mut self, after: AfterError, at: &BlockContext<'_>, outcome: &mut BlockOutcome) {
        if self.options.stop == StopPolicy::FirstError {
            self.scratch.after_error = after;
            outcome.step = Some(ControlStep::End(EndedBy::Error));
        } else {
            self.fail(after, at);
        }
    }
}

/// FC318: the program reports an error of its own, with a remedy class that stops it.
fn error_with(class: &str, span: Span, at: &BlockContext<'_>) -> Diagnostic {
    let message = format!("the control stops here: the program reports an error with {class}");
    let fault = Fault::new(Code::Fc318, span, message)
        .with_help("with `RC=0` it is a warning, and the program continues");
    at.diagnostic(fault)
}
