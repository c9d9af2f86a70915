//! Ways that are too many to follow (R9.91, R14.4).
//!
//! Each way that only the machine decides costs work, and loops and calls multiply it. Past the budget every way is
//! taken to the end of the outermost control block of the main program that any of them is in. Nothing of it is
//! executed any more: whatever its blocks, and those of the programs that it calls, could change is unknown (R2.51).
//! The program continues there, with a quarter of the budget for its ways.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::diagnostic::{Advice, Budget, Code, Diagnostic};
use crate::interpreter::programs::finder::Finder;
use crate::interpreter::programs::index::{EntryIndex, Index, ProgramId};
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::other_paths::OtherPaths;
use crate::interpreter::run::path::{Last, Path};
use crate::interpreter::unknown::branching::MAX_OPEN;
use crate::interpreter::values::cause::Unknown;

/// Most values that the advice names.
const MAX_NAMED: usize = 3;

impl OtherPaths {
    /// Whether following the ways of the program takes more work than its budget.
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
                it.control.frames.comes_before(frames).is_none()
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
        here.scratch.havoc_last_motion();
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
    /// The blocks of the main program that ways may execute up to the end of the control blocks that they are in.
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

    /// FC908.
    fn too_many_ways(&self, passed: &Range<EntryIndex>) -> Option<Diagnostic> {
        let main = self.state.control.frames.main();
        let index = main.map(|frame| self.programs.index(frame.unit));
        let index = index.filter(|index| !index.entries.is_empty());
        let last = || self.state.last.as_ref().map(Last::place);
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
    /// A range of blocks with all of each control block that it touches.
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
    /// The way when it reaches a block of the running program.
    pub(crate) fn at(mut self, entry: EntryIndex) -> Self {
        if let Some(frame) = self.control.frames.running_mut() {
            frame.next = entry;
            frame.seeking = None;
            frame.waiting.clear();
        }
        self
    }
}
