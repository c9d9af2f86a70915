//! A main program whose lines arrive one after another.
//!
//! Straight blocks are executed and forgotten. A block that makes the rest of the text count, for
//! example a jump label or a `$` statement, is the first one that can be reached again: it and
//! everything after it is taken into memory, and the run continues there. Nothing ever goes back to
//! the forgotten blocks.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::diagnostic::Collected;
use crate::interpreter::block::{BlockContext, ShownBlockLines, one};
use crate::interpreter::drive::host::Interpreter;
use crate::interpreter::drive::program::gather;
use crate::interpreter::events::{EndedBy, Observer};
use crate::interpreter::executor::{Executor, RunState};
use crate::interpreter::options::{RunOutcome, SourceMode, StopPolicy};
use crate::interpreter::programs::calls::{Finder, holds_program_end};
use crate::interpreter::programs::index::{Index, ProgramId, no_block, not_a_program};
use crate::interpreter::stack::{AwaitedBlock, ControlStep};
use crate::interpreter::values::location::Unknown;
use crate::language::HashAction;
use crate::syntax::ast::{Block, CallScope, Item};
use crate::syntax::{BlockReader, FastPath, RawBlock, Stretch, no_program};
use crate::text::{LineSource, SourceFile};

/// The lines of the main program that were not taken into memory.
pub(crate) struct MainLines<'l> {
    pub(crate) file: Arc<str>,
    reader: BlockReader<&'l mut dyn LineSource>,
    /// The block read last.
    block: Block,
    /// Whether the program is still to be executed.
    is_due: bool,
    /// Whether the program has a block so far.
    has_block: bool,
}

impl<'l> MainLines<'l> {
    fn new(file: &str, lines: &'l mut dyn LineSource, fast_path: FastPath) -> Self {
        Self {
            file: file.into(),
            reader: BlockReader::new(lines, 1, fast_path),
            block: Block::default(),
            is_due: false,
            has_block: false,
        }
    }

    /// Reads up to the first block. Returns the name of the program if a `%` line comes before it.
    fn open(&mut self, lost: &mut Collected) -> Option<String> {
        let raw = self.reader.next(&mut self.block)?;
        let Stretch::Program { name, local: false } = raw.stretch else {
            self.is_due = true;
            return None;
        };
        lost.extend(raw.opening_said(&self.file, &self.block));
        let name = name.of(raw.text).to_owned();
        self.is_due = self.reader.next(&mut self.block).is_some();
        Some(name)
    }

    /// Returns whether the block that is due can be executed only with the text after it.
    fn need_memory(&self, here: &Executor) -> bool {
        self.is_due && here.needs_text(&self.reader.last(), &self.block)
    }

    /// Takes the rest of the text, from the block that is due on.
    fn into_rest(mut self, lost: &mut Collected) -> SourceFile {
        let due = self.is_due.then(|| self.reader.last());
        let (mut text, first) = match due.map(|raw| (raw, raw.remark)) {
            Some((raw, Some(remark))) => (format!("{}\n{}\n", remark.text, raw.text), remark.line),
            Some((raw, None)) => (format!("{}\n", raw.text), raw.line),
            None => (String::new(), self.reader.next_line()),
        };
        self.reader.append_rest(&mut text);
        gather(&self.file, self.reader.lost_remarks(), u32::MAX, lost);
        SourceFile::new(self.file, text).from_line(first)
    }

    /// Indexes that rest, which continues the main program.
    fn index_rest(self, nesting: u32, lost: &mut Collected) -> Index {
        let mut index = Index::new(self.into_rest(lost), nesting);
        index.main = Some(0);
        index
    }

    /// Hands over the messages on the lines beside the blocks.
    fn leave(self, lost: &mut Collected) {
        let due = self.is_due.then(|| self.reader.last());
        if let Some(opening) = due.filter(begins_another) {
            lost.extend(opening.opening_said(&self.file, &self.block));
        }
        gather(&self.file, self.reader.lost_remarks(), u32::MAX, lost);
    }
}

impl Interpreter {
    /// Runs a main program whose lines arrive one after another. Memory does not grow with its length
    /// until a block makes the rest count; from there on it is held in memory.
    ///
    /// Control blocks and labels are checked when the rest is read, whereas a program in memory is
    /// refused before its first block; [`crate::syntax::FlowScan`] tells which program may have any.
    /// An observer that stops it ends it: see [`RunOutcome::Stopped`].
    pub fn stream(
        &mut self,
        file: &str,
        lines: &mut dyn LineSource,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        self.start();
        self.source_mode = SourceMode::LineByLine;
        match self.run_lines(file, lines, finder, observer) {
            RunOutcome::Paused => RunOutcome::Stopped,
            outcome => outcome,
        }
    }

    fn run_lines(
        &mut self,
        file: &str,
        lines: &mut dyn LineSource,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        let nesting = self.here.options.limits.nesting;
        let none = Index::new(SourceFile::new("", ""), nesting);
        self.here.programs.hold(none);
        if let Some(what) = no_program(lines.ahead()) {
            if self.here.announce(None, observer).is_break() {
                return RunOutcome::Paused;
            }
            let said = one(not_a_program(&file.into(), what));
            return self.ended(EndedBy::Error, &said, observer);
        }
        let mut lines = MainLines::new(file, lines, self.here.options.fast_path);
        let name = lines.open(&mut self.lost);
        let needs_memory = lines.need_memory(&self.here);
        if needs_memory && name.is_none() {
            let rest = lines.into_rest(&mut self.lost);
            return self.whole(rest, finder, observer);
        }
        if self.here.announce(name.as_deref(), observer).is_break() {
            return RunOutcome::Paused;
        }
        let mut lines = Some(lines);
        if needs_memory {
            self.take_rest(&mut lines);
        }
        self.begin(lines, finder, observer)
    }

    /// Takes the lines that were not read into memory: the frame of the main program is before the first of them.
    pub(crate) fn take_rest(&mut self, lines: &mut Option<MainLines<'_>>) {
        if let Some(lines) = lines.take() {
            let index = lines.index_rest(self.here.options.limits.nesting, &mut self.lost);
            self.here.programs.hold_first(index);
        }
    }

    /// Executes the next block of the lines. Returns the step after it, where that is not the next block.
    #[inline]
    pub(crate) fn run_line(
        &mut self,
        lines: &mut Option<MainLines<'_>>,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> ControlFlow<RunOutcome> {
        let Some(MainLines {
            file,
            reader,
            block,
            is_due,
            has_block,
        }) = lines
        else {
            return ControlFlow::Continue(());
        };
        let raw = if std::mem::take(is_due) {
            Some(reader.last())
        } else {
            reader.next(block)
        };
        let begins_another = raw.as_ref().is_some_and(begins_another);
        let (false, Some(raw)) = (begins_another, raw) else {
            *is_due = begins_another;
            if !std::mem::replace(has_block, true) {
                self.lost.push(no_block(file));
            }
            return self.end_way(EndedBy::EndOfFile);
        };
        *has_block = true;
        if self.here.needs_text(&raw, block) {
            *is_due = true;
            self.take_rest(lines);
            return match self.here.end_by_refusal() {
                Some(by) => ControlFlow::Break(RunOutcome::Ended(by)),
                None => ControlFlow::Continue(()),
            };
        }
        if self.here.is_skipped(block) {
            return ControlFlow::Continue(());
        }
        let shown = ShownBlockLines::default();
        let at = BlockContext::of_raw(file, &raw, block, &shown);
        // No other way waits while a block of the main program is executed that nothing goes back to.
        self.run_block(&at, (false, 0), finder, observer)?;
        if let Some(ControlStep::Return) = self.here.state.parked {
            self.look_after_return(lines);
        }
        ControlFlow::Continue(())
    }

    /// Reports FC310 for a program that M17 ended if it has M30 farther down; a subprogram run by itself ends as it
    /// should.
    fn look_after_return(&mut self, lines: &mut Option<MainLines<'_>>) {
        let Some(lines) = lines.take() else {
            return;
        };
        let index = lines.index_rest(self.here.options.limits.nesting, &mut self.lost);
        if !holds_program_end(index.text_from(0, 0)) {
            self.here.state.last = None;
        }
        if self.here.options.stop == StopPolicy::CheckAll {
            self.here.programs.hold_first(index);
        }
    }

    /// Continues at the block to which a called program returned, or after the call where the block is not kept.
    pub(crate) fn go_to_awaited(
        &mut self,
        awaited: AwaitedBlock,
        lines: &mut Option<MainLines<'_>>,
    ) {
        self.take_rest(lines);
        let RunState { control, work, .. } = &mut self.here.state;
        let programs = &mut self.here.programs;
        let found = programs.block_of(ProgramId::FIRST, &awaited.label, work);
        if let (Some(entry), Some(frame)) = (found, control.frames.running_mut()) {
            frame.next = entry;
        } else {
            self.here.havoc_all(&Unknown::text("M17"));
            self.here.version += 1;
            self.others.joined.push(awaited.lost);
        }
    }

    /// Leaves the lines after the end of a run, which are looked at only if all blocks are checked.
    pub(crate) fn leave_lines(&mut self, mut lines: Option<MainLines<'_>>, outcome: RunOutcome) {
        let is_over = matches!(outcome, RunOutcome::Ended(by) if by != EndedBy::Budget);
        if is_over && self.here.options.stop == StopPolicy::CheckAll {
            self.take_rest(&mut lines);
        }
        if let Some(lines) = lines {
            lines.leave(&mut self.lost);
        }
    }
}

impl Executor {
    /// Returns whether a block can be executed only with the text after it.
    #[inline]
    fn needs_text(&self, raw: &RawBlock<'_>, block: &Block) -> bool {
        self.undecided_level(block).is_some()
            || (!raw.plain && needs_rest(raw, block))
            || self.may_begin_without_feed(block)
    }
}

/// Returns whether another program begins, which no run reaches.
fn begins_another(raw: &RawBlock<'_>) -> bool {
    matches!(raw.stretch, Stretch::Program { .. })
}

/// Returns whether a block can be reached again, or needs what follows it.
fn needs_rest(raw: &RawBlock<'_>, block: &Block) -> bool {
    match raw.stretch {
        Stretch::Program { local, .. } => local,
        Stretch::Block => {
            block.number.is_some_and(|number| number.label)
                || block.items.iter().any(|item| match item {
                    // A macro's code may be a jump or a call.
                    Item::Label(_) | Item::Flow(..) | Item::MacroUse(_) => true,
                    Item::Call(call) => call.scope == CallScope::Local,
                    Item::Sequence(sequence) => sequence.name.is_none(),
                    Item::Hash(hash) => hash.command.action == HashAction::RealTimeLoop,
                    _ => false,
                })
        }
    }
}
