//! Makes the path from the rows of a session.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::limits::AxisLimits;
use super::look_ahead::LookAhead;
use super::sampler::Sampler;
use super::segment::{Ends, SAME_PLACE, Segment};
use super::trace::{Cause, Dwell, TraceSink};
use crate::comp::{AxisIndex, Kind, State};
use crate::diagnostic::{Advice, Budget, Code, Diagnostic};
use crate::interpreter::{Form, Motion, PathFeed, Travel};
use crate::machine::Machine;
use crate::text::{Place, Span};
use crate::timeline::Row;

/// How a trace is made.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct PlannerOptions {
    /// The CNC cycle.
    pub cycle_s: f64,
    /// How many cycles the trace may have.
    pub max_cycles: u64,
}

impl PlannerOptions {
    /// The same with another value of [`cycle_s`](Self::cycle_s).
    pub fn with_cycle_s(mut self, cycle_s: f64) -> Self {
        self.cycle_s = cycle_s;
        self
    }

    /// The same with another value of [`max_cycles`](Self::max_cycles).
    pub fn with_max_cycles(mut self, max_cycles: u64) -> Self {
        self.max_cycles = max_cycles;
        self
    }
}

impl Default for PlannerOptions {
    /// Cycles of 1 ms (R5.1), and 100 million of them: more than a day.
    fn default() -> Self {
        Self {
            cycle_s: 0.001,
            max_cycles: 100_000_000,
        }
    }
}

/// How many places are named at which the motion is not known.
const MAX_NAMED: usize = 100;

/// Turns the rows of a session into the commanded trace of some axes.
pub struct TrajectoryPlanner {
    look_ahead: LookAhead,
    followed: Vec<AxisIndex>,
    /// Whether each axis is X, Y or Z.
    main: Vec<bool>,
    /// Where the path ends, by axis; empty before it begins.
    stand: Vec<Option<f64>>,
    /// The same, to the last bit of the last segment.
    end: Vec<f64>,
    running: Running,
    friction: Arc<[State]>,
    version: Option<u64>,
    /// The last block that moved something.
    file: Arc<str>,
    text: String,
    line: u32,
    diagnostics: Vec<Diagnostic>,
    named: BTreeSet<(Code, Arc<str>, u32)>,
}

/// A difference, in mm or degrees, that rounding makes and no program.
const NOTHING: f64 = 1e-9;

/// Whether a straight motion goes nowhere.
fn is_nothing(travel: &Travel, from: &[f64], to: &[f64]) -> bool {
    let stays = from
        .iter()
        .zip(to)
        .all(|(from, to)| (to - from).abs() < NOTHING);
    stays && !matches!(travel.form, Form::Arc(_))
}

/// Whether the path is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Running {
    /// It has not begun, or broke off.
    No,
    Yes,
}

/// Why a motion cannot be followed.
enum Obstacle {
    /// Where the axes stand before it is not known.
    Start,
    Reason(&'static str),
}

/// The place of a block.
struct At<'a> {
    file: &'a str,
    text: &'a str,
    line: u32,
}

impl<'a> At<'a> {
    fn of(row: &Row<'a>) -> Self {
        Self {
            file: row.file,
            text: row.text,
            line: row.line,
        }
    }
}

impl TrajectoryPlanner {
    /// A planner for some axes of a machine, before the first block.
    pub fn new(machine: &Machine, followed: &[AxisIndex], options: PlannerOptions) -> Self {
        let limits = machine.axes.iter().map(AxisLimits::of).collect();
        let sampler = Sampler::new(followed, options.cycle_s, options.max_cycles);
        Self {
            look_ahead: LookAhead::new(limits, sampler),
            followed: followed.to_vec(),
            main: machine
                .axes
                .iter()
                .map(|axis| matches!(axis.name.as_str(), "X" | "Y" | "Z"))
                .collect(),
            stand: Vec::new(),
            end: Vec::new(),
            running: Running::No,
            friction: Arc::new([]),
            version: None,
            file: Arc::from(""),
            text: String::new(),
            line: 0,
            diagnostics: Vec::new(),
            named: BTreeSet::new(),
        }
    }

    /// Takes the next row of the session. `Break` when the trace is over.
    pub fn block(&mut self, row: &Row<'_>, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        let Some(motion) = row.motion else {
            return ControlFlow::Continue(());
        };
        let flow = match motion {
            Motion::Travel(travel) => self.travel(row, travel, sink),
            Motion::Dwell(seconds) => self.dwell(row, *seconds, sink),
        };
        self.text.clear();
        self.text.push_str(row.text);
        self.line = row.line;
        self.check_budget();
        flow
    }

    /// FC915 at the last block that moved something.
    fn check_budget(&mut self) {
        if self.look_ahead.is_over() {
            let at = At {
                file: &Arc::clone(&self.file),
                text: &std::mem::take(&mut self.text),
                line: self.line,
            };
            let help = Advice::RaiseBudget(Budget::Cycles);
            let message = "the trace is longer than its budget and ends here";
            self.say(&at, (Code::Fc915, message), help);
        }
    }

    fn follows(&self, axis: usize) -> bool {
        self.followed.iter().any(|followed| followed.get() == axis)
    }

    /// Follows the path to its end.
    pub fn finish(&mut self, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        self.running = Running::No;
        let flow = self.look_ahead.stop(sink);
        self.check_budget();
        flow
    }

    /// What there is to say about the motions, each once a place.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    fn travel(
        &mut self,
        row: &Row<'_>,
        travel: &Travel,
        sink: &mut dyn TraceSink,
    ) -> ControlFlow<()> {
        let segment = self.segment(row, travel);
        let segment = match segment {
            Ok(segment) => segment,
            // Where the path has not begun, nobody expects to know where it comes from.
            Err(Obstacle::Start) if self.running == Running::No => return ControlFlow::Continue(()),
            Err(Obstacle::Start) => {
                return self.lose(
                    row,
                    "the position of the axes before this motion is not known",
                    sink,
                );
            }
            Err(Obstacle::Reason(reason)) => return self.lose(row, reason, sink),
        };
        let Some(segment) = segment else {
            if self.running == Running::Yes {
                self.stand.clone_from(&travel.to);
            }
            return ControlFlow::Continue(());
        };
        if !row.modal.transformed.is_empty() {
            let message = "from here on the trace is that of the program, not of the machine: a \
                           transformation is active";
            self.say(
                &At::of(row),
                (Code::Fc904, message),
                "the axes of the machine move differently",
            );
        }
        let jumped = self.stand.iter().zip(&travel.from);
        if self.running == Running::Yes
            && jumped
                .into_iter()
                .any(|(is, was)| was.is_some() && is != was)
        {
            self.look_ahead.stop(sink)?;
            self.running = Running::No;
        }
        if self.running == Running::No {
            sink.begin(self.look_ahead.time_s(), &segment.cause)?;
            self.running = Running::Yes;
        }
        self.stand.clone_from(&travel.to);
        self.end.clear();
        self.end.extend_from_slice(segment.ends());
        self.look_ahead.add(segment, sink)
    }

    fn dwell(
        &mut self,
        row: &Row<'_>,
        seconds: Option<f64>,
        sink: &mut dyn TraceSink,
    ) -> ControlFlow<()> {
        if self.running == Running::No {
            return ControlFlow::Continue(());
        }
        match seconds {
            Some(seconds) if seconds >= 0.0 && seconds.is_finite() => {
                let dwell = Dwell {
                    seconds,
                    cause: &self.cause(row),
                };
                self.look_ahead.rest(dwell, sink)
            }
            Some(_) => self.lose(row, "a dwell time must not be negative", sink),
            None => self.lose(row, "the dwell time is not known", sink),
        }
    }

    /// The path breaks off: it goes on after the next motion whose start is known.
    fn lose(
        &mut self,
        row: &Row<'_>,
        reason: &'static str,
        sink: &mut dyn TraceSink,
    ) -> ControlFlow<()> {
        let message = format!("the trace leaves this motion out: {reason}");
        self.say(
            &At::of(row),
            (Code::Fc903, &message),
            Advice::CompleteMotion,
        );
        self.running = Running::No;
        self.look_ahead.stop(sink)
    }

    /// The segment of a motion; `None` where nothing moves.
    fn segment(&mut self, row: &Row<'_>, travel: &Travel) -> Result<Option<Segment>, Obstacle> {
        let moves = travel.from.iter().zip(&travel.to).enumerate();
        let mut unknown = moves.filter(|(_, (from, _))| from.is_none());
        if unknown.any(|(axis, (_, to))| to.is_some() || self.follows(axis)) {
            return Err(Obstacle::Start);
        }
        let feed = match (travel.form, travel.feed) {
            (Form::Rapid, _) => PathFeed::PerMinute(f64::INFINITY),
            (Form::Unknown(reason), _) | (_, PathFeed::Unknown(reason)) => {
                return Err(Obstacle::Reason(reason));
            }
            (_, PathFeed::PerMinute(feed) | PathFeed::Seconds(feed)) if feed <= 0.0 => {
                return Err(Obstacle::Reason("F is not above 0"));
            }
            (_, feed) => feed,
        };
        let mut from = Vec::with_capacity(travel.from.len());
        let mut to = Vec::with_capacity(travel.from.len());
        for ends in travel.from.iter().zip(&travel.to) {
            let (start, end) = match ends {
                (Some(start), Some(end)) => (*start, *end),
                (Some(_), None) => {
                    return Err(Obstacle::Reason("its end is not known"));
                }
                // It does not move: where it stands does not matter.
                (None, _) => (0.0, 0.0),
            };
            from.push(start);
            to.push(end);
        }
        if self.running == Running::Yes {
            // What was too short to be a motion is made up for by the next one.
            for (start, end) in from.iter_mut().zip(&self.end) {
                if (*start - end).abs() < SAME_PLACE {
                    *start = *end;
                }
            }
        }
        if is_nothing(travel, &from, &to) {
            return Ok(None);
        }
        let cause = self.cause(row);
        let ends = Ends {
            from: from.into(),
            to: to.into(),
            main: &self.main,
        };
        let segment = match &travel.form {
            Form::Arc(arc) => Some(Segment::arc(ends, arc, cause).map_err(Obstacle::Reason)?),
            _ => Segment::line(ends, cause),
        };
        let Some(mut segment) = segment else {
            return Ok(None);
        };
        if !segment.length.is_finite() {
            return Err(Obstacle::Reason("it is too long to compute"));
        }
        segment.feed = match feed {
            PathFeed::PerMinute(feed) => feed / 60.0,
            PathFeed::Seconds(seconds) => segment.length / seconds,
            PathFeed::Unknown(reason) => return Err(Obstacle::Reason(reason)),
        };
        segment.end = travel.end;
        Ok(Some(segment))
    }

    fn cause(&mut self, row: &Row<'_>) -> Arc<Cause> {
        if self.version != Some(row.state.version) {
            self.version = Some(row.state.version);
            let axes = self.followed.iter();
            self.friction = axes
                .map(|&axis| row.state.state(axis, Kind::Frict))
                .collect();
        }
        if *self.file != *row.file {
            self.file = row.file.into();
        }
        Arc::new(Cause {
            seq: row.seq,
            file: Arc::clone(&self.file),
            line: row.line,
            friction: Arc::clone(&self.friction),
        })
    }

    /// Says something about a block, once a place; of what holds for the rest of the program only
    /// the first.
    fn say(&mut self, at: &At<'_>, (code, message): (Code, &str), help: impl Into<Advice>) {
        let place = Place {
            file: at.file.into(),
            text: at.text.into(),
            first_line: at.line,
            span: Span::new(0, at.text.len()),
        };
        let key = match code {
            Code::Fc903 => (code, Arc::clone(&place.file), at.line),
            _ => (code, Arc::from(""), 0),
        };
        if self.named.len() < MAX_NAMED && self.named.insert(key) {
            let diagnostic = Diagnostic::new(code, place, message).with_help(help);
            self.diagnostics.push(diagnostic);
        }
    }
}
