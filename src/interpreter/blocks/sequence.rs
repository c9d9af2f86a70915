//! Parts of programs: `L SEQUENCE` (R2.77), and M17 and M29 with a place to return to (R2.78).

use crate::diagnostic::Code;
use crate::interpreter::programs::index::{LabelName, ProgramId};
use crate::interpreter::programs::wanted::{CalledPart, WantedCall};
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::block_scratch::BlockScratch;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::outcome::BlockOutcome;
use crate::interpreter::run::stack::CallFrame;
use crate::interpreter::run::step::{AwaitedBlock, ControlStep, Destination};
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::functions::numeric;
use crate::interpreter::values::value::{Value, rounded};
use crate::syntax::Fault;
use crate::syntax::ast::{BlockReference, CallScope, Operand, Return, ReturnLevels, SequenceCall};
use crate::text::Span;

impl Executor {
    /// `L SEQUENCE […]`
    pub(crate) fn sequence(
        &mut self,
        sequence: &SequenceCall,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) -> Result<(), Box<Fault>> {
        let span = sequence.span;
        let name = match sequence.name {
            None => String::new(),
            Some(name) => match self.called_name(name, at)? {
                Value::Text(name) => name.trim().to_owned(),
                Value::Unknown(cause) => {
                    self.unknown_call("which program is called", &cause, span, at);
                    return Ok(());
                }
                Value::Number(_) => {
                    return Err(Box::new(Fault::new(
                        Code::Fc312,
                        span,
                        "a number is not a program name",
                    )));
                }
            },
        };
        let passes = match sequence.passes {
            None => Value::Number(1.0),
            Some(passes) => self.value(passes, at)?,
        };
        let Some(passes) = numeric(&passes, span)?.and_then(rounded) else {
            let cause = match passes {
                Value::Unknown(cause) => cause,
                Value::Number(_) | Value::Text(_) => Unknown::text("REPEAT"),
            };
            self.unknown_call("how often a part is executed", &cause, span, at);
            return Ok(());
        };
        let first = self.label_of(sequence.first, at)?;
        let last = match sequence.last {
            Some(last) => self.label_of(last, at)?.map(Some),
            None => Ok(None),
        };
        let (first, last) = match (first, last) {
            (Ok(first), Ok(last)) => (first, last),
            (Err(cause), _) | (_, Err(cause)) => {
                self.unknown_call("which part is executed", &cause, span, at);
                return Ok(());
            }
        };
        let part = CalledPart {
            first,
            last,
            end_tag: sequence.end_tag,
            passes: u64::try_from(passes).unwrap_or_default().max(1),
            here: name.is_empty(),
        };
        let wanted = WantedCall::program(CallScope::Global, name, at.in_block(span));
        outcome.calls.push(WantedCall {
            part: Some(part),
            ..wanted
        });
        Ok(())
    }

    /// Returns the label that a target names, or the value that decides where it is not known offline.
    fn label_of(
        &mut self,
        target: BlockReference,
        at: &BlockContext<'_>,
    ) -> Result<Result<LabelName, Unknown>, Box<Fault>> {
        let value = match target {
            BlockReference::Label(name) => {
                return Ok(Ok(LabelName::Text(name.of(at.text).to_owned())));
            }
            BlockReference::Number(operand) => self.value(operand, at)?,
            BlockReference::Variable(place) => self.value(Operand::Expression(place), at)?,
        };
        match value {
            Value::Number(number) => Ok(rounded(number)
                .map(LabelName::Number)
                .ok_or_else(|| Unknown::text("N"))),
            Value::Text(name) => Ok(Ok(LabelName::Text(name.to_string()))),
            Value::Unknown(cause) => Ok(Err(cause)),
        }
    }

    fn unknown_return(&mut self, what: &str, cause: &Unknown, span: Span, at: &BlockContext<'_>) {
        self.havoc_by_call(cause);
        self.tell_unknown(
            what,
            "the dry run continues after the call",
            cause,
            span,
            at,
        );
    }

    /// `M17 [MAIN [LABEL]]`
    pub(crate) fn return_to(
        &mut self,
        back: &Return,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) -> Result<(), Box<Fault>> {
        let here = self.state.control.frames.level();
        let level = match back.levels {
            ReturnLevels::One => here.saturating_sub(1),
            ReturnLevels::Main => 0,
            ReturnLevels::Number(operand) => {
                let value = self.value(operand, at)?;
                if let Value::Unknown(cause) = &value {
                    self.unknown_return("how many programs are left", cause, back.span, at);
                    outcome.returns = true;
                    return Ok(());
                }
                let number = value
                    .number()
                    .and_then(rounded)
                    .filter(|number| *number > 0);
                let Some(number) = number else {
                    return Err(Box::new(Fault::new(
                        Code::Fc312,
                        back.span,
                        "`JUMPS` is a number of programs, 1 or more",
                    )));
                };
                let number = u32::try_from(number).unwrap_or(u32::MAX);
                self.scratch
                    .warn_too_many_jumps(number, here, back.span, at);
                here.saturating_sub(number)
            }
        };
        if here == 0 {
            outcome.returns = true;
            return Ok(());
        }
        let entry = match back.target {
            None => None,
            Some(target) => {
                let name = match self.label_of(target, at)? {
                    Ok(name) => name,
                    Err(cause) => {
                        self.unknown_return("where the program continues", &cause, back.span, at);
                        outcome.step =
                            Some(ControlStep::ReturnTo(Destination { level, entry: None }));
                        return Ok(());
                    }
                };
                let frame = self.state.control.frames.at_level(level);
                let program = frame.map_or(ProgramId::FIRST, CallFrame::program);
                let found = self.programs.block_of(program, &name, &self.state.work);
                if found.is_none() {
                    let missing = Fault::new(
                        Code::Fc209,
                        back.span,
                        format!(
                            "jump label `{name}` does not exist in the program that is returned to"
                        ),
                    );
                    let arrives = self.programs.index(program.unit).source.name().is_empty();
                    if !arrives || level > 0 {
                        return Err(Box::new(missing));
                    }
                    self.awaited = Some(AwaitedBlock {
                        label: name,
                        missing: at.diagnostic(missing),
                    });
                }
                found
            }
        };
        outcome.step = Some(ControlStep::ReturnTo(Destination { level, entry }));
        Ok(())
    }
}

impl BlockScratch {
    /// FC317: the control warns and returns to the main program (PM/206781707). A subprogram that is
    /// run by itself is not a main program.
    fn warn_too_many_jumps(&mut self, number: u32, here: u32, span: Span, at: &BlockContext<'_>) {
        if here == 0 || number <= here {
            return;
        }
        let programs = if here == 1 { "program" } else { "programs" };
        let message = format!(
            "`JUMPS` leaves {number} programs, but only {here} {programs} can be left here; the main program continues"
        );
        let fault = Fault::new(Code::Fc317, span, message)
            .with_help("write `M17 [MAIN]` to return to the main program");
        self.diagnostics.push(at.diagnostic(fault));
    }
}
