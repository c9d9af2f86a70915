//! The additive current and the commanded trace, in cycles per second.
//!
//! Each line is a ratio to a plain sum over the same cycles, taken in the same run, with the
//! absolute speed and the goal. `FRICTCOMP_BENCH_RUNS` sets how often each is taken.

#![allow(clippy::print_stdout)] // The table is its purpose.

use std::hint::black_box;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

use frictcomp::comp::{AxisIndex, State};
use frictcomp::interpreter::{Motions, NoFiles, Options};
use frictcomp::lists::{FrictionList, TablePoint};
use frictcomp::machine::Machine;
use frictcomp::session::{Program, Session, SessionOptions};
use frictcomp::text::SourceFile;
use frictcomp::timeline::{Record, Sink};
use frictcomp_physics::current::{AdditiveCurrent, Commanded, Followers, Reading};
use frictcomp_physics::motion::{Cause, PlannerOptions, Sample, TraceSink, TrajectoryPlanner};
use frictcomp_testing::measure::{Bench, median};

/// The cycles of the trace: 1000 s, a reversal every half second.
const CYCLES: u32 = 1_000_000;

fn main() {
    let jobs = Jobs {
        bench: Bench::new(5),
        trace: Trace::new(),
    };
    println!("{:<44}{:>9}{:>16}   goal", "job", "ratio", "speed");
    jobs.currents();
    jobs.motion("circles", &circles(200));
    jobs.motion("short blocks", &polyline(200_000));
}

/// A commanded trace that oscillates.
struct Trace {
    positions: Vec<f64>,
    velocities: Vec<f64>,
}

impl Trace {
    fn new() -> Self {
        let phase = |cycle| f64::from(cycle) * std::f64::consts::TAU / 1000.0;
        Self {
            positions: (0..CYCLES).map(|cycle| phase(cycle).sin() * 5e5).collect(),
            velocities: (0..CYCLES).map(|cycle| phase(cycle).cos() * 3e5).collect(),
        }
    }
}

struct Jobs {
    bench: Bench,
    trace: Trace,
}

impl Jobs {
    /// Returns the median time of a piece of work, which returns its number of cycles.
    fn median(&self, mut work: impl FnMut() -> u64) -> (u64, Duration) {
        let mut cycles = 0;
        let times = self.bench.times(|| cycles = black_box(work()));
        (cycles, median(times))
    }

    /// Seconds per cycle of the baseline: a sum over the trace.
    fn baseline(&self) -> f64 {
        let Trace {
            positions,
            velocities,
        } = &self.trace;
        let (cycles, time) = self.median(|| {
            let pairs = positions.iter().zip(velocities);
            black_box(pairs.fold(0.0, |sum, (x, v)| black_box(sum + x * v)));
            u64::from(CYCLES)
        });
        seconds(cycles, time)
    }

    fn print(&self, name: &str, work: impl FnMut() -> u64, goal: &str) {
        let (cycles, time) = self.median(work);
        let each = seconds(cycles, time);
        let ratio = each / self.baseline();
        let speed = format!("{:.1} M cycles/s", 1e-6 / each);
        println!("{name:<44}{ratio:>7.1} x{speed:>16}   {goal}");
    }

    fn currents(&self) {
        let Trace {
            positions,
            velocities,
        } = &self.trace;
        let goal = "20 M cycles/s";
        let whole = || {
            let mut current = AdditiveCurrent::new(&list(), Reading::default());
            black_box(current.trace(positions, velocities));
            u64::from(CYCLES)
        };
        self.print("additive current, whole trace", whole, goal);
        let steps = || {
            let mut current = AdditiveCurrent::new(&list(), Reading::default());
            for (at, (x, v)) in positions.iter().zip(velocities).enumerate() {
                let later = velocities.get(at + 1..at + 5).unwrap_or_default();
                black_box(current.step(*x, *v, later));
            }
            u64::from(CYCLES)
        };
        self.print("additive current, cycle by cycle", steps, goal);
        let followed = || {
            let current = AdditiveCurrent::new(&list(), Reading::default());
            let mut followers = Followers::new(vec![current]);
            for (position, velocity) in positions.iter().zip(velocities) {
                let commanded = Commanded {
                    position_units: *position,
                    velocity_units: *velocity,
                    friction: State::Active,
                };
                black_box(followers.push([commanded]));
            }
            u64::from(CYCLES)
        };
        self.print("additive current, as a trace comes in", followed, goal);
    }

    fn motion(&self, name: &str, program: &str) {
        let blocks = program.lines().count();
        let name = format!("commanded trace of {name}, {blocks} blocks");
        self.print(&name, || cycles_of(program), "");
    }
}

fn seconds(cycles: u64, time: Duration) -> f64 {
    let cycles = u32::try_from(cycles).map_or(f64::INFINITY, f64::from);
    time.as_secs_f64() / cycles
}

fn list() -> FrictionList {
    FrictionList {
        position_delay: 9,
        reversal_lookahead: 4,
        scaling_factor: 1000,
        delay_cycles: 2,
        max_points: 20,
        table: (0..8_u32)
            .map(|point| TablePoint {
                input: f64::from(point * point) * 4000.0,
                output: 120.0 - f64::from(point) * 3.0,
            })
            .collect(),
    }
}

/// Returns full circles of 20 mm at 2 m/min.
fn circles(turns: u32) -> String {
    let mut program = String::from("G01 X0 Y0 F2000\nX20\n");
    (0..turns).for_each(|_| program.push_str("G03 I-20\n"));
    program
}

/// Returns a line in blocks of 0.2 mm with small kinks.
fn polyline(blocks: u32) -> String {
    let block = |block: u32| {
        format!(
            "X{:.1} Y{:.4}\n",
            f64::from(block) * 0.2,
            f64::from(block % 2) * 0.0001
        )
    };
    let blocks: String = (0..blocks).map(block).collect();
    format!("G01 F3000\n{blocks}")
}

/// Counts cycles.
struct Counter {
    planner: TrajectoryPlanner,
    cycles: Count,
}

struct Count(u64);

impl TraceSink for Count {
    fn begin(&mut self, _: f64, _: &Arc<Cause>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        black_box(sample.velocities);
        self.0 += 1;
        ControlFlow::Continue(())
    }
}

impl Sink for Counter {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Block(row) => self.planner.block(row, &mut self.cycles),
            _ => ControlFlow::Continue(()),
        }
    }
}

fn cycles_of(program: &str) -> u64 {
    let machine = Machine::unconfigured();
    let axes: Vec<AxisIndex> = (0..2).map(AxisIndex::new).collect();
    let mut counter = Counter {
        planner: TrajectoryPlanner::new(&machine, &axes, PlannerOptions::default()),
        cycles: Count(0),
    };
    let options = SessionOptions::from(Options::default().with_motions(Motions::Taken));
    let mut session = Session::new(machine, options);
    let source = SourceFile::new("bench.nc", program);
    let _ = session.program(
        "bench.nc",
        Program::Whole(source),
        &mut NoFiles,
        &mut counter,
    );
    let _ = counter.planner.finish(&mut counter.cycles);
    counter.cycles.0
}
