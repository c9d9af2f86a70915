//! The words and statements of a block, from left to right, and macros whose code limits what shares the block with them (R2.35).

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::block::{
    AfterError, BlockContext, BlockScratch, LonePart, MacroCode, ShownBlockLines, is_harmless,
    stops,
};
use crate::interpreter::executor::Executor;
use crate::interpreter::options::StopPolicy;
use crate::interpreter::values::expression::unquoted;
use crate::interpreter::values::location::Unknown;
use crate::interpreter::values::value::{Value, rounded};
use crate::interpreter::words::motion::AxisBracket;
use crate::language::{AxisWords, Plc};
use crate::syntax::ast::{Block, Flow, Item, Operand};
use crate::syntax::{FastPath, Fault, hash_name};
use crate::text::Span;

/// Messages about one block that are reported one by one (R2.85).
pub(crate) const MAX_SAID: usize = 1000;

impl Executor {
    /// Returns the first place of the block that the control would refuse; nothing to its right is executed there.
    pub(crate) fn first_refusal(&self, block: &Block) -> Option<u32> {
        if self.options.stop == StopPolicy::KeepGoing {
            return None;
        }
        block
            .faults
            .iter()
            .find(|fault| fault.code.severity() == crate::diagnostic::Severity::Error)
            .map(|fault| fault.span.start)
    }

    /// Adds the faults of the text, up to the first error if that stops the program.
    pub(crate) fn take_faults(&mut self, at: &BlockContext<'_>, stopped: bool) {
        let error = |diagnostic: &&Diagnostic| stops(diagnostic);
        let executed = self
            .scratch
            .messages
            .diagnostics
            .iter()
            .find(error)
            .map(|d| d.place.span.start);
        let limit = if stopped {
            let refused = self.first_refusal(at.block);
            match (executed, refused) {
                (Some(executed), Some(refused)) => executed.min(refused),
                (found, None) | (None, found) => found.unwrap_or(u32::MAX),
            }
        } else {
            u32::MAX
        };
        let harmless = &self.machine.harmless;
        for fault in at
            .block
            .faults
            .iter()
            .filter(|fault| fault.span.start <= limit && !is_harmless(harmless, fault, at.text))
        {
            self.scratch
                .messages
                .diagnostics
                .push(at.diagnostic(fault.clone()));
        }
    }

    pub(crate) fn items(&mut self, at: &BlockContext<'_>, limit: Option<u32>) {
        let mut limit = limit.unwrap_or(u32::MAX);
        for word in &at.block.words {
            if word.span.start >= limit && self.refuse_from(&mut limit, at).is_break() {
                return;
            }
            if self.plain_word(word) {
                continue;
            }
            self.scratch.has_plain_words = false;
            let done = self.word(word, at);
            if self.say(done, at).is_break() {
                return;
            }
        }
        for item in &at.block.items {
            if item.span().start >= limit && self.refuse_from(&mut limit, at).is_break() {
                return;
            }
            self.scratch.has_plain_words = false;
            let done = self.item(item, at);
            // After a statement that leads elsewhere, `$CASE 2 X10`, nothing is executed.
            let leaves = matches!(item, Item::Flow(flow, _) if !matches!(flow, Flow::Goto(_)))
                && self.scratch.actions.step.is_some();
            if self.say(done, at).is_break() || leaves {
                return;
            }
        }
    }

    /// Refuses the rest of the block, to the right of what the control refuses. `Break` where it stops there.
    #[cold]
    fn refuse_from(&mut self, limit: &mut u32, at: &BlockContext<'_>) -> ControlFlow<()> {
        if self.options.stop == StopPolicy::FirstError {
            return ControlFlow::Break(());
        }
        *limit = u32::MAX;
        self.fail(AfterError::Reset, at);
        ControlFlow::Continue(())
    }

    /// Reports the fault of a part of the block. `Break` where the control stops.
    #[inline]
    fn say(&mut self, done: Result<(), Box<Fault>>, at: &BlockContext<'_>) -> ControlFlow<()> {
        if let Err(fault) = done {
            self.scratch.complain(*fault, at);
        }
        if self.scratch.messages.diagnostics.is_empty() {
            return ControlFlow::Continue(());
        }
        self.fail_if_refused(at);
        if self.is_halted() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// Reports the number of messages about a block that are left out.
    pub(crate) fn say_unsaid(&mut self, at: &BlockContext<'_>) {
        if let Some((span, more)) = self.scratch.messages.unsaid.take() {
            let message = format!(
                "the first {MAX_SAID} messages about this block are shown; there are {more} more"
            );
            let fault = Fault::new(Code::Fc905, at.in_block(span), message);
            self.scratch.messages.diagnostics.push(at.diagnostic(fault));
        }
    }

    /// Returns whether the control stops at a message about the block.
    #[inline]
    pub(crate) fn is_halted(&self) -> bool {
        self.options.stop == StopPolicy::FirstError
            && self.scratch.messages.diagnostics.iter().any(stops)
    }

    #[inline(never)]
    pub(crate) fn item(&mut self, item: &Item, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        match item {
            Item::Word(word) => self.word(word, at),
            Item::Comp(command) => {
                self.comp(command, at);
                Ok(())
            }
            Item::Bracket {
                axis,
                keyword,
                command,
                arguments,
                spindle,
                span,
            } => {
                let (name, keyword) = (axis.of(at.text), keyword.of(at.text));
                self.scratch.read.plc_acts |= command.plc == Plc::Acts;
                let bracket = AxisBracket {
                    name,
                    command: *command,
                    arguments,
                    spindle,
                    span: *span,
                };
                self.bracket(bracket, at);
                self.move_by_bracket(bracket, at);
                self.pass_over(&format!("{name}[{keyword}]"), *span, at);
                Ok(())
            }
            Item::BareNumber(operand, span) => {
                let value = self.number(*operand, *span, at)?;
                if self.scratch.actions.axis_words != AxisWords::Motion {
                    self.scratch.moves.geometry().dwell = Some(value);
                    return Ok(());
                }
                let found = span.of(at.text);
                Err(Box::new(Fault::new(
                    Code::Fc207,
                    *span,
                    format!("`{found}` has no address"),
                )))
            }
            Item::Assign(assignment) => self.assign(*assignment, at),
            Item::Hash(hash) => self.hash(hash, at),
            Item::MacroDefinition(name, code) => {
                let (name, code) = (unquoted(name.of(at.text)), unquoted(code.of(at.text)));
                self.state.control.memory.define_macro(name, code);
                self.scratch.wrote = true;
                Ok(())
            }
            Item::GCall(call) => self.g_call(call, at),
            Item::Sequence(sequence) => self.sequence(sequence, at),
            Item::Return(back) => self.return_to(back, at),
            Item::Call(call) => {
                let wanted = self.wanted(call, at)?;
                self.scratch.actions.calls.extend(wanted);
                Ok(())
            }
            Item::Flow(flow, span) => {
                let condition = self.one_line_condition(flow, *span, at);
                let condition = condition.or_else(|fault| {
                    let cause = cause_of(&fault, at);
                    self.undecidable(*fault, at)?;
                    self.part_at_undecided_jump((cause, *span), at);
                    Ok::<_, Box<Fault>>(Some(false))
                })?;
                if condition.is_some() {
                    self.scratch.actions.condition = condition;
                    return Ok(());
                }
                if self.scratch.actions.condition == Some(false) {
                    return Ok(());
                }
                if matches!(flow, Flow::Goto(_)) && self.jump_is_probed(at) {
                    self.part_at_probe(*span, at);
                    return Ok(());
                }
                let step = self.flow(flow, *span, at);
                self.scratch.actions.step = step.or_else(|fault| {
                    let cause = cause_of(&fault, at);
                    self.undecidable(*fault, at)?;
                    self.pass_over_undecided(flow, (cause, *span), at);
                    Ok::<_, Box<Fault>>(None)
                })?;
                Ok(())
            }
            Item::MacroUse(span) => self.expand(*span, at),
            Item::Unread(_, span) if self.machine.harmless.has_command(span.of(at.text)) => {
                let (name, _) = hash_name(span.of(at.text));
                self.pass_over(&name, *span, at);
                Ok(())
            }
            Item::Unread(effect, span) => {
                self.havoc_unread(*effect, &Unknown::text(span.of(at.text)));
                Ok(())
            }
            Item::Label(_) | Item::BadCommand(_) => Ok(()),
        }
    }

    /// Reports a condition that cannot be computed: what depends on it is unknown, and is not reported again (R2.51,
    /// R2.71).
    fn undecidable(&mut self, fault: Fault, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        if self.options.stop == StopPolicy::FirstError {
            return Err(Box::new(fault));
        }
        self.scratch.complain(fault, at);
        self.scratch.read.unread.set(true);
        Ok(())
    }

    /// Executes the code of a macro in place of words, as a separate block (R2.35).
    fn expand(&mut self, span: Span, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        let name = unquoted(span.of(at.text));
        let code = match self.state.control.memory.macro_code(name) {
            Some(Value::Text(code)) => Arc::clone(code),
            Some(Value::Unknown(cause)) => {
                let cause = cause.clone();
                return Err(self.lost_macro(span, name, &cause, at));
            }
            Some(Value::Number(_)) | None => {
                let fault = Fault::new(Code::Fc207, span, format!("macro `{name}` is not defined"));
                return Err(Box::new(fault.with_help(format!(
                    "define it first, with `\"{name}\" = \"code\"`"
                ))));
            }
        };
        let depth = self.with_evaluator(at, |evaluator, _| {
            let macros = evaluator.macros.expand(&code, evaluator.work, span);
            macros.map(|macros| macros.depth)
        })?;
        let mut block = Block::default();
        let lines = crate::text::TextLines::new(&code);
        let _ = crate::syntax::BlockReader::new(lines, 1, FastPath::On).next(&mut block);
        let shown = ShownBlockLines::default();
        let code = MacroCode {
            text: &code,
            block: &block,
            depth,
        };
        let inner = at.in_macro(&code, span, &shown);
        let said = self.scratch.messages.diagnostics.len();
        let moved = self.scratch.moves.len();
        let (switched, noted) = (
            self.scratch.outcomes.len(),
            self.scratch.read.notes.borrow().len(),
        );
        let limit = self.first_refusal(&block);
        self.items(&inner, limit);
        let stopped = limit.is_some() && self.options.stop == StopPolicy::FirstError;
        self.take_faults(&inner, stopped);
        // Messages about the macro's code are shown where the macro is used.
        for diagnostic in &mut self.scratch.messages.diagnostics[said..] {
            diagnostic.place = at.place(span);
        }
        self.scratch.moves.show_at(moved, span);
        for outcome in &mut self.scratch.outcomes[switched..] {
            outcome.command.span = span;
        }
        for note in &mut self.scratch.read.notes.borrow_mut()[noted..] {
            note.place = at.place(span);
        }
        self.check_sharing(&code, span, at)
    }

    #[inline]
    pub(crate) fn block_number(&mut self, at: &BlockContext<'_>) -> Option<i64> {
        let number = at.block.number.as_ref()?;
        match number.value {
            Operand::Number(number) => rounded(number),
            operand @ Operand::Expression(_) => self.computed_number(operand, number.span, at),
        }
    }

    #[inline(never)]
    fn computed_number(
        &mut self,
        operand: Operand,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Option<i64> {
        self.scratch.has_plain_words = false;
        match self.number(operand, span, at) {
            Ok(value) => value.and_then(rounded),
            Err(fault) => {
                self.scratch.complain(*fault, at);
                None
            }
        }
    }
}

impl BlockScratch {
    #[cold]
    pub(crate) fn complain(&mut self, fault: Fault, at: &BlockContext<'_>) {
        if self.messages.diagnostics.len() < MAX_SAID
            || !self.messages.diagnostics.iter().any(stops)
        {
            self.messages.diagnostics.push(at.diagnostic(fault));
        } else {
            self.messages.unsaid.get_or_insert((fault.span, 0)).1 += 1;
        }
    }
}

/// Returns the text that a fault is about.
fn cause_of(fault: &Fault, at: &BlockContext<'_>) -> Unknown {
    Unknown::text(fault.span.of(at.text).trim())
}

impl Executor {
    /// Reports what shares the block with a macro and must not, or perhaps not.
    fn check_sharing(
        &mut self,
        code: &MacroCode<'_>,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        let inner = self.scratch.read.lone.take();
        let Some(lone) = LonePart::of(code).or(inner) else {
            return Ok(());
        };
        let Some(conflict) = lone.conflict(at.block, span) else {
            // The macro may be part of another one.
            self.scratch.read.lone = Some(lone).filter(|_| at.macro_depth > 0);
            return Ok(());
        };
        let name = unquoted(span.of(at.text));
        let shown = conflict.of(at.text).trim();
        let fault = if lone.leaves_rest_open() {
            self.havoc_by_call(&Unknown::text(shown));
            let what = lone.as_str();
            let message = format!(
                "`{shown}` is in the same block as {what} in the code of macro `{name}`; whether the control executes \
                 it is not known, and whatever it could change is unknown from here on"
            );
            Fault::new(Code::Fc210, conflict, message).with_help("write it in a separate block")
        } else {
            let message = format!(
                "`{shown}` follows a call in the code of macro `{name}`, where the control accepts nothing"
            );
            Fault::new(Code::Fc207, conflict, message)
                .with_help("write it before the macro, or in the next block")
        };
        Err(Box::new(fault))
    }

    /// Returns a macro with unknown code, which may do anything (R2.51).
    fn lost_macro(
        &mut self,
        span: Span,
        name: &str,
        cause: &Unknown,
        at: &BlockContext<'_>,
    ) -> Box<Fault> {
        self.havoc_by_call(cause);
        let what = cause.seen_from(at.file);
        let message = format!(
            "what macro `{name}` does depends on {what}; whatever it could change is unknown from here on"
        );
        let fault = Fault::new(Code::Fc901, span, message);
        Box::new(fault.with_help(cause.advice()))
    }
}
