//! Programs whose lines arrive one after another.
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
use crate::interpreter::executor::Executor;
use crate::interpreter::options::{RunOutcome, SourceMode, StopPolicy};
use crate::interpreter::programs::calls::{Finder, holds_program_end};
use crate::interpreter::programs::index::{
    Index, LabelName, ProgramId, never_run, no_block, not_a_program,
};
use crate::interpreter::stack::{ControlStep, NextBlock};
use crate::interpreter::values::value::rounded;
use crate::language::HashAction;
use crate::syntax::ast::{Block, CallScope, Item, Operand};
use crate::syntax::{BlockReader, RawBlock, Stretch, no_program};
use crate::text::{LineSource, SourceFile};

/// Progress of the program.
#[derive(Clone, Copy)]
enum ProgramStage {
    /// Nothing was read yet.
    Before,
    /// The program was announced by its `%` line.
    Announced,
    /// Its first block was met.
    Running,
    /// It ended, by the command given or where another program begins; what follows is only checked.
    Beyond(Option<EndedBy>),
}

impl ProgramStage {
    /// Another program of the file begins.
    fn beyond(self) -> Self {
        match self {
            Self::Beyond(_) => self,
            _ => Self::Beyond(None),
        }
    }
}

/// Progress of the program, and the messages on blocks after its end.
struct StreamProgress {
    stage: ProgramStage,
    notes: Collected,
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
        let none = Index::new(SourceFile::new("", ""), self.here.options.limits.nesting);
        self.here.programs.hold(none);
        let outcome = match no_program(lines.ahead()) {
            Some(what) => self.refuse_file(&file.into(), what, observer),
            None => self.run_lines(file, lines, finder, observer),
        };
        match outcome {
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
        let file: Arc<str> = file.into();
        let mut reader = BlockReader::new(lines, 1, self.here.options.fast_path);
        let mut block = std::mem::take(&mut self.here.scratch.block);
        let mut stage = ProgramStage::Before;
        let mut notes = Collected::default();
        let mut never_begun = None;
        while let Some(raw) = reader.next(&mut block) {
            if raw.stretch == Stretch::Block {
                notes.extend(never_begun.take().map(never_run));
            }
            // Both ways of a block that may be skipped are followed, with what comes after them (R14.1).
            if self.here.needs_text(&raw, &block) {
                let rest = self.take_rest(opening(&raw), file, &mut reader);
                return self.go_on_with(rest, StreamProgress { stage, notes }, finder, observer);
            }
            if let Stretch::Program { name, local } = raw.stretch {
                let faults = block.faults.drain(..);
                self.lost
                    .extend(faults.map(|fault| raw.opening_said(&file, fault)));
                if matches!(stage, ProgramStage::Before) {
                    stage = ProgramStage::Announced;
                    let name = Some(name.of(raw.text));
                    if self.here.announce(name, observer).is_break() {
                        return RunOutcome::Paused;
                    }
                    continue;
                }
                if let ProgramStage::Announced = stage {
                    stage = ProgramStage::Running;
                    self.lost.push(no_block(&file));
                    if let Some(outcome) = self.begin_lines(&file, finder, observer) {
                        return outcome;
                    }
                }
                // Another program of the file: never executed, as where the text is whole.
                if self.here.options.stop != StopPolicy::CheckAll {
                    break;
                }
                never_begun = (!local).then(|| raw.place(&file, name));
                stage = stage.beyond();
                continue;
            }
            match stage {
                ProgramStage::Running => {}
                ProgramStage::Beyond(_) => {
                    if !self.here.is_skipped(&block) {
                        self.here.check_unexecuted(&file, &raw, &block, &mut notes);
                    }
                    continue;
                }
                ProgramStage::Before | ProgramStage::Announced => {
                    if let Some(outcome) = self.begin_at(stage, &file, finder, observer) {
                        return outcome;
                    }
                    stage = ProgramStage::Running;
                }
            }
            if self.here.is_on_the_way(&block) {
                continue;
            }
            let shown = ShownBlockLines::default();
            let at = BlockContext::of_raw(&file, &raw, &block, &shown);
            if let Some(over) = self.here.over_budget(&at) {
                return self.ended(EndedBy::Budget, &one(over), observer);
            }
            if self.here.is_skipped(&block) {
                continue;
            }
            let step = match self.execute(&at, finder, observer) {
                ControlFlow::Continue(()) => continue,
                ControlFlow::Break(NextBlock::Step(step)) => step,
                ControlFlow::Break(NextBlock::Paused) => return RunOutcome::Paused,
            };
            let returns = matches!(step, ControlStep::Return);
            match self.others.follow(&mut self.here, step) {
                ControlFlow::Continue(()) => {
                    if let Some(outcome) = self.run_called(finder, observer) {
                        return outcome;
                    }
                }
                ControlFlow::Break(ended) => {
                    stage = ProgramStage::Beyond(Some(ended));
                    if returns {
                        let line = raw.line_after();
                        let rest = self.take_rest((String::new(), line), file, &mut reader);
                        let progress = StreamProgress { stage, notes };
                        return self.returned(rest, progress, finder, observer);
                    }
                    if self.here.options.stop != StopPolicy::CheckAll {
                        break;
                    }
                }
            }
        }
        if let ProgramStage::Before | ProgramStage::Announced = stage {
            self.lost.push(no_block(&file));
        }
        gather(&file, reader.lost_remarks(), u32::MAX, &mut self.lost);
        self.here.scratch.block = block;
        // A program without any block begins and ends here.
        let begun = self.begin_at(stage, &file, finder, observer);
        begun.unwrap_or_else(|| self.end_of_lines(stage, &notes, observer))
    }

    /// Ends the run at a file that is no program.
    fn refuse_file(
        &mut self,
        file: &Arc<str>,
        what: &str,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        match self.here.announce(None, observer) {
            ControlFlow::Break(()) => RunOutcome::Paused,
            ControlFlow::Continue(()) => {
                let said = one(not_a_program(file, what));
                self.ended(EndedBy::Error, &said, observer)
            }
        }
    }

    /// Begins a program that has not begun at its first block; an outcome when that is the end.
    fn begin_at(
        &mut self,
        stage: ProgramStage,
        file: &str,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> Option<RunOutcome> {
        match stage {
            ProgramStage::Before if self.here.announce(None, observer).is_break() => {
                Some(RunOutcome::Paused)
            }
            ProgramStage::Before | ProgramStage::Announced => {
                self.begin_lines(file, finder, observer)
            }
            ProgramStage::Running | ProgramStage::Beyond(_) => None,
        }
    }

    /// Enters the program that was announced and runs the one that comes before each; an outcome
    /// when that is the end.
    fn begin_lines(
        &mut self,
        file: &str,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> Option<RunOutcome> {
        self.here.enter(0, 0);
        match self.here.start_program(file, finder) {
            Ok(()) => self.run_called(finder, observer),
            Err(missing) => Some(self.ended(EndedBy::Error, &one(*missing), observer)),
        }
    }

    /// Runs called programs until their caller continues; `None` when it does.
    fn run_called(
        &mut self,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> Option<RunOutcome> {
        let frame = self.here.state.control.frames.running();
        if frame.is_none_or(|frame| frame.level == 0) {
            return None;
        }
        match self.run(finder, observer) {
            RunOutcome::Ended(EndedBy::EndOfFile) => None,
            RunOutcome::Ended(by) => {
                let mut notes = Collected::default();
                notes.extend(self.here.scratch.ending.over.drain(..));
                Some(self.ended(by, &notes, observer))
            }
            stopped @ (RunOutcome::Paused | RunOutcome::Stopped) => Some(stopped),
        }
    }

    /// Takes the rest of the text into memory and continues in it.
    fn go_on_with(
        &mut self,
        rest: SourceFile,
        progress: StreamProgress,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        let StreamProgress { stage, notes } = progress;
        if matches!(stage, ProgramStage::Before) {
            return self.whole(rest, finder, observer);
        }
        // The blocks so far come before the first one of the index, and so does the frame.
        let mut index = Index::new(rest, self.here.options.limits.nesting);
        index.main = Some(0);
        self.here.programs.hold_first(index);
        match stage {
            ProgramStage::Before | ProgramStage::Announced => self.begin(finder, observer),
            ProgramStage::Running if self.here.is_refused() => self.refuse(observer),
            ProgramStage::Running => {
                if let Some(awaited) = self.here.awaited.take() {
                    let found = self.here.programs.block_of(
                        ProgramId::FIRST,
                        &awaited.label,
                        &self.here.state.work,
                    );
                    match (found, self.here.state.control.frames.running_mut()) {
                        (Some(entry), Some(frame)) => frame.next = entry,
                        _ => return self.ended(EndedBy::Error, &one(awaited.missing), observer),
                    }
                }
                let outcome = self.run(finder, observer);
                self.close(outcome, observer)
            }
            ProgramStage::Beyond(_) => self.end_of_lines(stage, &notes, observer),
        }
    }

    /// Reads the remaining lines into memory, after a text; `first` is the number of its first line.
    fn take_rest<S: LineSource>(
        &mut self,
        (mut text, first): (String, u32),
        file: Arc<str>,
        reader: &mut BlockReader<S>,
    ) -> SourceFile {
        reader.append_rest(&mut text);
        gather(&file, reader.lost_remarks(), u32::MAX, &mut self.lost);
        SourceFile::new(file, text).from_line(first)
    }

    /// M17 ended the program; the rest is looked at only if all blocks are checked. FC310 if the program has M30
    /// farther down; a subprogram run by itself ends as it should.
    fn returned(
        &mut self,
        rest: SourceFile,
        mut progress: StreamProgress,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        let lines = rest.text().split_inclusive('\n');
        let own = lines.take_while(|line| !line.trim_start().starts_with('%'));
        let own: usize = own.map(str::len).sum();
        if !holds_program_end(&rest.text()[..own]) {
            self.here.state.last = None;
        }
        progress.notes.extend(self.here.state.missing_end());
        if self.here.options.stop == StopPolicy::CheckAll {
            self.go_on_with(rest, progress, finder, observer)
        } else {
            self.end_of_lines(progress.stage, &progress.notes, observer)
        }
    }

    /// Ends a program all of whose lines were read; `notes` are about blocks after its end.
    fn end_of_lines(
        &mut self,
        stage: ProgramStage,
        notes: &Collected,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        if let Some(awaited) = self.here.awaited.take() {
            return self.ended(EndedBy::Error, &one(awaited.missing), observer);
        }
        let mut said = self.here.programs.refused();
        let by = if let ProgramStage::Beyond(Some(by)) = stage {
            by
        } else {
            said.extend(self.here.state.missing_end());
            EndedBy::EndOfFile
        };
        said.append(notes);
        self.here.check_all_unexecuted(&mut said);
        self.ended(by, &said, observer)
    }
}

impl Executor {
    /// Whether a block can be executed only with the text after it.
    fn needs_text(&self, raw: &RawBlock<'_>, block: &Block) -> bool {
        self.undecided_level(block).is_some()
            || (!raw.plain && needs_rest(raw, block))
            || self.may_begin_without_feed(block)
    }

    /// Whether a block is passed over on the way to the one that M17 returned to.
    fn is_on_the_way(&mut self, block: &Block) -> bool {
        let Some(awaited) = &self.awaited else {
            return false;
        };
        let number = block.number.map(|number| number.value);
        let is_it = match (&awaited.label, number) {
            (LabelName::Number(wanted), Some(Operand::Number(number))) => {
                rounded(number) == Some(*wanted)
            }
            _ => false,
        };
        if is_it {
            self.awaited = None;
        }
        !is_it
    }
}

/// Whether a block can be reached again, or needs what follows it.
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

/// The text of a block with the remark above it, and the number of its first line.
fn opening(raw: &RawBlock<'_>) -> (String, u32) {
    match raw.remark {
        Some(remark) => (format!("{}\n{}\n", remark.text, raw.text), remark.line),
        None => (format!("{}\n", raw.text), raw.line),
    }
}
