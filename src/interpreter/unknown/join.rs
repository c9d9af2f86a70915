//! Ways that join the one of the dry run again (R2.51, R2.52).

use std::collections::HashSet;

use crate::comp::AxisIndex;
use crate::diagnostic::Code;
use crate::interpreter::programs::finder::Finder;
use crate::interpreter::programs::index::{EntryIndex, ProgramId};
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::block_scratch::PassedBy;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::stack::CallFrame;
use crate::interpreter::run::state::State;
use crate::interpreter::run::ways::{
    AxisKinds, Branch, JumpTarget, OpenPath, PathState, RETURN, Remainder, Ways, join_names,
};
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::location::Location;
use crate::interpreter::values::value::Value;
use crate::interpreter::values::work_budget::ITEM;
use crate::syntax::Fault;
use crate::text::Span;

impl Interpreter {
    /// Remembers the ways that leave at the executed block, and reports that they are not taken
    /// (FC902).
    #[cold]
    pub(crate) fn depart(&mut self, finder: &mut dyn Finder, at: &BlockContext<'_>) {
        let said = self.departing.iter().filter(|way| way.say.is_some());
        let said = said.max_by_key(|way| rank(way.to)).cloned();
        if let Some(way) = said
            && !self.scratch.unread.get()
            && self.differs(way.to, way.here)
        {
            let what = match way.to {
                JumpTarget::End => "the program may end here, which",
                JumpTarget::Return | JumpTarget::Far => "the program may be left here, which",
                JumpTarget::Block(_) => "a jump may leave this control block, which",
            };
            let value = way.cause.seen_from(at.file);
            let message = format!(
                "{what} depends on {value}; the dry run continues, and where both ways meet what differs is unknown"
            );
            let span = way.say.filter(|span| span.end > span.start);
            let span = span.unwrap_or(Span::new(0, at.text.len()));
            let help = way.cause.advice();
            let fault = Fault::new(Code::Fc902, span, message).with_help(help);
            self.tell_once(&way.cause, what, fault, at);
        }
        let here = self.take_departing();
        self.meet(here, finder);
    }

    /// Opens the ways that leave; returns the block after those that are passed over.
    pub(crate) fn take_departing(&mut self) -> EntryIndex {
        let departing = std::mem::take(&mut self.departing);
        let depth = self.state.control.frames.depth();
        let mut here = 0;
        let mut known = HashSet::new();
        for Branch {
            to,
            cause,
            here: after,
            ..
        } in departing
        {
            here = here.max(after);
            let targets: Vec<(usize, EntryIndex)> = match to {
                JumpTarget::Block(target) => vec![(depth, target)],
                JumpTarget::Return => vec![(depth, RETURN)],
                JumpTarget::Far => {
                    let main = self.state.control.frames.main();
                    let labels = main.map(|main| {
                        let index = self.programs.index(main.unit);
                        index.labels(main.section).map(|label| (1, label))
                    });
                    let returns = (2..=depth).map(|depth| (depth, RETURN));
                    returns.chain(labels.into_iter().flatten()).collect()
                }
                JumpTarget::End => vec![(0, 0)],
            };
            for (depth, target) in targets {
                if !known.insert((depth, target)) {
                    continue;
                }
                let way = self.state.way(depth, target, cause.clone());
                // M17 ends a main program.
                if depth == 0 || (depth == 1 && target == RETURN) {
                    self.state.track.ways.add_end(way);
                } else {
                    self.state.track.ways.add(way);
                }
            }
        }
        here
    }

    /// Joins the ways that continue at the next block, or before it.
    #[cold]
    pub(crate) fn arrive(&mut self, finder: &mut dyn Finder) {
        let here = self
            .state
            .control
            .frames
            .running()
            .map_or(0, |frame| frame.next);
        self.meet(here.saturating_sub(1), finder);
    }

    fn meet(&mut self, here: EntryIndex, finder: &mut dyn Finder) {
        let depth = self.state.control.frames.depth();
        while let Some(way) = self.state.track.ways.arrived(depth, here) {
            let (target, cause) = (way.target, way.cause.clone());
            let mut tails = HashSet::new();
            self.join(way, &mut tails);
            let place = self
                .state
                .control
                .frames
                .program()
                .filter(|_| target < here);
            if let Some(place) = place
                && self.programs.index(place.unit).entries.len() >= here as usize
            {
                // It executes what the dry run jumped over, or what it has after it.
                self.note_passed(place.unit, target..here, &cause, PassedBy::Way);
                let region = self.havoc_region(place.unit, target..here, &cause);
                self.note_exits(&region, target..=here, &cause, None);
            }
            self.havoc_called(finder);
            self.take_departing();
            if self.is_exhausted() {
                break;
            }
        }
        self.state.track.ways.tidy();
    }

    /// A program is left: its ways continue in the caller, after the blocks that they still execute.
    pub(crate) fn leave_ways(&mut self, frame: &CallFrame) {
        let depth = self.state.control.frames.depth();
        let caller = self.state.control.frames.running().map(|caller| {
            let waiting = caller.waiting.iter().map(|request| Remainder {
                unit: request.found.unit,
                section: request.found.section,
                from: self.programs.section(request.found).start,
            });
            (caller.next, waiting.collect::<Vec<_>>())
        });
        for mut way in self.state.track.ways.left(depth + 1) {
            if way.target != RETURN {
                way.tails.push(Remainder {
                    unit: frame.unit,
                    section: frame.section,
                    from: way.target,
                });
            }
            if let Some(saved) = &frame.restores {
                way.state.modal.restore(saved);
            }
            let Some((next, waiting)) = &caller else {
                self.state.track.ways.add_end(way);
                continue;
            };
            way.tails.extend(waiting);
            (way.depth, way.target) = (depth, *next);
            self.state.track.ways.add(way);
        }
    }

    /// The program ends: every way ends it too.
    pub(crate) fn meet_at_end(&mut self, finder: &mut dyn Finder) {
        if !self.state.track.ways.is_open() {
            return;
        }
        let own = self.state.control.all_kinds();
        let mut tails = HashSet::new();
        let open = std::mem::take(&mut self.state.track.ways.open);
        for mut way in open {
            let frames = self.state.control.frames.iter().take(way.depth);
            let rest = frames.enumerate().filter_map(|(level, frame)| {
                let from = if level + 1 == way.depth {
                    (way.target != RETURN).then_some(way.target)?
                } else {
                    frame.next
                };
                Some(Remainder {
                    unit: frame.unit,
                    section: frame.section,
                    from,
                })
            });
            let rest: Vec<Remainder> = rest.collect();
            way.tails.extend(rest);
            self.join(way, &mut tails);
        }
        self.havoc_called(finder);
        self.departing.clear();
        if let Some(end) = self.state.track.ways.end.take() {
            self.join(*end, &mut tails);
            self.havoc_called(finder);
            self.departing.clear();
        }
        self.try_passed();
        self.state.track.ways = Ways {
            ends: std::mem::take(&mut self.state.track.ways.ends),
            own: Some(own),
            ..Ways::default()
        };
        if !self.scratch.changes.is_empty() {
            self.version += 1;
        }
    }

    /// Makes unknown what may differ between the way of the dry run and another that continues here.
    fn join(&mut self, way: OpenPath, tails: &mut HashSet<Remainder>) {
        let OpenPath {
            since,
            cause,
            state,
            ..
        } = way;
        for (position, kinds) in state.kinds.iter().enumerate() {
            let axis = AxisIndex::new(position);
            let known = self.state.control.kinds(axis);
            let differing = known.differing(*kinds);
            self.havoc(axis, differing.without(known.unknown));
        }
        self.state.control.history.join_sites(&state.history);
        self.state.control.modal.join(&state.modal);
        if state.macros != self.state.control.memory.macro_version() {
            self.havoc_macros(&cause);
        }
        self.state.control.cycles.join(&state.cycles);
        if state.couplings != self.state.control.couplings.version() {
            self.havoc_couplings();
        }
        join_names(&mut self.state.control.named, &state.named, &cause);
        self.state.control.channel_axes.join(&state.channel_axes);
        let written = &self.state.track.ways.written.0;
        self.state.work.charge_region(ITEM + written.len());
        let later = written.iter().filter(|(_, seq)| **seq > since);
        let later: Vec<Location> = later.map(|(target, _)| target.clone()).collect();
        if self.state.track.ways.everything > since {
            self.havoc_memory(&cause);
        }
        for target in &later {
            self.write(target, Value::Unknown(cause.clone()));
        }
        for tail in way.tails {
            if tails.insert(tail) {
                self.havoc_tail(tail, &cause);
            }
        }
    }

    /// Makes unknown the possible effects of a section from a block on, and of the blocks that it
    /// jumps back to.
    fn havoc_tail(&mut self, tail: Remainder, cause: &Unknown) {
        let Remainder {
            unit,
            section,
            mut from,
        } = tail;
        let program = ProgramId { unit, section };
        let Some(end) = self.programs.units().get(unit).and_then(|unit| {
            let has_text = !unit.index.entries.is_empty();
            has_text.then(|| unit.index.sections[section].end)
        }) else {
            // Lines that are read one after another.
            self.havoc_all(cause);
            return;
        };
        while from < end && !self.is_exhausted() {
            let region = self.region(unit, from..end);
            let aims = region.exits.iter();
            let aims = aims.flat_map(|exit| self.aims(exit, program));
            let lowest = aims.filter_map(|aim| match aim {
                JumpTarget::Block(target) => Some(target),
                JumpTarget::Return | JumpTarget::Far | JumpTarget::End => None,
            });
            match lowest.min() {
                Some(lowest) if lowest < from => from = lowest,
                _ => {
                    self.note_passed(unit, from..end, cause, PassedBy::Way);
                    let region = self.havoc_region(unit, from..end, cause);
                    self.note_far_exits(&region, cause);
                    return;
                }
            }
        }
    }
}

impl State {
    /// A way that leaves now.
    fn way(&self, depth: usize, target: EntryIndex, cause: Unknown) -> OpenPath {
        let count = self.control.compensation.len();
        self.work.charge_region(ITEM + count);
        OpenPath {
            depth,
            target,
            since: self.seq,
            latest: self.seq,
            cause,
            state: PathState {
                kinds: self.control.all_kinds(),
                history: self.control.history.clone(),
                modal: self.control.modal.clone(),
                cycles: self.control.cycles.clone(),
                couplings: self.control.couplings.version(),
                named: self.control.named.clone(),
                channel_axes: self.control.channel_axes.clone(),
                macros: self.control.memory.macro_version(),
            },
            tails: Vec::new(),
        }
    }
}

impl ControlState {
    fn kinds(&self, axis: AxisIndex) -> AxisKinds {
        let compensation = &self.compensation;
        AxisKinds {
            selected: compensation.selected(axis),
            unknown: compensation.unknown(axis),
        }
    }
}

/// Returns the rank of a target; the message names the way of the highest.
fn rank(to: JumpTarget) -> u8 {
    match to {
        JumpTarget::Block(_) => 0,
        JumpTarget::Return | JumpTarget::Far => 1,
        JumpTarget::End => 2,
    }
}
