//! The path that is executed: the machine, the state of the control, and the block at hand. [`RunState`] is what is saved
//! of it and resumed.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::comp::{AxisIndex, Compensation, KindSet};
use crate::interpreter::axes::{AxisLookup, AxisNames};
use crate::interpreter::block::{BlockScratch, LastBlock};
use crate::interpreter::control::ControlState;
use crate::interpreter::motion::modal::Modal;
use crate::interpreter::options::Options;
use crate::interpreter::programs::store::ProgramStore;
use crate::interpreter::stack::{ControlStep, ProgramPosition};
use crate::interpreter::values::externals::ExternalNames;
use crate::interpreter::values::handover::{FoundVariables, VariableUse};
use crate::interpreter::values::location::{Reads, Unknown};
use crate::interpreter::values::rows;
use crate::interpreter::values::work_budget::{PER_UNIT_READ, WorkBudget};
use crate::interpreter::ways::history::FoundStates;
use crate::interpreter::ways::path::{AskedCondition, BranchSide, EndedPath, Path, RunTrack};
use crate::interpreter::ways::possible_state::{PossibleStates, shown, ways_of};
use crate::interpreter::ways::question::Condition;
use crate::interpreter::ways::set::WaySet;
use crate::interpreter::ways::words::WayCondition;
use crate::lists::Origin;
use crate::machine::{Axis, AxisSet, Machine};
use crate::readings::QuestionSet;
use crate::syntax::ast::Block;
use crate::syntax::{SkipLevels, VariableFamily, VariableName};
use crate::text::Place;

/// Executes blocks on one path. It knows no other path: where the run parts, it leaves the sides of the question, and
/// the paths on which it may go on elsewhere.
#[derive(Clone)]
pub(crate) struct Executor {
    pub(crate) machine: Arc<Machine>,
    pub(crate) options: Options,
    pub(crate) names: AxisNames,
    /// The variables of the machine of which the configuration says who writes them (R14.1, R2.99).
    pub(crate) externals: Arc<ExternalNames>,
    /// Whether any axis requires a compensation (P-AXIS-00465).
    pub(crate) any_required: bool,
    pub(crate) programs: ProgramStore,
    /// Targets of the answers to the condition of the current block.
    pub(crate) sides: Vec<BranchSide>,
    /// Whether no other path waits.
    pub(crate) is_alone: bool,
    /// The states that are possible, as users see them, and where they count.
    pub(crate) shown: ShownWays,
    /// The answers among which the user may choose where one way is followed.
    pub(crate) offered: Vec<WayCondition>,
    /// The places of the chosen answers to the next such conditions.
    pub(crate) chosen: VecDeque<usize>,
    pub(crate) state: RunState,
    /// The use of variables that outlive programs, if requested.
    pub(crate) used: Option<RefCell<VariableUse>>,
    pub(crate) version: u64,
    pub(crate) scratch: BlockScratch,
}

/// Ways to a block that are shown.
#[derive(Debug, Clone, Default)]
pub(crate) struct ShownWays {
    version: u64,
    pub(crate) possible: Vec<PossibleStates>,
    pub(crate) branch: Option<Vec<Vec<WayCondition>>>,
}

impl Executor {
    pub(crate) fn new(
        machine: Arc<Machine>,
        options: Options,
        externals: Arc<ExternalNames>,
        state: RunState,
    ) -> Self {
        Self {
            names: AxisNames::of(&machine),
            externals,
            any_required: machine.axes.iter().any(|axis| !axis.monitored().is_empty()),
            machine,
            options,
            programs: ProgramStore::new(options.limits.nesting),
            sides: Vec::new(),
            is_alone: true,
            shown: ShownWays::default(),
            offered: Vec::new(),
            chosen: VecDeque::new(),
            state,
            used: None,
            version: 1,
            scratch: BlockScratch::default(),
        }
    }

    /// Updates the ways that are shown.
    #[inline]
    pub(crate) fn show_ways(&mut self) {
        if self.shown.version != self.version {
            self.show_ways_anew();
        }
    }

    #[inline(never)]
    fn show_ways_anew(&mut self) {
        let RunState {
            control,
            track,
            conditions,
            ..
        } = &self.state;
        let state = (&control.compensation, &control.history);
        self.shown = ShownWays {
            version: self.version,
            possible: shown(state, &track.reach, conditions),
            branch: {
                let ways = (!track.reach.is_always()).then(|| ways_of(&track.reach, conditions));
                ways.filter(|ways| !ways.is_empty())
            },
        };
    }

    /// Sets what programs before this one may have left in variables that outlive programs (R2.34) and in the control,
    /// and records their use from here on.
    pub(crate) fn find(&mut self, found: &FoundVariables) {
        self.state.control.memory.find(found);
        self.state.control.find_lasting(found.lasting());
        let used = VariableUse::new(self.machine.parameters, &self.externals);
        self.used = Some(RefCell::new(used));
    }

    /// Returns the use of variables that outlive programs by the programs since, and what they leave of the control.
    pub(crate) fn take_use(&mut self) -> VariableUse {
        let used = self.used.take().map(RefCell::into_inner);
        let mut used = used.unwrap_or_default();
        used.written
            .leave(&self.state.control.lasting(&self.machine));
        used
    }

    /// Records the use of variables that outlive programs, if requested.
    pub(crate) fn note_use(&self, note: impl FnOnce(&mut VariableUse)) {
        if let Some(used) = &self.used {
            note(&mut used.borrow_mut());
        }
    }

    /// Returns whether a variable outlives programs, and only they write it.
    pub(crate) fn only_programs_write(&self, name: &VariableName) -> bool {
        name.family() == VariableFamily::Shared || self.externals.is_own(name)
    }

    /// Returns the axes that names mean at the block.
    pub(crate) fn axes(&self) -> AxisLookup<'_> {
        AxisLookup {
            machine: &self.machine,
            own: &self.names,
            channel: &self.state.control.channel_axes,
        }
    }

    /// Returns where the path is in its programs.
    pub(crate) fn position(&self) -> ProgramPosition<'_> {
        ProgramPosition {
            frames: &self.state.control.frames,
            programs: &self.programs,
        }
    }

    /// Returns the axis that `@X` means in the plane in force.
    pub(crate) fn main_axis(&self, letter: u8) -> Option<AxisIndex> {
        self.axes().main(letter, &self.state.control.modal)
    }

    /// Records the occurrence of an axis.
    #[inline]
    pub(crate) fn see(&mut self, axis: AxisIndex) {
        self.scratch.new_axes |= !std::mem::replace(&mut self.state.occurred[axis.get()], true);
    }

    /// Returns the skip levels that are on, where they are known (R2.90).
    pub(crate) fn skip_levels(&self) -> Option<SkipLevels> {
        self.options.skip.or(self.machine.skip)
    }

    /// Returns whether a block is known not to be executed.
    pub(crate) fn is_skipped(&self, block: &Block) -> bool {
        let skips = |level| self.skip_levels().is_some_and(|levels| levels.has(level));
        block.skip.is_some_and(skips)
    }

    /// Returns the skip level that decides whether a block is executed, where that is not known.
    #[inline]
    pub(crate) fn undecided_level(&self, block: &Block) -> Option<u8> {
        block
            .skip
            .filter(|_| self.skip_levels().is_none() && !self.state.is_on_marked_way())
    }

    /// Returns the level that decides whether the parts of a control block belong together: one of them has a skip mark
    /// and its opener has none.
    pub(crate) fn split_level(&self) -> Option<u8> {
        let frame = self.state.control.frames.running()?;
        let entry = frame.next.checked_sub(1)?;
        let level = self.programs.index(frame.unit).split.get(&entry).copied()?;
        let is_known = self.skip_levels().is_some() || self.state.is_on_marked_way();
        (!is_known).then_some(level)
    }

    /// Returns the limit of the level of work.
    pub(crate) fn work_bound(&self) -> u64 {
        let granted = self.programs.granted();
        self.options.limits.work.saturating_add(granted)
    }

    /// Returns whether even reading what the ways could change takes too much work.
    #[inline]
    pub(crate) fn is_past_all_ways(&self) -> bool {
        self.state.work.ways() > self.options.limits.ways
            && self.state.work.ways() > self.ways_bound().saturating_mul(2)
    }

    #[cold]
    pub(crate) fn ways_bound(&self) -> u64 {
        let granted = self.work_bound() - self.options.limits.work;
        let granted = granted.saturating_mul(PER_UNIT_READ);
        self.options.limits.ways.saturating_add(granted)
    }

    /// Returns whether the budget of work is used up.
    pub(crate) fn is_exhausted(&self) -> bool {
        self.state.work.level() > self.work_bound() || self.is_past_all_ways()
    }

    /// Defines the macros of the channel list, which no program takes away (TF5200 Programming manual, 208400267).
    pub(crate) fn define_machine_macros(&mut self) {
        for (name, code) in &self.machine.programs.macros {
            self.state.control.memory.define_macro(name, code);
        }
    }

    /// Kinds of an axis become unknown.
    pub(crate) fn havoc(&mut self, axis: AxisIndex, kinds: KindSet) {
        self.state.control.history.close(axis, kinds);
        let compensation = &mut self.state.control.compensation;
        compensation.havoc(axis, kinds, &mut self.scratch.changes);
        let doubted = compensation.unknown(axis).intersection(kinds);
        if !doubted.is_empty() {
            self.scratch.doubted.push((axis, doubted));
        }
    }
}

impl RunState {
    /// Returns whether the current way executes the blocks with a skip mark around this one.
    fn is_on_marked_way(&self) -> bool {
        let frames = &self.control.frames;
        let here = frames.running().zip(self.track.marked);
        here.is_some_and(|(frame, marked)| {
            (marked.depth, marked.unit) == (frames.depth(), frame.unit)
                && (marked.first < frame.next && frame.next <= marked.after)
        })
    }
}

/// Number of different words of a program that are reported once.
const MAX_ONCE: usize = 1000;

/// The path that is executed, with what all paths of the run have in common.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct RunState {
    /// State of the control.
    pub(crate) control: ControlState,
    /// The way to it.
    pub(crate) track: RunTrack,
    /// The ways that have ended.
    pub(crate) ended: Vec<EndedPath>,
    /// The conditions that ways name, by their numbers.
    pub(crate) conditions: Vec<Condition>,
    /// The questions of the program that read no value, and so have one answer on all ways.
    pub(crate) asked: Vec<AskedCondition>,
    /// Executed blocks of the program.
    pub(crate) seq: u64,
    /// Executed blocks of the session.
    pub(crate) blocks: u64,
    pub(crate) work: WorkBudget,
    /// Words and commands that were passed over.
    pub(crate) opaque: BTreeMap<String, u64>,
    /// The words of the program that were reported, once each (R2.94).
    pub(crate) once: BTreeSet<String>,
    /// The axes that occurred.
    pub(crate) occurred: Vec<bool>,
    /// Whether a loop is compared with an earlier pass, so that reads matter.
    pub(crate) watching: bool,
    pub(crate) reads: RefCell<Reads>,
    /// The last executed block of the main program.
    pub(crate) last: Option<LastBlock>,
    /// The step after the block, where that is not the next block.
    pub(crate) parked: Option<ControlStep>,
    /// The unknown values that messages were about.
    pub(crate) mentioned: MentionedUnknowns,
    /// The open questions whose readings results depend on (R15.3).
    pub(crate) rests_on: QuestionSet,
}

impl RunState {
    /// Returns the state before the first program.
    pub(crate) fn at_start(machine: &Machine, compensation: Compensation) -> Self {
        let configured = machine.axis_set == AxisSet::Configured;
        let occurred = |axis: &Axis| configured || axis.frict_comp_origin != Origin::Default;
        let modal = Modal::at_start(machine.axes.len(), &machine.channel);
        Self {
            control: ControlState::new(compensation, modal),
            track: RunTrack::default(),
            ended: Vec::new(),
            conditions: Vec::new(),
            asked: Vec::new(),
            seq: 0,
            blocks: 0,
            work: WorkBudget::default(),
            opaque: BTreeMap::new(),
            once: BTreeSet::new(),
            occurred: machine.axes.iter().map(occurred).collect(),
            watching: false,
            reads: RefCell::default(),
            last: None,
            parked: None,
            mentioned: MentionedUnknowns::default(),
            rests_on: QuestionSet::default(),
        }
    }

    /// Returns the states of the control here and where paths have ended.
    pub(crate) fn controls_mut(&mut self) -> impl Iterator<Item = &mut ControlState> {
        let ended = self.ended.iter_mut().map(|ended| &mut ended.path.control);
        std::iter::once(&mut self.control).chain(ended)
    }

    /// Returns the states that the program found, where it is now.
    pub(crate) fn found_states(&self) -> FoundStates<'_> {
        FoundStates {
            history: &self.control.history,
            reach: &self.track.reach,
            conditions: &self.conditions,
        }
    }

    /// Restricts the run to some of the ways that lead here.
    pub(crate) fn go_on_with(&mut self, ways: WaySet) {
        self.track.reach = ways;
        let control = &mut self.control;
        control
            .history
            .narrow(&self.track.reach, &mut control.compensation);
    }

    /// Takes the way that was being executed.
    pub(crate) fn leave_path(&mut self) -> Path {
        Path {
            control: self.control.clone(),
            track: std::mem::take(&mut self.track),
            parted: self.seq,
        }
    }

    /// Returns whether a word that is reported once occurs for the first time in the program.
    pub(crate) fn is_new_word(&mut self, word: &str) -> bool {
        let words = &mut self.once;
        words.len() < MAX_ONCE && words.insert(word.to_owned())
    }
}

/// Unknown values that are remembered; beyond them a message may be said again.
const MAX_ROOTS: usize = 1000;

/// The unknown values that messages of the program were about, by what makes them unknown.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct MentionedUnknowns {
    #[serde(with = "rows")]
    roots: BTreeMap<Unknown, Root>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Root {
    /// The block where the value first occurred.
    place: Place,
    /// Names that messages called unknown because of it, with the line of the first.
    named: BTreeMap<String, (Arc<str>, u32)>,
}

impl MentionedUnknowns {
    /// Remembers where a value first occurred.
    pub(crate) fn enter(&mut self, cause: &Unknown, place: impl FnOnce() -> Place) {
        if self.roots.len() < MAX_ROOTS && !self.roots.contains_key(cause) {
            let root = Root {
                place: place(),
                named: BTreeMap::new(),
            };
            self.roots.insert(cause.clone(), root);
        }
    }

    /// Returns the block where a value first occurred.
    pub(crate) fn origin(&self, cause: &Unknown) -> Option<&Place> {
        self.roots.get(cause).map(|root| &root.place)
    }

    /// Returns whether a message names anything that no message about the same value in another block has named. A
    /// message that a loop repeats at its own place is counted, not withheld (R2.85).
    pub(crate) fn is_new(
        &mut self,
        cause: &Unknown,
        named: impl IntoIterator<Item = String>,
        place: &Place,
    ) -> bool {
        let Some(root) = self.roots.get_mut(cause) else {
            return true;
        };
        let here = (place.file.clone(), place.first_line);
        let mut is_new = false;
        for name in named {
            is_new |= *root.named.entry(name).or_insert_with(|| here.clone()) == here;
        }
        is_new
    }
}
