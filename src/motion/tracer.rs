//! Makes the path from the rows of a session.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::course::Course;
use super::leg::{Ends, Leg};
use super::limits::AxisLimits;
use super::sampler::Sampler;
use super::{Cause, Cycles};
use crate::codes::Code;
use crate::compensation::State;
use crate::diagnostic::{Diagnostic, Place};
use crate::interpreter::{Form, Motion, PathFeed, PositionFrame, Travel};
use crate::machine::{AxisIndex, Machine};
use crate::source::Span;
use crate::syntax::Kind;
use crate::timeline::Row;

/// How a trace is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TracerOptions {
    /// The CNC cycle in seconds.
    pub cycle: f64,
    /// How many cycles the trace may have.
    pub max_cycles: u64,
}

impl Default for TracerOptions {
    /// Cycles of 1 ms (R5.1), and 100 million of them: more than a day.
    fn default() -> Self {
        Self {
            cycle: 0.001,
            max_cycles: 100_000_000,
        }
    }
}

/// How many places are named at which the motion is not known.
const MAX_NAMED: usize = 100;

/// Turns the rows of a session into the commanded trace of some axes.
pub struct Tracer {
    course: Course,
    followed: Vec<AxisIndex>,
    /// Whether each axis is X, Y or Z.
    main: Vec<bool>,
    /// Where the path ends, by axis; empty before it begins.
    stand: Vec<Option<f64>>,
    running: Running,
    friction: Arc<[State]>,
    version: Option<u64>,
    file: Arc<str>,
    diagnostics: Vec<Diagnostic>,
    named: BTreeSet<(Code, Arc<str>, u32)>,
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

impl Tracer {
    /// A tracer for some axes of a machine, before the first block.
    pub fn new(machine: &Machine, followed: &[AxisIndex], options: TracerOptions) -> Self {
        let limits = machine.axes.iter().map(AxisLimits::of).collect();
        let sampler = Sampler::new(followed, options.cycle, options.max_cycles);
        Self {
            course: Course::new(limits, sampler),
            followed: followed.to_vec(),
            main: machine
                .axes
                .iter()
                .map(|axis| matches!(axis.name.as_str(), "X" | "Y" | "Z"))
                .collect(),
            stand: Vec::new(),
            running: Running::No,
            friction: Arc::new([]),
            version: None,
            file: Arc::from(""),
            diagnostics: Vec::new(),
            named: BTreeSet::new(),
        }
    }

    /// Takes the next row of the session. `Break` when the trace is over.
    pub fn block(&mut self, row: &Row<'_>, cycles: &mut dyn Cycles) -> ControlFlow<()> {
        let Some(motion) = row.motion else {
            return ControlFlow::Continue(());
        };
        let flow = match motion {
            Motion::Travel(travel) => self.travel(row, travel, cycles),
            Motion::Dwell(seconds) => self.dwell(row, *seconds, cycles),
        };
        if self.course.is_over() {
            let help = "ask for more with `--max-cycles`";
            let message = "the trace is longer than its bound and ends here";
            self.say(row, (Code::Fc915, message), help);
        }
        flow
    }

    /// Follows the path to its end.
    pub fn finish(&mut self, cycles: &mut dyn Cycles) -> ControlFlow<()> {
        self.running = Running::No;
        self.course.stop(cycles)
    }

    /// What there is to say about the motions, each once a place.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    fn travel(
        &mut self,
        row: &Row<'_>,
        travel: &Travel,
        cycles: &mut dyn Cycles,
    ) -> ControlFlow<()> {
        let leg = self.leg(row, travel);
        let leg = match leg {
            Ok(leg) => leg,
            // Where the path has not begun, nobody expects to know where it comes from.
            Err(Obstacle::Start) if self.running == Running::No => return ControlFlow::Continue(()),
            Err(Obstacle::Start) => {
                return self.lose(
                    row,
                    "where the axes stand before this motion is not known",
                    cycles,
                );
            }
            Err(Obstacle::Reason(reason)) => return self.lose(row, reason, cycles),
        };
        let Some(leg) = leg else {
            return ControlFlow::Continue(());
        };
        if row.modal.position(self.followed[0]).frame == PositionFrame::Programmed {
            let message = "from here on the trace is that of the program, not of the machine: a \
                           transformation is in force";
            self.say(
                row,
                (Code::Fc904, message),
                "the axes of the machine move in another way",
            );
        }
        let jumped = self.stand.iter().zip(&travel.from);
        if self.running == Running::Yes
            && jumped
                .into_iter()
                .any(|(is, was)| was.is_some() && is != was)
        {
            self.course.stop(cycles)?;
            self.running = Running::No;
        }
        if self.running == Running::No {
            cycles.begin(self.course.time(), &leg.cause)?;
            self.running = Running::Yes;
        }
        self.stand.clone_from(&travel.to);
        self.course.add(leg, cycles)
    }

    fn dwell(
        &mut self,
        row: &Row<'_>,
        seconds: Option<f64>,
        cycles: &mut dyn Cycles,
    ) -> ControlFlow<()> {
        if self.running == Running::No {
            return ControlFlow::Continue(());
        }
        match seconds {
            Some(seconds) if seconds >= 0.0 && seconds.is_finite() => {
                let cause = self.cause(row);
                self.course.rest(seconds, &cause, cycles)
            }
            Some(_) => self.lose(row, "a dwell time below 0 is none", cycles),
            None => self.lose(row, "how long the axes dwell is not known", cycles),
        }
    }

    /// The path breaks off: it goes on behind the next motion whose start is known.
    fn lose(
        &mut self,
        row: &Row<'_>,
        reason: &'static str,
        cycles: &mut dyn Cycles,
    ) -> ControlFlow<()> {
        let message = format!("the trace leaves this motion out: {reason}");
        let help = "write what is missing into the program (`F`, absolute positions), or give \
                    values with `--set`; the trace begins anew behind it";
        self.say(row, (Code::Fc903, &message), help);
        self.running = Running::No;
        self.course.stop(cycles)
    }

    /// The leg of a motion; `None` where nothing moves.
    fn leg(&mut self, row: &Row<'_>, travel: &Travel) -> Result<Option<Leg>, Obstacle> {
        if let Form::Unknown(reason) = travel.form {
            return Err(Obstacle::Reason(reason));
        }
        let feed = match (travel.form, travel.feed) {
            (Form::Rapid, _) => PathFeed::PerMinute(f64::INFINITY),
            (_, PathFeed::Unknown(reason)) => return Err(Obstacle::Reason(reason)),
            (_, PathFeed::PerMinute(feed) | PathFeed::Seconds(feed)) if feed <= 0.0 => {
                return Err(Obstacle::Reason("F is not above 0"));
            }
            (_, feed) => feed,
        };
        let mut from = Vec::with_capacity(travel.from.len());
        let mut to = Vec::with_capacity(travel.from.len());
        for (axis, ends) in travel.from.iter().zip(&travel.to).enumerate() {
            let followed = self.followed.iter().any(|followed| followed.get() == axis);
            let (start, end) = match ends {
                (Some(start), Some(end)) => (*start, *end),
                (None, None) if followed => return Err(Obstacle::Start),
                // It does not move: where it stands does not matter.
                (None, None) => (0.0, 0.0),
                (None, Some(_)) => return Err(Obstacle::Start),
                (Some(_), None) => {
                    return Err(Obstacle::Reason("where it ends is not known"));
                }
            };
            from.push(start);
            to.push(end);
        }
        let cause = self.cause(row);
        let ends = Ends {
            from: from.into(),
            to: to.into(),
            main: &self.main,
        };
        let leg = match &travel.form {
            Form::Arc(arc) => Some(Leg::arc(ends, arc, cause).map_err(Obstacle::Reason)?),
            _ => Leg::line(ends, cause),
        };
        let Some(mut leg) = leg else { return Ok(None) };
        if !leg.length.is_finite() {
            return Err(Obstacle::Reason("it is longer than numbers can say"));
        }
        leg.feed = match feed {
            PathFeed::PerMinute(feed) => feed / 60.0,
            PathFeed::Seconds(seconds) => leg.length / seconds,
            PathFeed::Unknown(reason) => return Err(Obstacle::Reason(reason)),
        };
        leg.end = travel.end;
        Ok(Some(leg))
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
    fn say(&mut self, row: &Row<'_>, (code, message): (Code, &str), help: &str) {
        let place = Place {
            file: row.file.into(),
            text: row.text.into(),
            first_line: row.line,
            span: Span::new(0, row.text.len()),
        };
        let key = match code {
            Code::Fc904 => (code, Arc::from(""), 0),
            _ => (code, Arc::clone(&place.file), row.line),
        };
        if self.named.len() < MAX_NAMED && self.named.insert(key) {
            let diagnostic = Diagnostic::new(code, place, message).with_help(help);
            self.diagnostics.push(diagnostic);
        }
    }
}
