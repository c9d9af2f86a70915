//! The call stack, and the step after a block that does not lead to the next one.

use std::collections::BTreeMap;
use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::diagnostic::Diagnostic;
use crate::interpreter::block::BlockContext;
use crate::interpreter::events::EndedBy;
use crate::interpreter::motion::modal::Saved;
use crate::interpreter::programs::calls::{WantedCall, holds_program_end, is_main_program};
use crate::interpreter::programs::index::{EntryIndex, JumpAcross, LabelName, ProgramId};
use crate::interpreter::programs::store::ProgramStore;
use crate::interpreter::values::location::Unknown;
use crate::interpreter::values::names::join_value;
use crate::interpreter::values::value::Value;
use crate::syntax::ast::{CallForm, Item, Operand};
use crate::text::Place;

/// The programs that run, the main program first.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct CallStack(Vec<CallFrame>);

/// One level of the call stack: the position in a program or subprogram.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct CallFrame {
    /// The file, by its position among the files of the run.
    pub(crate) unit: usize,
    pub(crate) section: usize,
    /// The next block.
    pub(crate) next: EntryIndex,
    /// The call depth; 0 is the main program.
    pub(crate) level: u32,
    /// Own parameters of the call.
    pub(crate) own: BTreeMap<u32, Value>,
    /// Set between `$IF` or `$SWITCH` and the branch being looked for.
    pub(crate) seeking: Option<Seeking>,
    /// Place of the call.
    pub(crate) called_from: Option<Box<Place>>,
    /// State that the end of a cycle restores.
    pub(crate) restores: Option<Box<Saved>>,
    pub(crate) retains: Retains,
    /// Programs that are called before the next block, the first one last.
    pub(crate) waiting: Vec<Request>,
    /// The blocks that are executed, where that is not the whole program.
    pub(crate) passage: Option<Passage>,
}

impl CallFrame {
    /// Returns the program that it belongs to.
    pub(crate) fn program(&self) -> ProgramId {
        ProgramId {
            unit: self.unit,
            section: self.section,
        }
    }
}

/// Changes to G functions and feed that outlive a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Retains {
    /// No changes.
    Nothing,
    /// `#RETAIN CYCLE CHANGES` may have been executed.
    Perhaps,
}

/// Decision that the next branch statement has to make.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum Seeking {
    /// A true condition.
    Condition,
    /// A case with this value.
    Case(Value),
}

impl CallFrame {
    /// Joins another way at the same block: whatever differs becomes unknown.
    fn join(&mut self, other: &Self, cause: &Unknown) {
        let Self {
            // Both are at the same block.
            unit: _,
            section: _,
            next: _,
            level: _,
            seeking: _,
            waiting: _,
            own,
            called_from,
            restores,
            retains,
            passage,
        } = other;
        let given: Vec<u32> = self.own.keys().chain(own.keys()).copied().collect();
        for index in given {
            let mut mine = self.own.get(&index).cloned();
            join_value(&mut mine, own.get(&index), cause);
            if let Some(value) = mine {
                self.own.insert(index, value);
            }
        }
        if self.called_from.is_none() {
            self.called_from.clone_from(called_from);
        }
        if let (Some(mine), Some(theirs)) = (&mut self.restores, restores) {
            mine.join(theirs);
        }
        if *retains == Retains::Perhaps {
            self.retains = Retains::Perhaps;
        }
        if let (Some(mine), Some(theirs)) = (&mut self.passage, passage) {
            mine.begun = mine.begun.min(theirs.begun);
        }
    }
}

impl CallStack {
    /// Joins another way at the same block: whatever differs becomes unknown.
    pub(crate) fn join(&mut self, other: &Self, cause: &Unknown) {
        for (mine, theirs) in self.0.iter_mut().zip(&other.0) {
            mine.join(theirs, cause);
        }
    }

    /// Returns the program whose blocks are executed.
    #[inline]
    pub(crate) fn running(&self) -> Option<&CallFrame> {
        self.0.last()
    }

    /// Returns the program whose blocks are executed.
    #[inline]
    pub(crate) fn running_mut(&mut self) -> Option<&mut CallFrame> {
        self.0.last_mut()
    }

    /// Returns the main program.
    pub(crate) fn main(&self) -> Option<&CallFrame> {
        self.0.first()
    }

    /// Returns whether a subprogram is being executed.
    pub(crate) fn is_running(&self, program: ProgramId) -> bool {
        self.iter().any(|frame| {
            frame.level > 0 && (frame.unit, frame.section) == (program.unit, program.section)
        })
    }

    /// Returns the running cycle, whose end restores what was in force before it.
    pub(crate) fn cycle_mut(&mut self) -> Option<&mut CallFrame> {
        let mut frames = self.0.iter_mut().rev();
        frames.find(|frame| frame.restores.is_some())
    }

    /// Returns the place of the program whose blocks are executed.
    pub(crate) fn program(&self) -> Option<ProgramId> {
        self.running().map(CallFrame::program)
    }

    /// Returns the call depth of the program whose blocks are executed; 0 is the main program.
    pub(crate) fn level(&self) -> u32 {
        self.running().map_or(0, |frame| frame.level)
    }

    /// Returns the block that is executed.
    pub(crate) fn entry(&self) -> Option<EntryIndex> {
        self.running()?.next.checked_sub(1)
    }

    /// Returns whether a block of the running program comes before the next one.
    pub(crate) fn is_passed(&self, target: EntryIndex) -> bool {
        self.running().is_some_and(|frame| target < frame.next)
    }

    /// Returns the outermost program of a call depth.
    pub(crate) fn at_level(&self, level: u32) -> Option<&CallFrame> {
        self.0.iter().find(|frame| frame.level == level)
    }

    /// Returns the program at a call depth, the main program being the first.
    pub(crate) fn at_depth_mut(&mut self, depth: usize) -> Option<&mut CallFrame> {
        self.0.get_mut(depth.checked_sub(1)?)
    }

    /// Returns the number of nested programs.
    pub(crate) fn depth(&self) -> usize {
        self.0.len()
    }

    /// Returns whether no program runs.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the programs, the main program first.
    pub(crate) fn iter(&self) -> impl DoubleEndedIterator<Item = &CallFrame> {
        self.0.iter()
    }

    /// Enters a called program.
    pub(crate) fn push(&mut self, frame: CallFrame) {
        self.0.push(frame);
    }

    /// Leaves a program.
    pub(crate) fn pop(&mut self) -> Option<CallFrame> {
        self.0.pop()
    }

    /// Returns the programs that called the running one.
    pub(crate) fn without_running(&self) -> Self {
        Self(self.0[..self.0.len().saturating_sub(1)].to_vec())
    }

    /// Returns the running program, whoever called it.
    pub(crate) fn running_alone(&self) -> Self {
        let alone = |frame: &CallFrame| CallFrame {
            called_from: None,
            ..frame.clone()
        };
        Self(self.running().map(alone).into_iter().collect())
    }

    /// Leaves all programs.
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }
}

/// Step of the control after a block, where it does not lead to the next one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum ControlStep {
    /// The program was announced and has not begun.
    Begin,
    /// Jump to a block of the same program.
    Jump(EntryIndex),
    /// Programs, one after the other.
    Call(Vec<Request>),
    /// M17, M29.
    Return,
    /// M17, M29 with a place to return to.
    ReturnTo(Destination),
    End(EndedBy),
    /// Nowhere: another way does what this one would do (R14.3).
    Covered,
}

/// A program to call.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Request {
    pub(crate) found: ProgramId,
    pub(crate) passage: Option<Passage>,
    pub(crate) own: BTreeMap<u32, Value>,
    pub(crate) form: CallForm,
    pub(crate) called_from: Place,
}

/// The blocks of a program that a frame executes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Passage {
    pub(crate) first: EntryIndex,
    pub(crate) last: EntryIndex,
    /// Number of passes left.
    pub(crate) left: u64,
    /// Number of blocks executed before this pass began.
    pub(crate) begun: u64,
}

impl Passage {
    /// Returns the start of the next pass, when there is one. A pass of blocks that are all skipped is the last one.
    pub(crate) fn again(&mut self, executed: u64) -> Option<EntryIndex> {
        if self.left == 0 || executed == self.begun {
            return None;
        }
        self.left -= 1;
        self.begun = executed;
        Some(self.first)
    }
}

/// Target of an M17.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Destination {
    pub(crate) level: u32,
    /// The block, where it is not the one that follows the call.
    pub(crate) entry: Option<EntryIndex>,
    /// The block of a main program that is read line by line; no snapshot of such a run is taken.
    #[serde(skip)]
    pub(crate) awaited: Option<Box<AwaitedBlock>>,
}

impl Destination {
    /// Returns the block after the call of a level.
    pub(crate) fn after_call(level: u32) -> Self {
        Self {
            level,
            entry: None,
            awaited: None,
        }
    }
}

/// A block of a main program that is read line by line, and the message if it is not kept.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AwaitedBlock {
    pub(crate) label: LabelName,
    pub(crate) lost: Diagnostic,
}

/// Position of a path in its programs.
#[derive(Clone, Copy)]
pub(crate) struct ProgramPosition<'a> {
    pub(crate) frames: &'a CallStack,
    pub(crate) programs: &'a ProgramStore,
}

impl ProgramPosition<'_> {
    /// Returns the statement being executed and the end of its control block.
    pub(crate) fn current_block(self) -> Range<EntryIndex> {
        self.frames.running().map_or(0..0, |frame| {
            let entry = frame.next - 1;
            entry..self.programs.index(frame.unit).links(entry).end
        })
    }

    /// Returns whether an `$IF` of the running file has no `$ENDIF`.
    pub(crate) fn is_unclosed(self, opener: EntryIndex) -> bool {
        let frame = self.frames.running();
        frame.is_some_and(|frame| {
            let index = self.programs.index(frame.unit);
            index.unclosed.contains(&index.links(opener).opener)
        })
    }

    /// Returns the control blocks that a jump from the current block crosses.
    pub(crate) fn jump_across(self, to: EntryIndex) -> JumpAcross {
        let frames = &self.frames;
        match (frames.running(), frames.entry()) {
            (Some(frame), Some(from)) => self.programs.index(frame.unit).jump_across(from, to),
            _ => JumpAcross::Nothing,
        }
    }

    /// Returns whether a jump of the running program may go to the block: it names the number or the label of the
    /// block, or computes its target.
    pub(crate) fn may_be_jumped_to(self, at: &BlockContext<'_>) -> bool {
        let Some(frame) = self.frames.running() else {
            return true;
        };
        let targets = &self.programs.index(frame.unit).targets;
        let number = at.block.number.map(|number| match number.value {
            Operand::Number(number) => Some(LabelName::numbered(number)),
            Operand::Expression(_) => None,
        });
        let labels = at.block.items.iter().filter_map(|item| match item {
            Item::Label(name) => Some(Some(LabelName::Text(name.of(at.text).to_owned()))),
            _ => None,
        });
        let mut names = number.into_iter().chain(labels);
        names.any(|name| name.is_none_or(|name| targets.may_be(&name)))
    }

    /// Returns whether the file that runs is a main program: one that ends with M02 or M30.
    pub(crate) fn runs_main_program(self) -> bool {
        let Some(frame) = self.frames.iter().next() else {
            return true;
        };
        let index = self.programs.index(frame.unit);
        let start = index.sections.get(frame.section).map_or(0, |it| it.start);
        index.entries.is_empty() || is_main_program(index.text_from(frame.section, start))
    }

    /// Returns whether the running program has M30 or M02 after its last executed block; `None` if its lines are read
    /// one after another.
    pub(crate) fn holds_end_after(self) -> Option<bool> {
        let frame = self.frames.running()?;
        let index = self.programs.index(frame.unit);
        let is_kept = !index.source.text().is_empty();
        is_kept.then(|| holds_program_end(index.text_from(frame.section, frame.next)))
    }

    /// Returns the block after the one being executed.
    pub(crate) fn next_block(self) -> EntryIndex {
        self.frames.running().map_or(0, |it| it.next)
    }

    /// Returns whether a part belongs to the program being executed.
    pub(crate) fn is_here(self, wanted: &WantedCall) -> bool {
        let own_name = || {
            let found = self.frames.program()?;
            let index = self.programs.index(found.unit);
            index.sections[found.section].name.clone()
        };
        wanted
            .part
            .as_ref()
            .is_some_and(|part| part.here || own_name().as_deref() == Some(&*wanted.name))
    }
}
