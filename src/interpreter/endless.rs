//! Loops that never end (R2.84).
//!
//! A run depends on its state and on nothing else. Where a loop comes round and the state is what
//! it was some passes ago, every further pass does what those did: the loop is known to be
//! endless. Parameters that only count, `P1 = P1 + 1`, and that nothing else reads may differ.
//! What is compared is all of the state, so what a pass can see need not be known.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::call::Found;
use super::coupling::Couplings;
use super::event::EndedBy;
use super::exchange::ChannelAxes;
use super::expression::Place;
use super::memory::Memory;
use super::modal::Modal;
use super::program::EntryIndex;
use super::region::Target;
use super::run::Interpreter;
use super::state::{Description, Frame, Repeated, State};
use super::value::Value;
use crate::comp::Compensation;
use crate::diagnostic::{Advice, Code, Diagnostic};
use crate::syntax::ast::{Assignment, BinaryOperator, Block, Node, Operand};

/// The pass after which a loop is looked at for the first time, then at each doubling.
const FIRST_LOOK: u64 = 32;

/// How many passes the state may take to come back to what it was.
const LONGEST_PERIOD: u64 = 8;

/// The weight of values beyond which nothing is compared.
const MAX_WEIGHT: usize = 10_000;

/// Different values that are kept of what was read; with more, everything counts as read.
const MAX_READS: usize = 256;

/// The widest step of something that only counts. It would take longer than any run to leave the
/// range of numbers.
const WIDEST_STEP: f64 = 1e9;

/// A loop that came round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Loop {
    /// How many programs call each other down to the one that holds it.
    depth: usize,
    unit: usize,
    section: usize,
    /// The block to which it goes back, and the one from which.
    target: EntryIndex,
    from: EntryIndex,
    passes: u64,
    /// The state at the start of an earlier pass.
    mark: Option<Box<Mark>>,
}

/// Everything that the blocks of a program can see or change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Mark {
    pass: u64,
    compensation: Compensation,
    memory: Memory,
    modal: Modal,
    frames: Vec<Frame>,
    occurred: Vec<bool>,
    couplings: Couplings,
    repeated: Option<Repeated>,
    refused: BTreeSet<usize>,
    ending: Option<EndedBy>,
    named: BTreeMap<String, Value>,
    channel_axes: ChannelAxes,
    described: Option<Box<Description>>,
}

/// What was read since a loop was looked at.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(super) struct Reads {
    targets: BTreeSet<Target>,
    too_many: bool,
}

impl Reads {
    pub(super) fn note(&mut self, target: Target) {
        if self.targets.len() < MAX_READS {
            self.targets.insert(target);
        } else {
            self.too_many = true;
        }
    }

    fn has(&self, target: &Target) -> bool {
        self.too_many || self.targets.contains(target)
    }
}

impl Loop {
    /// The section that it stands in.
    pub(super) fn place(&self) -> Found {
        Found {
            unit: self.unit,
            section: self.section,
        }
    }

    /// Whether its counters are below a bound.
    pub(super) fn fits(&self, bound: u64) -> bool {
        let marked = self.mark.as_ref().map_or(0, |mark| mark.pass);
        self.passes.max(marked) < bound
    }
}

impl Mark {
    fn of(state: &State, pass: u64) -> Self {
        Self {
            pass,
            compensation: state.compensation.clone(),
            memory: state.memory.clone(),
            modal: state.modal.clone(),
            frames: state.frames.clone(),
            occurred: state.occurred.clone(),
            couplings: state.couplings.clone(),
            repeated: state.repeated.clone(),
            refused: state.refused.clone(),
            ending: state.ending,
            named: state.named.clone(),
            channel_axes: state.channel_axes.clone(),
            described: state.described.clone(),
        }
    }

    /// What differs from the state of the moment, where that only counts; `None` where anything
    /// else differs.
    fn counters(&self, state: &State) -> Option<Vec<Target>> {
        let same = self.frames == state.frames
            && self.modal == state.modal
            && self.compensation == state.compensation
            && self.occurred == state.occurred
            && self.couplings == state.couplings
            && self.repeated == state.repeated
            && self.refused == state.refused
            && self.ending == state.ending
            && self.named == state.named
            && self.channel_axes == state.channel_axes
            && self.described == state.described;
        if !same {
            return None;
        }
        let differing = self.memory.differing_numbers(&state.memory)?;
        let reads = state.reads.borrow();
        let only_counts = differing.iter().all(|target| !reads.has(target));
        only_counts.then_some(differing)
    }
}

impl Loop {
    /// Whether the loop lies around a jump, or is the one that jumps.
    fn is_around(&self, (unit, section): (usize, usize), (target, from): Jump) -> bool {
        let around = self.target < target && from <= self.from;
        self.unit == unit && self.section == section && (self.target == target || around)
    }

    /// Whether the state is compared at this pass, or kept to be compared with.
    fn is_due(&self) -> bool {
        self.mark.is_some() || (self.passes >= FIRST_LOOK && self.passes.is_power_of_two())
    }
}

/// The block to which a jump goes, and the one from which.
type Jump = (EntryIndex, EntryIndex);

impl Interpreter {
    /// Takes note that a program jumps back. FC910 when it will do so for ever.
    pub(super) fn come_round(
        &mut self,
        target: EntryIndex,
        from: EntryIndex,
    ) -> Option<Diagnostic> {
        let depth = self.state.frames.len();
        let frame = self.state.frames.last()?;
        let (unit, section) = (frame.unit, frame.section);
        let jump = (target, from);
        while let Some(last) = self.state.loops.last() {
            let stays = last.depth < depth
                || (last.depth == depth && last.is_around((unit, section), jump));
            if stays {
                break;
            }
            self.state.loops.pop();
        }
        let known = self.state.loops.last();
        if known.is_none_or(|last| last.depth < depth || last.target != target) {
            self.state.loops.push(Loop {
                depth,
                unit,
                section,
                target,
                from,
                passes: 0,
                mark: None,
            });
        }
        let last = self.state.loops.last_mut()?;
        last.from = last.from.max(from);
        last.passes += 1;
        if last.is_due() {
            return self.look(from);
        }
        None
    }

    /// Compares the state with that of an earlier pass, or keeps it for that.
    #[cold]
    fn look(&mut self, from: EntryIndex) -> Option<Diagnostic> {
        let mut last = self.state.loops.pop()?;
        let mut found = None;
        if let Some(mark) = &last.mark {
            found = mark.counters(&self.state);
            if last.passes >= mark.pass + LONGEST_PERIOD {
                last.mark = None;
            }
        } else if self.state.memory.weight() <= MAX_WEIGHT {
            last.mark = Some(Box::new(Mark::of(&self.state, last.passes)));
        }
        let said = found.map(|counters| self.endless(&last, from, &counters));
        self.state.loops.push(last);
        self.state.watching = self.state.loops.iter().any(|known| known.mark.is_some());
        if !self.state.watching {
            *self.state.reads.borrow_mut() = Reads::default();
        }
        said
    }

    fn endless(&self, known: &Loop, from: EntryIndex, counters: &[Target]) -> Diagnostic {
        let index = &self.units[known.unit].index;
        let opener = if index.is_linked(from) {
            index.links(from).opener
        } else {
            known.target
        };
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
        Diagnostic::new(Code::Fc910, index.block_place(opener), message)
            .with_help("nothing after the loop runs; to see it, remove the loop or give it an end")
            .with_help(Advice::EndLoop)
    }

    /// How often the loop that begins at a block came round.
    pub(super) fn passes(&self, unit: usize, opener: EntryIndex) -> Option<u64> {
        let loops = self.state.loops.iter().rev();
        let mut known = loops.filter(|known| known.unit == unit);
        // A `$FOR` goes back to the block after its opener.
        let found = known.find(|known| known.target == opener || known.target == opener + 1);
        found.map(|known| known.passes)
    }

    /// Whether an assignment counts: `P1 = P1 + 1`.
    pub(super) fn counts(
        assignment: Assignment,
        place: &Place,
        (block, text): (&Block, &str),
    ) -> bool {
        let Operand::Expression(value) = assignment.value else {
            return false;
        };
        let range = value.start as usize..value.end as usize;
        let (Some(nodes), Some(spans)) = (block.nodes.get(range.clone()), block.spans.get(range))
        else {
            return false;
        };
        let steps = |step: &f64| step.abs() <= WIDEST_STEP;
        let read = match nodes {
            [
                read,
                Node::Number(step),
                Node::Binary(BinaryOperator::Add | BinaryOperator::Subtract),
            ] if steps(step) => Some((read, spans.first())),
            [Node::Number(step), read, Node::Binary(BinaryOperator::Add)] if steps(step) => {
                Some((read, spans.get(1)))
            }
            _ => None,
        };
        match (read, place) {
            (Some((Node::Parameter { owner, index }, _)), Place::Parameter(to, number)) => {
                owner == to && index == number
            }
            (Some((Node::Variable { subscripts: 0 }, Some(span))), Place::Variable(name)) => {
                span.of(text) == name
            }
            _ => false,
        }
    }
}
