//! Loops: which never end by themselves, and which other ways leave.
//!
//! A run depends only on its state. Where a loop is repeated and the state is the same as some passes ago, every further
//! pass repeats those passes: the loop is known to be endless (R2.84). Parameters that only count, `P1 = P1 + 1`, and that
//! nothing else reads may differ. The whole state is compared, so it need not be known what a pass reads.
//!
//! Where a value that is not known offline leads out of the loop on another way, it is not endless: it is followed pass by
//! pass, or joined at its head (R14.3).

use std::ops::RangeInclusive;

use crate::diagnostic::{Advice, Code, Diagnostic};
use crate::interpreter::executor::{Executor, RunState};
use crate::interpreter::programs::calls::Finder;
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::programs::store::ProgramStore;
use crate::interpreter::stack::{CallStack, ControlStep};
use crate::interpreter::values::location::{Location, Reads, Unknown};
use crate::interpreter::values::value::Value;
use crate::interpreter::ways::others::{Arrival, LoopHead, OtherPaths, head_place, place_at};
use crate::interpreter::ways::path::{Loop, Mark, Path, RunTrack};
use crate::syntax::VariableName;

/// Most passes of a loop that is left on other ways and whose own condition is known.
const MOST_FOLLOWED_PASSES: u64 = 32;

/// Most passes of such a `$FOR`, which ends by itself.
const MOST_COUNTED_PASSES: u64 = 1000;

/// Passes after which a loop that is joined at its head is given up (R14.4).
const MOST_JOINED_PASSES: u64 = 64;

/// Certainty that a loop is repeated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Repeats {
    Known,
    Unknown,
}

/// The loop around another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Around {
    Nothing,
    /// Loop executed pass by pass.
    Known,
    /// Loop joined at its head.
    Joined,
}

impl OtherPaths {
    /// Follows a loop that is left on other ways until a pass begins in the same state as earlier ones.
    #[cold]
    fn follow_loop(
        &mut self,
        here: &mut Executor,
        target: EntryIndex,
        repeats: Repeats,
        finder: &mut dyn Finder,
    ) -> ControlStep {
        let Some(mut known) = here.state.track.loops.pop() else {
            return ControlStep::Jump(target);
        };
        if let Some(counters) = known.endless.take() {
            self.lose_counters(&mut here.state, (&counters, known.since));
        }
        let index = here.programs.index(known.unit);
        let counts = index.links(known.head).opener == known.head && target == known.head + 1;
        let most = match repeats {
            Repeats::Unknown => 0,
            Repeats::Known if here.state.track.open_loops.contains(&known.place()) => 0,
            Repeats::Known if counts => MOST_COUNTED_PASSES,
            Repeats::Known => MOST_FOLLOWED_PASSES,
        };
        if known.passes > most + MOST_JOINED_PASSES {
            here.state.track.loops.push(known);
            let after = here.havoc_loop(&Unknown::Passes, finder);
            self.let_leave(here);
            return ControlStep::Jump(after);
        }
        let now = here.at_head(target);
        let blocks = known.head..=known.from;
        let last = known.last.take();
        if known.passes <= most {
            if last.is_some_and(|last| last.covers(&now, &Unknown::Passes)) {
                return ControlStep::Covered;
            }
            self.drop_heads(&here.state.control.frames, &blocks);
            known.last = Some(Box::new(now));
            here.state.track.loops.push(known);
            return ControlStep::Jump(target);
        }
        here.state.track.loops.push(known);
        match self.reach_head(here, target, (last.map(|last| *last), now), &blocks) {
            Arrival::Covered => ControlStep::Covered,
            Arrival::Grown => ControlStep::Jump(target),
        }
    }

    /// Begins a pass of a loop that is joined.
    fn reach_head(
        &mut self,
        here: &mut Executor,
        target: EntryIndex,
        (last, now): (Option<Path>, Path),
        blocks: &RangeInclusive<EntryIndex>,
    ) -> Arrival {
        let frames = &here.state.control.frames;
        let place = head_place(frames, target);
        let heads = &mut self.loop_heads;
        if !heads.has(&place) {
            let is_first = last.is_none();
            let head = LoopHead {
                blocks: blocks.clone(),
                state: last.unwrap_or_else(|| now.clone()),
            };
            heads.insert(place.clone(), head);
            if self.around(here, *blocks.start()) == Around::Nothing {
                let frames = &here.state.control.frames;
                self.loop_heads.drop_without(frames, blocks);
            }
            if is_first {
                return Arrival::Grown;
            }
        }
        let Some((arrival, state)) = self.loop_heads.arrive(&place, now) else {
            return Arrival::Grown;
        };
        if arrival == Arrival::Grown {
            let Path { control, track, .. } = state.clone();
            here.state.control = control;
            here.state.track.reach = track.reach;
            here.state.track.assumed = track.assumed;
            here.state.track.asked = track.asked;
            here.state.track.failed = track.failed;
            here.version += 1;
        }
        arrival
    }

    /// Returns whether the run enters a loop at a block with nothing that earlier passes of a loop around it did not
    /// enter it with.
    #[cold]
    pub(crate) fn enters_covered(&mut self, here: &mut Executor, block: EntryIndex) -> bool {
        let frames = &here.state.control.frames;
        let (depth, unit) = (frames.depth(), frames.running().map(|frame| frame.unit));
        let mut repeated = here.state.track.loops.iter();
        if repeated.any(|it| it.depth == depth && Some(it.unit) == unit && it.target == block) {
            return false;
        }
        let Some(head) = self.loop_heads.get(&head_place(frames, block)) else {
            return false;
        };
        let blocks = head.blocks.clone();
        if self.around(here, *blocks.start()) != Around::Joined {
            self.drop_heads(&here.state.control.frames, &blocks);
            return false;
        }
        let now = here.at_head(block);
        self.reach_head(here, block, (None, now), &blocks) == Arrival::Covered
    }

    /// Returns how the innermost loop around another one is repeated, in the running program or in those that call it.
    fn around(&self, here: &Executor, opener: EntryIndex) -> Around {
        let RunState { control, track, .. } = &here.state;
        let mut inner = Some(opener);
        for depth in (1..=control.frames.depth()).rev() {
            let Some(frame) = control.frames.iter().nth(depth - 1) else {
                continue;
            };
            let block = inner.take().unwrap_or(frame.next.saturating_sub(1));
            let structured = here.programs.index(frame.unit).loop_around(block);
            let mut repeated = track.loops.iter().rev();
            let repeated = repeated
                .find(|it| it.depth == depth && it.head < block && block <= it.from)
                .filter(|it| structured.is_none_or(|opener| it.head > opener));
            let is_joined = match (repeated, structured) {
                (Some(known), _) => {
                    self.loop_heads
                        .has(&place_at(&control.frames, depth, known.target))
                }
                (None, Some(opener)) => track.open_loops.contains(&(depth, frame.unit, opener)),
                (None, None) => continue,
            };
            return if is_joined {
                Around::Joined
            } else {
                Around::Known
            };
        }
        Around::Nothing
    }

    /// Returns whether the loop whose passes begin with a block is joined there.
    fn is_joined_at(&self, here: &Executor, target: EntryIndex) -> bool {
        let heads = &self.loop_heads;
        !heads.is_empty() && heads.has(&head_place(&here.state.control.frames, target))
    }
}

impl Executor {
    /// Returns the state with which a pass begins.
    fn at_head(&mut self, target: EntryIndex) -> Path {
        if let Some(frame) = self.state.control.frames.running_mut() {
            frame.next = target;
        }
        self.charge_copies(&self.state.control, &self.state.track.reach);
        self.state.arriving()
    }
}

/// Greatest number of passes after which a repeated state is recognised.
const LONGEST_PERIOD: u64 = 8;

/// The weight of values beyond which nothing is compared.
const MAX_WEIGHT: usize = 10_000;

impl OtherPaths {
    /// Returns the next step where a block jumps.
    pub(crate) fn jump(
        &mut self,
        here: &mut Executor,
        target: EntryIndex,
        finder: &mut dyn Finder,
    ) -> ControlStep {
        if !here.state.control.frames.is_passed(target) {
            return ControlStep::Jump(target);
        }
        let repeats = here.note_pass(target);
        let is_left = self.left_meanwhile(&here.state).next().is_some();
        // The program may wait for what the PLC writes (R2.99).
        if here.state.control.memory.holds_any() {
            if repeats {
                here.let_plc_act();
                here.state.forget_passes();
            } else if is_left {
                let names = self.names_of_exits(&here.state);
                here.let_plc_write(|name| names.contains(name));
            }
        }
        if is_left || self.is_joined_at(here, target) {
            return self.follow_loop(here, target, Repeats::Known, finder);
        }
        self.drop_heads_in_known_loop(&here.state);
        ControlStep::Jump(target)
    }

    /// Returns the next step where a way that only the machine decides leads back.
    pub(crate) fn come_back(
        &mut self,
        here: &mut Executor,
        target: EntryIndex,
        finder: &mut dyn Finder,
    ) -> ControlStep {
        let _ = here.note_pass(target);
        self.follow_loop(here, target, Repeats::Unknown, finder)
    }
}

impl Executor {
    /// Counts a pass of a loop. Returns whether it begins in the state of an earlier one.
    fn note_pass(&mut self, target: EntryIndex) -> bool {
        self.count_pass(target).is_some() && self.state.repeats()
    }

    /// Counts a pass of a loop; `None` where it need not be compared with earlier ones.
    fn count_pass(&mut self, target: EntryIndex) -> Option<()> {
        let depth = self.state.control.frames.depth();
        let place = self.state.control.frames.program()?;
        let from = self.state.control.frames.running()?.next.checked_sub(1)?;
        let index = self.programs.index(place.unit);
        // A `$FOR` goes back to the block after its opener.
        let head = if index.is_linked(from) {
            index.links(from).opener
        } else {
            target
        };
        while let Some(last) = self.state.track.loops.last() {
            let stays =
                last.depth < depth || (last.depth == depth && last.is_around(place, head, from));
            if stays {
                break;
            }
            self.state.track.loops.pop();
        }
        let known = self.state.track.loops.last();
        if known.is_none_or(|last| last.depth < depth || last.head != head) {
            self.state.track.loops.push(Loop {
                depth,
                unit: place.unit,
                section: place.section,
                head,
                target,
                from,
                passes: 0,
                since: self.state.seq,
                mark: None,
                endless: None,
                last: None,
            });
        }
        let last = self.state.track.loops.last_mut()?;
        last.from = last.from.max(from);
        last.passes += 1;
        let is_due = last.is_due();
        is_due.then_some(())
    }

    /// Makes unknown what the innermost loop could change in the passes that are not run. Returns the block after it.
    #[cold]
    fn havoc_loop(&mut self, cause: &Unknown, finder: &mut dyn Finder) -> EntryIndex {
        let Some(last) = self.state.track.loops.last() else {
            return 0;
        };
        self.pass_over_blocks(last.head..last.from.saturating_add(1), cause, finder)
    }

    /// Returns FC910 where the innermost loop is known to be endless.
    pub(crate) fn endless_loop(&self) -> Option<Diagnostic> {
        let known = self.state.track.loops.last()?;
        let counters = known.endless.as_ref()?;
        Some(self.programs.endless(known, counters))
    }
}

impl OtherPaths {
    /// Makes counters unknown where other ways have left a loop that is not run to its end.
    fn lose_counters(&mut self, state: &mut RunState, (counters, since): (&[Location], u64)) {
        let ended = state.ended.iter_mut().map(|ended| &mut ended.path);
        for path in self.waiting.iter_mut().chain(ended) {
            if path.parted >= since {
                for counter in counters {
                    let unknown = Value::Unknown(Unknown::Passes);
                    path.control.memory.write(counter, unknown);
                }
            }
        }
    }

    /// Drops what is kept of loops inside the innermost loop, which begins a new pass: it belongs to the last pass,
    /// unless only the machine ends the loop.
    fn drop_heads_in_known_loop(&mut self, state: &RunState) {
        let last = state.track.loops.last();
        let Some(known) = last.filter(|_| !self.loop_heads.is_empty()) else {
            return;
        };
        if !state.track.open_loops.contains(&known.place()) {
            self.drop_heads(&state.control.frames, &(known.head..=known.from));
        }
    }

    fn drop_heads(&mut self, frames: &CallStack, blocks: &RangeInclusive<EntryIndex>) {
        if !self.loop_heads.is_empty() {
            self.loop_heads.drop_within(frames, blocks);
        }
    }

    /// Returns the other ways that have left the innermost loop.
    fn left_meanwhile<'a>(&'a self, state: &'a RunState) -> impl Iterator<Item = &'a Path> {
        let last = state.track.loops.last();
        let since = last.map_or(u64::MAX, |known| known.since);
        let ended = state.ended.iter().map(|ended| &ended.path);
        let others = self.waiting.iter().chain(ended);
        others.filter(move |path| path.parted >= since)
    }

    /// Returns the variables that must change on ways that have left the innermost loop.
    fn names_of_exits(&self, state: &RunState) -> Vec<VariableName> {
        let left = self.left_meanwhile(state);
        let conditions = left.flat_map(|path| path.track.reach.conditions());
        let conditions = conditions.filter_map(|it| state.conditions.get(it as usize));
        let kept = conditions.filter_map(|condition| condition.kept.as_ref());
        kept.flat_map(|kept| kept.names.iter().cloned()).collect()
    }
}

impl RunState {
    /// Discards the proofs of earlier passes, since the innermost loop begins anew.
    fn forget_passes(&mut self) {
        if let Some(known) = self.track.loops.last_mut() {
            known.mark = None;
            known.endless = None;
        }
    }

    /// Returns whether the state is that of an earlier pass; if there is none, it is kept for comparison.
    #[cold]
    fn repeats(&mut self) -> bool {
        let Some(mut last) = self.track.loops.pop() else {
            return false;
        };
        if let Some(mark) = &last.mark {
            last.endless = counters(mark, self);
            if last.passes >= mark.pass + LONGEST_PERIOD {
                last.mark = None;
            }
        } else if self.control.memory.weight() <= MAX_WEIGHT {
            last.mark = Some(Box::new(Mark {
                pass: last.passes,
                control: self.control.clone(),
                occurred: self.occurred.clone(),
            }));
        }
        let repeats = last.endless.is_some();
        self.track.loops.push(last);
        self.watching = watches(&self.track);
        if !self.watching {
            *self.reads.borrow_mut() = Reads::default();
        }
        repeats
    }
}

impl RunTrack {
    /// Returns the number of repetitions of the loop that begins at a block.
    pub(crate) fn passes(&self, unit: usize, opener: EntryIndex) -> Option<u64> {
        let loops = self.loops.iter().rev();
        let mut known = loops.filter(|known| known.unit == unit);
        let found = known.find(|known| known.head == opener);
        found.map(|known| known.passes)
    }
}

impl ProgramStore {
    fn endless(&self, known: &Loop, counters: &[Location]) -> Diagnostic {
        let place = self.index(known.unit).block_place(known.head);
        let passes = known.passes;
        let names: Vec<String> = counters.iter().map(|name| format!("`{name}`")).collect();
        let but = if names.is_empty() {
            "nothing changes any more".to_owned()
        } else {
            format!(
                "nothing changes any more except {}, which nothing reads",
                names.join(", ")
            )
        };
        let message =
            format!("this loop never ends: after {passes} passes {but}; the dry run ends here");
        Diagnostic::new(Code::Fc910, place, message)
            .with_help("nothing after the loop runs; to see it, remove the loop or give it an end")
            .with_help(Advice::EndLoop)
    }
}

/// Returns the differences from the present state if they are counters; `None` where anything else
/// differs.
fn counters(mark: &Mark, state: &RunState) -> Option<Vec<Location>> {
    if mark.occurred != state.occurred {
        return None;
    }
    let differing = mark.control.differing_numbers(&state.control)?;
    let reads = state.reads.borrow();
    let only_counts = differing.iter().all(|target| !reads.has(target));
    only_counts.then_some(differing)
}

/// Returns whether a loop is compared with an earlier pass.
pub(crate) fn watches(track: &RunTrack) -> bool {
    track.loops.iter().any(|known| known.mark.is_some())
}
