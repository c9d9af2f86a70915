//! Contours of programs on the disk.

use std::ops::ControlFlow;
use std::sync::Arc;

use thiserror::Error;

use super::dry_run::{Axes, SingleRun, run_alone};
use crate::disk::{Input, Naming};
use crate::error::HostError;
use crate::machines::LoadedMachine;
use crate::watch::{Done, Watch};
use frictcomp::interpreter::Motions;
use frictcomp::lists::FrictionList;
use frictcomp::session::SessionOptions;
use frictcomp::timeline::{Record, Sink};
use frictcomp_physics::contour::{
    ContourOptions, ContourReport, ContourSink, MovingAxes, NoContour, ProgramContour, parameterise,
};
use frictcomp_physics::current::Reading;
use frictcomp_physics::motion::{Cause, PlannerOptions, ProgramTrace, Sample, TraceSink};
use frictcomp_physics::simulation::{FrictionModel, Plant};

/// Setup of a contour: the drives, and the options of the run.
#[derive(Debug, Clone)]
pub struct ContourSetup {
    /// The axes of the plane.
    pub plane: [String; 2],
    /// The drives.
    pub plant: Plant,
    /// Value lists that replace those of the machine: the axis, the name of the list, the list.
    pub value_lists: Vec<(String, String, FrictionList)>,
    /// The friction model.
    pub model: FrictionModel,
    /// Options of the commanded trace.
    pub planner: PlannerOptions,
    /// Options of the run.
    pub session: SessionOptions,
    /// Naming of files.
    pub naming: Naming,
}

/// Reason why a program has no contour.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum NoDrivenContour {
    /// The program cannot be read.
    #[error(transparent)]
    Host(#[from] HostError),
    /// The axes cannot be driven.
    #[error(transparent)]
    Axes(#[from] NoContour),
    /// A plant whose control loops are unstable on the path.
    #[error("the simulated drives are unstable after {after_s:.3} s of `{program}`")]
    Unstable {
        /// Path of the program.
        program: String,
        /// The machine time in s.
        after_s: f64,
    },
    /// The watcher stopped the work.
    #[error("the contour was stopped")]
    Stopped,
    /// Standard input, which can be read only once.
    #[error("standard input can be read only once, and a contour needs the program twice")]
    OnlyOnce,
}

/// Drives the path of a program: a first run finds the axes that move, and, if there is a watcher,
/// the machine time; a second one drives them. `sink` is made for the driven axes, and returned with the contour.
///
/// # Errors
/// The program cannot be read or its axes cannot be driven, a drive is unstable, or the watcher stops it.
pub fn drive_contour<S: ContourSink>(
    input: &Input,
    loaded: &LoadedMachine,
    setup: &ContourSetup,
    sink: impl FnOnce(&ContourOptions) -> S,
) -> Result<(ContourReport, S), NoDrivenContour> {
    if *input == Input::Stdin {
        return Err(NoDrivenContour::OnlyOnce);
    }
    let mut loaded = loaded.clone();
    let alone = || SingleRun {
        options: SessionOptions {
            run: setup.session.run.with_motions(Motions::Taken),
            ..setup.session.clone()
        },
        naming: setup.naming,
        axes: Axes::AsTheyOccur,
    };
    let mut ahead = Ahead::new(&loaded, &setup.planner);
    run_alone(input, &loaded, alone(), &mut ahead)?;
    if loaded.watch.is_stopped() {
        return Err(NoDrivenContour::Stopped);
    }
    let (moving, seconds) = ahead.finish();
    let [first, second] = &setup.plane;
    let axes = moving.driven(
        &loaded.machine,
        [first, second],
        &setup.plant,
        &setup.value_lists,
    )?;
    parameterise(&mut loaded.machine, &axes);
    let options = ContourOptions::new(axes)
        .with_planner(setup.planner.clone())
        .with_model(setup.model)
        .with_reading(Reading::from(&loaded.machine.readings));
    let sink = sink(&options);
    let mut contour = ProgramContour::new(&loaded.machine, options, sink);
    let mut watched = WatchedContour {
        contour: &mut contour,
        watch: &loaded.watch,
        seconds,
    };
    run_alone(input, &loaded, alone(), &mut watched)?;
    if loaded.watch.is_stopped() {
        return Err(NoDrivenContour::Stopped);
    }
    let (report, sink) = contour.finish();
    if report.is_unstable {
        return Err(NoDrivenContour::Unstable {
            program: input.name(Naming::AsGiven),
            after_s: report.machine_time_s,
        });
    }
    Ok((report, sink))
}

/// Facts known before the axes are driven.
struct Ahead {
    moving: MovingAxes,
    /// A trace of no axis, to count cycles for a watcher.
    trace: Option<ProgramTrace<Cycles>>,
    cycle_s: f64,
}

/// Counts the cycles of a trace.
#[derive(Default)]
struct Cycles(u32);

impl TraceSink for Cycles {
    fn begin(&mut self, _: f64, _: &Arc<Cause>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn sample(&mut self, _: &Sample<'_>) -> ControlFlow<()> {
        self.0 = self.0.saturating_add(1);
        ControlFlow::Continue(())
    }
}

impl Ahead {
    fn new(loaded: &LoadedMachine, planner: &PlannerOptions) -> Self {
        let trace = || ProgramTrace::new(&loaded.machine, &[], planner.clone(), Cycles::default());
        Self {
            moving: MovingAxes::default(),
            trace: loaded.watch.is_on().then(trace),
            cycle_s: planner.cycle_s,
        }
    }

    /// Returns the axes that move, and the machine time in s.
    fn finish(self) -> (MovingAxes, f64) {
        let seconds = self.trace.map_or(0.0, |mut trace| {
            let _ = trace.finish();
            f64::from(trace.sink().0) * self.cycle_s
        });
        (self.moving, seconds)
    }
}

impl Sink for Ahead {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        if let Some(trace) = &mut self.trace {
            let _ = trace.record(record);
        }
        self.moving.record(record)
    }
}

/// Reports how much of the machine time is covered.
struct WatchedContour<'a, S> {
    contour: &'a mut ProgramContour<S>,
    watch: &'a Watch,
    seconds: f64,
}

impl<S: ContourSink> Sink for WatchedContour<'_, S> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        let flow = self.contour.record(record);
        self.watch.show(|| Done::MachineTime {
            seconds: whole(self.contour.machine_time_s()),
            all: whole(self.seconds),
        });
        if self.watch.is_stopped() {
            return ControlFlow::Break(());
        }
        flow
    }
}

fn whole(seconds: f64) -> u64 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
    let whole = seconds as u64;
    whole
}
