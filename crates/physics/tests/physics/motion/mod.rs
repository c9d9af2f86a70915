//! Runs a program and keeps its commanded trace.

mod contouring;
mod feeds;
mod forms;
mod limits;
mod listed;
mod start;
mod tool;
mod turns;
mod unknown;

use std::ops::ControlFlow;
use std::sync::Arc;

use frictcomp::comp::AxisIndex;
use frictcomp::interpreter::{Motions, NoFiles, Options};
use frictcomp::machine::Machine;
use frictcomp::session::{Program, Session, SessionOptions};
use frictcomp::text::SourceFile;
use frictcomp::timeline::{Record, Sink};
use frictcomp_physics::motion::{
    AxisLimits, Cause, PlannerOptions, Sample, SkippedMotion, TraceSink, TrajectoryPlanner,
    Transitions,
};

/// The CNC cycle of these tests, in seconds.
pub(crate) const CYCLE: f64 = 0.001;

/// X, Y, Z with 12 m/min, 2 m/s² and 50 m/s³, and a slower rotary axis.
pub(crate) const MACHINE: &str = r#"
[[axis]]
name = "X"
max_velocity = 12000
max_acceleration = 2
max_jerk = 50
[[axis]]
name = "Y"
max_velocity = 12000
max_acceleration = 1.5
max_jerk = 40
[[axis]]
name = "Z"
max_velocity = 6000
max_acceleration = 1
max_jerk = 30
[[axis]]
name = "C"
type = "R"
max_velocity = 7200
max_acceleration = 400
max_jerk = 8000
"#;

/// A commanded trace, column by column.
#[derive(Debug, Default)]
pub(crate) struct Trace {
    /// The positions of the followed axes, cycle by cycle.
    pub(crate) positions: Vec<Vec<f64>>,
    pub(crate) velocities: Vec<Vec<f64>>,
    pub(crate) lines: Vec<u32>,
    /// The cycles at which the trace begins, or begins anew.
    pub(crate) begins: Vec<usize>,
    /// The reported codes, with their lines.
    pub(crate) said: Vec<(String, u32)>,
    /// Messages of the programs, and their help lines.
    pub(crate) messages: Vec<String>,
    /// The lines of the motions that are left out, with the times.
    pub(crate) left_out: Vec<(u32, f64)>,
    pub(crate) causes: Vec<Arc<Cause>>,
    pub(crate) path_velocities: Vec<f64>,
    /// The treatment of the transitions.
    pub(crate) transitions: Transitions,
}

impl Trace {
    /// Returns the last position.
    pub(crate) fn end(&self) -> &[f64] {
        self.positions.last().expect("a trace")
    }

    /// Seconds from the first to the last cycle.
    pub(crate) fn seconds(&self) -> f64 {
        let cycles = u32::try_from(self.positions.len()).expect("a short trace");
        f64::from(cycles - 1) * CYCLE
    }

    /// Returns the highest speed of an axis.
    pub(crate) fn top_speed(&self, axis: usize) -> f64 {
        let speeds = self.velocities.iter().map(|cycle| cycle[axis].abs());
        speeds.fold(0.0, f64::max)
    }
}

impl TraceSink for Trace {
    fn begin(&mut self, _: f64, _: &Arc<Cause>) -> ControlFlow<()> {
        self.begins.push(self.positions.len());
        ControlFlow::Continue(())
    }

    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        self.positions.push(sample.positions.to_vec());
        self.velocities.push(sample.velocities.to_vec());
        self.lines.push(sample.cause.line);
        self.causes.push(Arc::clone(sample.cause));
        self.path_velocities.push(sample.path_velocity);
        ControlFlow::Continue(())
    }

    fn left_out(&mut self, motion: &SkippedMotion<'_>) {
        self.left_out.push((motion.line, motion.time_s));
    }
}

/// A planner and the trace that it makes.
struct Planned {
    planner: TrajectoryPlanner,
    trace: Trace,
}

impl Sink for Planned {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Block(row) => self.planner.block(row, &mut self.trace),
            _ => ControlFlow::Continue(()),
        }
    }
}

/// Returns the trace of the named axes.
pub(crate) fn trace_of(
    machine: &str,
    program: &str,
    axes: &[&str],
    options: PlannerOptions,
) -> Trace {
    let machine = Machine::from_toml(machine).expect("a machine");
    follow(machine, program, (axes, &[]), options)
}

/// Returns the trace of the named axes on a machine, from their current positions.
pub(crate) fn follow(
    machine: Machine,
    program: &str,
    (axes, start): (&[&str], &[(&str, f64)]),
    options: PlannerOptions,
) -> Trace {
    let followed: Vec<AxisIndex> = axes
        .iter()
        .map(|name| machine.find(name).expect("an axis"))
        .collect();
    let mut planned = Planned {
        planner: TrajectoryPlanner::new(&machine, &followed, options),
        trace: Trace::default(),
    };
    let start = start.iter().map(|(name, at)| ((*name).to_owned(), *at));
    let session = SessionOptions::from(Options::default().with_motions(Motions::Taken));
    let mut session = Session::new(machine, session.with_start(start.collect()));
    let source = SourceFile::new("a.nc", program);
    let flow = session.program("a.nc", Program::Whole(source), &mut NoFiles, &mut planned);
    if flow.is_continue() {
        let _ = planned.planner.finish(&mut planned.trace);
    }
    let said = planned.planner.diagnostics().iter();
    planned.trace.messages = said
        .clone()
        .map(|diagnostic| format!("{}; {}", diagnostic.message, diagnostic.help().join("; ")))
        .collect();
    assert_eq!(
        planned.planner.left_out(),
        planned.trace.left_out.len() as u64
    );
    planned.trace.transitions = planned.planner.transitions();
    planned.trace.said = said
        .map(|diagnostic| (diagnostic.code.to_string(), diagnostic.place.first_line))
        .collect();
    planned.trace
}

/// Returns the trace of the named axes on the machine of these tests.
pub(crate) fn trace(program: &str, axes: &[&str]) -> Trace {
    trace_of(MACHINE, program, axes, PlannerOptions::default())
}

/// Asserts that every cycle keeps velocity, acceleration and jerk of each axis.
///
/// The differences of a trace are means over cycles, so that they keep whatever the motion keeps;
/// `1e-6` of a limit is left to the rounding of positions, which a third difference magnifies.
pub(crate) fn assert_limits(machine: &str, names: &[&str], trace: &Trace) {
    let machine = Machine::from_toml(machine).expect("a machine");
    for (column, name) in names.iter().enumerate() {
        let axis = machine.find(name).expect("an axis");
        let limits = AxisLimits::of(machine.axis(axis));
        let mut parts = trace.begins.clone();
        parts.push(trace.positions.len());
        for part in parts.windows(2) {
            let cycles = &trace.positions[part[0]..part[1]];
            let positions: Vec<f64> = cycles.iter().map(|cycle| cycle[column]).collect();
            // The axis is at rest before and after.
            let rest = |at: Option<&f64>| vec![*at.expect("a cycle"); 3];
            let positions = [
                rest(positions.first()),
                positions.clone(),
                rest(positions.last()),
            ];
            let velocity = difference(&positions.concat());
            let acceleration = difference(&velocity);
            let jerk = difference(&acceleration);
            let magnitude = positions[1].iter().fold(1.0_f64, |top, x| top.max(x.abs()));
            for (what, found, limit, order) in [
                ("velocity", &velocity, limits.velocity_per_s, 1),
                ("acceleration", &acceleration, limits.acceleration_per_s2, 2),
                ("jerk", &jerk, limits.jerk_per_s3, 3),
            ] {
                let noise = 8.0 * f64::EPSILON * magnitude / CYCLE.powi(order);
                let worst = found
                    .iter()
                    .enumerate()
                    .fold((0, 0.0_f64), |top, (at, value)| {
                        if value.abs() > top.1 {
                            (at, value.abs())
                        } else {
                            top
                        }
                    });
                assert!(
                    worst.1 <= limit * (1.0 + 1e-6) + noise,
                    "{what} of {name} is {} of {limit} at cycle {} (line {})",
                    worst.1,
                    part[0] + worst.0,
                    trace.lines[(part[0] + worst.0).min(part[1] - 1)],
                );
            }
        }
    }
}

fn difference(values: &[f64]) -> Vec<f64> {
    values
        .windows(2)
        .map(|pair| (pair[1] - pair[0]) / CYCLE)
        .collect()
}
