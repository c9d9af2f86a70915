//! The interpreter: a machine, the state of a run on it, and the files it consists of.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::ops::Range;
use std::sync::Arc;

use super::block_scratch::BlockScratch;
use super::call_effects::CallEffects;
use super::channel_axes::AxisNameMeaning;
use super::control::ControlState;
use super::loop_heads::LoopHeads;
use super::mentioned::MentionedUnknowns;
use super::options::{Options, SourceMode};
use super::path::{BranchSide, RunTrack};
use super::state::State;
use super::step::AwaitedBlock;
use super::waiting_paths::WaitingPaths;
use crate::comp::{AxisIndex, Compensation, KindSet};
use crate::diagnostic::{Collected, Diagnostic};
use crate::interpreter::coordinates::modal::{AxisPosition, Modal};
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::programs::store::ProgramStore;
use crate::interpreter::values::externals::ExternalNames;
use crate::interpreter::values::found::{FoundVariables, VariableUse};
use crate::interpreter::values::value::Value;
use crate::interpreter::values::work_budget::{PER_UNIT_READ, WorkBudget};
use crate::interpreter::ways::possible_state::{PossibleStates, shown, ways_of};
use crate::interpreter::ways::words::WayCondition;
use crate::machine::{AxisSet, Machine, Setting};
use crate::readings::QuestionSet;
use crate::syntax::ast::Block;
use crate::syntax::{SkipLevels, VariableFamily, VariableName};

/// Runs programs on a machine.
///
/// ```
/// use std::ops::ControlFlow;
/// use frictcomp::interpreter::{Event, Interpreter, NoFiles, Options};
/// use frictcomp::{machine::Machine, text::SourceFile};
///
/// let machine = Machine::enabled(["X"]);
/// let comp = machine.compensation();
/// let mut run = Interpreter::new(machine, comp, Options::default());
/// let program = SourceFile::new("a.nc", "N10 X[COMP OFF FRICT]\nN20 M30\n");
/// let mut changes = 0;
/// run.program(program, &mut NoFiles, &mut |event: Event<'_>| {
///     if let Event::Executed(block) = event {
///         changes += block.changes.len();
///     }
///     ControlFlow::Continue(())
/// });
/// assert_eq!(changes, 1);
/// ```
///
/// A clone is at the same block as the run and shares its texts: a debugger uses it to look ahead.
#[derive(Clone)]
pub struct Interpreter {
    pub(crate) machine: Arc<Machine>,
    pub(crate) options: Options,
    pub(crate) source_mode: SourceMode,
    /// The axes with one-letter names.
    pub(crate) letters: [Option<AxisIndex>; 26],
    /// The axes with longer names.
    pub(crate) names: BTreeMap<String, AxisIndex>,
    /// The variables of the machine of which the configuration says who writes them (R14.1, R2.99).
    pub(crate) externals: Arc<ExternalNames>,
    /// Whether any axis requires a compensation (P-AXIS-00465).
    pub(crate) any_required: bool,
    pub(crate) programs: ProgramStore,
    /// Label at which a main program that is read line by line continues.
    pub(crate) awaited: Option<AwaitedBlock>,
    /// Targets of the answers to the condition of the current block.
    pub(crate) sides: Vec<BranchSide>,
    /// The states that are possible, as users see them, and where they count.
    pub(crate) shown: ShownWays,
    /// Messages on ways that joined before the current block.
    pub(crate) joined: Vec<Diagnostic>,
    /// Such messages that are withheld, because they were reported before or nothing differs.
    pub(crate) joined_withheld: Vec<Diagnostic>,
    /// The answers among which the user may choose where one way is followed.
    pub(crate) offered: Vec<WayCondition>,
    /// The places of the chosen answers to the next such conditions.
    pub(crate) chosen: VecDeque<usize>,
    /// Messages on lines that are not blocks and not kept.
    pub(crate) lost: Collected,
    pub(crate) state: State,
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

impl Interpreter {
    /// Updates the ways that are shown.
    #[inline]
    pub(crate) fn show_ways(&mut self) {
        if self.shown.version != self.version {
            self.show_ways_anew();
        }
    }

    #[inline(never)]
    fn show_ways_anew(&mut self) {
        let State {
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

    /// The kinds that are unknown because ways differ, with the states that are possible (R14.2).
    pub fn possible(&self) -> &[PossibleStates] {
        &self.shown.possible
    }

    /// An interpreter for a machine whose compensation is in a given state.
    pub fn new(
        machine: impl Into<Arc<Machine>>,
        compensation: Compensation,
        options: Options,
    ) -> Self {
        let machine = machine.into();
        let axes = machine.axes.len();
        let configured = machine.axis_set == AxisSet::Configured;
        let occurred = machine
            .axes
            .iter()
            .map(|axis| configured || axis.frict_comp_origin != crate::lists::Origin::Default)
            .collect();
        let modal = Modal::at_start(axes, &machine.channel);
        let state = State {
            control: ControlState::new(compensation, modal),
            track: RunTrack::default(),
            waiting: WaitingPaths::default(),
            loop_heads: LoopHeads::default(),
            call_effects: CallEffects::default(),
            ended: Vec::new(),
            conditions: Vec::new(),
            seq: 0,
            blocks: 0,
            work: WorkBudget::default(),
            widened: 0,
            opaque: BTreeMap::new(),
            once: BTreeSet::new(),
            occurred,
            watching: false,
            reads: RefCell::default(),
            last: None,
            parked: None,
            mentioned: MentionedUnknowns::default(),
            rests_on: QuestionSet::default(),
        };
        let mut interpreter = Self::with_state(machine, options, state);
        interpreter.define_machine_macros();
        interpreter
    }

    pub(crate) fn with_state(machine: Arc<Machine>, options: Options, mut state: State) -> Self {
        let mut letters = [None; 26];
        let mut names = BTreeMap::new();
        // A spindle is not an axis that coordinates move.
        let axes = machine.axes.iter().enumerate();
        for (position, axis) in axes.filter(|(_, axis)| !axis.is_spindle()) {
            let index = AxisIndex::new(position);
            match axis.name.as_bytes() {
                [letter @ b'A'..=b'Z'] => letters[usize::from(letter - b'A')] = Some(index),
                _ => {
                    names.insert(axis.name.clone(), index);
                }
            }
        }
        let externals = Arc::new(ExternalNames::new(&machine.stable, &machine.own));
        for control in state.controls_mut() {
            control.memory.describe_externals(&externals);
        }
        Self {
            externals,
            any_required: machine.axes.iter().any(|axis| !axis.monitored().is_empty()),
            machine,
            options,
            programs: ProgramStore::new(options.limits.nesting),
            source_mode: SourceMode::Whole,
            letters,
            names,
            awaited: None,
            sides: Vec::new(),
            joined: Vec::new(),
            joined_withheld: Vec::new(),
            offered: Vec::new(),
            chosen: VecDeque::new(),
            shown: ShownWays::default(),
            lost: Collected::default(),
            used: None,
            state,
            version: 1,
            scratch: BlockScratch::default(),
        }
    }

    /// Gives a variable the value that only the machine knows (R2.36).
    pub fn set(&mut self, name: &str, setting: &Setting) {
        self.state
            .control
            .memory
            .give(VariableName::read(name), setting.into());
    }

    /// Sets what programs before this one may have left in variables that outlive programs (R2.34), and records
    /// their use from here on.
    pub(crate) fn find(&mut self, found: &FoundVariables) {
        self.state.control.memory.find(found);
        let used = VariableUse::new(self.machine.parameters, &self.externals);
        self.used = Some(RefCell::new(used));
    }

    /// The use of variables that outlive programs by the programs since.
    pub(crate) fn take_use(&mut self) -> VariableUse {
        let used = self.used.take().map(RefCell::into_inner);
        used.unwrap_or_default()
    }

    /// Records the use of variables that outlive programs, if requested.
    pub(crate) fn note_use(&self, note: impl FnOnce(&mut VariableUse)) {
        if let Some(used) = &self.used {
            note(&mut used.borrow_mut());
        }
    }

    /// Sets the position of an axis before the first program, in mm or degrees; a name that no axis has
    /// is ignored.
    pub fn place(&mut self, name: &str, position: f64) {
        if let Some(axis) = self.axis_named(name) {
            self.state.control.modal.place(axis, Some(position));
        }
    }

    /// The machine.
    pub fn machine(&self) -> &Arc<Machine> {
        &self.machine
    }

    /// The current compensation state.
    pub fn compensation(&self) -> &Compensation {
        &self.state.control.compensation
    }

    /// The axes that occurred so far, by position; every axis of a configured machine.
    pub fn occurred(&self) -> &[bool] {
        &self.state.occurred
    }

    /// Marks an axis as one that occurred.
    pub fn expect_axis(&mut self, axis: AxisIndex) {
        self.state.occurred[axis.get()] = true;
        self.version += 1;
    }

    /// Rises whenever the compensation state or the axes that occurred change.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// The executed blocks of the session.
    pub fn blocks(&self) -> u64 {
        self.state.blocks
    }

    /// Returns the words passed over, with their number.
    pub fn opaque(&self) -> &BTreeMap<String, u64> {
        &self.state.opaque
    }

    /// Returns the open questions whose readings the results so far depend on (R15.3).
    pub fn rests_on(&self) -> QuestionSet {
        self.state.rests_on
    }

    /// The position of an axis after the last block: the programmed coordinate in mm or degrees.
    pub fn position(&self, axis: AxisIndex) -> AxisPosition {
        self.state.control.modal.position(axis)
    }

    /// The G functions in force.
    pub fn modal(&self) -> &Modal {
        &self.state.control.modal
    }

    /// The variables that outlive programs and that only programs write: `V.S.`, and `V.E.` where the configuration
    /// says so (R2.34, R2.99).
    pub fn shared_variables(&self) -> BTreeMap<String, Value> {
        self.state.control.memory.shared()
    }

    /// Whether a variable outlives programs, and only they write it.
    pub(crate) fn only_programs_write(&self, name: &VariableName) -> bool {
        name.family() == VariableFamily::Shared || self.externals.is_own(name)
    }

    /// The values that the running program sees, by name: the own parameters of its call, the
    /// parameters in the order of their numbers, and the variables.
    pub fn values(&self) -> Vec<(String, Value)> {
        let running = self.state.control.frames.running();
        let own = running.into_iter().flat_map(|frame| &frame.own);
        let own = own.map(|(index, value)| (format!("@P{index}"), value.clone()));
        own.chain(self.state.control.memory.all()).collect()
    }

    /// Takes over the compensation state of an earlier session.
    pub fn set_compensation(&mut self, compensation: Compensation) {
        self.state.control.history.close_all();
        self.state.control.compensation = compensation;
        self.version += 1;
    }

    /// The axis that `@X` means in the plane in force.
    pub(crate) fn main_axis(&self, letter: u8) -> Option<AxisIndex> {
        let letter = self.state.control.modal.main_axis(letter)?;
        self.letter_axis(letter)
    }

    /// The axis that a letter currently denotes, if that is known.
    pub(crate) fn letter_axis(&self, letter: u8) -> Option<AxisIndex> {
        let mut name = [0; 4];
        self.axis_named(char::from(letter).encode_utf8(&mut name))
    }

    /// The axis that a name currently denotes, if that is known.
    pub(crate) fn axis_now(&self, name: &str) -> Option<AxisIndex> {
        match self.state.control.channel_axes.meaning(name) {
            None => self.machine.find(name),
            Some(AxisNameMeaning::Axis(axis)) => Some(axis),
            Some(AxisNameMeaning::Released(_) | AxisNameMeaning::Unknown) => None,
        }
    }

    /// An axis by its name.
    pub(crate) fn axis_named(&self, name: &str) -> Option<AxisIndex> {
        if let Some(meaning) = self.state.control.channel_axes.meaning(name) {
            return match meaning {
                AxisNameMeaning::Axis(axis) => Some(axis),
                AxisNameMeaning::Released(_) | AxisNameMeaning::Unknown => None,
            };
        }
        match name.as_bytes() {
            [letter @ b'A'..=b'Z'] => self.letters[usize::from(letter - b'A')],
            _ => self.names.get(name).copied(),
        }
    }

    /// Whether a name is that of the main spindle (P-CHAN-00053).
    pub(crate) fn is_main_spindle(&self, name: &str) -> bool {
        name == "S"
            || self
                .machine
                .channel
                .main_spindle
                .iter()
                .any(|main| main == name)
    }

    /// An axis occurs.
    #[inline]
    pub(crate) fn see(&mut self, axis: AxisIndex) {
        self.scratch.new_axes |= !std::mem::replace(&mut self.state.occurred[axis.get()], true);
    }

    /// The skip levels that are on, where they are known (R2.90).
    pub(crate) fn skip_levels(&self) -> Option<SkipLevels> {
        self.options.skip.or(self.machine.skip)
    }

    /// Whether a block is known not to be executed.
    pub(crate) fn is_skipped(&self, block: &Block) -> bool {
        let skips = |level| self.skip_levels().is_some_and(|levels| levels.has(level));
        block.skip.is_some_and(skips)
    }

    /// The skip level that decides whether a block is executed, where that is not known.
    #[inline]
    pub(crate) fn undecided_level(&self, block: &Block) -> Option<u8> {
        block
            .skip
            .filter(|_| self.skip_levels().is_none() && !self.state.is_on_marked_way())
    }

    /// The level that decides whether the parts of a control block belong together: one of them has a
    /// skip mark and its opener has none.
    pub(crate) fn split_level(&self) -> Option<u8> {
        let frame = self.state.control.frames.running()?;
        let entry = frame.next.checked_sub(1)?;
        let level = self.programs.index(frame.unit).split.get(&entry).copied()?;
        let is_known = self.skip_levels().is_some() || self.state.is_on_marked_way();
        (!is_known).then_some(level)
    }

    /// The work of the session so far, in units: characters of macros, texts and regions that were
    /// gone through, operands that were computed, names that were compared (R2.60).
    pub fn work(&self) -> u64 {
        self.state.work.spent()
    }

    /// Returns the limit of the level of work.
    pub(crate) fn work_bound(&self) -> u64 {
        let granted = self.programs.granted();
        self.options.limits.work.saturating_add(granted)
    }

    /// Whether even reading what the ways could change takes too much work.
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

    /// Whether the budget of work is used up.
    pub(crate) fn is_exhausted(&self) -> bool {
        self.state.work.level() > self.work_bound() || self.is_past_all_ways()
    }

    /// The macros of the channel list, which no program takes away (TF5200 Programming manual,
    /// 208400267).
    pub(crate) fn define_machine_macros(&mut self) {
        for (name, code) in &self.machine.programs.macros {
            self.state.control.memory.define_macro(name, code);
        }
    }

    /// The statement being executed and the end of its control block.
    pub(crate) fn current_block(&self) -> Range<EntryIndex> {
        self.state.control.frames.running().map_or(0..0, |frame| {
            let entry = frame.next - 1;
            entry..self.programs.index(frame.unit).links(entry).end
        })
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

impl State {
    /// Whether the current way executes the blocks with a skip mark around this one.
    fn is_on_marked_way(&self) -> bool {
        let frames = &self.control.frames;
        let here = frames.running().zip(self.track.marked);
        here.is_some_and(|(frame, marked)| {
            (marked.depth, marked.unit) == (frames.depth(), frame.unit)
                && (marked.first < frame.next && frame.next <= marked.after)
        })
    }
}
