//! Computation of the currents of axes from the rows of a session, cycle by cycle: program, trace, current.

use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::Arc;

use thiserror::Error;

use super::additive::AdditiveCurrent;
use super::followers::{Commanded, CurrentSample, Followers};
use super::reading::Reading;
use super::units::{POSITION_UNITS_PER_MM, VELOCITY_UNITS_PER_MM_PER_S};
use crate::motion::{Cause, PlannerOptions, ProgramTrace, Sample, TraceSink};
use frictcomp::comp::AxisIndex;
use frictcomp::diagnostic::{Diagnostic, UnknownName};
use frictcomp::lists::FrictionList;
use frictcomp::machine::{Machine, Parameterisation};
use frictcomp::readings::QuestionSet;
use frictcomp::timeline::{ReadingsInForce, Record, Sink};

/// The additive currents of several axes in one CNC cycle.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct CurrentCycle<'a> {
    /// The time since the beginning of the program.
    pub time_s: f64,
    /// The block that is executed, and the conditions during it.
    pub cause: &'a Arc<Cause>,
    /// The axes, in the requested order.
    pub axes: &'a [CurrentSample],
}

/// Receiver of the currents of a program. A function of a [`CurrentCycle`] is one.
pub trait CurrentSink {
    /// Takes a cycle. `Break` ends the program.
    fn cycle(&mut self, cycle: &CurrentCycle<'_>) -> ControlFlow<()>;

    /// Begins the trace, or restarts it after motions that are not known.
    fn begin(&mut self, time_s: f64, line: u32) {
        let _ = (time_s, line);
    }
}

impl<F: FnMut(&CurrentCycle<'_>) -> ControlFlow<()>> CurrentSink for F {
    fn cycle(&mut self, cycle: &CurrentCycle<'_>) -> ControlFlow<()> {
        self(cycle)
    }
}

/// Options of the currents of a program.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct CurrentOptions {
    /// Options of its trace.
    pub planner: PlannerOptions,
    /// Reading of the points that the documents leave open.
    pub reading: Reading,
}

impl From<PlannerOptions> for CurrentOptions {
    fn from(planner: PlannerOptions) -> Self {
        let reading = Reading::default();
        Self { planner, reading }
    }
}

impl CurrentOptions {
    /// Sets the reading of the documents.
    pub fn with_reading(self, reading: Reading) -> Self {
        Self { reading, ..self }
    }
}

/// An axis whose current cannot be computed.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum FollowError {
    /// `Q` on a machine with X, Y and Z.
    #[error("the machine has no axis `{}`", .0.name)]
    NoAxis(UnknownName),
    /// An axis on which compensation is assumed.
    #[error("the friction values of axis `{0}` are not known, only assumed to exist")]
    Assumed(String),
    /// A machine without a value list for any axis.
    #[error("no axis has an accepted compensation value list, so there is no current")]
    NoList,
}

/// Finds axes by their names, each once; without names, all that have a value list.
///
/// # Errors
/// The machine has no axis of a name, or no values for it; without names, no axis has a value list.
pub fn axes_to_follow(names: &[String], machine: &Machine) -> Result<Vec<AxisIndex>, FollowError> {
    let listed = machine.axes.iter();
    let listed = listed.filter(|it| matches!(it.friction, Parameterisation::Accepted(_)));
    let listed: Vec<String> = listed.map(|it| it.name.clone()).collect();
    let names = if names.is_empty() { &listed } else { names };
    if names.is_empty() {
        return Err(FollowError::NoList);
    }
    let mut followed: Vec<AxisIndex> = Vec::new();
    for name in names {
        let Some(index) = machine.find(name) else {
            let known = machine.axes.iter().map(|axis| axis.name.as_str());
            return Err(FollowError::NoAxis(UnknownName::new(name, known)));
        };
        if followed.contains(&index) {
            continue;
        }
        followed.push(index);
        if machine.axis(index).friction == Parameterisation::Assumed {
            return Err(FollowError::Assumed(name.clone()));
        }
    }
    Ok(followed)
}

/// Makes currents from the rows of a session, which must include the motions of blocks
/// ([`Motions::Taken`](frictcomp::interpreter::Motions::Taken)).
pub struct ProgramCurrents<S> {
    trace: ProgramTrace<Cycles<S>>,
    /// The open questions on the currents of the lists.
    of_lists: QuestionSet,
    rests_on: ReadingsInForce,
}

/// The cycles of a trace on their way to a sink.
struct Cycles<S> {
    followers: Followers,
    /// Time and block of the cycles whose current is not known yet.
    waiting: VecDeque<(f64, Arc<Cause>)>,
    count: u64,
    sink: S,
}

impl<S: CurrentSink> ProgramCurrents<S> {
    /// Returns the currents of some axes of a machine.
    pub fn new(
        machine: &Machine,
        followed: &[AxisIndex],
        options: CurrentOptions,
        sink: S,
    ) -> Self {
        let current = |axis: &AxisIndex| {
            let axis = machine.axis(*axis);
            let list = values(&axis.friction);
            AdditiveCurrent::new(&list, options.reading).scaled(axis.torque_scale.factor())
        };
        let cycles = Cycles {
            followers: Followers::new(followed.iter().map(current).collect()),
            waiting: VecDeque::new(),
            count: 0,
            sink,
        };
        let lists = followed
            .iter()
            .map(|axis| values(&machine.axis(*axis).friction));
        let of_lists = lists.map(|list| options.reading.rests_on(&machine.readings, &list));
        Self {
            trace: ProgramTrace::new(machine, followed, options.planner, cycles),
            of_lists: of_lists.fold(QuestionSet::default(), QuestionSet::union),
            rests_on: ReadingsInForce::default(),
        }
    }

    /// Ends the session: the rest of the trace is given out.
    pub fn finish(&mut self) {
        if self.trace.finish().is_continue() {
            let _ = self.trace.sink().drain();
        }
    }

    /// Returns the errors that the session reported, then the messages about the trace.
    pub fn diagnostics(&self) -> (&[Diagnostic], &[Diagnostic]) {
        self.trace.diagnostics()
    }

    /// Returns the first messages on stretches that only the machine decides, which are not in the trace (R14.8).
    pub fn undecided(&self) -> &[Diagnostic] {
        self.trace.undecided()
    }

    /// Returns whether a budget stopped a program, as an endless loop does (FC910): the rest is not known.
    pub fn is_cut_short(&self) -> bool {
        self.trace.is_cut_short()
    }

    /// Returns the readings of open questions on which the currents rest, once the session is over (R15.3).
    pub fn rests_on(&self) -> &ReadingsInForce {
        &self.rests_on
    }

    /// Returns the number of motions that the trace leaves out.
    pub fn left_out(&self) -> u64 {
        self.trace.left_out()
    }

    /// Returns the number of cycles of the trace.
    pub fn cycles(&mut self) -> u64 {
        self.trace.sink().count
    }

    /// Returns the number of cycles in which the output of each axis was limited to 16 bit.
    pub fn saturated(&mut self) -> impl Iterator<Item = u64> {
        self.trace.sink().followers.saturated()
    }

    /// Returns the number of cycles at standstill in which R4.6 matters, by axis; see [`AdditiveCurrent::at_rest`].
    pub fn at_rest(&mut self) -> impl Iterator<Item = u64> {
        self.trace.sink().followers.at_rest()
    }

    /// Returns the receiver of the currents.
    pub fn sink(&mut self) -> &mut S {
        &mut self.trace.sink().sink
    }
}

impl<S: CurrentSink> Sink for ProgramCurrents<S> {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        if let Record::Summary(summary) = record {
            let questions = self.of_lists.union(summary.rests_on);
            self.rests_on = ReadingsInForce::of(questions, summary.state.machine);
        }
        self.trace.record(record)
    }
}

impl<S: CurrentSink> Cycles<S> {
    /// Gives out the waiting cycles.
    fn drain(&mut self) -> ControlFlow<()> {
        while let Some(axes) = self.followers.pop() {
            let Some((time_s, cause)) = self.waiting.pop_front() else {
                break;
            };
            let cause = &cause;
            self.sink.cycle(&CurrentCycle {
                time_s,
                cause,
                axes,
            })?;
        }
        ControlFlow::Continue(())
    }
}

impl<S: CurrentSink> TraceSink for Cycles<S> {
    fn begin(&mut self, time_s: f64, cause: &Arc<Cause>) -> ControlFlow<()> {
        self.drain()?;
        self.followers.restart();
        self.sink.begin(time_s, cause.line);
        ControlFlow::Continue(())
    }

    fn sample(&mut self, sample: &Sample<'_>) -> ControlFlow<()> {
        self.count += 1;
        self.waiting
            .push_back((sample.time_s, Arc::clone(sample.cause)));
        let axes = sample.positions.iter().zip(sample.velocities);
        let inputs = axes
            .zip(sample.cause.friction.iter())
            .map(|((x, v), state)| Commanded {
                position_units: x * POSITION_UNITS_PER_MM,
                velocity_units: v * VELOCITY_UNITS_PER_MM_PER_S,
                friction: *state,
            });
        if let Some(axes) = self.followers.push(inputs)
            && let Some((time_s, cause)) = self.waiting.pop_front()
        {
            let cause = &cause;
            return self.sink.cycle(&CurrentCycle {
                time_s,
                cause,
                axes,
            });
        }
        ControlFlow::Continue(())
    }
}

/// Returns the value list of an axis; an empty one if the control would not accept any.
fn values(friction: &Parameterisation) -> FrictionList {
    match friction {
        Parameterisation::Accepted(list) => list.clone(),
        _ => FrictionList {
            position_delay: 0,
            reversal_lookahead: 0,
            scaling_factor: 1000,
            delay_cycles: 0,
            max_points: 0,
            table: Vec::new(),
        },
    }
}
