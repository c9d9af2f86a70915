//! Computation of the contour from the rows of a session: program, trace, currents, drives, deviations.

use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::axes::MovingAxes;
use super::feed::{FeedOnly, FeedReached, is_too_slow};
use super::figures::{ContourSummary, Deviations, Due};
use super::measured::MeasuredCycle;
use super::obstacle::ContourObstacle;
use super::options::{ContourAxis, ContourOptions, MOST_AXES};
use super::path::{CommandedPath, Distance, Places};
use super::per_run::PerRun;
use super::report::ContourReport;
use super::reversals::{ContourReversal, ReversalFinder, WindowEvent};
use super::run::DrivenRun;
use crate::current::{
    AdditiveCurrent, Commanded, CurrentSample, Followers, POSITION_UNITS_PER_MM,
    VELOCITY_UNITS_PER_MM_PER_S,
};
use crate::motion::{
    AssumedLimits, Cause, Movement, ProgramTrace, Sample, TraceSink, without_assumed_limits,
};
use frictcomp::comp::{AxisIndex, State};
use frictcomp::interpreter::{Motion, PositionFrame};
use frictcomp::machine::Machine;
use frictcomp::readings::QuestionSet;
use frictcomp::timeline::{ReadingsInForce, Record, Row, Sink};

const UM_PER_MM: f64 = 1000.0;

/// Cycles of the path that are known beyond the one that is driven.
const AHEAD: usize = 16;

/// The contour in one CNC cycle.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct ContourPoint<'a> {
    /// The time of the trace.
    pub time_s: f64,
    /// The block that is executed, and the conditions during it.
    pub cause: &'a Arc<Cause>,
    /// Commanded positions of the axes, in mm; those of the plane first.
    pub positions: &'a [f64],
    /// The signed distance from the path in the plane, positive on the outside of a curve.
    pub deviation_um: PerRun<f64>,
    /// The distance from the path in space (R11.27).
    pub space_um: PerRun<f64>,
    /// Vector from the nearest point of the path to the position of the axes of the plane, as programmed, in mm.
    pub error_mm: [f64; 2],
    /// Whether the cycle counts: in a feed move, with positions of the machine.
    pub counts: bool,
}

/// A listener to a contour.
pub trait ContourSink {
    /// Takes a block that moves axes, before its cycles.
    fn block(&mut self, row: &Row<'_>) {
        let _ = row;
    }

    /// Takes a cycle.
    fn point(&mut self, point: &ContourPoint<'_>) {
        let _ = point;
    }

    /// Takes a reversal, once its window has ended.
    fn reversal(&mut self, reversal: &ContourReversal) {
        let _ = reversal;
    }

    /// Takes a place where compensation of an axis is switched during its motion (R1.57): `state` is the
    /// new one, and the block the first one with it.
    fn switch(&mut self, switch: &ContourReversal) {
        let _ = switch;
    }

    /// Returns whether it takes no more.
    fn is_closed(&self) -> bool {
        false
    }
}

/// Makes the contour from the rows of a session, which must include the motions of blocks
/// ([`Motions::Taken`](frictcomp::interpreter::Motions::Taken)).
pub struct ProgramContour<S> {
    trace: ProgramTrace<Tracer<S>>,
    /// The same path without the assumed limits of the axes, if there are any.
    unlimited: Option<ProgramTrace<FeedOnly>>,
    assumed: Vec<(AxisIndex, AssumedLimits)>,
    moving: MovingAxes,
    /// The open questions on the currents of the lists.
    of_currents: QuestionSet,
    rests_on: ReadingsInForce,
}

/// A cycle that is not driven yet.
struct Cycle {
    time_s: f64,
    cause: Arc<Cause>,
    places: Places,
    velocities: Places,
    path_velocity: f64,
    programmed_velocity: f64,
    /// The number of its point of the path.
    point: u64,
    /// The additive currents of the programmed run, and of the one with all of it on.
    added: [Places; 2],
}

/// The three runs and their measured values.
struct Tracer<S> {
    options: ContourOptions,
    path: CommandedPath,
    programmed: Followers,
    all_on: Followers,
    /// Cycles whose currents are not known yet.
    waiting: VecDeque<Cycle>,
    /// Cycles whose currents are known.
    ready: VecDeque<Cycle>,
    runs: Option<[DrivenRun; 3]>,
    reversals: ReversalFinder,
    deviations: PerRun<Deviations>,
    due: Due,
    feed: FeedReached,
    axes: Vec<ContourSummary>,
    cycles: u64,
    not_of_the_machine: u64,
    /// First block of each axis that cuts while its state is not known, and the cycles.
    unknown: Vec<Option<(Arc<Cause>, u64)>>,
    is_unstable: bool,
    sink: S,
}

impl<S: ContourSink> ProgramContour<S> {
    /// Returns the contour of a program on a machine.
    pub fn new(machine: &Machine, options: ContourOptions, sink: S) -> Self {
        let followed: Vec<AxisIndex> = options.axes.iter().map(|axis| axis.axis).collect();
        let current = |axis: &ContourAxis| {
            AdditiveCurrent::new(&axis.list, options.reading).scaled(axis.torque_scale)
        };
        let followers = || Followers::new(options.axes.iter().map(current).collect());
        let names: Vec<String> = options.axes.iter().map(|axis| axis.name.clone()).collect();
        let summary = |axis: &String| ContourSummary {
            axis: axis.clone(),
            ..ContourSummary::default()
        };
        let planner = options.planner.clone();
        let lists = options.axes.iter().map(|axis| &axis.list);
        let of_currents = lists.map(|list| options.reading.rests_on(&machine.readings, list));
        let of_currents = of_currents.fold(QuestionSet::default(), QuestionSet::union);
        let tracer = Tracer {
            path: CommandedPath::new(lag_cycles(&options)),
            programmed: followers(),
            all_on: followers(),
            waiting: VecDeque::new(),
            ready: VecDeque::new(),
            runs: None,
            axes: names.iter().map(summary).collect(),
            reversals: ReversalFinder::new(names, options.planner.cycle_s),
            deviations: PerRun::default(),
            due: Due::default(),
            feed: FeedReached::default(),
            cycles: 0,
            not_of_the_machine: 0,
            unknown: vec![None; options.axes.len()],
            is_unstable: false,
            options,
            sink,
        };
        let unlimited = without_assumed_limits(machine)
            .map(|machine| ProgramTrace::new(&machine, &[], planner.clone(), FeedOnly::default()));
        let indices = (0..).map(AxisIndex::new);
        let assumed = indices.zip(machine.axes.iter().map(AssumedLimits::of));
        let assumed = assumed.filter_map(|(axis, limits)| Some((axis, limits?)));
        Self {
            trace: ProgramTrace::new(machine, &followed, planner, tracer),
            unlimited,
            assumed: assumed.collect(),
            moving: MovingAxes::default(),
            of_currents,
            rests_on: ReadingsInForce::default(),
        }
    }

    fn tracer(&self) -> &Tracer<S> {
        self.trace.sink_ref()
    }

    /// Ends the session: the rest of the trace is driven. Returns the contour and the listener.
    pub fn finish(mut self) -> (ContourReport, S) {
        if self.trace.finish().is_continue() {
            let _ = self.trace.sink().drain();
        }
        if let Some(unlimited) = &mut self.unlimited {
            let _ = unlimited.finish();
        }
        let slow_share_by_assumed = self.slow_share_by_assumed();
        let obstacles = self.obstacles(slow_share_by_assumed);
        let machine_time_s = self.machine_time_s();
        let time_not_of_the_machine_s = self.time_not_of_the_machine_s();
        let transitions = self.trace.transitions();
        let (errors, remarks) = self.trace.diagnostics();
        let (errors, remarks) = (errors.to_vec(), remarks.to_vec());
        let (is_cut_short, left_out) = (self.trace.is_cut_short(), self.trace.left_out());
        let moving = self.moving;
        let assumed = self.assumed.into_iter();
        let assumed = assumed.filter(|(axis, _)| moving.contains(*axis));
        let assumed_limits = assumed.map(|(_, limits)| limits).collect();
        let Tracer {
            options,
            deviations,
            due,
            feed,
            axes,
            is_unstable,
            sink,
            ..
        } = self.trace.into_sink();
        let report = ContourReport {
            options,
            deviations,
            due,
            feed,
            slow_share_by_assumed,
            assumed_limits,
            transitions,
            obstacles,
            axes,
            machine_time_s,
            time_not_of_the_machine_s,
            is_cut_short,
            is_unstable,
            left_out,
            errors,
            remarks,
            rests_on: self.rests_on,
        };
        (report, sink)
    }

    /// The machine time in s that has been driven.
    pub fn machine_time_s(&self) -> f64 {
        seconds(self.tracer().cycles, self.tracer().options.planner.cycle_s)
    }

    fn time_not_of_the_machine_s(&self) -> f64 {
        let cycles = self.tracer().not_of_the_machine;
        seconds(cycles, self.tracer().options.planner.cycle_s)
    }

    fn slow_share_by_assumed(&self) -> f64 {
        let unlimited = self.unlimited.as_ref().map(ProgramTrace::sink_ref);
        unlimited.map_or(0.0, |FeedOnly(unlimited)| {
            self.tracer().feed.slow_share_against(unlimited)
        })
    }

    /// Returns the axes that are cut while their state is not known.
    fn unknown_states(&self) -> impl Iterator<Item = ContourObstacle> {
        let tracer = self.tracer();
        let axes = tracer.options.axes.iter().zip(&tracer.unknown);
        axes.filter_map(|(axis, unknown)| {
            let (first, cycles) = unknown.as_ref()?;
            Some(ContourObstacle::UnknownState(
                axis.name.clone(),
                format!("{}:{}", first.file, first.line),
                seconds(*cycles, tracer.options.planner.cycle_s),
            ))
        })
    }

    /// Returns the obstacles to a verdict on the whole contour.
    fn obstacles(&self, slow_share_by_assumed: f64) -> Vec<ContourObstacle> {
        let mut obstacles = Vec::new();
        let left_out = self.trace.left_out_feed();
        let deviations = &self.tracer().deviations;
        if self.machine_time_s() <= 0.0 {
            obstacles.push(ContourObstacle::NotDriven);
        } else if left_out == 0 && deviations.programmed.max_at().is_none() {
            obstacles.push(ContourObstacle::NothingCut);
        }
        if left_out > 0 {
            obstacles.push(ContourObstacle::LeftOut(
                left_out,
                self.trace.left_out_feed_at().to_vec(),
            ));
        }
        let undecided = self.trace.undecided().iter();
        obstacles.extend(undecided.map(ContourObstacle::undecided));
        obstacles.extend(self.unknown_states());
        let (errors, remarks) = self.trace.diagnostics();
        let budgets = remarks.iter().filter(|remark| remark.code.is_budget());
        let ends = errors.iter().chain(budgets);
        for end in ends.map(|end| ContourObstacle::Ended(end.code)) {
            if !obstacles.contains(&end) {
                obstacles.push(end);
            }
        }
        let seconds = self.time_not_of_the_machine_s();
        if seconds > 0.0 {
            obstacles.push(ContourObstacle::NotOfTheMachine(seconds));
        }
        if is_too_slow(slow_share_by_assumed) {
            obstacles.push(ContourObstacle::AssumedLimits(slow_share_by_assumed));
        }
        obstacles
    }
}

/// Returns the largest lag of a drive in cycles: the part of the lag `v/Kv` that the feed forward leaves, plus 20 ms
/// for the loops and an overshoot.
fn lag_cycles(options: &ContourOptions) -> u64 {
    let lags = options.axes.iter().map(|axis| {
        let drive = &axis.drive;
        (1.0 - drive.velocity_forward).max(0.0) / drive.position_gain_per_s
    });
    let longest_s = lags.fold(0.0, f64::max) * 1.5 + 0.02;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
    let cycles = (longest_s / options.planner.cycle_s).ceil() as u64;
    cycles.max(4)
}

#[allow(clippy::cast_precision_loss)] // far below 2^52 cycles
fn seconds(cycles: u64, each_s: f64) -> f64 {
    cycles as f64 * each_s
}

impl<S: ContourSink> Sink for ProgramContour<S> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Block(row) if matches!(row.motion, Some(Motion::Travel(_))) => {
                self.trace.sink().sink.block(row);
            }
            Record::Summary(summary) => {
                let questions = self.of_currents.union(summary.rests_on);
                self.rests_on = ReadingsInForce::of(questions, summary.state.machine);
            }
            _ => {}
        }
        let _ = self.moving.record(record);
        if let Some(unlimited) = &mut self.unlimited {
            let _ = unlimited.record(record);
        }
        self.trace.record(record)
    }
}

impl<S: ContourSink> TraceSink for Tracer<S> {
    fn begin(&mut self, _: f64, _: &Arc<Cause>) -> ControlFlow<()> {
        self.drain()?;
        self.restart();
        ControlFlow::Continue(())
    }

    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        self.feed.push(sample);
        let places = widened(sample.positions);
        let friction = sample.cause.friction.iter();
        let commanded = |friction: &mut dyn Iterator<Item = State>| -> Vec<Commanded> {
            let axes = sample.positions.iter().zip(sample.velocities);
            axes.zip(friction)
                .map(|((x, v), friction)| Commanded {
                    position_units: x * POSITION_UNITS_PER_MM,
                    velocity_units: v * VELOCITY_UNITS_PER_MM_PER_S,
                    friction,
                })
                .collect()
        };
        self.waiting.push_back(Cycle {
            time_s: sample.time_s,
            cause: Arc::clone(sample.cause),
            places,
            velocities: widened(sample.velocities),
            path_velocity: sample.path_velocity,
            programmed_velocity: sample.programmed_velocity,
            point: self.path.push(places),
            added: Default::default(),
        });
        let programmed = self.programmed.push(commanded(&mut friction.copied()));
        let on = commanded(&mut std::iter::repeat(State::Active));
        if let (Some(programmed), Some(all_on)) = (programmed, self.all_on.push(on))
            && let Some(mut cycle) = self.waiting.pop_front()
        {
            cycle.added = [programmed, all_on].map(|added| units(added, &self.options.axes));
            self.ready.push_back(cycle);
        }
        self.advance(AHEAD)
    }
}

impl<S: ContourSink> Tracer<S> {
    /// Drives the cycles that are ready, except a number of the last ones.
    fn advance(&mut self, keep: usize) -> ControlFlow<()> {
        while self.ready.len() > keep.max(1) {
            let Some(cycle) = self.ready.pop_front() else {
                break;
            };
            let to = self.ready.front().map_or(cycle.places, |next| next.places);
            self.drive(&cycle, &to)?;
        }
        ControlFlow::Continue(())
    }

    /// Drives the rest of the trace.
    fn drain(&mut self) -> ControlFlow<()> {
        while let (Some(programmed), Some(all_on)) = (self.programmed.pop(), self.all_on.pop()) {
            let Some(mut cycle) = self.waiting.pop_front() else {
                break;
            };
            cycle.added = [programmed, all_on].map(|added| units(added, &self.options.axes));
            self.ready.push_back(cycle);
        }
        self.advance(0)?;
        if let Some(last) = self.ready.pop_front() {
            let to = last.places;
            self.drive(&last, &to)?;
        }
        let (axes, sink) = (&mut self.axes, &mut self.sink);
        self.reversals.restart(|found| take(axes, sink, &found));
        ControlFlow::Continue(())
    }

    fn restart(&mut self) {
        self.programmed.restart();
        self.all_on.restart();
        self.waiting.clear();
        self.ready.clear();
        self.path.restart();
        self.runs = None;
    }

    /// Computes one CNC cycle of all runs.
    fn drive(&mut self, cycle: &Cycle, to: &Places) -> ControlFlow<()> {
        let options = &self.options;
        let runs = self
            .runs
            .get_or_insert_with(|| [(); 3].map(|()| DrivenRun::at_rest(options, &cycle.places)));
        let none = Places::default();
        let [programmed, all_on] = &cycle.added;
        let mut distances = [Distance::default(); 3];
        for ((run, added), distance) in runs
            .iter_mut()
            .zip([programmed, all_on, &none])
            .zip(&mut distances)
        {
            let places = (&cycle.places, to);
            let Some(reached) = run.follow(places, added, options.planner.cycle_s) else {
                self.is_unstable = true;
                return ControlFlow::Break(());
            };
            *distance = self.path.distance(&reached, (&mut run.near, cycle.point));
        }
        self.path.forget_before(cycle.point);
        self.cycles += 1;
        let count = options.axes.len();
        let is_of_machine = cycle.cause.frame != PositionFrame::Programmed;
        self.not_of_the_machine += u64::from(!is_of_machine);
        let counts = is_of_machine && cycle.cause.movement == Movement::Feed;
        let deviation_um = distances.map(|distance| distance.plane * UM_PER_MM);
        let space_um = distances.map(|distance| distance.space * UM_PER_MM);
        if counts {
            for (axis, unknown) in self.unknown.iter_mut().enumerate() {
                let moves = cycle.velocities[axis].abs() > f64::EPSILON;
                if moves && cycle.cause.friction.get(axis) == Some(&State::Unknown) {
                    let first = || (Arc::clone(&cycle.cause), 0);
                    unknown.get_or_insert_with(first).1 += 1;
                }
            }
            let all = self.deviations.each_mut().into_iter();
            for (at, deviations) in all.enumerate() {
                deviations.push([deviation_um[at], space_um[at]], &cycle.cause);
            }
            self.due.push([space_um[0], space_um[1]], &cycle.cause);
            for axis in 2..count {
                let beside = |run: usize| distances[run].normal[axis] * UM_PER_MM;
                self.due.push([beside(0), beside(1)], &cycle.cause);
            }
        }
        let (axes, sink) = (&mut self.axes, &mut self.sink);
        if is_of_machine {
            let measured = MeasuredCycle {
                time_s: cycle.time_s,
                cause: &cycle.cause,
                positions: &cycle.places[..count],
                velocities: &cycle.velocities[..count],
                path_velocity: cycle.path_velocity,
                programmed_velocity: cycle.programmed_velocity,
                added: &programmed[..count],
                distances: &distances,
            };
            self.reversals
                .push(&measured, |found| take(axes, sink, &found));
        }
        self.sink.point(&ContourPoint {
            time_s: cycle.time_s,
            cause: &cycle.cause,
            positions: &cycle.places[..count],
            deviation_um: PerRun::from_each(deviation_um),
            space_um: PerRun::from_each(space_um),
            error_mm: [distances[0].normal[0], distances[0].normal[1]],
            counts,
        });
        if self.sink.is_closed() {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }
}

fn take<S: ContourSink>(
    axes: &mut [ContourSummary],
    sink: &mut S,
    (event, reversal): &(WindowEvent, ContourReversal),
) {
    if *event == WindowEvent::Switch {
        sink.switch(reversal);
        return;
    }
    if let Some(axis) = axes.iter_mut().find(|axis| axis.axis == reversal.axis) {
        axis.push(reversal);
    }
    sink.reversal(reversal);
}

fn widened(values: &[f64]) -> Places {
    let mut places = [0.0; MOST_AXES];
    places[..values.len()].copy_from_slice(values);
    places
}

/// Returns the additive currents as they reach the drives, scaled by the control on the way (R7.8).
fn units(samples: &[CurrentSample], axes: &[ContourAxis]) -> Places {
    let mut added = [0.0; MOST_AXES];
    for ((added, sample), axis) in added.iter_mut().zip(samples).zip(axes) {
        *added = sample.added.current_units * axis.torque_scale;
    }
    added
}
