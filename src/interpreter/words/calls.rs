//! Calls: which program is meant (R2.13 to R2.16), where it is, whether it may be called, and parts of programs (R2.77, R2.78).

use std::collections::BTreeMap;

use crate::diagnostic::{Advice, Budget, Code};
use crate::interpreter::block::{BlockContext, BlockScratch, LeftOpen, stops};
use crate::interpreter::control::{ModalCycles, Repeated, RepeatedCall, after_motion_only};
use crate::interpreter::events::EndedBy;
use crate::interpreter::executor::Executor;
use crate::interpreter::options::StopPolicy;
use crate::interpreter::programs::calls::{CalledPart, Finder, WantedCall};
use crate::interpreter::programs::index::{LabelName, ProgramId};
use crate::interpreter::programs::store::Caller;
use crate::interpreter::stack::{
    AwaitedBlock, CallFrame, ControlStep, Destination, Passage, Request,
};
use crate::interpreter::values::expression::unquoted;
use crate::interpreter::values::handover::VariableUse;
use crate::interpreter::values::location::Unknown;
use crate::interpreter::values::value::{Value, numeric, rounded};
use crate::machine::Keeps;
use crate::syntax::Fault;
use crate::syntax::ast::{
    BlockReference, Call, CallForm, CallName, CallScope, Operand, Return, ReturnLevels,
    SequenceCall,
};
use crate::text::Span;

impl Executor {
    /// Returns the program that a call statement names; `None` where the name is not known offline (R2.52).
    pub(crate) fn wanted(
        &mut self,
        call: &Call,
        at: &BlockContext<'_>,
    ) -> Result<Option<WantedCall>, Box<Fault>> {
        let name = self.called_name(call.name, at)?;
        let mut own = BTreeMap::new();
        for (index, operand) in &call.arguments {
            own.insert(*index, self.value(*operand, at)?);
        }
        for (_, operand) in &call.words {
            self.value(*operand, at)?;
        }
        match name {
            Value::Text(name) => Ok(Some(WantedCall {
                scope: call.scope,
                name: name.trim().to_owned(),
                own,
                span: at.in_block(call.span),
                named: named(call.name, at),
                form: call.form,
                repeat: after_motion_only(call),
                part: None,
                word: None,
            })),
            Value::Unknown(cause) => {
                self.havoc_by_call(&cause);
                if call.scope == CallScope::Local {
                    self.pass_over_locals(&cause);
                }
                if self.scratch.read.unread.get() {
                    return Ok(None);
                }
                let what = "which program is called";
                self.tell_unknown(what, "the call is passed over", &cause, call.span, at);
                Ok(None)
            }
            Value::Number(_) => Err(Box::new(Fault::new(
                Code::Fc312,
                call.span,
                "a number is not a program name",
            ))),
        }
    }

    /// Returns the name of a called program.
    fn called_name(&mut self, name: CallName, at: &BlockContext<'_>) -> Result<Value, Box<Fault>> {
        Ok(match name {
            CallName::Literal(span) => Value::Text(span.of(at.text).into()),
            CallName::Quoted(span) => {
                let name = unquoted(span.of(at.text));
                self.state.control.memory.macro_or_text(name)
            }
            CallName::Variable(place) => self.value(Operand::Expression(place), at)?,
        })
    }
}

/// Returns the span of a program's name in its block, without quotes.
fn named(name: CallName, at: &BlockContext<'_>) -> Option<Span> {
    let span = match name {
        CallName::Literal(span) | CallName::Quoted(span) => span,
        CallName::Variable(_) => return None,
    };
    let name = unquoted(span.of(at.text)).trim();
    let start = span.start as usize + span.of(at.text).find(name)?;
    at.used
        .is_none()
        .then(|| Span::new(start, start + name.len()))
}

impl Executor {
    /// Looks for the programs that a block calls.
    #[inline(never)]
    pub(crate) fn resolve_all(
        &mut self,
        calls: Vec<WantedCall>,
        at: &BlockContext<'_>,
        finder: &mut dyn Finder,
    ) -> Vec<Request> {
        let mut requests = Vec::new();
        for wanted in calls {
            let refused = self.scratch.messages.diagnostics.iter().any(stops);
            if refused && self.options.stop == StopPolicy::FirstError {
                break;
            }
            requests.extend(self.resolve(wanted, at, finder));
        }
        requests
    }

    /// Looks for the program.
    pub(crate) fn resolve(
        &mut self,
        wanted: WantedCall,
        at: &BlockContext<'_>,
        finder: &mut dyn Finder,
    ) -> Option<Request> {
        if wanted.form == CallForm::Cycle && self.is_refused_in_cycle(wanted.span, at) {
            return None;
        }
        if wanted.scope == CallScope::Global && self.state.control.files.has(&wanted.name) {
            let why = "an earlier block or program renames, deletes or writes it";
            self.call_unknown(&wanted, why, at);
            return None;
        }
        if self.is_external(&wanted) {
            self.pass_over_external(wanted, at);
            return None;
        }
        let unit = self
            .state
            .control
            .frames
            .running()
            .map_or(0, |frame| frame.unit);
        let caller = Caller {
            unit,
            file: at.file,
        };
        let here = self
            .state
            .control
            .frames
            .program()
            .filter(|_| self.position().is_here(&wanted));
        let found = match here.map_or_else(
            || {
                self.programs
                    .find(&wanted, caller, finder, &self.state.work)
            },
            |here| Ok(Some(here)),
        ) {
            Ok(found) => found?,
            Err(_) if self.state.control.files.is_guarded(&wanted.name) => {
                let why = "it is not here, and the program asks whether it exists";
                self.call_unknown(&wanted, why, at);
                return None;
            }
            Err(fault) => {
                let cause = Unknown::Program(wanted.missing());
                self.state.mentioned.enter_root(&cause, wanted.span, at);
                self.state.control.memory.miss(&cause);
                self.note_use(VariableUse::write_anything);
                self.scratch
                    .messages
                    .diagnostics
                    .push(at.diagnostic(*fault));
                return None;
            }
        };
        if wanted.scope == CallScope::Global && here.is_none() {
            self.tell_others(&wanted, found, finder, at);
        }
        let is_refused = !self.programs.index(found.unit).refused.is_empty();
        if is_refused && found.unit > 0 {
            // The faults of the file are reported at the first call of it (R2.85).
            if self.state.control.refused.insert(found.unit) {
                let refused = &self.programs.index(found.unit).refused;
                self.scratch
                    .messages
                    .diagnostics
                    .extend(refused.said.iter().cloned());
            }
            if self.options.stop == StopPolicy::FirstError {
                return None;
            }
        }
        if let Some(after_motion_only) = wanted.repeat {
            self.state.control.cycles = ModalCycles::of(Repeated {
                call: RepeatedCall::Program(found),
                own: wanted.own.clone(),
                after_motion_only,
            });
        }
        let depth = self.state.control.frames.level() + 1;
        if depth > self.options.limits.calls {
            let fault = Fault::new(
                Code::Fc911,
                wanted.span,
                format!(
                    "subprogram calls are nested more than {} levels deep",
                    self.options.limits.calls
                ),
            )
            .with_help(Advice::RaiseBudget(Budget::Calls));
            self.scratch.messages.diagnostics.push(at.diagnostic(fault));
            self.scratch.ending.too_deep = self.options.stop != StopPolicy::KeepGoing;
            return None;
        }
        let passage = self.passage(&wanted, found, at).ok()?;
        Some(Request {
            found,
            passage,
            own: wanted.own,
            form: wanted.form,
            called_from: at.place(wanted.span),
        })
    }

    /// Reports FC329: other files have the name of the called program (R2.108).
    fn tell_others(
        &mut self,
        wanted: &WantedCall,
        found: ProgramId,
        finder: &mut dyn Finder,
        at: &BlockContext<'_>,
    ) {
        let first = self.programs.section(found).start;
        if self.programs.was_read(found.unit, first) {
            return;
        }
        let others = finder.others(&wanted.name, at.file);
        if others.is_empty() {
            return;
        }
        let taken = self.programs.index(found.unit).source.name();
        let message = format!(
            "`{}` is called here, and `{}` has the name, too; the control takes the first one on its own paths",
            taken,
            others.join("`, `")
        );
        let fault = Fault::new(Code::Fc329, wanted.span, message)
            .with_help("call it with its folder, or give the others names of their own");
        self.scratch.messages.diagnostics.push(at.diagnostic(fault));
    }

    /// Reports FC902: the program that is called may be another one on the machine (R2.108).
    fn call_unknown(&mut self, wanted: &WantedCall, why: &str, at: &BlockContext<'_>) {
        let cause = Unknown::Program(wanted.missing());
        self.havoc_by_call(&cause);
        let message = format!(
            "what `{}` does is not known: {why}; the call is passed over, and everything that a program could change \
             becomes unknown",
            wanted.name
        );
        let fault = Fault::new(Code::Fc902, wanted.span, message);
        self.tell_once(&cause, "call", fault, at);
    }

    /// Reports P-ERR-21381: a cycle is called while a modal one is in force (R2.104). Returns whether that stops the
    /// program.
    fn is_refused_in_cycle(&mut self, span: Span, at: &BlockContext<'_>) -> bool {
        let cycles = self.state.control.cycles.known();
        if cycles.is_empty() {
            return false;
        }
        let is_open = |it: &Repeated| match it.call {
            RepeatedCall::Program(found) => self.state.control.frames.is_running(found),
            RepeatedCall::External(_) => false,
            RepeatedCall::Perhaps(_) => true,
        };
        if cycles.iter().any(is_open) {
            let what = "this block calls a cycle while a modal cycle may be active";
            self.may_refuse(21381, what, span, at);
            return false;
        }
        let what =
            "this block calls a cycle while a modal cycle is active, which the control refuses";
        let said = at.diagnostic(*Fault::refused(Code::PErr21381, span, what));
        self.scratch.messages.diagnostics.push(said);
        true
    }

    /// Passes over a program that only the machine has (R2.83): whatever it may change is unknown after it.
    fn pass_over_external(&mut self, wanted: WantedCall, at: &BlockContext<'_>) {
        let program = wanted.missing();
        let name = wanted.name;
        self.pass_over(&name, wanted.span, at);
        self.leave_to_machine(&program);
        let keeps = self.machine.programs.keeps(&name);
        if !keeps.compensation {
            self.scratch.left_open = Some(LeftOpen {
                program: program.clone(),
                place: at.place(wanted.span),
            });
        }
        if !keeps.compensation || !keeps.positions {
            let what = match keeps {
                Keeps {
                    compensation: true, ..
                } => "all positions become unknown",
                Keeps {
                    positions: true, ..
                } => "the compensation of every axis becomes unknown",
                Keeps { .. } => "every axis becomes unknown",
            };
            if wanted.word.is_some() {
                self.warn_without_program(&name, what, wanted.span, at);
            } else {
                let message = format!(
                    "the program `{name}` is only on the machine; the call is passed over, and {what}"
                );
                let fault = Fault::new(Code::Fc902, wanted.span, message).with_help(
                    "if it leaves them as they are, say so in `[machine.external_keeps]`",
                );
                self.tell_once(&Unknown::Program(program.clone()), "call", fault, at);
            }
        }
        if let Some(after_motion_only) = wanted.repeat {
            self.state.control.cycles = ModalCycles::of(Repeated {
                call: RepeatedCall::External(program),
                own: wanted.own,
                after_motion_only,
            });
        }
    }

    /// Reports FC325: no program is known for a word that calls one; once per word and program (R2.94).
    fn warn_without_program(&mut self, word: &str, then: &str, span: Span, at: &BlockContext<'_>) {
        if !self.state.is_new_word(word) {
            return;
        }
        let message = format!(
            "no program is known for `{word}`, which calls one on the control; the call is passed over, and {then}"
        );
        let fault = Fault::new(Code::Fc325, span, message)
            .with_help(format!(
                "name its program, `{word} = \"cycle.nc\"` in `[machine.programs]`; one that frictcomp cannot read \
                 belongs in `external`, and `[machine.external_keeps]` says what it keeps"
            ))
            .with_help(format!(
                "if it keeps every compensation, set `harmless = [\"{word}\"]` in `[machine]`"
            ));
        self.scratch.messages.diagnostics.push(at.diagnostic(fault));
    }

    /// Returns the calls of a block with the modal cycle after them, unless the block is one of the cycle's.
    pub(crate) fn repetition(
        &mut self,
        step: Option<ControlStep>,
        moved: bool,
        at: &BlockContext<'_>,
        finder: &mut dyn Finder,
    ) -> Option<ControlStep> {
        if self.state.control.cycles.is_empty() {
            return step;
        }
        let mut calls = match step {
            Some(ControlStep::Call(calls)) => calls,
            // The cycle itself was called with this block.
            step => {
                debug_assert!(step.is_none());
                Vec::new()
            }
        };
        for cycle in self.state.control.cycles.known().to_vec() {
            if moved || !cycle.after_motion_only {
                calls.extend(self.repeat(cycle, &calls, at, finder));
            }
        }
        (!calls.is_empty()).then_some(ControlStep::Call(calls))
    }

    /// Returns a modal cycle after a block that made some calls.
    fn repeat(
        &mut self,
        cycle: Repeated,
        calls: &[Request],
        at: &BlockContext<'_>,
        finder: &mut dyn Finder,
    ) -> Option<Request> {
        let found = match &cycle.call {
            RepeatedCall::Program(found) | RepeatedCall::Perhaps(found) => *found,
            RepeatedCall::External(program) => {
                self.leave_to_machine(program);
                return None;
            }
        };
        let is_inside = self.state.control.frames.is_running(found);
        if is_inside || calls.iter().any(|call| call.found == found) {
            return None;
        }
        if let RepeatedCall::Perhaps(_) = cycle.call {
            let section = self.programs.section(found);
            let blocks = section.start..section.end;
            let name = self.programs.index(found.unit).source.name().clone();
            let cause = Unknown::Cycle(name);
            self.perhaps_execute(found.unit, blocks, &cause, finder);
            return None;
        }
        Some(Request {
            found,
            passage: None,
            own: cycle.own,
            form: CallForm::Cycle,
            called_from: at.place(Span::new(0, at.text.len())),
        })
    }

    /// Returns the blocks that a call asks for; `Err` where they are not in the program.
    pub(crate) fn passage(
        &mut self,
        wanted: &WantedCall,
        found: ProgramId,
        at: &BlockContext<'_>,
    ) -> Result<Option<Passage>, ()> {
        let Some(part) = &wanted.part else {
            return Ok(None);
        };
        let here = self.state.control.frames.program() == Some(found);
        let call = self.state.control.frames.entry();
        let end = self.programs.section(found).end;
        let first = self.programs.block_of(found, &part.first, &self.state.work);
        let last = match &part.last {
            Some(last) => self
                .programs
                .block_of(found, last, &self.state.work)
                .map(Some),
            None => Some(None),
        };
        let (Some(first), Some(last)) = (first, last) else {
            let missing = match first {
                None => &part.first,
                Some(_) => part.last.as_ref().unwrap_or(&part.first),
            };
            self.no_block(missing, found.unit, wanted.span, at);
            return Err(());
        };
        // The part ends before its call.
        let tag = call.filter(|call| part.end_tag && here && *call > first);
        let tag = tag.map(|call| call - 1);
        let last = last.filter(|last| *last >= first);
        let last = match (last, tag) {
            (Some(last), Some(tag)) => last.min(tag),
            (Some(last), None) => last,
            (None, Some(tag)) => tag,
            // Without an end only the block is executed; an end before it is never reached.
            (None, None) if part.last.is_none() && !part.end_tag => first,
            (None, None) => end.saturating_sub(1),
        };
        Ok(Some(Passage {
            first,
            last,
            left: part.passes - 1,
            begun: self.state.seq,
        }))
    }

    /// Reports that a program has no such block; lines read one after another are not kept.
    fn no_block(&mut self, name: &LabelName, unit: usize, span: Span, at: &BlockContext<'_>) {
        let fault = if self.programs.is_cut(unit) {
            self.havoc_all(&Unknown::text("L SEQUENCE"));
            not_kept(name, span, "the call is passed over")
        } else {
            Fault::new(
                Code::Fc209,
                span,
                format!("block `{name}` does not exist in this program"),
            )
        };
        self.scratch.messages.diagnostics.push(at.diagnostic(fault));
    }

    /// Ends the program, after the configured program that runs before its end (R2.15).
    pub(crate) fn program_end(
        &mut self,
        by: EndedBy,
        at: &BlockContext<'_>,
        finder: &mut dyn Finder,
    ) -> ControlStep {
        if self.state.control.ending.is_none()
            && let Some(name) = self.machine.programs.end.clone()
        {
            let wanted = WantedCall::program(CallScope::Global, name, Span::new(0, at.text.len()));
            self.state.control.frames.clear();
            if let Some(request) = self.resolve(wanted, at, finder) {
                self.state.control.ending = Some(by);
                return ControlStep::Call(vec![request]);
            }
        }
        ControlStep::End(self.state.control.ending.take().unwrap_or(by))
    }
}

impl Executor {
    /// Executes `L SEQUENCE […]`.
    pub(crate) fn sequence(
        &mut self,
        sequence: &SequenceCall,
        at: &BlockContext<'_>,
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
        self.scratch.actions.calls.push(WantedCall {
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

    /// Executes `M17 [MAIN [LABEL]]`.
    pub(crate) fn return_to(
        &mut self,
        back: &Return,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        let here = self.state.control.frames.level();
        let level = match back.levels {
            ReturnLevels::One => here.saturating_sub(1),
            ReturnLevels::Main => 0,
            ReturnLevels::Number(operand) => {
                let value = self.value(operand, at)?;
                if let Value::Unknown(cause) = &value {
                    self.unknown_return("how many programs are left", cause, back.span, at);
                    self.scratch.actions.returns = true;
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
            self.scratch.actions.returns = true;
            return Ok(());
        }
        let mut destination = Destination::after_call(level);
        match back.target {
            None => {}
            Some(target) => {
                let name = match self.label_of(target, at)? {
                    Ok(name) => name,
                    Err(cause) => {
                        self.unknown_return("where the program continues", &cause, back.span, at);
                        self.scratch.actions.step =
                            Some(ControlStep::ReturnTo(Destination::after_call(level)));
                        return Ok(());
                    }
                };
                let frame = self.state.control.frames.at_level(level);
                let program = frame.map_or(ProgramId::FIRST, CallFrame::program);
                destination.entry = self.programs.block_of(program, &name, &self.state.work);
                if destination.entry.is_none() {
                    if !self.programs.is_cut(program.unit) || level > 0 {
                        return Err(Box::new(Fault::new(
                            Code::Fc209,
                            back.span,
                            format!(
                                "jump label `{name}` does not exist in the program that is returned to"
                            ),
                        )));
                    }
                    let lost = not_kept(&name, back.span, "the dry run continues after the call");
                    destination.awaited = Some(Box::new(AwaitedBlock {
                        lost: at.diagnostic(lost),
                        label: name,
                    }));
                }
            }
        }
        self.scratch.actions.step = Some(ControlStep::ReturnTo(destination));
        Ok(())
    }
}

/// Returns FC902: a block of a program whose lines are read one after another and not kept.
fn not_kept(name: &LabelName, span: Span, then: &str) -> Fault {
    let message = format!(
        "`{name}` is in a part of the program that was read line by line and is not kept; {then}, and every axis becomes unknown"
    );
    Fault::new(Code::Fc902, span, message).with_help("give the program as a file")
}

impl BlockScratch {
    /// Reports FC317: the control warns and returns to the main program (PM/206781707). A subprogram that is run by
    /// itself is not a main program.
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
        self.messages.diagnostics.push(at.diagnostic(fault));
    }
}
