//! Transitions between straight blocks, rounded as by the control (R11.21, R11.22).
//!
//! Short lines that follow a curve become that curve. Any other corner is rounded by two spans of a
//! cubic B-spline, which leave the blocks at the same distance and bend nowhere at their ends.

use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::Arc;

use super::look_ahead::LookAhead;
use super::segment::PathSegment;
use super::smoothing::{AxisPositions, Bend, SmoothRun};
use super::trace::{Cause, Dwell, Movement, TraceSink};
use frictcomp::interpreter::{BlockEnd, Contouring, Joining};

/// Greatest distance of a vertex of a run from the line through its neighbours, in mm: four times a
/// sagitta of 0.2 µm (R11.22), and the share of the third decimal.
const FINE: f64 = 0.0015;

/// The sharpest kink in a run, in rad: 1° (R11.22), and the share of the third decimal.
const FINE_KINK: f64 = 0.05;

/// Largest ratio of a chord of a run to its neighbour.
const EVEN: f64 = 4.0;

/// Angle from which a corner turns back: it is not rounded (PM/475073291).
const TURNS_BACK: f64 = 3.0;

/// Size of a kink below which it is due only to the decimals of the program.
const STRAIGHT: f64 = 1e-7;

/// Largest deviation of the followed path from the programmed one.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Departure {
    /// The distance in µm.
    pub um: f64,
    /// The block.
    pub at: Option<Arc<Cause>>,
}

/// Treatment of the transitions between feed moves.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Transitions {
    /// Number of those that are part of a curve that joins short lines.
    pub joined: u64,
    /// Number of rounded corners.
    pub rounded: u64,
    /// Number of kinks that are not rounded, and that are passed below 80 % of F.
    pub slow: u64,
    /// Largest deviation by rounding from the programmed path.
    pub rounding: Departure,
    /// The largest distance of a chord from the curve that joins it with others.
    pub sagitta: Departure,
}

/// Passage of a transition.
enum CornerPassage {
    /// Unchanged.
    Kink,
    /// Blocks that are part of one curve.
    Joined {
        /// Distance of the curve from its chords, in mm.
        sagitta: f64,
        /// The bend there.
        bend: Bend,
        /// The distance in mm that the mode permits.
        tolerance: f64,
    },
    /// Rounded corner.
    Corner(Corner),
}

/// A rounded corner.
struct Corner {
    /// Length of the curve in both blocks, in mm.
    reach: f64,
    /// Distance of the curve from the corner, in mm.
    departure: f64,
}

/// Rounds transitions, and passes the path on.
pub(super) struct Rounding {
    look_ahead: LookAhead,
    main: Arc<[bool]>,
    /// The straight blocks of the run that have not been passed on.
    blocks: VecDeque<Straight>,
    /// The number of the first of them in the run.
    next: usize,
    run: SmoothRun,
    transitions: Transitions,
}

/// A straight block.
struct Straight {
    segment: PathSegment,
    contouring: Option<Contouring>,
}

impl Rounding {
    pub(super) fn new(look_ahead: LookAhead, main: Arc<[bool]>) -> Self {
        Self {
            look_ahead,
            main,
            blocks: VecDeque::new(),
            next: 0,
            run: SmoothRun::new(),
            transitions: Transitions::default(),
        }
    }

    /// Returns the known path, except for its roundings.
    pub(super) fn look_ahead(&self) -> &LookAhead {
        &self.look_ahead
    }

    /// Returns the treatment of the transitions.
    pub(super) fn transitions(&self) -> Transitions {
        Transitions {
            slow: self.look_ahead.slow_kinks(),
            ..self.transitions.clone()
        }
    }

    /// Adds the next segment, and the rounding of the transition after it.
    pub(super) fn add(
        &mut self,
        (segment, contouring): (PathSegment, Option<Contouring>),
        sink: &mut dyn TraceSink,
    ) -> ControlFlow<()> {
        let is_line = segment.is_straight() && segment.cause.movement == Movement::Feed;
        let contouring = contouring.filter(|_| {
            is_line && segment.end == BlockEnd::Through && segment.end_velocity.is_infinite()
        });
        if !is_line || (contouring.is_none() && self.blocks.is_empty()) {
            self.flush(None, sink)?;
            return self.hand_on(segment, sink);
        }
        let next = Straight {
            segment,
            contouring,
        };
        let Some(last) = self.blocks.back() else {
            self.begin(next, None);
            return ControlFlow::Continue(());
        };
        match self.passage(last, &next.segment) {
            CornerPassage::Kink => {
                self.flush(None, sink)?;
                self.begin(next, None);
            }
            CornerPassage::Joined {
                sagitta,
                bend,
                tolerance,
            } => {
                self.transitions.joined += 1;
                note(&mut self.transitions.sagitta, sagitta, &next.segment.cause);
                let place = next.segment.ends().into();
                self.run.join(place, (bend, tolerance));
                self.blocks.push_back(next);
                while self.blocks.len() > 1 && self.run.is_ready(self.next) {
                    self.hand_on_span(sink)?;
                }
            }
            CornerPassage::Corner(corner) => {
                self.transitions.rounded += 1;
                note(
                    &mut self.transitions.rounding,
                    corner.departure,
                    &next.segment.cause,
                );
                self.round(next, &corner, sink)?;
            }
        }
        if self.blocks.back().is_some_and(|it| it.contouring.is_none()) {
            self.flush(None, sink)?;
        }
        ControlFlow::Continue(())
    }

    /// Holds the axes at rest.
    pub(super) fn rest(&mut self, dwell: Dwell<'_>, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        self.flush(None, sink)?;
        self.look_ahead.rest(dwell, sink)
    }

    /// Follows the path to its end and stops there.
    pub(super) fn stop(&mut self, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        self.flush(None, sink)?;
        self.look_ahead.stop(sink)
    }

    /// Begins a run with a block, at its start or farther on.
    fn begin(&mut self, block: Straight, from: Option<AxisPositions>) {
        let start = from.unwrap_or_else(|| block.segment.starts().into());
        self.run.begin(start);
        self.run.push(block.segment.ends().into());
        self.next = 0;
        self.blocks.push_back(block);
    }

    /// Rounds the corner between the last block and the next one.
    fn round(
        &mut self,
        next: Straight,
        corner: &Corner,
        sink: &mut dyn TraceSink,
    ) -> ControlFlow<()> {
        let Some(last) = self.blocks.back() else {
            return ControlFlow::Continue(());
        };
        let before = last.segment.clone();
        let along = |segment: &PathSegment, from: &[f64], part: f64| -> AxisPositions {
            let way = part * corner.reach / segment.length;
            let ends = segment.starts().iter().zip(segment.ends());
            let steps = ends.map(|(start, end)| way * (end - start));
            from.iter().zip(steps).map(|(at, step)| at + step).collect()
        };
        let vertex = before.ends();
        let points = [
            along(&before, vertex, -2.0),
            along(&before, vertex, -1.0),
            vertex.into(),
            along(&next.segment, vertex, 1.0),
            along(&next.segment, vertex, 2.0),
        ];
        let [first, from, middle, to, last] = &points;
        let halves = (
            before.curved([first, from, middle, to], &self.main),
            next.segment.curved([from, middle, to, last], &self.main),
        );
        self.flush(Some(from.clone()), sink)?;
        if let (Some(first), Some(second)) = halves {
            self.hand_on(first, sink)?;
            self.hand_on(second, sink)?;
        }
        self.begin(next, Some(to.clone()));
        ControlFlow::Continue(())
    }

    /// Passes the rest of the run on, which ends at its last vertex or before it.
    fn flush(&mut self, end: Option<AxisPositions>, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        if self.blocks.is_empty() {
            return ControlFlow::Continue(());
        }
        self.run.end(end);
        if self.run.newest() == 1 {
            if let Some(block) = self.blocks.pop_front() {
                let ends = [self.run.vertex(0), self.run.vertex(1)];
                if let Some(line) = block.segment.moved(ends[0], ends[1], &self.main) {
                    self.hand_on(line, sink)?;
                }
            }
            return ControlFlow::Continue(());
        }
        while !self.blocks.is_empty() {
            self.hand_on_span(sink)?;
        }
        ControlFlow::Continue(())
    }

    /// Passes on the next span of the curve that joins the blocks of the run.
    fn hand_on_span(&mut self, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        let Some(block) = self.blocks.pop_front() else {
            return ControlFlow::Continue(());
        };
        let [p, q, r, s] = self.run.span(self.next);
        let span = block.segment.curved([&p, &q, &r, &s], &self.main);
        self.next += 1;
        self.run.forget_before(self.next);
        match span {
            Some(span) => self.hand_on(span, sink),
            None => ControlFlow::Continue(()),
        }
    }

    fn hand_on(&mut self, segment: PathSegment, sink: &mut dyn TraceSink) -> ControlFlow<()> {
        self.look_ahead.add(segment, sink)
    }

    /// Returns whether an axis moves the other way in the last block only: a curve through all three blocks may pass
    /// over its stroke (R11.29).
    fn is_stroke_between(&self, next: &PathSegment) -> bool {
        let mut blocks = self.blocks.iter().rev();
        let (Some(last), Some(before)) = (blocks.next(), blocks.next()) else {
            return false;
        };
        let step =
            |segment: &PathSegment, axis: usize| segment.ends()[axis] - segment.starts()[axis];
        (0..next.axes()).any(|axis| {
            let here = step(&last.segment, axis);
            here * step(&before.segment, axis) < 0.0 && here * step(next, axis) < 0.0
        })
    }

    /// Returns the passage of the transition from the last block to the next one.
    fn passage(&self, last: &Straight, next: &PathSegment) -> CornerPassage {
        let Some(contouring) = &last.contouring else {
            return CornerPassage::Kink;
        };
        let main = || (0..self.main.len()).filter(|axis| self.main[*axis]);
        let directions = [&last.segment, next].map(|segment| {
            move |axis: usize| (segment.ends()[axis] - segment.starts()[axis]) / segment.length
        });
        let [one, two] = &directions;
        let (mut cosine, mut sine) = (0.0, 0.0);
        for axis in main() {
            cosine += one(axis) * two(axis);
            sine += (two(axis) - one(axis)).powi(2);
        }
        if cosine == 0.0 && sine == 0.0 {
            return CornerPassage::Kink;
        }
        // Twice the sine of half the angle.
        let chord = sine.sqrt();
        let kink = 2.0 * (chord / 2.0).min(1.0).asin();
        let lengths = [last.segment.length, next.length];
        let [before, after] = lengths;
        let bow = kink * before * after / (before + after);
        let sagitta = bow / 4.0;
        let tolerance = contouring.tolerance_mm.unwrap_or(f64::INFINITY);
        let is_even = before <= EVEN * after && after <= EVEN * before;
        let beside = (0..self.main.len())
            .filter(|axis| !self.main[*axis])
            .map(|axis| (two(axis) - one(axis)).abs() * before.min(after))
            .fold(0.0, f64::max);
        let bend = if kink <= FINE_KINK && bow <= FINE.min(4.0 * tolerance) {
            Bend::Fine
        } else {
            Bend::Coarse
        };
        let joins = match contouring.joining {
            Joining::WithinTolerance => {
                let is_lost = bend == Bend::Coarse && self.is_stroke_between(next);
                let angle = contouring
                    .max_angle_deg
                    .map_or(TURNS_BACK / 2.0, f64::to_radians);
                kink <= angle && sagitta <= tolerance && !is_lost
            }
            _ => bend == Bend::Fine,
        };
        if joins && is_even && tolerance > 0.0 && beside <= 4.0 * tolerance {
            return CornerPassage::Joined {
                sagitta,
                bend,
                tolerance,
            };
        }
        let angle = contouring.max_angle_deg.map_or(TURNS_BACK, f64::to_radians);
        if kink < STRAIGHT || kink > angle.min(TURNS_BACK) {
            return CornerPassage::Kink;
        }
        // The spline is a sixth of the difference of its neighbours from the corner.
        let part = chord / 6.0;
        let reach = (tolerance / part)
            .min(contouring.distance_mm.unwrap_or(f64::INFINITY))
            .min(contouring.reach * before.min(after))
            .min(if beside > 0.0 {
                6.0 * tolerance * before.min(after) / beside
            } else {
                f64::INFINITY
            });
        if reach <= 0.0 {
            return CornerPassage::Kink;
        }
        CornerPassage::Corner(Corner {
            reach,
            departure: reach * part,
        })
    }
}

fn note(departure: &mut Departure, mm: f64, cause: &Arc<Cause>) {
    let um = mm * 1000.0;
    if um > departure.um {
        *departure = Departure {
            um,
            at: Some(Arc::clone(cause)),
        };
    }
}
