//! The budgets of a run (R2.60), and ways that are too many to follow (R9.91, R14.4).
//!
//! Each way that only the machine decides costs work, and loops and calls multiply it. Past the budget every way is taken to
//! the end of the outermost control block of the main program that any of them is in. Nothing of it is executed any more:
//! whatever its blocks, and those of the programs that it calls, could change is unknown (R2.51). The program continues
//! there, with a quarter of the budget for its ways.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::diagnostic::{Advice, Budget, Code, Diagnostic, Severity};
use crate::interpreter::block::{BlockContext, LastBlock};
use crate::interpreter::control::ControlState;
use crate::interpreter::executor::Executor;
use crate::interpreter::programs::calls::Finder;
use crate::interpreter::programs::index::{EntryIndex, Index, ProgramId};
use crate::interpreter::values::location::Unknown;
use crate::interpreter::ways::others::OtherPaths;
use crate::interpreter::ways::path::Path;
use crate::interpreter::ways::set::WaySet;
use crate::interpreter::words::questions::MAX_OPEN;
use crate::syntax::Fault;
use crate::text::Span;

impl Executor {
    /// Returns FC910 when the next block may not be executed any more.
    #[inline]
    pub(crate) fn over_budget(&self, at: &BlockContext<'_>) -> Option<Diagnostic> {
        let limits = &self.options.limits;
        if self.state.blocks >= limits.blocks {
            return Some(too_many_blocks(limits.blocks, at));
        }
        let is_over = self.state.work.repeated() > limits.repeats;
        is_over.then(|| too_many_repeats(self.state.blocks, at))
    }

    /// Returns FC919, FC908 or FC918 when the block exceeded a budget. Whatever else it could have changed is then
    /// unknown: the run did not reach its end.
    pub(crate) fn used_up(&mut self, at: &BlockContext<'_>) -> Option<Diagnostic> {
        if self.is_past_all_ways() {
            self.havoc_all(&Unknown::Work);
            return Some(too_much_to_follow(at));
        }
        if self.state.work.level() > self.options.limits.work && self.is_exhausted() {
            self.havoc_all(&Unknown::Work);
            return Some(self.too_much_work(at));
        }
        let is_over = self.scratch.wrote && self.holds_too_many_values();
        is_over.then(|| too_many_values(self.options.limits.values, at))
    }

    /// Returns whether variables and couplings hold more than their budget.
    pub(crate) fn holds_too_many_values(&self) -> bool {
        let control = &self.state.control;
        let held = control
            .memory
            .weight()
            .saturating_add(control.couplings.len());
        u32::try_from(held).map_or(true, |held| held > self.options.limits.values)
    }

    #[cold]
    fn too_much_work(&self, at: &BlockContext<'_>) -> Diagnostic {
        let budget = self.options.limits.work;
        let fault = Fault::new(
            Code::Fc919,
            Span::new(0, at.text.len()),
            format!("this block made more than {budget} units of work beyond its own text"),
        )
        .with_help(Advice::RaiseBudget(Budget::Work));
        self.with_loop(at.diagnostic(fault))
    }

    /// Returns the budget's message with the loop that used it up.
    pub(crate) fn with_loop(&self, diagnostic: Diagnostic) -> Diagnostic {
        let Some(frame) = self.state.control.frames.running() else {
            return diagnostic;
        };
        let index = self.programs.index(frame.unit);
        let Some(opener) = index.innermost_loop(frame.next.saturating_sub(1)) else {
            return diagnostic;
        };
        let passes = match self.state.track.passes(frame.unit, opener) {
            Some(passes) => format!("in this loop, after {passes} passes"),
            None => "in this loop".to_owned(),
        };
        diagnostic.with_label(index.block_place(opener), passes)
    }
}

/// Returns FC910 at the budget of blocks.
#[cold]
fn too_many_blocks(budget: u64, at: &BlockContext<'_>) -> Diagnostic {
    cut_off(
        format!("more than {budget} blocks were executed; the dry run ends here"),
        at,
    )
}

/// Returns FC910 at the budget of repeated work.
#[cold]
fn too_many_repeats(blocks: u64, at: &BlockContext<'_>) -> Diagnostic {
    cut_off(
        format!("loops and calls go on after {blocks} executed blocks; the dry run ends here"),
        at,
    )
}

/// Returns FC910 for a program that may end: its remaining course is not known, so the message is an error (R9.91).
fn cut_off(message: String, at: &BlockContext<'_>) -> Diagnostic {
    let fault = Fault::new(Code::Fc910, Span::new(0, at.text.len()), message)
        .with_help(Advice::RaiseBudget(Budget::Blocks));
    at.diagnostic(fault).raised(Severity::Error)
}

/// Returns FC908 where even what the ways could change takes too long to find.
#[cold]
fn too_much_to_follow(at: &BlockContext<'_>) -> Diagnostic {
    let message = "what the blocks from here on could change takes too much work to find; the dry run ends here, \
                   and everything that a program can change is unknown";
    let fault = Fault::new(Code::Fc908, Span::new(0, at.text.len()), message)
        .with_help(Advice::RaiseBudget(Budget::Ways));
    at.diagnostic(fault)
}

/// Returns FC918: the program holds more values than the limit.
#[cold]
fn too_many_values(limit: u32, at: &BlockContext<'_>) -> Diagnostic {
    at.diagnostic(
        Fault::new(
            Code::Fc918,
            Span::new(0, at.text.len()),
            format!("the program holds more than {limit} values; a string counts once more for every 32 bytes"),
        )
        .with_help(Advice::RaiseBudget(Budget::Values)),
    )
}

/// Units of a block on one of several ways, with the row that shows it.
const BLOCK: u64 = 3000;

/// Units of a copy of the state of the control.
const COPY: u64 = 3000;

/// Units of a copied or compared level of the call stack.
const LEVEL: u64 = 100;

/// Units of a pair of answers: ways that meet are compared with each other until none can be left out.
const PAIR: u64 = 20;

impl Executor {
    /// Counts the work of copying a state, or of comparing it with another one.
    pub(crate) fn charge_copies(&self, control: &ControlState, reach: &WaySet) {
        let levels = LEVEL.saturating_mul(control.frames.depth() as u64);
        let pairs = PAIR.saturating_mul(control.pairs(reach));
        let axes = 20 * self.machine.axes.len() as u64;
        let answers = 10 * reach.conditions().count() as u64;
        let units = COPY.saturating_add(levels).saturating_add(pairs);
        self.state
            .work
            .charge_ways(units.saturating_add(axes + answers));
    }

    /// Counts the work of a block that is executed while other ways wait.
    pub(crate) fn charge_block(&self, weight: u64) {
        let compared = 20 * self.state.control.frames.depth() as u64;
        let units = BLOCK.saturating_add(weight).saturating_add(compared);
        self.state.work.charge_ways(units);
    }
}

impl ControlState {
    /// Pairs of answers that are compared where ways to this state meet others.
    fn pairs(&self, reach: &WaySet) -> u64 {
        let sets = self.history.sets().chain([reach]);
        sets.map(WaySet::pairs).fold(0, u64::saturating_add)
    }
}

/// Most values that the advice names.
const MAX_NAMED: usize = 3;

impl OtherPaths {
    /// Returns whether following the ways of the program takes more work than its budget.
    #[inline]
    pub(crate) fn is_past_ways(&self, here: &Executor) -> bool {
        let is_past = here.state.work.ways() > here.options.limits.ways
            && here.state.work.ways() > here.ways_bound() / 4 * (4 + self.widened);
        is_past || self.waiting.len() > MAX_OPEN
    }

    /// Joins the ways that wait at the same block.
    #[cold]
    pub(crate) fn join_waiting(&mut self, here: &mut Executor) {
        let mine = here.state.leave_path();
        let mut ways = self.waiting.take_all().into_iter().peekable();
        while let Some(way) = ways.next() {
            here.enter_path(way);
            let is_here = |it: &Path| {
                let frames = &here.state.control.frames;
                it.control.frames.order_of_execution(frames).is_eq()
            };
            let others: Vec<Path> = std::iter::from_fn(|| ways.next_if(is_here)).collect();
            for other in others {
                self.join_path(here, other);
            }
            let joined = here.state.leave_path();
            self.waiting.push(joined);
        }
        here.enter_path(mine);
    }

    /// Takes all ways to the end of the outermost control block that any of them is in, and reports what is unknown
    /// from there on (FC908).
    #[cold]
    pub(crate) fn widen(&mut self, here: &mut Executor, finder: &mut dyn Finder) {
        self.widened += 1;
        let cause = Unknown::Ways;
        let mut left = BTreeSet::new();
        let mut ways = self.waiting.take_all();
        ways.insert(0, here.state.leave_path());
        for way in &mut ways {
            here.enter_path(way.clone());
            while here.state.control.frames.depth() > 1 {
                let program = here.state.control.frames.program();
                left.extend(program.map(|it| (it.unit, it.section)));
                here.leave();
            }
            *way = here.state.leave_path();
        }
        let passed = here.passed_by_all(&ways);
        let mut ways = ways.into_iter().map(|way| way.at(passed.end));
        let Some(mut joined) = ways.next() else {
            return;
        };
        for way in ways {
            joined.join(way, &cause);
        }
        joined.track.loops.clear();
        self.loop_heads.clear();
        self.call_effects.clear();
        joined.track.open_loops.clear();
        joined.track.marked = None;
        joined.track.labels = None;
        here.enter_path(joined);
        here.scratch.moves.forget_last();
        for (unit, section) in left {
            let section = here.programs.section(ProgramId { unit, section });
            let blocks = section.start..section.end;
            here.perhaps_execute(unit, blocks, &cause, finder);
        }
        let after = here.pass_over_blocks(passed.clone(), &cause, finder);
        self.let_leave(here);
        if let Some(frame) = here.state.control.frames.running_mut() {
            frame.next = after;
        }
        let passed = passed.start..after;
        here.version += 1;
        let said = here.too_many_ways(&passed);
        self.joined.extend(said);
    }
}

impl Executor {
    /// Returns the blocks of the main program that ways may execute up to the end of the control blocks that they are
    /// in.
    fn passed_by_all(&self, ways: &[Path]) -> Range<EntryIndex> {
        let frames = ways.iter().filter_map(|way| way.control.frames.running());
        let next: Vec<EntryIndex> = frames.map(|frame| frame.next).collect();
        let first = next.iter().min().copied().unwrap_or_default();
        let last = next.iter().max().copied().unwrap_or_default();
        let running = self.state.control.frames.main();
        let running = running.or_else(|| ways.first()?.control.frames.main());
        match running.map(|frame| self.programs.index(frame.unit)) {
            Some(index) if !index.entries.is_empty() => index.around(first.saturating_sub(1)..last),
            _ => last..last,
        }
    }

    /// Returns FC908: the run has more ways than are followed.
    fn too_many_ways(&self, passed: &Range<EntryIndex>) -> Option<Diagnostic> {
        let main = self.state.control.frames.main();
        let index = main.map(|frame| self.programs.index(frame.unit));
        let index = index.filter(|index| !index.entries.is_empty());
        let last = || self.state.last.as_ref().map(LastBlock::place);
        let place = index.map(|index| index.block_place(passed.start));
        let place = place.or_else(last)?;
        let to = index.and_then(|index| index.entries.get(passed.end.checked_sub(1)? as usize));
        let to = to.map_or(String::new(), |entry| format!(" to line {}", entry.line));
        let unknown = self.newly_unknown(&[]);
        let unknown = if unknown.is_empty() {
            String::new()
        } else {
            format!(": {}", unknown.join(", "))
        };
        let message = format!(
            "there are too many ways from here{to} to follow all of them; the dry run continues after them, and \
             whatever these blocks could change is unknown{unknown}"
        );
        let mut said = Diagnostic::new(Code::Fc908, place, message);
        let mut causes: Vec<&Unknown> = Vec::new();
        for condition in &self.state.conditions {
            if causes.len() < MAX_NAMED && !causes.contains(&&condition.cause) {
                causes.push(&condition.cause);
            }
        }
        for cause in causes {
            said = said.with_help(cause.advice());
        }
        Some(said.with_help(Advice::RaiseBudget(Budget::Ways)))
    }
}

impl Index {
    /// Returns a range of blocks with all of each control block that it touches.
    fn around(&self, mut blocks: Range<EntryIndex>) -> Range<EntryIndex> {
        loop {
            let mut whole = blocks.clone();
            for links in self.links.values() {
                if links.opener < whole.end && links.end >= whole.start {
                    whole = whole.start.min(links.opener)..whole.end.max(links.end + 1);
                }
            }
            if whole == blocks {
                return blocks;
            }
            blocks = whole;
        }
    }
}

impl Path {
    /// Returns the way when it reaches a block of the running program.
    pub(crate) fn at(mut self, entry: EntryIndex) -> Self {
        if let Some(frame) = self.control.frames.running_mut() {
            frame.next = entry;
            frame.seeking = None;
            frame.waiting.clear();
        }
        self
    }
}
