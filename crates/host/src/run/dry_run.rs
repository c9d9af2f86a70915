//! Running programs in a session.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use super::state_file::StateFile;
use crate::disk::{Disk, FileRegistry, Input, Naming, Opened};
use crate::error::HostError;
use crate::machines::{AxesAhead, LoadedMachine, ProgramFinder, SearchPath, switched_axes};
use crate::watch::{Watch, Watched};
use frictcomp::diagnostic::Diagnostic;
use frictcomp::machine::AxisSet;
use frictcomp::session::{Program, Session, SessionOptions};
use frictcomp::timeline::Sink;

/// Folders of called programs, and the naming of files.
#[derive(Clone)]
pub struct RunContext<'a> {
    search_path: SearchPath,
    registry: FileRegistry,
    disk: Disk,
    watch: Arc<Watch>,
    naming: Naming,
    before_waiting: &'a dyn Fn(),
}

impl<'a> RunContext<'a> {
    /// Creates the context of a machine's configuration.
    pub fn new(loaded: &LoadedMachine, naming: Naming) -> Self {
        Self {
            search_path: loaded.search_path.clone(),
            registry: loaded.registry.clone(),
            disk: loaded.disk.clone(),
            watch: Arc::clone(&loaded.watch),
            naming,
            before_waiting: &|| (),
        }
    }

    /// Sets what is called whenever a pipe may have to wait for more of a program.
    pub fn before_waiting(self, before_waiting: &'a dyn Fn()) -> Self {
        Self {
            before_waiting,
            ..self
        }
    }
}

/// Runs one program in a session. `Break` when the sink takes no more.
///
/// # Errors
/// The program cannot be read.
pub fn run_program(
    session: &mut Session,
    input: &Input,
    context: &RunContext<'_>,
    sink: &mut dyn Sink,
) -> Result<ControlFlow<()>, HostError> {
    let name = input.name(context.naming);
    let watch = &*context.watch;
    let mut watched;
    let sink: &mut dyn Sink = if watch.is_on() {
        watched = Watched::new(sink, watch);
        &mut watched
    } else {
        sink
    };
    let RunContext {
        search_path,
        naming,
        disk,
        registry,
        ..
    } = context;
    let mut finder = ProgramFinder::new(input, search_path, *naming, disk).noting(registry);
    let flow = match input.open(context.naming, context.before_waiting)? {
        Opened::Whole(source) => session.program(&name, Program::Whole(source), &mut finder, sink),
        Opened::Lines(mut lines) => {
            let flow = session.program(&name, Program::Lines(&mut lines), &mut finder, sink);
            if let Some(error) = lines.take_failure() {
                return Err(HostError::read(Path::new(&name), error));
            }
            flow
        }
    };
    watch.program_done();
    Ok(match flow {
        ControlFlow::Break(()) => ControlFlow::Break(()),
        ControlFlow::Continue(_) => ControlFlow::Continue(()),
    })
}

/// Opens a session that continues from a saved state, or begins at the start of the control; also returns
/// the messages of the control about lists that changed since the state was saved (P-ERR-110641).
///
/// # Errors
/// The state cannot be read, is damaged, or belongs to another machine.
pub fn open_session(
    loaded: &LoadedMachine,
    options: SessionOptions,
    state: Option<&StateFile>,
) -> Result<(Session, Vec<Diagnostic>), HostError> {
    let machine = loaded.machine.clone();
    if let Some(file) = state
        && let Some(saved) = file.load()?
    {
        return Session::resume(machine, options, saved).map_err(|error| file.refused(&error));
    }
    Ok((Session::new(machine, options), Vec::new()))
}

/// Lists from the start the axes found by a look through the programs, where no machine is described
/// (R9.74).
pub fn expect_axes(session: &mut Session, loaded: &LoadedMachine, inputs: &[Input]) {
    if loaded.machine.axis_set == AxisSet::AsTheyOccur {
        session.expect_axes(AxesAhead::of(inputs, []).names());
    }
}

/// Programs that run one after the other.
#[derive(Debug, Clone, Copy)]
pub struct Programs<'a> {
    /// The programs.
    pub inputs: &'a [Input],
    /// Messages on the machine before the first of them.
    pub said: &'a [Diagnostic],
}

/// Progress of the programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct RunSummary {
    /// `Break` when the sink took no more.
    pub flow: ControlFlow<()>,
    /// Number of programs that did not run when the session stopped.
    pub unrun: usize,
}

/// Runs programs in a session, from its beginning to its summary.
///
/// # Errors
/// A program cannot be read.
pub fn run_programs(
    session: &mut Session,
    programs: Programs<'_>,
    context: &RunContext<'_>,
    sink: &mut dyn Sink,
) -> Result<RunSummary, HostError> {
    let mut flow = session.begin(programs.said, sink);
    let mut unrun = programs.inputs.len();
    for input in programs.inputs {
        if flow.is_break() || session.is_stopped() {
            break;
        }
        unrun -= 1;
        flow = run_program(session, input, context, sink)?;
    }
    if flow.is_continue() {
        flow = session.finish(sink);
    } else {
        unrun = 0;
    }
    Ok(RunSummary { flow, unrun })
}

/// Setup for a program that runs in a separate session.
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct SingleRun {
    /// Options of the session.
    pub options: SessionOptions,
    /// Naming of files in records.
    pub naming: Naming,
    /// Listed axes where no machine is described.
    pub axes: Axes,
}

/// Listed axes where no machine is described.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Axes {
    /// Axes found by a look through the program (R9.74).
    Ahead,
    /// No list of the axes: they are added as they occur.
    AsTheyOccur,
}

/// Runs one program in a separate session, from the start of the control to the summary, and
/// returns the session.
///
/// # Errors
/// The program cannot be read.
pub fn run_alone(
    input: &Input,
    loaded: &LoadedMachine,
    alone: SingleRun,
    sink: &mut dyn Sink,
) -> Result<Session, HostError> {
    let context = RunContext::new(loaded, alone.naming);
    let mut options = alone.options;
    if !loaded.machine.is_described() {
        options.switched = switched_axes([input]);
    }
    let mut session = Session::new(loaded.machine.clone(), options);
    if alone.axes == Axes::Ahead {
        expect_axes(&mut session, loaded, std::slice::from_ref(input));
    }
    let mut flow = begin(&mut session, loaded, sink);
    if flow.is_continue() {
        flow = run_program(&mut session, input, &context, sink)?;
    }
    if flow.is_continue() {
        let _ = session.finish(sink);
    }
    Ok(session)
}

/// Reports what the session starts with, and why the control does not accept its lists.
pub(crate) fn begin(
    session: &mut Session,
    loaded: &LoadedMachine,
    sink: &mut dyn Sink,
) -> ControlFlow<()> {
    let errors: Vec<_> = loaded.errors().cloned().collect();
    session.begin(&errors, sink)
}
