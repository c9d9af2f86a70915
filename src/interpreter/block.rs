//! One block: its words from left to right, then what it does as a whole.

use std::ops::ControlFlow;
use std::sync::Arc;

use super::at::{At, Shown};
use super::call::Wanted;
use super::event::{EndedBy, Event, Executed, Observer};
use super::finder::Finder;
use super::modal::Group;
use super::options::StopPolicy;
use super::program::EntryIndex;
use super::run::Interpreter;
use super::start::{ended_by, stops};
use super::state::{Departure, Last, Request, Step};
use super::unit::is_harmless;
use super::value::{Value, rounded};
use super::words::AxisWords;
use crate::diagnostic::{Code, Diagnostic};
use crate::syntax::ast::{Block, CallScope, Flow, Item, Operand};
use crate::syntax::{FastPath, Fault, hash_name};
use crate::text::Span;

/// Messages about one block that are said one by one (R2.85).
const MAX_SAID: usize = 1000;

/// The F word of a block.
#[derive(Debug, Clone, Copy, Default)]
pub(super) enum Feed {
    /// There is none.
    #[default]
    Absent,
    /// Its value, where it is known.
    Given(Option<f64>),
}

/// What a block does after its words.
#[derive(Default)]
pub(super) struct Intent {
    /// M02, M30.
    pub(super) end: Option<EndedBy>,
    /// M17, M29.
    pub(super) returns: bool,
    /// A jump, or a control block's business.
    pub(super) step: Option<Step>,
    /// Calls, in the order in which they are made.
    pub(super) calls: Vec<Wanted>,
    /// The G functions of the block, to find two of one group.
    pub(super) groups: [Option<u32>; Group::COUNT],
    /// What axis words are: G04, G92 … make them something else than coordinates.
    pub(super) axis_words: AxisWords,
    /// F, which may be unknown.
    pub(super) feed: Feed,
    /// R of a circle.
    pub(super) radius: Option<Span>,
    /// The condition of an `$IF` in a block with `$GOTO`.
    condition: Option<bool>,
}

impl Intent {
    /// Whether nothing in the block itself leads elsewhere than to the next one.
    fn goes_on(&self) -> bool {
        self.end.is_none() && !self.returns && self.step.is_none()
    }
}

impl Interpreter {
    /// Executes a block and tells the observer. `Continue` where the next block follows.
    pub(super) fn execute(
        &mut self,
        block: &Block,
        at: &At<'_>,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> ControlFlow<Departure> {
        self.work.clear();
        self.state.seq += 1;
        self.state.blocks += 1;
        if self.state.ways.has_targets() {
            self.arrive(finder);
        }
        let mut intent = Intent::default();
        let limit = self.first_refusal(block);
        self.items(block, at, &mut intent, limit);
        if self.work.again != 0 {
            self.refuse_repeated_axes(intent.axis_words, at);
        }
        self.move_around(intent.axis_words);
        if self.any_required && self.state.described.is_none() {
            let goes_on = !self.work.diagnostics.iter().any(stops);
            if goes_on || self.options.stop != StopPolicy::FirstError {
                self.check_required(intent.axis_words, at);
            }
        }
        if !self.pending.is_empty() {
            self.forget_called(finder);
        }
        if !self.work.doubted.is_empty() {
            self.name_doubted();
        }
        if !self.departing.is_empty() {
            self.depart(finder, at);
        }
        let calls = if intent.calls.is_empty() {
            Vec::new()
        } else {
            self.resolve_all(std::mem::take(&mut intent.calls), at, finder)
        };
        let refused = self.work.diagnostics.iter().any(stops);
        let stopped = self.options.stop == StopPolicy::FirstError && (limit.is_some() || refused);
        if !block.faults.is_empty() {
            self.take_faults(block, at, stopped);
        }
        if !stopped {
            self.move_axes(&intent, at);
        }
        let number = self.block_number(block, at);
        self.state.grant(at.text);
        let is_plain = !self.work.wrote
            && self.work.unsaid.is_none()
            && self.state.level.get() <= self.options.limits.work;
        let is_over = !is_plain && self.settle(at);
        if !self.work.changes.is_empty() || self.work.new_axes {
            self.version += 1;
        }
        self.remember_last(at);
        let step = if is_over {
            Some(Step::End(EndedBy::Budget))
        } else if stopped {
            Some(Step::End(ended_by(&self.work.diagnostics)))
        } else if calls.is_empty() && intent.goes_on() && self.state.cycles.is_empty() {
            None
        } else {
            match self.step(intent, calls, at, finder) {
                Some(Step::Jump(target)) if self.is_behind(target) => {
                    Some(self.come_round(target, at, finder))
                }
                step => step,
            }
        };
        let flow = observer.event(Event::Executed(Executed {
            seq: self.state.seq,
            file: at.file,
            line: at.line,
            text: at.text,
            comments: at.comments,
            remark: at.remark,
            number,
            level: (at.level > 0).then_some(at.level),
            block,
            outcomes: &self.work.outcomes,
            changes: &self.work.changes,
            doubted: &self.work.doubted,
            moved: if stopped { &[] } else { &self.work.moved },
            motion: self.work.motion.as_ref(),
            notes: &self.work.notes.borrow(),
            diagnostics: &self.work.diagnostics,
            stopped,
            compensation: &self.state.compensation,
            modal: &self.state.modal,
            occurred: &self.state.occurred,
            version: self.version,
        }));
        // They are said; what is left at program end belongs to no executed block.
        self.work.diagnostics.clear();
        self.work.changes.clear();
        match step {
            step if flow.is_break() => {
                self.state.parked = step;
                ControlFlow::Break(Departure::Paused)
            }
            None => ControlFlow::Continue(()),
            Some(step) => ControlFlow::Break(Departure::Step(step)),
        }
    }

    /// Where the control would refuse the block's text; nothing right of it is executed then.
    fn first_refusal(&self, block: &Block) -> Option<u32> {
        if self.options.stop != StopPolicy::FirstError {
            return None;
        }
        block
            .faults
            .iter()
            .find(|fault| fault.code.severity() == crate::diagnostic::Severity::Error)
            .map(|fault| fault.span.start)
    }

    /// Adds what is wrong with the text, up to the first error when that stops the program.
    pub(super) fn take_faults(&mut self, block: &Block, at: &At<'_>, stopped: bool) {
        let error = |diagnostic: &&Diagnostic| stops(diagnostic);
        let executed = self
            .work
            .diagnostics
            .iter()
            .find(error)
            .map(|d| d.place.span.start);
        let limit = if stopped {
            let refused = self.first_refusal(block);
            match (executed, refused) {
                (Some(executed), Some(refused)) => executed.min(refused),
                (found, None) | (None, found) => found.unwrap_or(u32::MAX),
            }
        } else {
            u32::MAX
        };
        let harmless = &self.machine.harmless;
        for fault in block
            .faults
            .iter()
            .filter(|fault| fault.span.start <= limit && !is_harmless(harmless, fault, at.text))
        {
            self.work.diagnostics.push(at.diagnostic(fault.clone()));
        }
    }

    pub(super) fn items(
        &mut self,
        block: &Block,
        at: &At<'_>,
        intent: &mut Intent,
        limit: Option<u32>,
    ) {
        let limit = limit.unwrap_or(u32::MAX);
        let is_reached = |span: Span| span.start < limit;
        for word in &block.words {
            if !is_reached(word.span) {
                return;
            }
            if self.plain_word(word, intent) {
                continue;
            }
            let done = self.word(word, block, at, intent);
            if self.say(done, at).is_break() {
                return;
            }
        }
        for item in &block.items {
            if !is_reached(item.span()) {
                return;
            }
            let done = self.item(item, block, at, intent);
            // After a statement that goes elsewhere, `$CASE 2 X10`, nothing is executed.
            let leaves = matches!(item, Item::Flow(flow, _) if !matches!(flow, Flow::Goto(_)))
                && intent.step.is_some();
            if self.say(done, at).is_break() || leaves {
                return;
            }
        }
    }

    /// Says what is wrong with a part of the block. `Break` where the control goes no further.
    #[inline]
    fn say(&mut self, done: Result<(), Box<Fault>>, at: &At<'_>) -> ControlFlow<()> {
        if let Err(fault) = done {
            self.complain(*fault, at);
        }
        let refused =
            self.options.stop == StopPolicy::FirstError && self.work.diagnostics.iter().any(stops);
        if refused {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    #[cold]
    fn complain(&mut self, fault: Fault, at: &At<'_>) {
        if self.work.diagnostics.len() < MAX_SAID || !self.work.diagnostics.iter().any(stops) {
            self.work.diagnostics.push(at.diagnostic(fault));
        } else {
            self.work.unsaid.get_or_insert((fault.span, 0)).1 += 1;
        }
    }

    /// What a block that did more than move says at its end: how much it left unsaid, and which
    /// budget it used up. Whether it used up one.
    #[inline(never)]
    fn settle(&mut self, at: &At<'_>) -> bool {
        if let Some((span, more)) = self.work.unsaid.take() {
            let message = format!(
                "the first {MAX_SAID} messages about this block are shown; there are {more} more"
            );
            let fault = Fault::new(Code::Fc905, at.in_block(span), message);
            self.work.diagnostics.push(at.diagnostic(fault));
        }
        let Some(over) = self.used_up(at) else {
            return false;
        };
        // The faults of the parts that were given up say no more than it does.
        let is_part = |said: &Diagnostic| said.code == Code::Fc919;
        self.work.diagnostics.retain(|said| !is_part(said));
        self.work.diagnostics.push(over);
        true
    }

    /// What the control does next, where that is not the next block.
    #[inline(never)]
    fn step(
        &mut self,
        mut intent: Intent,
        calls: Vec<Request>,
        at: &At<'_>,
        finder: &mut dyn Finder,
    ) -> Option<Step> {
        let moved = !self.work.moved.is_empty();
        if !calls.is_empty() {
            intent.step = Some(Step::Call(calls));
        }
        if let Some(by) = intent.end {
            if self.state.ending.is_none() && at.level > 0 {
                let fault = Fault::new(
                    Code::Fc315,
                    Span::new(0, at.text.len()),
                    "a program end inside a subprogram ends the whole run",
                )
                .with_help("end a subprogram with `M17` or `M29`");
                self.work.diagnostics.push(at.diagnostic(fault));
            }
            if at.level == 0 && at.used.is_none() && self.state.ending.is_none() {
                self.work.end = Some(at.place(Span::new(0, at.text.len())));
            }
            return Some(self.program_end(by, at, finder));
        }
        if intent.returns {
            return Some(Step::Return);
        }
        let step = intent.step.take();
        if step.is_none() || matches!(step, Some(Step::Call(_))) {
            return self.repetition(step, moved, at, finder);
        }
        step
    }

    /// The program ends, after the configured program that runs before its end (R2.15).
    pub(super) fn program_end(
        &mut self,
        by: EndedBy,
        at: &At<'_>,
        finder: &mut dyn Finder,
    ) -> Step {
        if self.state.ending.is_none() {
            self.meet_at_end(finder);
            if let Some(name) = self.machine.programs.end.clone() {
                let wanted = Wanted::program(CallScope::Global, name, Span::new(0, at.text.len()));
                self.state.frames.clear();
                if let Some(request) = self.resolve(wanted, at, finder) {
                    self.state.ending = Some(by);
                    return Step::Call(vec![request]);
                }
            }
        }
        Step::End(self.state.ending.take().unwrap_or(by))
    }

    /// Whether a block of the running program stands before the next one.
    fn is_behind(&self, target: EntryIndex) -> bool {
        let frame = self.state.frames.last();
        frame.is_some_and(|frame| target < frame.next)
    }

    #[inline(never)]
    fn item(
        &mut self,
        item: &Item,
        block: &Block,
        at: &At<'_>,
        intent: &mut Intent,
    ) -> Result<(), Box<Fault>> {
        match item {
            Item::Word(word) => self.word(word, block, at, intent),
            Item::Comp(command) => {
                self.comp(command, at);
                Ok(())
            }
            Item::Bracket {
                axis,
                keyword,
                span,
            } => {
                let word = format!("{}[{}]", axis.of(at.text), keyword.of(at.text));
                self.pass_over(&word, *span, at);
                Ok(())
            }
            Item::BareNumber(operand, span) => {
                let value = self.value(*operand, block, at)?;
                if intent.axis_words != AxisWords::Motion {
                    self.geometry().dwell = Some(value.number());
                    return Ok(());
                }
                let found = span.of(at.text);
                Err(Box::new(Fault::new(
                    Code::Fc207,
                    *span,
                    format!("`{found}` has no address"),
                )))
            }
            Item::Assign(assignment) => self.assign(*assignment, block, at),
            Item::Hash(hash) => self.hash(hash, block, at, intent),
            Item::MacroDefinition(name, code) => {
                let (name, code) = (unquoted(*name, at), unquoted(*code, at));
                self.state.memory.define_macro(name, code);
                self.work.wrote = true;
                Ok(())
            }
            Item::GCall(call) => self.g_call(call, block, at, intent),
            Item::Sequence(sequence) => self.sequence(sequence, block, at, intent),
            Item::Return(back) => self.return_to(back, block, at, intent),
            Item::Call(call) => {
                let wanted = self.wanted(call, block, at)?;
                intent.calls.extend(wanted);
                Ok(())
            }
            Item::Flow(flow, span) => {
                let condition = self.one_line_condition(flow, block, at);
                let condition = condition.or_else(|fault| {
                    let cause = cause_of(&fault, at);
                    self.undecidable(*fault, at)?;
                    self.pass_jump(block, &cause, at);
                    Ok::<_, Box<Fault>>(Some(false))
                })?;
                if condition.is_some() {
                    intent.condition = condition;
                    return Ok(());
                }
                if intent.condition == Some(false) {
                    return Ok(());
                }
                let step = self.flow(flow, *span, block, at);
                intent.step = step.or_else(|fault| {
                    let cause = cause_of(&fault, at);
                    self.undecidable(*fault, at)?;
                    Ok::<_, Box<Fault>>(self.undecided(flow, &cause, *span, at))
                })?;
                Ok(())
            }
            Item::MacroUse(span) => self.expand(*span, at, intent),
            Item::Unread(_, span) if self.machine.harmless.has_command(span.of(at.text)) => {
                let (name, _) = hash_name(span.of(at.text));
                self.pass_over(&name, *span, at);
                Ok(())
            }
            Item::Unread(effect, span) => {
                self.forget_unread(*effect, &span.of(at.text).into());
                Ok(())
            }
            Item::Label(_) | Item::BadCommand(_) => Ok(()),
        }
    }

    /// A condition that cannot be computed: what depends on it is not known, and is not said again
    /// (R2.51, R2.71).
    fn undecidable(&mut self, fault: Fault, at: &At<'_>) -> Result<(), Box<Fault>> {
        if self.options.stop == StopPolicy::FirstError {
            return Err(Box::new(fault));
        }
        self.complain(fault, at);
        self.work.unread.set(true);
        Ok(())
    }

    /// A macro in place of words: its code is a block of its own, executed here (R2.35).
    fn expand(&mut self, span: Span, at: &At<'_>, intent: &mut Intent) -> Result<(), Box<Fault>> {
        let name = unquoted(span, at);
        let code = match self.state.memory.macro_code(name) {
            Some(Value::Text(code)) => Arc::clone(code),
            Some(Value::Unknown(cause)) => {
                let cause = Arc::clone(cause);
                return Err(self.lost_macro(span, name, &cause));
            }
            Some(Value::Number(_)) | None => {
                let fault = Fault::new(Code::Fc207, span, format!("macro `{name}` is not defined"));
                return Err(Box::new(fault.with_help(format!(
                    "define it first, with `\"{name}\" = \"code\"`"
                ))));
            }
        };
        let macros = self.with_evaluator(&Block::default(), at, |evaluator| {
            let macros = evaluator.macros.expand(&code, evaluator.state, span);
            macros.map(|macros| macros.depth)
        })?;
        let mut block = Block::default();
        let lines = crate::text::TextLines::new(&code);
        let _ = crate::syntax::BlockReader::new(lines, 1, FastPath::On).next(&mut block);
        let shown = Shown::default();
        let inner = At {
            shown: &shown,
            text: &code,
            macro_depth: macros,
            used: at.used.or(Some(span)),
            ..*at
        };
        let (said, moved) = (self.work.diagnostics.len(), self.work.moved.len());
        let (switched, noted) = (self.work.outcomes.len(), self.work.notes.borrow().len());
        let limit = self.first_refusal(&block);
        self.items(&block, &inner, intent, limit);
        self.take_faults(&block, &inner, limit.is_some());
        // What is said about the macro's code is shown where the macro is used.
        for diagnostic in &mut self.work.diagnostics[said..] {
            diagnostic.place = at.place(span);
        }
        for word in &mut self.work.moved[moved..] {
            word.span = span;
        }
        for outcome in &mut self.work.outcomes[switched..] {
            outcome.command.span = span;
        }
        for note in &mut self.work.notes.borrow_mut()[noted..] {
            note.place = at.place(span);
        }
        Ok(())
    }

    /// A macro whose code is not known may do anything (R2.51).
    fn lost_macro(&mut self, span: Span, name: &str, cause: &Arc<str>) -> Box<Fault> {
        self.forget_all(cause);
        let what = super::cause::unknown_value(cause);
        let message = format!(
            "what macro `{name}` does depends on {what}; whatever it could change is unknown from here on"
        );
        let fault = Fault::new(Code::Fc901, span, message);
        Box::new(fault.with_help(super::cause::how_to_set(cause)))
    }

    fn block_number(&mut self, block: &Block, at: &At<'_>) -> Option<i64> {
        let number = block.number.as_ref()?;
        let value = match &number.value {
            Operand::Number(number) => return rounded(*number),
            operand @ Operand::Expression(_) => self.value(*operand, block, at),
        };
        value
            .ok()
            .as_ref()
            .and_then(Value::number)
            .and_then(rounded)
    }

    /// Keeps the block in mind for FC310; it is not known beforehand whether M30 follows.
    fn remember_last(&mut self, at: &At<'_>) {
        if at.level > 0 {
            return;
        }
        match &mut self.state.last {
            Some(last) => {
                at.text.clone_into(&mut last.text);
                last.line = at.line;
            }
            None => {
                self.state.last = Some(Last {
                    file: at.file.clone(),
                    line: at.line,
                    text: at.text.to_owned(),
                });
            }
        }
    }
}

/// What a fault is about.
fn cause_of(fault: &Fault, at: &At<'_>) -> Arc<str> {
    fault.span.of(at.text).trim().into()
}

fn unquoted<'a>(span: Span, at: &At<'a>) -> &'a str {
    super::expression::unquoted(span.of(at.text))
}
