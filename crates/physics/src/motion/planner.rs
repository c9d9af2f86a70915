//! Makes the path from the rows of a session.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::limits::MachineLimits;
use super::look_ahead::LookAhead;
use super::remarks::{MotionRemark, MotionRemarks, RemarkPlace};
use super::rounding::{Rounding, Transitions};
use super::sampler::Sampler;
use super::segment::{Ends, PathSegment};
use super::tool_path::{ToolOffset, ToolPath};
use super::trace::{Cause, Dwell, Movement, SkippedMotion, TraceSink};
use frictcomp::comp::{AxisIndex, Kind, State};
use frictcomp::diagnostic::{Advice, Budget, Code, Diagnostic};
use frictcomp::interpreter::{
    Group, Motion, PathFeed, PathForm, PositionFrame, SAME_PLACE, Travel,
};
use frictcomp::machine::{Axis, Machine};
use frictcomp::timeline::Row;

/// The radii of tools in mm, for G41 and G42 (R11.30).
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum ToolRadii {
    /// Unknown radii: the programmed contour is followed.
    #[default]
    Unknown,
    /// One radius for every tool.
    Every(f64),
    /// Radii by the number of the D word in force; with another one the programmed contour is followed.
    OfData(Arc<BTreeMap<u32, f64>>),
}

impl ToolRadii {
    /// Returns the radius with the tool data of a number, where one is known to be in force.
    fn of(&self, data: Option<u32>) -> Option<f64> {
        match self {
            Self::Unknown => None,
            Self::Every(radius) => Some(*radius),
            Self::OfData(radii) => radii.get(&data?).copied(),
        }
    }
}

/// Options of a trace.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct PlannerOptions {
    /// The CNC cycle.
    pub cycle_s: f64,
    /// Limit of the cycles of the trace.
    pub max_cycles: u64,
    /// The radii of the tools.
    pub tool_radii: ToolRadii,
}

impl PlannerOptions {
    /// Sets [`cycle_s`](Self::cycle_s).
    pub fn with_cycle_s(mut self, cycle_s: f64) -> Self {
        self.cycle_s = cycle_s;
        self
    }

    /// Sets [`max_cycles`](Self::max_cycles).
    pub fn with_max_cycles(mut self, max_cycles: u64) -> Self {
        self.max_cycles = max_cycles;
        self
    }

    /// Sets [`tool_radii`](Self::tool_radii).
    pub fn with_tool_radii(mut self, tool_radii: ToolRadii) -> Self {
        self.tool_radii = tool_radii;
        self
    }
}

impl Default for PlannerOptions {
    /// Cycles of 1 ms (R5.1), and 100 million of them: more than a day.
    fn default() -> Self {
        Self {
            cycle_s: 0.001,
            max_cycles: 100_000_000,
            tool_radii: ToolRadii::Unknown,
        }
    }
}

/// Most places of motions that are left out.
const MAX_PLACES: usize = 3;

/// Reason to leave out a motion whose start is not known.
const UNKNOWN_START: &str = "the position of the axes before this motion is not known";

/// Turns the rows of a session into the commanded trace of some axes.
pub struct TrajectoryPlanner {
    path: ToolPath,
    tool_radii: ToolRadii,
    followed: Vec<AxisIndex>,
    /// The name of each axis.
    names: Vec<String>,
    /// Whether each axis is X, Y or Z.
    main: Arc<[bool]>,
    /// End of the path, by axis; empty before it begins.
    stand: Vec<Option<f64>>,
    /// The end of the path, to the last bit of the last segment.
    end: Vec<f64>,
    running: Running,
    friction: Arc<[State]>,
    version: Option<u64>,
    /// The last block that moved something.
    file: Arc<str>,
    text: String,
    line: u32,
    /// Whether a motion was left out for another reason than its start.
    has_lost: bool,
    left_out: u64,
    /// The number of them that are not known to be rapid.
    left_out_feed: u64,
    /// The places of the first of these: `part.nc:8`.
    left_out_feed_at: Vec<String>,
    remarks: MotionRemarks,
}

/// A difference, in mm or degrees, that is due to rounding and not to a program.
const NOTHING: f64 = 1e-9;

/// Returns whether a straight motion goes nowhere.
fn is_nothing(travel: &Travel, from: &[f64], to: &[f64]) -> bool {
    let stays = from
        .iter()
        .zip(to)
        .all(|(from, to)| (to - from).abs() < NOTHING);
    stays && !matches!(travel.form, PathForm::Arc(_))
}

/// Knowledge of the path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Running {
    /// Path that has not begun, or broke off.
    No,
    Yes,
}

/// Reason why a motion cannot be followed.
enum PlanObstacle {
    /// The positions of the axes before it are not known.
    Start,
    Reason(&'static str),
}

impl TrajectoryPlanner {
    /// Returns a planner for some axes of a machine, before the first block.
    pub fn new(machine: &Machine, followed: &[AxisIndex], options: PlannerOptions) -> Self {
        let limits = MachineLimits::of(machine, options.cycle_s);
        let sampler = Sampler::new(followed, options.cycle_s, options.max_cycles);
        let is_main = |axis: &Axis| matches!(axis.name.as_str(), "X" | "Y" | "Z");
        let main: Arc<[bool]> = machine.axes.iter().map(is_main).collect();
        Self {
            path: ToolPath::new(
                Rounding::new(LookAhead::new(limits, sampler), Arc::clone(&main)),
                Arc::clone(&main),
            ),
            tool_radii: options.tool_radii,
            followed: followed.to_vec(),
            main,
            stand: Vec::new(),
            end: Vec::new(),
            running: Running::No,
            friction: Arc::new([]),
            version: None,
            file: Arc::from(""),
            text: String::new(),
            line: 0,
            has_lost: false,
            left_out: 0,
            left_out_feed: 0,
            left_out_feed_at: Vec::new(),
            remarks: MotionRemarks::default(),
            names: machine.axes.iter().map(|axis| axis.name.clone()).collect(),
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

    /// Reports FC915 at the last block that moved something.
    fn check_budget(&mut self) {
        if self.path.rounding().look_ahead().is_over() {
            let at = RemarkPlace {
                file: &Arc::clone(&self.file),
                text: &std::mem::take(&mut self.text),
                line: self.line,
            };
            let remark = MotionRemark {
                code: Code::Fc915,
                message: "the trace is longer than its budget and ends here",
                help: Advice::RaiseBudget(Budget::Cycles),
            };
            self.remarks.say(&at, remark);
        }
    }

    fn follows(&self, axis: usize) -> bool {
        self.followed.iter().any(|followed| followed.get() == axis)
    }

    /// Follows the path to its end.
    pub fn finish(&mut self, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        self.remarks.say_before();
        self.running = Running::No;
        let flow = self.path.stop(sink);
        self.check_budget();
        flow
    }

    /// Returns the treatment of the transitions between feed moves.
    pub fn transitions(&self) -> Transitions {
        self.path.rounding().transitions()
    }

    /// Returns the number of motions that the trace leaves out.
    pub fn left_out(&self) -> u64 {
        self.left_out
    }

    /// Returns the number of those that are not known to be rapid moves.
    pub fn left_out_feed(&self) -> u64 {
        self.left_out_feed
    }

    /// Returns the places of the first of these, as `part.nc:8`.
    pub fn left_out_feed_at(&self) -> &[String] {
        &self.left_out_feed_at
    }

    /// Returns the messages on the motions, each once per place.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        self.remarks.diagnostics()
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
            Err(PlanObstacle::Start) if self.running == Running::No => {
                self.note_before(row, travel);
                self.leave_out(row, UNKNOWN_START, sink);
                return ControlFlow::Continue(());
            }
            Err(PlanObstacle::Start) => return self.lose(row, UNKNOWN_START, sink),
            Err(PlanObstacle::Reason(reason)) => return self.lose(row, reason, sink),
        };
        let Some(segment) = segment else {
            if self.running == Running::Yes {
                self.stand.clone_from(&travel.to);
            }
            return ControlFlow::Continue(());
        };
        self.remarks.say_frame(row, segment.cause.frame);
        let beside = self.beside(row, travel);
        if beside.is_some() && segment.cause.frame == PositionFrame::Machine {
            self.remarks.say_tool(row, &self.tool_radii);
        }
        let jumped = self.stand.iter().zip(&travel.from);
        if self.running == Running::Yes
            && jumped
                .into_iter()
                .any(|(is, was)| was.is_some() && is != was)
        {
            self.path.stop(sink)?;
            self.running = Running::No;
        }
        if self.running == Running::No {
            self.remarks.say_before();
            sink.begin(self.path.rounding().look_ahead().time_s(), &segment.cause)?;
            self.running = Running::Yes;
        }
        self.stand.clone_from(&travel.to);
        self.end.clear();
        self.end.extend_from_slice(segment.ends());
        match self.path.add((segment, travel.contouring), beside, sink) {
            Ok(flow) => flow,
            Err(reason) => self.lose(row, reason, sink),
        }
    }

    /// Returns the axes of the plane in force.
    fn plane(&self, row: &Row<'_>) -> Option<[usize; 2]> {
        let axis = |name: &str| self.names.iter().position(|it| it == name);
        let [one, two] = match row.modal.functions.plane {
            _ if !row.modal.is_known(Group::Plane) => return None,
            18 => ["Z", "X"],
            19 => ["Y", "Z"],
            _ => ["X", "Y"],
        };
        Some([axis(one)?, axis(two)?])
    }

    /// Returns where the tool follows the contour, if its radius and the plane are known.
    fn beside(&self, row: &Row<'_>, travel: &Travel) -> Option<ToolOffset> {
        let radius = self.tool_radii.of(row.modal.functions.tool_data);
        Some(ToolOffset::of(travel.tool?, self.plane(row)?, radius?))
    }

    /// Returns the difference between the followed path and that of the machine.
    fn frame(&self, row: &Row<'_>, travel: &Travel) -> PositionFrame {
        match row.modal.frame() {
            PositionFrame::Contour if self.beside(row, travel).is_some() => PositionFrame::Machine,
            frame => frame,
        }
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
                    cause: &self.cause(row, Movement::Dwell, row.modal.frame()),
                };
                self.path.rest(dwell, sink)
            }
            Some(_) => self.lose(row, "a dwell time must not be negative", sink),
            None => self.lose(row, "the dwell time is not known", sink),
        }
    }

    /// Breaks the path off: it continues after the next motion whose start is known.
    fn lose(
        &mut self,
        row: &Row<'_>,
        reason: &'static str,
        sink: &mut dyn TraceSink,
    ) -> ControlFlow<()> {
        self.remarks.say_left_out(row, reason);
        self.has_lost = true;
        self.running = Running::No;
        self.path.stop(sink)?;
        self.leave_out(row, reason, sink);
        ControlFlow::Continue(())
    }

    /// Returns the segment of a motion; `None` if nothing moves.
    fn segment(
        &mut self,
        row: &Row<'_>,
        travel: &Travel,
    ) -> Result<Option<PathSegment>, PlanObstacle> {
        if let PathForm::Unknown(reason) = travel.form {
            return Err(PlanObstacle::Reason(reason));
        }
        if self.unknown_at_start(travel).next().is_some() {
            return Err(PlanObstacle::Start);
        }
        let feed = match travel.feed {
            PathFeed::Unknown(reason) => return Err(PlanObstacle::Reason(reason)),
            PathFeed::PerMinute(feed) | PathFeed::Seconds(feed) | PathFeed::OfAxes(feed)
                if feed <= 0.0 =>
            {
                return Err(PlanObstacle::Reason("F is not above 0"));
            }
            feed => feed,
        };
        let mut from = Vec::with_capacity(travel.from.len());
        let mut to = Vec::with_capacity(travel.from.len());
        for ends in travel.from.iter().zip(&travel.to) {
            let (start, end) = match ends {
                (Some(start), Some(end)) => (*start, *end),
                (Some(_), None) => {
                    return Err(PlanObstacle::Reason("its end is not known"));
                }
                // It does not move: its position does not matter.
                (None, _) => (0.0, 0.0),
            };
            from.push(start);
            to.push(end);
        }
        if self.running == Running::Yes {
            // A distance too short to be a motion is made up for by the next one.
            for (start, end) in from.iter_mut().zip(&self.end) {
                if (*start - end).abs() < SAME_PLACE {
                    *start = *end;
                }
            }
        }
        if is_nothing(travel, &from, &to) {
            return Ok(None);
        }
        let movement = match travel.form {
            PathForm::Rapid => Movement::Rapid,
            _ => Movement::Feed,
        };
        self.remarks.say_simplified(row, travel.simplified);
        let cause = self.cause(row, movement, self.frame(row, travel));
        let ends = Ends {
            from: from.into(),
            to: to.into(),
            main: &self.main,
        };
        let segment = match &travel.form {
            PathForm::Arc(arc) => {
                Some(PathSegment::arc(ends, arc, cause).map_err(PlanObstacle::Reason)?)
            }
            _ => PathSegment::line(ends, cause),
        };
        let Some(mut segment) = segment else {
            return Ok(None);
        };
        if !segment.length.is_finite() {
            return Err(PlanObstacle::Reason("it is too long to compute"));
        }
        segment.feed = match feed {
            PathFeed::PerMinute(feed) => feed / 60.0,
            PathFeed::Seconds(seconds) => segment.length / seconds,
            PathFeed::OfAxes(share) if share >= 1.0 => f64::INFINITY,
            PathFeed::OfAxes(share) => self.path.rounding().look_ahead().fastest(&segment) * share,
            PathFeed::Unknown(reason) => return Err(PlanObstacle::Reason(reason)),
        };
        segment.end = travel.end;
        segment.slope = travel.slope;
        if let Some(feed) = travel.end_feed_per_min {
            segment.end_velocity = feed / 60.0;
        }
        Ok(Some(segment))
    }

    fn cause(&mut self, row: &Row<'_>, movement: Movement, frame: PositionFrame) -> Arc<Cause> {
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
            program: row.program,
            seq: row.seq,
            file: Arc::clone(&self.file),
            line: row.line,
            number: row.number,
            movement,
            frame,
            simplified: self.remarks.simplified(),
            friction: Arc::clone(&self.friction),
        })
    }

    /// Leaves a motion out of the trace.
    fn leave_out(&mut self, row: &Row<'_>, reason: &'static str, sink: &mut dyn TraceSink) {
        self.left_out += 1;
        let is_rapid =
            matches!(row.motion, Some(Motion::Travel(travel)) if travel.form == PathForm::Rapid);
        if !is_rapid {
            self.left_out_feed += 1;
            if self.left_out_feed_at.len() < MAX_PLACES {
                let place = format!("{}:{}", row.file, row.line);
                self.left_out_feed_at.push(place);
            }
        }
        sink.left_out(&SkippedMotion {
            time_s: self.path.rounding().look_ahead().time_s(),
            file: row.file,
            line: row.line,
            number: row.number,
            reason,
        });
    }

    /// Notes a motion before the trace begins. Once it has begun, the reason for its break was reported.
    fn note_before(&mut self, row: &Row<'_>, travel: &Travel) {
        if self.has_lost || !self.stand.is_empty() {
            return;
        }
        let unknown = self.unknown_at_start(travel);
        let names: Vec<String> = unknown.map(|axis| self.names[axis].clone()).collect();
        self.remarks.note_before(row, names);
    }

    /// Returns the axes that matter to a motion and whose position before it is not known.
    fn unknown_at_start(&self, travel: &Travel) -> impl Iterator<Item = usize> {
        let ends = travel.from.iter().zip(&travel.to).enumerate();
        let matters = |axis, to: &Option<f64>| {
            let moves = || travel.axes.iter().any(|moved| moved.get() == axis);
            to.is_some() || self.follows(axis) || moves()
        };
        ends.filter(move |(axis, (from, to))| from.is_none() && matters(*axis, to))
            .map(|(axis, _)| axis)
    }
}
