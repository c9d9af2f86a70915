//! `frictcomp.run`: programs one after the other in one session.

use frictcomp::interpreter::{Options, StopPolicy};
use frictcomp::{diagnostic::Diagnostic, session::Session};
use frictcomp_host::{
    self, MachineOptions, Naming, RunContext, expect_axes, open_session, run_programs,
    switched_axes,
};
use pyo3::prelude::*;

use crate::arrow::ArrowTable;
use crate::failure::Failure;
use crate::kinds::Kinds;
use crate::limits::{self, PyLimits};
use crate::machine::{machine_of, machine_options};
use crate::messages::GivenMessages;
use crate::program::GivenPrograms;
use crate::state::{self, StartState};
use crate::timeline::{PyTimeline, RecordedSession, Recorder, ShownColumns};
use crate::work::{Stop, interruptible};

/// Runs programs one after the other, as they are given, in one session of the control; a set has no order.
///
/// A program is a path, or a text: ``Text``, or ``bytes``. ``state`` is what an earlier run left;
/// the path of a state file is read and, at the end, written, as ``--state`` does. An error of the
/// control stops the session unless ``keep_going`` is set. ``kinds`` adds columns such as ``X.LEAD``,
/// ``positions`` adds ``X_pos`` in mm or degrees.
#[pyfunction]
#[pyo3(signature = (program, *, machine=None, state=None, keep_going=false, kinds=None, positions=false, limits=None))]
// Each is a separate argument in Python.
#[allow(clippy::too_many_arguments)]
pub(crate) fn run(
    program: &Bound<'_, PyAny>,
    machine: Option<&Bound<'_, PyAny>>,
    state: Option<&Bound<'_, PyAny>>,
    keep_going: bool,
    kinds: Option<Kinds>,
    positions: bool,
    limits: Option<&Bound<'_, PyLimits>>,
) -> PyResult<PyTimeline> {
    let job = RunJob {
        programs: GivenPrograms::in_order(program)?,
        machine: machine_options(machine)?,
        start: StartState::of(state)?,
        run: limits::options(limits).with_stop(if keep_going {
            StopPolicy::KeepGoing
        } else {
            StopPolicy::FirstError
        }),
        shown: ShownColumns {
            kinds: Kinds::of(kinds)?,
            positions,
        },
    };
    let recorded = interruptible(program.py(), move |stop| job.done(stop))?;
    PyTimeline::new(program.py(), recorded)
}

/// Input of a run, independent of Python.
struct RunJob {
    programs: GivenPrograms,
    machine: MachineOptions,
    start: StartState,
    run: Options,
    shown: ShownColumns,
}

impl RunJob {
    /// Does the run, and returns what was recorded.
    fn done(self, stop: &Stop) -> Result<(RecordedSession, ArrowTable, GivenMessages), Failure> {
        let inputs = &self.programs.inputs;
        self.programs.probe()?;
        let loaded = machine_of(self.machine, &self.programs, self.start.axes())?;
        let mut options = loaded.session(self.run);
        if !loaded.machine.is_described() {
            options = options.with_switched(switched_axes(inputs));
        }
        let file = self.start.lock()?;
        let (mut session, changed) = match self.start {
            StartState::Left(saved) => {
                let resumed = Session::resume(loaded.machine.clone(), options, (*saved).clone());
                resumed.map_err(Failure::of_state)?
            }
            _ => open_session(&loaded, options, file.as_ref())?,
        };
        expect_axes(&mut session, &loaded, inputs);
        let said: Vec<Diagnostic> = loaded.errors().chain(&changed).cloned().collect();
        let programs = frictcomp_host::Programs {
            inputs,
            said: &said,
        };
        let surroundings = RunContext::new(&loaded, Naming::AsGiven);
        let mut recorder = Recorder::new(self.shown, stop);
        let played = run_programs(&mut session, programs, &surroundings, &mut recorder)?;
        let saved = session.save();
        if let (true, Some(file)) = (played.flow.is_continue(), &file) {
            state::save(file, &saved)?;
        }
        Ok(recorder.finish(session.state(), saved, played.unrun))
    }
}
