//! Loops that other ways leave: they are followed pass by pass, or joined at their heads (R14.3).

use std::ops::RangeInclusive;

use crate::interpreter::programs::finder::Finder;
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::loop_heads::{Arrival, LoopHead, head_place, place_at};
use crate::interpreter::run::other_paths::OtherPaths;
use crate::interpreter::run::path::Path;
use crate::interpreter::run::state::RunState;
use crate::interpreter::run::step::ControlStep;
use crate::interpreter::values::cause::Unknown;

/// Most passes of a loop that is left on other ways and whose own condition is known.
const MOST_FOLLOWED_PASSES: u64 = 32;

/// Most passes of such a `$FOR`, which ends by itself.
const MOST_COUNTED_PASSES: u64 = 1000;

/// Passes after which a loop that is joined at its head is given up (R14.4).
const MOST_JOINED_PASSES: u64 = 64;

/// Whether it is known that a loop is repeated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Repeats {
    Known,
    Unknown,
}

/// The loop around another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Around {
    Nothing,
    /// It is executed pass by pass.
    Known,
    /// It is joined at its head.
    Joined,
}

impl OtherPaths {
    /// Follows a loop that is left on other ways until a pass begins in the same state as earlier ones.
    #[cold]
    pub(super) fn follow_loop(
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

    /// A pass of a loop that is joined begins.
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
    pub(super) fn enters_covered(&mut self, here: &mut Executor, block: EntryIndex) -> bool {
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

    /// How the innermost loop around another one is repeated, in the running program or in those that call it.
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

    /// Whether the loop whose passes begin with a block is joined there.
    pub(super) fn is_joined_at(&self, here: &Executor, target: EntryIndex) -> bool {
        let heads = &self.loop_heads;
        !heads.is_empty() && heads.has(&head_place(&here.state.control.frames, target))
    }
}

impl Executor {
    /// The state with which a pass begins.
    fn at_head(&mut self, target: EntryIndex) -> Path {
        if let Some(frame) = self.state.control.frames.running_mut() {
            frame.next = target;
        }
        self.charge_copies(&self.state.control, &self.state.track.reach);
        self.state.arriving()
    }
}
