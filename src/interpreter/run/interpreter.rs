//! The interpreter, as a host uses it: the path that is executed, the others, and what the lines beside blocks say.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

use super::executor::Executor;
use super::options::{Options, SourceMode};
use super::other_paths::OtherPaths;
use super::state::RunState;
use crate::comp::{AxisIndex, Compensation};
use crate::diagnostic::Collected;
use crate::interpreter::coordinates::modal::{AxisPosition, Modal};
use crate::interpreter::values::externals::ExternalNames;
use crate::interpreter::values::found::{FoundVariables, VariableUse};
use crate::interpreter::values::value::Value;
use crate::interpreter::ways::possible_state::PossibleStates;
use crate::machine::{Machine, Setting};
use crate::readings::QuestionSet;
use crate::syntax::VariableName;

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
    /// The path that is executed.
    pub(crate) here: Executor,
    /// The others.
    pub(crate) others: OtherPaths,
    pub(crate) source_mode: SourceMode,
    /// Messages on lines that are not blocks and not kept.
    pub(crate) lost: Collected,
}

impl Interpreter {
    /// The kinds that are unknown because ways differ, with the states that are possible (R14.2).
    pub fn possible(&self) -> &[PossibleStates] {
        &self.here.shown.possible
    }

    /// An interpreter for a machine whose compensation is in a given state.
    pub fn new(
        machine: impl Into<Arc<Machine>>,
        compensation: Compensation,
        options: Options,
    ) -> Self {
        let machine = machine.into();
        let state = RunState::at_start(&machine, compensation);
        let mut interpreter = Self::with_state(machine, options, (state, OtherPaths::default()));
        interpreter.here.define_machine_macros();
        interpreter
    }

    pub(crate) fn with_state(
        machine: Arc<Machine>,
        options: Options,
        (mut state, mut others): (RunState, OtherPaths),
    ) -> Self {
        let externals = Arc::new(ExternalNames::new(&machine.stable, &machine.own));
        for control in state.controls_mut().chain(others.controls_mut()) {
            control.memory.describe_externals(&externals);
        }
        Self {
            here: Executor::new(machine, options, externals, state),
            others,
            source_mode: SourceMode::Whole,
            lost: Collected::default(),
        }
    }

    /// Gives a variable the value that only the machine knows (R2.36).
    pub fn set(&mut self, name: &str, setting: &Setting) {
        self.here
            .state
            .control
            .memory
            .give(VariableName::read(name), setting.into());
    }

    /// Sets what programs before this one may have left in variables that outlive programs (R2.34), and records
    /// their use from here on.
    pub(crate) fn find(&mut self, found: &FoundVariables) {
        self.here.state.control.memory.find(found);
        let used = VariableUse::new(self.here.machine.parameters, &self.here.externals);
        self.here.used = Some(RefCell::new(used));
    }

    /// The use of variables that outlive programs by the programs since.
    pub(crate) fn take_use(&mut self) -> VariableUse {
        let used = self.here.used.take().map(RefCell::into_inner);
        used.unwrap_or_default()
    }

    /// Sets the position of an axis before the first program, in mm or degrees; a name that no axis has
    /// is ignored.
    pub fn place(&mut self, name: &str, position: f64) {
        if let Some(axis) = self.here.axis_named(name) {
            self.here.state.control.modal.place(axis, Some(position));
        }
    }

    /// The machine.
    pub fn machine(&self) -> &Arc<Machine> {
        &self.here.machine
    }

    /// The current compensation state.
    pub fn compensation(&self) -> &Compensation {
        &self.here.state.control.compensation
    }

    /// The axes that occurred so far, by position; every axis of a configured machine.
    pub fn occurred(&self) -> &[bool] {
        &self.here.state.occurred
    }

    /// Marks an axis as one that occurred.
    pub fn expect_axis(&mut self, axis: AxisIndex) {
        self.here.state.occurred[axis.get()] = true;
        self.here.version += 1;
    }

    /// Rises whenever the compensation state or the axes that occurred change.
    pub fn version(&self) -> u64 {
        self.here.version
    }

    /// The executed blocks of the session.
    pub fn blocks(&self) -> u64 {
        self.here.state.blocks
    }

    /// Returns the words passed over, with their number.
    pub fn opaque(&self) -> &BTreeMap<String, u64> {
        &self.here.state.opaque
    }

    /// Returns the open questions whose readings the results so far depend on (R15.3).
    pub fn rests_on(&self) -> QuestionSet {
        self.here.state.rests_on
    }

    /// The position of an axis after the last block: the programmed coordinate in mm or degrees.
    pub fn position(&self, axis: AxisIndex) -> AxisPosition {
        self.here.state.control.modal.position(axis)
    }

    /// The G functions in force.
    pub fn modal(&self) -> &Modal {
        &self.here.state.control.modal
    }

    /// The variables that outlive programs and that only programs write: `V.S.`, and `V.E.` where the configuration
    /// says so (R2.34, R2.99).
    pub fn shared_variables(&self) -> BTreeMap<String, Value> {
        self.here.state.control.memory.shared()
    }

    /// The values that the running program sees, by name: the own parameters of its call, the
    /// parameters in the order of their numbers, and the variables.
    pub fn values(&self) -> Vec<(String, Value)> {
        let running = self.here.state.control.frames.running();
        let own = running.into_iter().flat_map(|frame| &frame.own);
        let own = own.map(|(index, value)| (format!("@P{index}"), value.clone()));
        own.chain(self.here.state.control.memory.all()).collect()
    }

    /// Takes over the compensation state of an earlier session.
    pub fn set_compensation(&mut self, compensation: Compensation) {
        self.here.state.control.history.close_all();
        self.here.state.control.compensation = compensation;
        self.here.version += 1;
    }

    /// The work of the session so far, in units: characters of macros, texts and regions that were
    /// gone through, operands that were computed, names that were compared (R2.60).
    pub fn work(&self) -> u64 {
        self.here.state.work.spent()
    }
}
