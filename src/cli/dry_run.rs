//! Programs on their way through a session.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use clap::Args;

use super::discovery::LoadedMachine;
use super::failure::Failure;
use super::files::{Input, Naming, Opened};
use super::finder::{ProgramFinder, Reach};
use super::ledger::Ledger;
use super::lookahead::AxesAhead;
use super::settings::{self, SkipLevels};
use super::switched;
use super::watch::{Watch, Watched};
use crate::machine::AxisSet;
use crate::report::command_line;
use crate::session::{Limits, Motions, Notes, Program, Session, SessionOptions, StopPolicy};
use crate::timeline::Sink;

/// What a dry run skips and where it ends.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Execution")]
pub(super) struct ExecutionArgs {
    /// Skip blocks that begin with `/`, by level: `1,3-5` or `all`
    #[arg(long, value_name = "LEVELS", value_parser = settings::parse_levels)]
    skip: Option<SkipLevels>,
    /// The largest number of executed blocks
    #[arg(long, value_name = "N", default_value_t = Limits::default().blocks)]
    #[arg(value_parser = clap::value_parser!(u64).range(1..))]
    max_blocks: u64,
    /// The largest amount of work beyond the text of the blocks, caused by macros, growing strings
    /// and regions under unknown conditions
    #[arg(long, value_name = "N", default_value_t = Limits::default().work)]
    max_work: u64,
    /// The largest number of values that a program may hold
    #[arg(long, value_name = "N", default_value_t = Limits::default().values)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..))]
    max_values: u32,
    /// The deepest nesting of subprogram calls
    #[arg(long, value_name = "N", default_value_t = Limits::default().calls)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..))]
    max_calls: u32,
    /// The deepest nesting of `$` control blocks
    #[arg(long, value_name = "N", default_value_t = Limits::default().nesting)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..))]
    max_nesting: u32,
    /// The deepest nesting of macros, at most 64
    #[arg(long, value_name = "N", default_value_t = Limits::default().macros)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=64))]
    max_macros: u32,
}

impl ExecutionArgs {
    /// The options of a session on a machine.
    pub(super) fn options(&self, loaded: &LoadedMachine, stop: StopPolicy) -> SessionOptions {
        SessionOptions {
            stop,
            skip: self.skip.unwrap_or_default().0,
            limits: Limits {
                blocks: self.max_blocks,
                work: self.max_work,
                values: self.max_values,
                calls: self.max_calls,
                nesting: self.max_nesting,
                macros: self.max_macros,
            },
            levels: loaded.levels.clone(),
            settings: loaded.settings.clone(),
            notes: Notes::None,
            motions: Motions::None,
            switched: Vec::new(),
            wording: Some(command_line),
        }
    }
}

/// Where called programs are looked for, and how files are named.
#[derive(Clone)]
pub(super) struct Surroundings<'a> {
    reach: Reach,
    ledger: Ledger,
    watch: Arc<Watch>,
    naming: Naming,
    before_waiting: &'a dyn Fn(),
}

impl<'a> Surroundings<'a> {
    pub(super) fn new(loaded: &LoadedMachine, naming: Naming) -> Self {
        Self {
            reach: loaded.reach.clone(),
            ledger: loaded.ledger.clone(),
            watch: Arc::clone(&loaded.watch),
            naming,
            before_waiting: &|| (),
        }
    }

    /// The same; what is called whenever a pipe may have to wait for more of a program.
    pub(super) fn before_waiting(self, before_waiting: &'a dyn Fn()) -> Self {
        Self {
            before_waiting,
            ..self
        }
    }
}

/// Runs one program in a session. `Break` when the sink wants no more.
pub(super) fn run_program(
    session: &mut Session,
    input: &Input,
    surroundings: &Surroundings<'_>,
    sink: &mut dyn Sink,
) -> Result<ControlFlow<()>, Failure> {
    let name = input.name(surroundings.naming);
    let watch = &*surroundings.watch;
    let mut watched;
    let sink: &mut dyn Sink = if watch.is_on() {
        watched = Watched::new(sink, watch);
        &mut watched
    } else {
        sink
    };
    let finder = ProgramFinder::new(input, &surroundings.reach, surroundings.naming);
    let mut finder = finder.noting(&surroundings.ledger);
    let flow = match input.open(surroundings.naming, surroundings.before_waiting)? {
        Opened::Whole(source) => session.program(&name, Program::Whole(source), &mut finder, sink),
        Opened::Lines(mut lines) => {
            let flow = session.program(&name, Program::Lines(&mut lines), &mut finder, sink);
            if let Some(error) = lines.take_failure() {
                return Err(Failure::reading(Path::new(&name), &error));
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

/// How a program runs in a session of its own.
pub(super) struct Alone {
    pub(super) options: SessionOptions,
    pub(super) naming: Naming,
    pub(super) axes: Axes,
}

/// Which axes are listed where no machine is described.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Axes {
    /// Those that a look over the program finds (R9.74).
    Ahead,
    /// Nobody lists them.
    AsTheyOccur,
}

/// Runs one program in a session of its own, from the start of the control to the summary, and
/// returns the session.
pub(super) fn run_alone(
    input: &Input,
    loaded: &LoadedMachine,
    alone: Alone,
    sink: &mut dyn Sink,
) -> Result<Session, Failure> {
    let surroundings = Surroundings::new(loaded, alone.naming);
    let mut options = alone.options;
    if !loaded.machine.is_described() {
        options.switched = switched::axes([input]);
    }
    let mut session = Session::new(loaded.machine.clone(), options);
    if alone.axes == Axes::Ahead && loaded.machine.axis_set == AxisSet::AsTheyOccur {
        session.expect_axes(AxesAhead::of([input], []).names());
    }
    let mut flow = begin(&mut session, loaded, sink);
    if flow.is_continue() {
        flow = run_program(&mut session, input, &surroundings, sink)?;
    }
    if flow.is_continue() {
        let _ = session.finish(sink);
    }
    Ok(session)
}

/// Says what the session starts with, and what keeps the control from taking its lists.
pub(super) fn begin(
    session: &mut Session,
    loaded: &LoadedMachine,
    sink: &mut dyn Sink,
) -> ControlFlow<()> {
    let errors: Vec<_> = loaded.errors().cloned().collect();
    session.begin(&errors, sink)
}
