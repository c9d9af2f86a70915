//! The interpreter, as a host uses it: the path that is executed and the others; what one program hands to the next (R2.34,
//! R9.32), a reset between two of them, and questions to a run that has stopped.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::comp::{AxisIndex, Compensation, Kind, KindSet};
use crate::diagnostic::Collected;
use crate::interpreter::block::{BlockContext, ShownBlockLines};
use crate::interpreter::drive::program::ProgramStop;
use crate::interpreter::executor::{Executor, RunState};
use crate::interpreter::motion::modal::{AxisPosition, Modal};
use crate::interpreter::options::{Options, SourceMode};
use crate::interpreter::stack::ControlStep;
use crate::interpreter::values::externals::ExternalNames;
use crate::interpreter::values::handover::Carried;
use crate::interpreter::values::value::Value;
use crate::interpreter::ways::others::OtherPaths;
use crate::interpreter::ways::possible_state::{CarriedWays, PossibleStates};
use crate::interpreter::ways::words::WayCondition;
use crate::machine::{Machine, Setting};
use crate::readings::{Question, QuestionSet};
use crate::syntax::ast::Block;
use crate::syntax::{Comments, RawBlock, Stretch, VariableName, parse_expression};

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
    /// Returns the kinds that are unknown because ways differ, with the states that are possible (R14.2).
    pub fn possible(&self) -> &[PossibleStates] {
        &self.here.shown.possible
    }

    /// Returns the answers to the condition in the last executed block, where only the machine knows which holds and
    /// none was chosen ([`Branches::OneFollowed`](crate::interpreter::Branches::OneFollowed)).
    pub fn offered(&self) -> &[WayCondition] {
        &self.here.offered
    }

    /// Answers the next such condition with one of the answers that are [`offered`](Self::offered), by its place among
    /// them; a second call answers the one after it.
    pub fn choose(&mut self, place: usize) {
        self.here.chosen.push_back(place);
    }

    /// Returns an interpreter for a machine whose compensation is in a given state.
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

    /// Sets the position of an axis before the first program, in mm or degrees; a name that no axis has
    /// is ignored.
    pub fn place(&mut self, name: &str, position: f64) {
        if let Some(axis) = self.here.axes().named(name) {
            self.here.state.control.modal.place(axis, Some(position));
        }
    }

    /// Returns the machine.
    pub fn machine(&self) -> &Arc<Machine> {
        &self.here.machine
    }

    /// Returns the current compensation state.
    pub fn compensation(&self) -> &Compensation {
        &self.here.state.control.compensation
    }

    /// Returns the axes that occurred so far, by position; every axis of a configured machine.
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

    /// Returns the executed blocks of the session.
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

    /// Returns the position of an axis after the last block: the programmed coordinate in mm or degrees.
    pub fn position(&self, axis: AxisIndex) -> AxisPosition {
        self.here.state.control.modal.position(axis)
    }

    /// Returns the G functions in force.
    pub fn modal(&self) -> &Modal {
        &self.here.state.control.modal
    }

    /// Returns the variables that outlive programs and that only programs write: `V.S.`, and `V.E.` where the
    /// configuration says so (R2.34, R2.99).
    pub fn shared_variables(&self) -> BTreeMap<String, Value> {
        self.here.state.control.memory.shared()
    }

    /// Returns the values that the running program sees, by name: the own parameters of its call, the parameters in the
    /// order of their numbers, and the variables.
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

    /// Returns the work of the session so far, in units: characters of macros, texts and regions that were gone
    /// through, operands that were computed, names that were compared (R2.60).
    pub fn work(&self) -> u64 {
        self.here.state.work.spent()
    }
}

impl Interpreter {
    /// Returns the state that the next program finds.
    pub fn carried(&self) -> Carried {
        let name = |axis: &AxisIndex| self.here.machine.axis(*axis).name.clone();
        let couplings = self.here.state.control.couplings.groups();
        Carried {
            couplings: couplings
                .map(|(group, axes)| (group.to_owned(), axes.iter().map(name).collect()))
                .collect(),
            lost_couplings: self
                .here
                .state
                .control
                .couplings
                .lost()
                .map(|axis| name(&axis))
                .collect(),
            ways: CarriedWays::of(
                &self.here.state.control.history,
                &self.here.state.conditions,
                &self.here.machine,
            ),
            ..self
                .here
                .state
                .control
                .memory
                .carried(self.here.machine.parameters)
        }
    }

    /// Takes over what an earlier session left. Axes that the machine does not have are passed over.
    pub fn take_over(&mut self, mut carried: Carried) {
        let ways = std::mem::take(&mut carried.ways);
        let compensation = &self.here.state.control.compensation;
        (self.here.state.conditions, self.here.state.control.history) =
            ways.into_parts(&self.here.machine, compensation);
        self.here.version += 1;
        self.here.show_ways();
        for (group, names) in &carried.couplings {
            let found = names.iter().filter_map(|name| self.here.machine.find(name));
            let axes = found.collect();
            self.here.state.control.couplings.define(group, axes);
        }
        if !carried.lost_couplings.is_empty() {
            let names = carried.lost_couplings.iter();
            let axes = names.filter_map(|name| self.here.machine.find(name));
            self.here.state.control.couplings.lose(axes);
        }
        self.here.state.control.memory.take_over(carried);
    }

    /// Takes over the position of an axis, and that a program named it.
    pub fn place_axis(&mut self, axis: AxisIndex, position: Option<f64>) {
        self.here.state.occurred[axis.get()] = true;
        self.here.state.control.modal.place(axis, position);
        self.here.version += 1;
    }
}

impl Interpreter {
    /// Resets the channel (R1.28): the compensation stays as it is, or returns to its start-up state, depending on the
    /// reading; kinds with manual activation are switched off in any case. Couplings and exchanged axes end with it,
    /// unless the channel list says otherwise.
    pub fn reset(&mut self) {
        let control = &mut self.here.state.control;
        control.end_exchange(ProgramStop::Reset, &self.here.machine.channel);
        let _ = control.compensation.reset();
        self.here.reset_friction();
        self.here.scratch.changes.clear();
        self.here.version += 1;
    }
}

impl Executor {
    /// Makes friction compensation unknown if the state before the start of the control is not known and the machine is
    /// read as keeping it (R1.29).
    pub(crate) fn havoc_start(&mut self) {
        if self.machine.readings.takes_second(Question::Restart) {
            self.havoc_any_axis(KindSet::of(Kind::Frict));
            self.scratch.clear();
            self.version += 1;
        }
    }
}

impl Interpreter {
    /// Returns a copy positioned in the program whose block comes next. A run that was stopped after a
    /// call is still in the caller, which does not see the parameters of the called program.
    #[must_use]
    pub fn settled(&self) -> Self {
        let mut copy = self.clone();
        match copy.here.state.parked.take() {
            Some(
                step @ (ControlStep::Call(_) | ControlStep::Return | ControlStep::ReturnTo(_)),
            ) => {
                // A return of the main program ends it; then nothing comes next.
                let _ = copy.others.follow(&mut copy.here, step);
            }
            other => copy.here.state.parked = other,
        }
        copy
    }

    /// Computes an expression with the values that the next block would read.
    ///
    /// # Errors
    /// The text is not an expression, or it has no value here: the reason in words.
    pub fn evaluate(&self, text: &str) -> Result<Value, String> {
        let text = text.trim();
        let mut block = Block::default();
        let operand = parse_expression(text, &mut block)
            .ok_or_else(|| format!("`{text}` is not an expression"))?;
        let mut copy = self.settled();
        let (file, shown) = (Arc::from(""), ShownBlockLines::default());
        let raw = RawBlock {
            stretch: Stretch::Block,
            text,
            line: 1,
            offset: 0,
            comments: Comments::Absent,
            plain: false,
            remark: None,
        };
        let at = BlockContext::of_raw(&file, &raw, &block, &shown);
        copy.here.value(operand, &at).map_err(|fault| fault.message)
    }
}
