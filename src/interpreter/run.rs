//! The interpreter: a machine, the state of a run on it, and the files it consists of.

use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

use super::coupling::Couplings;
use super::cycles::ModalCycles;
use super::exchange::ChannelAxes;
use super::finder::NoProgram;
use super::memory::Memory;
use super::modal::{AxisPosition, Modal};
use super::options::{Handed, Options};
use super::program::EntryIndex;
use super::sequence::Sought;
use super::state::State;
use super::unit::Unit;
use super::unknown::{Journal, Regions, Scan};
use super::value::Value;
use super::ways::{Departing, Ways};
use super::work::Work;
use crate::comp::{AxisIndex, Compensation};
use crate::diagnostic::Collected;
use crate::machine::{AxisSet, Machine, Setting};

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
pub struct Interpreter {
    pub(super) machine: Arc<Machine>,
    pub(super) options: Options,
    pub(super) handed: Handed,
    /// The axes with one-letter names.
    pub(super) letters: [Option<AxisIndex>; 26],
    /// The axes with longer names.
    pub(super) names: BTreeMap<String, AxisIndex>,
    /// Whether any axis requires a compensation (P-AXIS-00465).
    pub(super) any_required: bool,
    pub(super) units: Vec<Unit>,
    /// The blocks of sections by their numbers, where those were asked for.
    pub(super) numbers: HashMap<(usize, usize), HashMap<i64, EntryIndex>>,
    /// Where a main program that is read line by line goes on.
    pub(super) sought: Option<Sought>,
    /// Which file a call by name from a file meant.
    pub(super) found: BTreeMap<(String, String), usize>,
    /// Which calls found none, and why.
    pub(super) missing: BTreeMap<(String, String), NoProgram>,
    /// The files of the run by name.
    pub(super) unit_names: HashMap<Arc<str>, usize>,
    /// Calls in regions that may or may not be executed.
    pub(super) pending: Vec<Scan>,
    /// Ways that leave at the block that is executed.
    pub(super) departing: Vec<Departing>,
    pub(super) regions: Regions,
    /// What there is to say about comments of lines that are not kept.
    pub(super) lost: Collected,
    pub(super) journal: Journal,
    pub(super) kept: usize,
    /// Bytes of the programs in memory.
    pub(super) held_text: u64,
    /// Names that were compared with those of calls that found nothing.
    pub(super) compared: usize,
    pub(super) state: State,
    pub(super) version: u64,
    pub(super) work: Work,
}

impl Interpreter {
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
            .map(|axis| configured || axis.frict_comp_origin != crate::machine::Origin::Default)
            .collect();
        let state = State {
            compensation,
            memory: Memory::default(),
            modal: Modal::new(axes),
            frames: Vec::new(),
            seq: 0,
            blocks: 0,
            spent: Cell::new(0),
            level: Cell::new(0),
            opaque: BTreeMap::new(),
            occurred,
            couplings: Couplings::default(),
            channel_axes: ChannelAxes::default(),
            cycles: ModalCycles::default(),
            loops: Vec::new(),
            left_loops: Vec::new(),
            watching: false,
            reads: RefCell::default(),
            refused: BTreeSet::new(),
            ending: None,
            last: None,
            parked: None,
            named: BTreeMap::new(),
            described: None,
            ways: Ways::default(),
        };
        let mut interpreter = Self::with_state(machine, options, state);
        interpreter.define_machine_macros();
        interpreter
    }

    pub(super) fn with_state(machine: Arc<Machine>, options: Options, state: State) -> Self {
        let mut letters = [None; 26];
        let mut names = BTreeMap::new();
        for (position, axis) in machine.axes.iter().enumerate() {
            let index = AxisIndex::new(position);
            match axis.name.as_bytes() {
                [letter @ b'A'..=b'Z'] => letters[usize::from(letter - b'A')] = Some(index),
                _ => {
                    names.insert(axis.name.clone(), index);
                }
            }
        }
        Self {
            any_required: machine.axes.iter().any(|axis| !axis.required.is_empty()),
            machine,
            options,
            handed: Handed::Whole,
            letters,
            names,
            units: Vec::new(),
            numbers: HashMap::new(),
            sought: None,
            found: BTreeMap::new(),
            missing: BTreeMap::new(),
            unit_names: HashMap::new(),
            pending: Vec::new(),
            departing: Vec::new(),
            regions: Regions::new(),
            lost: Collected::default(),
            journal: Journal::default(),
            kept: 0,
            held_text: 0,
            compared: 0,
            state,
            version: 0,
            work: Work::default(),
        }
    }

    /// Gives a variable the value that only the machine knows (R2.36).
    pub fn set(&mut self, name: &str, setting: &Setting) {
        self.state.memory.give(name, setting.into());
        self.journal.begin_anew();
    }

    /// The machine.
    pub fn machine(&self) -> &Arc<Machine> {
        &self.machine
    }

    /// The compensation state of the moment.
    pub fn compensation(&self) -> &Compensation {
        &self.state.compensation
    }

    /// The axes that occurred so far, by position; every axis of a configured machine.
    pub fn occurred(&self) -> &[bool] {
        &self.state.occurred
    }

    /// Takes an axis for one that occurred.
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

    /// What was passed over, by word.
    pub fn opaque(&self) -> &BTreeMap<String, u64> {
        &self.state.opaque
    }

    /// The position of an axis after the last block: the programmed coordinate in mm or degrees.
    pub fn position(&self, axis: AxisIndex) -> AxisPosition {
        self.state.modal.position(axis)
    }

    /// The G functions in force.
    pub fn modal(&self) -> &Modal {
        &self.state.modal
    }

    /// The `V.S.` variables, which outlive programs (R2.34).
    pub fn shared_variables(&self) -> BTreeMap<String, Value> {
        self.state.memory.shared()
    }

    /// Takes over the compensation state of an earlier session.
    pub fn set_compensation(&mut self, compensation: Compensation) {
        self.state.compensation = compensation;
        self.version += 1;
    }
}
