//! The loop: it takes the path that is due, executes its block, and follows the step after it.

use std::ops::ControlFlow;

use crate::comp::{KindSet, State as CompState};
use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::block::{
    AfterError, BlockContext, LastBlock, OwnEnd, ShownBlockLines, ended_by, stops,
};
use crate::interpreter::control::OptionalSection;
use crate::interpreter::drive::host::Interpreter;
use crate::interpreter::drive::lines::MainLines;
use crate::interpreter::events::{BlockMove, EndedBy, Event, Executed, Joined, Observer};
use crate::interpreter::executor::{Executor, RunState};
use crate::interpreter::options::{RunOutcome, StopPolicy};
use crate::interpreter::programs::calls::Finder;
use crate::interpreter::programs::index::{EntryIndex, ProgramId};
use crate::interpreter::stack::{CallFrame, ControlStep, Destination, Request};
use crate::interpreter::values::location::Unknown;
use crate::interpreter::ways::history::{BlockSite, KindEffect};
use crate::interpreter::ways::path::RunTrack;
use crate::interpreter::ways::words::limit_to;
use crate::interpreter::words::questions::MAX_OPEN;
use crate::syntax::ast::{Block, Item};
use crate::syntax::{FastPath, Fault};
use crate::text::Span;

/// The block that is due.
enum DueBlock {
    /// A block of a file in memory.
    Indexed(usize, EntryIndex),
    /// The next one of the lines of the main program.
    Line,
    /// No block on this way: the run first goes on elsewhere.
    Elsewhere,
}

impl Interpreter {
    /// Executes blocks until the call stack is empty, the program ends, or the observer stops it.
    pub(crate) fn run(
        &mut self,
        lines: &mut Option<MainLines<'_>>,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> RunOutcome {
        loop {
            if let ControlFlow::Break(outcome) = self.advance(lines, finder, observer) {
                return outcome;
            }
        }
    }

    /// Executes the block that is due, and the step after it.
    #[inline]
    fn advance(
        &mut self,
        lines: &mut Option<MainLines<'_>>,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> ControlFlow<RunOutcome> {
        self.choose_way(finder, observer);
        match self.due_block(lines.is_some())? {
            DueBlock::Indexed(unit, next) => self.run_indexed(unit, next, finder, observer)?,
            DueBlock::Line => self.run_line(lines, finder, observer)?,
            DueBlock::Elsewhere => {}
        }
        match self.here.state.parked.take() {
            Some(step) => self.take_step(step, lines, observer),
            None => ControlFlow::Continue(()),
        }
    }

    /// Executes a block of a file in memory.
    fn run_indexed(
        &mut self,
        unit: usize,
        next: EntryIndex,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> ControlFlow<RunOutcome> {
        let is_repeated = self.here.programs.was_read(unit, next);
        let parsed = self.here.programs.parsed(unit, next);
        if let Some(frame) = self.here.state.control.frames.running_mut() {
            frame.next = next + 1;
        }
        if self.here.is_skipped(&parsed.block) {
            self.here.seek_beyond(unit, next);
            return ControlFlow::Continue(());
        }
        let level = self.here.state.control.frames.level();
        let shown = ShownBlockLines::default();
        let mut at = BlockContext::of_parsed(&parsed, level, &shown);
        if let Some(skip) = self.here.undecided_level(&parsed.block)
            && self.here.part_by_skip(skip, &parsed)
        {
            let flow = if self.here.offered.is_empty() {
                ControlFlow::Continue(())
            } else {
                self.here.offer_skip(&at, observer)
            };
            if let Some(frame) = self.here.state.control.frames.running_mut() {
                frame.next = next;
            }
            self.others.take_sides(&mut self.here, None, finder);
            return flow.map_break(|()| RunOutcome::Paused);
        }
        let frames = &mut self.here.state.control.frames;
        let depth = frames.depth();
        let caller = |frame: &mut CallFrame| frame.called_from.take();
        let called_from = frames.running_mut().and_then(caller);
        at.called_from = called_from.as_deref();
        let flow = self.run_block(&at, (is_repeated, parsed.weight), finder, observer);
        if called_from.is_some()
            && let Some(frame) = self.here.state.control.frames.at_depth_mut(depth)
        {
            frame.called_from = called_from;
        }
        flow
    }

    /// Executes a block, unless a budget is used up, and parts the run after it.
    #[inline]
    pub(crate) fn run_block(
        &mut self,
        at: &BlockContext<'_>,
        (is_repeated, weight): (bool, u64),
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> ControlFlow<RunOutcome> {
        if let Some(over) = self.here.over_budget(at) {
            let over = self.here.with_loop(over);
            self.here.scratch.ending.over.push(over);
            return self.end_way(EndedBy::Budget);
        }
        let spent = self.here.state.work.spent();
        let is_on_ways = !self.others.waiting.is_empty();
        let flow = self.execute(at, finder, observer);
        if is_repeated {
            self.here
                .state
                .work
                .repeat(weight, self.here.scratch.messages.said, spent);
        } else {
            self.here.state.work.grant_ways();
        }
        if is_on_ways {
            self.here.charge_block(weight);
        }
        if !self.here.sides.is_empty() {
            let step = self.here.state.parked.take();
            self.here.state.parked = self.part_and_step(step, finder);
        }
        flow.map_break(|()| RunOutcome::Paused)
    }

    /// Ends the way. Another one goes on if there is one.
    pub(crate) fn end_way(&mut self, by: EndedBy) -> ControlFlow<RunOutcome> {
        match self.others.end_path(&mut self.here, by) {
            Some(by) => ControlFlow::Break(RunOutcome::Ended(by)),
            None => ControlFlow::Continue(()),
        }
    }

    /// Returns the next block of the running program, `Break` where the last way ends.
    #[inline]
    fn due_block(&mut self, has_lines: bool) -> ControlFlow<RunOutcome, DueBlock> {
        let Some(frame) = self.here.state.control.frames.running() else {
            let ending = self.here.state.control.ending.take();
            self.end_way(ending.unwrap_or(EndedBy::EndOfFile))?;
            return ControlFlow::Continue(DueBlock::Elsewhere);
        };
        let (unit, section, next) = (frame.unit, frame.section, frame.next);
        let (passage, level) = (frame.passage, frame.level);
        if !frame.waiting.is_empty() {
            if let ControlFlow::Break(by) = self.others.call_waiting(&mut self.here) {
                self.end_way(by)?;
            }
            return ControlFlow::Continue(DueBlock::Elsewhere);
        }
        if has_lines && level == 0 {
            return ControlFlow::Continue(DueBlock::Line);
        }
        let is_past = next >= self.here.programs.section(ProgramId { unit, section }).end;
        if is_past && frame.seeking.is_some() && self.here.ends_in_open_if() {
            self.end_way(EndedBy::Error)?;
            return ControlFlow::Continue(DueBlock::Elsewhere);
        }
        if is_past || passage.is_some_and(|passage| next > passage.last) {
            if level == 0 {
                self.end_way(EndedBy::EndOfFile)?;
            } else {
                self.others.end_of_pass(&mut self.here);
            }
            return ControlFlow::Continue(DueBlock::Elsewhere);
        }
        if !self.others.loop_heads.is_empty() && self.others.enters_covered(&mut self.here, next) {
            self.here.scratch.ending.covered = true;
            self.end_way(EndedBy::EndOfFile)?;
            return ControlFlow::Continue(DueBlock::Elsewhere);
        }
        ControlFlow::Continue(DueBlock::Indexed(unit, next))
    }

    /// Continues on the way whose block comes first in the text; past their budget, all ways are joined.
    #[inline]
    fn choose_way(&mut self, finder: &mut dyn Finder, observer: &mut dyn Observer) {
        if !self.others.waiting.is_empty() && self.others.choose_path(&mut self.here) {
            self.here.tell_joined(observer);
        }
        if self.others.waiting.len() > MAX_OPEN {
            self.others.join_waiting(&mut self.here);
        }
        if self.others.is_past_ways(&self.here) {
            self.others.widen(&mut self.here, finder);
            self.here.tell_joined(observer);
        }
        let is_alone = self.others.waiting.is_empty();
        self.here.is_alone = is_alone;
        let RunState { track, control, .. } = &mut self.here.state;
        track.follow_again(&control.frames, is_alone);
    }

    /// Executes a step. `Break` if it is the last one of the last way.
    pub(crate) fn take_step(
        &mut self,
        mut step: ControlStep,
        lines: &mut Option<MainLines<'_>>,
        observer: &mut dyn Observer,
    ) -> ControlFlow<RunOutcome> {
        let awaited = match &mut step {
            ControlStep::ReturnTo(destination) => destination.awaited.take(),
            _ => None,
        };
        if let ControlFlow::Break(by) = self.others.follow(&mut self.here, step) {
            return self.end_way(by);
        }
        if let Some(awaited) = awaited {
            self.go_to_awaited(*awaited, lines);
            self.here.tell_joined(observer);
        }
        ControlFlow::Continue(())
    }

    /// Parts the run after a block that asked. Returns the remaining step, which is that of the way on which no jump is
    /// taken.
    fn part_and_step(
        &mut self,
        step: Option<ControlStep>,
        finder: &mut dyn Finder,
    ) -> Option<ControlStep> {
        match step {
            None | Some(ControlStep::Call(_)) => {
                self.others
                    .take_sides(&mut self.here, step.as_ref(), finder);
                None
            }
            Some(ControlStep::Covered) => {
                // An error ends the block on all ways.
                self.here.sides.clear();
                step
            }
            _ if self.here.is_jump_chosen() => {
                self.others.take_sides(&mut self.here, None, finder);
                None
            }
            step => {
                self.others.take_jumps(&mut self.here, finder);
                step
            }
        }
    }

    /// Executes a block and informs the observer; `Break` if that stops the run. The step after the block is then due,
    /// where that is not the next block.
    pub(crate) fn execute(
        &mut self,
        at: &BlockContext<'_>,
        finder: &mut dyn Finder,
        observer: &mut dyn Observer,
    ) -> ControlFlow<()> {
        let first = self.begin_block(at);
        let number = self.here.block_number(at);
        self.here.read(at);
        let is_alone = self.others.waiting.is_empty();
        let is_done = is_alone && self.here.is_done(at);
        let stopped = if is_done {
            self.here.move_on(at);
            false
        } else {
            self.act(first, at, finder)
        };
        let flow = if self.here.state.track.is_shadow() {
            self.here.note_moves_of_shadow();
            ControlFlow::Continue(())
        } else {
            self.note_lone_motion();
            let is_quiet = is_done || (is_alone && !stopped && self.here.is_quiet());
            if is_quiet && !observer.takes_quiet(&self.here.moved(at)) {
                ControlFlow::Continue(())
            } else {
                self.here.raise(number, stopped, at, observer)
            }
        };
        self.here.scratch.clear_said();
        flow
    }

    /// Executes what the words of a block ask for beyond a motion and values. Returns whether an error of the control
    /// stops the run at it.
    #[inline(never)]
    fn act(&mut self, first: usize, at: &BlockContext<'_>, finder: &mut dyn Finder) -> bool {
        self.here.scratch.has_plain_words = false;
        let calls = self.pass_over_and_call(at, finder);
        let stopped = self.here.judge(at);
        let is_over = self.here.account(at);
        let here = &mut self.here;
        here.state.parked = match here.step(calls, (is_over, stopped), at, finder) {
            // A return to an earlier block repeats what is between them, as a jump does.
            Some(ControlStep::ReturnTo(Destination {
                level,
                entry: Some(target),
                awaited: None,
            })) if here.sides.is_empty() => {
                self.others.go_back(here, &Destination::after_call(level));
                Some(self.others.jump(here, target, finder))
            }
            Some(ControlStep::Jump(target)) => Some(self.others.jump(here, target, finder)),
            Some(ControlStep::End(EndedBy::Error)) => Some(here.end_by_error(at)),
            step => step,
        };
        self.here.limit_messages(first);
        self.here.note_doubts(at);
        stopped
    }

    /// Begins a block: reports what joining ways leave, and counts the block. Returns the number of
    /// messages.
    #[inline]
    fn begin_block(&mut self, at: &BlockContext<'_>) -> usize {
        self.here.scratch.clear();
        let are_told = self.others.joined.is_empty() && self.others.joined_withheld.is_empty();
        if !(are_told || self.here.state.track.is_shadow()) {
            let scratch = &mut self.here.scratch;
            let said = &mut scratch.messages.diagnostics;
            said.append(&mut self.others.joined);
            let withheld = &mut scratch.aside.withheld;
            withheld.append(&mut self.others.joined_withheld);
        }
        if !self.here.state.track.shadow.moved.is_empty() && !self.here.state.track.is_shadow() {
            self.here.take_moves_of_shadows();
        }
        let first = self.here.scratch.messages.diagnostics.len();
        self.here.state.seq += 1;
        self.here.state.blocks += 1;
        if self.here.state.track.searching.is_some() {
            self.here.scratch.has_plain_words = false;
            self.here.search(at);
        }
        first
    }

    /// Makes unknown what the block passes over, and finds the programs that it calls.
    #[inline]
    fn pass_over_and_call(
        &mut self,
        at: &BlockContext<'_>,
        finder: &mut dyn Finder,
    ) -> Vec<Request> {
        self.here.pass_over_parts(finder);
        self.others.let_leave(&mut self.here);
        let mut calls = Vec::new();
        let actions = &mut self.here.scratch.actions;
        if !actions.calls.is_empty() && actions.goes_on() {
            let wanted = std::mem::take(&mut actions.calls);
            calls = self.here.resolve_all(wanted, at, finder);
            if !self.others.waiting.is_empty() {
                calls = self
                    .others
                    .without_open_recursion(&mut self.here, calls, at, finder);
            }
        } else if !actions.calls.is_empty() {
            self.here.pass_over_calls(at);
        }
        if let Some(name) = self.here.scratch.actions.looks_for.take() {
            self.here.look_for_file(name, at, finder);
        }
        if self.here.scratch.read.plc_acts {
            self.here.let_plc_act();
        }
        calls
    }

    /// Notes whether the motion of the block is that of one way only.
    #[inline]
    fn note_lone_motion(&mut self) {
        let here = &mut self.here;
        if here.options.takes_motions() && here.scratch.moves.motion().is_some() {
            let is_alone = self.others.waiting.is_empty() && here.state.ended.is_empty();
            here.state.track.shadow.moves_alone |= !is_alone;
        }
    }
}

impl Executor {
    /// Announces the states before the next block, where they are not those after the last one.
    #[cold]
    fn tell_joined(&mut self, observer: &mut dyn Observer) {
        let Some(frame) = self.state.control.frames.running() else {
            return;
        };
        if self.state.track.is_shadow() {
            return;
        }
        let place = self.programs.index(frame.unit).block_place(frame.next);
        self.show_ways();
        // A run stops at blocks: a request to stop takes effect at the next one.
        let _ = observer.event(Event::Joined(Joined {
            seq: self.state.seq,
            place: &place,
            compensation: &self.state.control.compensation,
            possible: &self.shown.possible,
            occurred: &self.state.occurred,
            version: self.version,
        }));
    }

    /// Looks for a branch beyond the part of a control block at an entry, which is skipped.
    fn seek_beyond(&mut self, unit: usize, entry: EntryIndex) {
        let links = self.programs.index(unit).links(entry);
        if let Some(frame) = self.state.control.frames.running_mut()
            && frame.seeking.is_some()
        {
            if links.next == entry {
                frame.seeking = None;
            } else {
                frame.next = links.next;
            }
        }
    }
}

/// Returns whether the control only computes, branches or switches.
fn is_still(item: &Item) -> bool {
    matches!(
        item,
        Item::Comp(_) | Item::Assign(_) | Item::Label(_) | Item::Flow(..)
    )
}

impl Executor {
    /// Executes the words of a block and looks at its motion.
    #[inline]
    fn read(&mut self, at: &BlockContext<'_>) {
        if let Some(level) = self.undecided_level(at.block) {
            let whole = Span::new(0, at.text.trim_end().len());
            self.scratch.has_plain_words = false;
            self.pass_over_part(Unknown::SkipLevel(level), whole, at);
        } else if !self.is_halted() {
            self.remembered_items(at);
        }
        self.look_at_motion(at);
        self.outdate_readings(at);
    }

    /// Returns whether an error of the control stops the run at the block; else its axes move.
    #[inline]
    fn judge(&mut self, at: &BlockContext<'_>) -> bool {
        let said = &self.scratch.messages.diagnostics;
        let refused = self.first_refusal(at.block).is_some() || said.iter().any(stops);
        let stopped = refused && self.options.stop == StopPolicy::FirstError;
        if refused {
            self.fail(AfterError::Reset, at);
        }
        if !at.block.faults.is_empty() {
            self.take_faults(at, stopped);
        }
        if stopped {
            self.scratch.moves.stop();
        } else {
            self.move_axes(at);
        }
        stopped
    }

    /// Checks the motion of the axes of a block: the axes that move with its words, and whether
    /// each may.
    #[inline]
    fn look_at_motion(&mut self, at: &BlockContext<'_>) {
        let words = self.scratch.actions.axis_words;
        if self.scratch.moves.has_repeated() {
            self.refuse_repeated_axes(words, at);
        }
        if self.scratch.moves.lacks_axes() {
            self.say_lacking(words, at);
        }
        self.check_words(at);
        self.move_around(words);
        self.check_feed(at);
        self.carry_along(words);
        if !self.scratch.outcomes.is_empty() {
            self.note_command_with_motion();
        }
        if self.any_required && self.state.control.described.is_none() {
            let goes_on = !self.scratch.messages.diagnostics.iter().any(stops);
            if goes_on || self.options.stop != StopPolicy::FirstError {
                self.check_required(words, at);
            }
        }
    }

    /// Remembers the axes that a shadow moves.
    #[cold]
    fn note_moves_of_shadow(&mut self) {
        let axes = self.scratch.moves.axes();
        self.state.track.shadow.moved.extend(axes);
    }

    /// Makes the position of the axes unknown that shadows moved.
    #[cold]
    fn take_moves_of_shadows(&mut self) {
        for axis in std::mem::take(&mut self.state.track.shadow.moved) {
            self.state.control.modal.havoc_position(axis);
            self.scratch.moves.perhaps_move(axis);
        }
    }

    /// Returns whether the block only computes, or moves axes that have moved before, and nothing else is due after it.
    #[inline]
    fn is_done(&self, at: &BlockContext<'_>) -> bool {
        self.options.fast_path == FastPath::On
            && self.scratch.is_done()
            && at.block.faults.is_empty()
            && self.sides.is_empty()
            && !self.scratch.new_axes
            && !self.state.track.is_shadow()
            && self.state.track.searching.is_none()
            && self.state.control.cycles.is_empty()
            && self.is_within_budgets()
    }

    /// Returns whether a block of the only way switches nothing, nothing is said on it, and its axes have moved before.
    #[inline]
    fn is_quiet(&self) -> bool {
        self.scratch.is_quiet() && !self.scratch.new_axes && self.state.track.searching.is_none()
    }

    /// Moves the axes of a block that does no more than that and compute.
    #[inline]
    fn move_on(&mut self, at: &BlockContext<'_>) {
        self.move_axes(at);
        debug_assert!(self.scratch.asks_for_nothing(), "{}", at.text);
        self.state.work.grant(at.text);
        self.state.remember_last(at);
        self.show_ways();
        self.scratch.messages.said = 0;
    }

    #[inline]
    fn moved<'a>(&'a self, at: &BlockContext<'a>) -> BlockMove<'a> {
        BlockMove {
            comments: at.comments,
            remark: at.remark,
            moves: &self.scratch.moves,
            branch: self.shown.branch.as_deref(),
            compensation: &self.state.control.compensation,
            modal: &self.state.control.modal,
            version: self.version,
        }
    }

    /// Returns whether no budget is used up.
    #[inline]
    fn is_within_budgets(&self) -> bool {
        !(self.scratch.wrote && self.holds_too_many_values())
            && self.scratch.messages.unsaid.is_none()
            && self.state.work.level() <= self.options.limits.work
            && self.state.work.ways() <= self.options.limits.ways
    }

    /// Informs the observer of a block.
    #[inline]
    fn raise(
        &mut self,
        number: Option<i64>,
        stopped: bool,
        at: &BlockContext<'_>,
        observer: &mut dyn Observer,
    ) -> ControlFlow<()> {
        let (scratch, state) = (&mut self.scratch, &self.state);
        let moves = &scratch.moves;
        observer.event(Event::Executed(Executed {
            seq: state.seq,
            file: at.file,
            line: at.line,
            text: at.text,
            comments: at.comments,
            remark: at.remark,
            number,
            level: (at.level > 0).then_some(at.level),
            block: at.block,
            outcomes: &scratch.outcomes,
            changes: &scratch.changes,
            doubted: &scratch.doubted,
            moved: moves.words(),
            moves,
            aside: &scratch.aside,
            also_moved: moves.also_moved(),
            word_motion: moves.row().map(|row| row.kind),
            motion: moves.motion(),
            notes: scratch.read.notes.get_mut(),
            diagnostics: &scratch.messages.diagnostics,
            stopped,
            passed: state.track.searching.is_some(),
            compensation: &state.control.compensation,
            possible: &self.shown.possible,
            found: state.found_states(),
            failed: state.track.failed.as_deref(),
            branch: self.shown.branch.as_deref(),
            modal: &state.control.modal,
            occurred: &state.occurred,
            version: self.version,
        }))
    }

    /// Informs the observer of a block with a skip mark that it may decide on.
    #[cold]
    fn offer_skip(
        &mut self,
        at: &BlockContext<'_>,
        observer: &mut dyn Observer,
    ) -> ControlFlow<()> {
        self.state.seq += 1;
        self.state.blocks += 1;
        let number = self.block_number(at);
        self.raise(number, false, at, observer)
    }

    /// Accounts for the work and the changes of a block. Returns whether the program is over.
    #[inline]
    fn account(&mut self, at: &BlockContext<'_>) -> bool {
        self.state.work.grant(at.text);
        let is_over = !self.is_within_budgets() && self.settle(at);
        let scratch = &self.scratch;
        if !scratch.changes.is_empty() || scratch.new_axes || scratch.left_open.is_some() {
            self.version += 1;
            self.close_changed();
        }
        if let Some(earlier) = self.scratch.earlier.take()
            && let OptionalSection::Asked(condition) = self.state.control.optional
        {
            self.join_earlier(condition, &earlier);
        }
        self.state.remember_last(at);
        self.scratch.gather_asked();
        is_over
    }

    /// Ends the way at an error of the control.
    #[cold]
    fn end_by_error(&mut self, at: &BlockContext<'_>) -> ControlStep {
        let after = std::mem::take(&mut self.scratch.ending.after_error);
        let ways = self.state.track.reach.clone();
        self.stop_on(&ways, after, at);
        ControlStep::Covered
    }

    /// Limits the messages of the block to the ways on which they apply, except the first ones, which are
    /// about ways that meet (R14.5).
    #[inline]
    fn limit_messages(&mut self, first: usize) {
        self.show_ways();
        if let Some(ways) = &self.shown.branch {
            let own = self.scratch.messages.diagnostics.iter_mut().skip(first);
            own.for_each(|said| limit_to(said, ways));
        }
        let work = &mut self.scratch.messages;
        work.diagnostics.append(&mut work.of_some_ways);
    }

    /// Invalidates values that the machine may change between the questions of blocks.
    #[inline]
    fn outdate_readings(&mut self, at: &BlockContext<'_>) {
        if !self.state.track.readings.is_empty() {
            self.state.track.outdate_readings(at.block);
        }
    }

    /// Finishes a block that did more than move: reports the number of messages left out and a budget
    /// that is used up. Returns whether one is.
    #[inline(never)]
    fn settle(&mut self, at: &BlockContext<'_>) -> bool {
        self.say_unsaid(at);
        let Some(over) = self.used_up(at) else {
            return false;
        };
        // The faults of the parts that were given up add nothing to it.
        let is_part = |said: &Diagnostic| said.code == Code::Fc919;
        self.scratch
            .messages
            .diagnostics
            .retain(|said| !is_part(said));
        self.scratch.messages.diagnostics.push(over);
        true
    }

    /// Returns the next step of the control, where that is not the next block.
    #[inline(never)]
    fn step(
        &mut self,
        calls: Vec<Request>,
        (is_over, stopped): (bool, bool),
        at: &BlockContext<'_>,
        finder: &mut dyn Finder,
    ) -> Option<ControlStep> {
        if is_over || self.scratch.ending.too_deep {
            return Some(ControlStep::End(EndedBy::Budget));
        }
        if stopped {
            let by = ended_by(&self.scratch.messages.diagnostics);
            return Some(ControlStep::End(by));
        }
        let goes_on = calls.is_empty() && self.scratch.actions.goes_on();
        if goes_on && self.state.control.cycles.is_empty() {
            return None;
        }
        let moved = !self.scratch.moves.words().is_empty();
        if !calls.is_empty() {
            self.scratch.actions.step = Some(ControlStep::Call(calls));
        }
        if let Some(by) = self.scratch.actions.end {
            if self.state.control.ending.is_none() && at.level > 0 {
                let fault = Fault::new(
                    Code::Fc315,
                    Span::new(0, at.text.len()),
                    "a program end inside a subprogram ends the whole run",
                )
                .with_help("end a subprogram with `M17` or `M29`");
                self.scratch.messages.diagnostics.push(at.diagnostic(fault));
            }
            if at.used.is_none() && self.state.control.ending.is_none() {
                self.scratch.ending.at = Some(OwnEnd {
                    place: at.place(Span::new(0, at.text.len())),
                    is_passed_into: !self.position().may_be_jumped_to(at),
                });
            }
            return Some(self.program_end(by, at, finder));
        }
        if self.scratch.actions.returns {
            return Some(ControlStep::Return);
        }
        let step = self.scratch.actions.step.take();
        if step.is_none() || matches!(step, Some(ControlStep::Call(_))) {
            return self.repetition(step, moved, at, finder);
        }
        step
    }

    /// Executes the items of a block. Its commands are then the last ones on the way, each at the place where it is
    /// written or used as a macro.
    fn remembered_items(&mut self, at: &BlockContext<'_>) {
        let limit = self.first_refusal(at.block);
        self.items(at, limit);
        for outcome in &mut self.scratch.outcomes {
            let Ok(axis) = outcome.result else {
                continue;
            };
            let (command, history) = (&outcome.command, &mut self.state.control.history);
            outcome.repeated = history.repeated(axis, command.selection, &self.state.track.reach);
            let site = BlockSite {
                seq: self.state.seq,
                place: at.place(command.span),
            };
            history.switch(axis, command.selection, site);
        }
        if let Some(cause) = self.scratch.read.unknown_call.take() {
            self.havoc_all(&cause);
        }
    }

    /// Drops the sets of states that a change by the block has decided.
    fn close_changed(&mut self) {
        let history = &mut self.state.control.history;
        for change in &self.scratch.changes {
            history.close(change.axis, KindSet::of(change.kind));
        }
        if let Some(left) = self.scratch.left_open.take() {
            self.leave_open(&left);
        }
    }

    /// Records what the block, or what it calls, may have switched without a command.
    #[inline]
    fn note_doubts(&mut self, at: &BlockContext<'_>) {
        if self.scratch.changes.is_empty() && self.scratch.doubted.is_empty() {
            return;
        }
        let history = &mut self.state.control.history;
        let seq = self.state.seq;
        let site = || BlockSite {
            seq,
            place: at.place(Span::new(0, at.text.len())),
        };
        let lost = self.scratch.changes.iter();
        for change in lost.filter(|change| change.to == CompState::Unknown) {
            let kinds = KindSet::of(change.kind);
            history.doubt((change.axis, kinds), KindEffect::Lost, site());
        }
        for doubted in &self.scratch.doubted {
            history.doubt(*doubted, KindEffect::Doubted, site());
        }
    }
}

impl RunState {
    /// Remembers the block for FC310; it is not known beforehand whether M30 follows.
    #[inline]
    fn remember_last(&mut self, at: &BlockContext<'_>) {
        if at.level > 0 {
            return;
        }
        let last = self.last.get_or_insert_with(|| LastBlock {
            file: at.file.clone(),
            line: at.line,
            text: String::new(),
        });
        at.text.clone_into(&mut last.text);
        last.line = at.line;
    }
}

impl RunTrack {
    /// Drops readings that an action of the control may change; a `#` command may wait for any
    /// value (R14.1).
    #[cold]
    fn outdate_readings(&mut self, block: &Block) {
        let readings = &mut self.readings;
        let mut items = block.items.iter();
        if items.clone().any(|item| matches!(item, Item::Hash(_))) {
            readings.clear();
        } else if !block.words.is_empty() || !items.all(is_still) {
            readings.act();
        }
    }
}
