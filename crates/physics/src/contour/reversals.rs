//! Reversals of axes, each with the glitch that it leaves (R11.2, R11.26), and the places where
//! compensation is switched during the motion of an axis (R1.57).

use std::sync::Arc;

use super::glitch::{Course, ReversalWindow};
use super::measured::MeasuredCycle;
use super::path::Places;
use super::per_run::PerRun;
use crate::motion::Movement;
use frictcomp::comp::State;

/// Greatest share of the motion of an axis that reverses: beyond it the path itself turns back.
const ALONG: f64 = 0.99;

/// Basis of the glitch at a reversal (R11.26).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum GlitchFigure {
    /// No glitch: a stop, a corner or the next reversal of the axis is too close.
    Missing,
    /// No glitch, 0: the axis moves along the path, and nothing of it is normal to the path.
    AlongPath,
    /// The deviation before and after the reversal.
    Measured,
}

/// A reversal of an axis.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ContourReversal {
    /// Name of the axis.
    pub axis: String,
    /// Path of the file, as it is shown.
    pub file: Arc<str>,
    /// The line of the block, from 1.
    pub line: u32,
    /// The block number, if it is known.
    pub number: Option<i64>,
    /// The executed block.
    pub seq: u64,
    /// The time of the trace in s.
    pub time_s: f64,
    /// Commanded position of each driven axis, in mm.
    pub positions: Vec<f64>,
    /// The path velocity in mm/min.
    pub feed_mm_per_min: f64,
    /// The programmed path velocity in mm/min; `None` in a rapid move.
    pub programmed_mm_per_min: Option<f64>,
    /// The acceleration of the axis in mm/s².
    pub acceleration_mm_per_s2: f64,
    /// Rapid or feed.
    pub movement: Movement,
    /// The friction compensation of the axis in the program.
    pub state: State,
    /// The additive current in drive units before the reversal, and at the end of its window.
    pub current_units: [f64; 2],
    /// Distance of the deviation in the direction of the axis, normal to the path, from the
    /// straight line through both sides of the reversal, peak to peak in µm; 0 if it has no
    /// figure.
    pub glitch_um: PerRun<f64>,
    /// Basis of the glitch.
    pub figure: GlitchFigure,
}

impl ContourReversal {
    /// Returns the gain from compensation there, in µm.
    pub fn gain_um(&self) -> f64 {
        self.glitch_um.programmed - self.glitch_um.all_on
    }

    /// Returns whether the glitch is known.
    pub fn has_figure(&self) -> bool {
        self.figure != GlitchFigure::Missing
    }
}

/// Event in a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum WindowEvent {
    /// Reversal of an axis.
    Reversal,
    /// Switch of the compensation of an axis during its motion.
    Switch,
}

/// A reversal whose window has not ended.
struct Open {
    event: WindowEvent,
    reversal: ContourReversal,
    axis: usize,
    /// `None` if the path turns back: nothing of the axis is normal to it.
    window: Option<ReversalWindow>,
}

impl Open {
    fn finish(mut self) -> (WindowEvent, ContourReversal) {
        if let Some(window) = self.window {
            let (figure, glitch_um) = match window.figure() {
                Some(glitch_um) => (GlitchFigure::Measured, glitch_um),
                None => (GlitchFigure::Missing, [0.0; 3]),
            };
            self.reversal.figure = figure;
            self.reversal.glitch_um = PerRun::from_each(glitch_um);
        }
        (self.event, self.reversal)
    }
}

/// Finds reversals and follows each to the end of its window.
pub(super) struct ReversalFinder {
    names: Vec<String>,
    cycle_s: f64,
    /// The last direction of each axis.
    directions: Vec<f64>,
    velocities: Vec<f64>,
    added: Vec<f64>,
    friction: Option<Arc<[State]>>,
    course: Course,
    open: Vec<Open>,
}

impl ReversalFinder {
    pub(super) fn new(names: Vec<String>, cycle_s: f64) -> Self {
        let count = names.len();
        Self {
            names,
            cycle_s,
            directions: vec![0.0; count],
            velocities: vec![0.0; count],
            added: vec![0.0; count],
            friction: None,
            course: Course::default(),
            open: Vec::new(),
        }
    }

    /// Restarts the trace: no axis has a direction.
    pub(super) fn restart(&mut self, mut take: impl FnMut((WindowEvent, ContourReversal))) {
        self.open.drain(..).for_each(|open| take(open.finish()));
        self.directions.fill(0.0);
        self.velocities.fill(0.0);
        self.added.fill(0.0);
        self.friction = None;
        self.course = Course::default();
    }

    /// Takes a cycle, and gives out the reversals whose windows end.
    pub(super) fn push(
        &mut self,
        measured: &MeasuredCycle<'_>,
        mut take: impl FnMut((WindowEvent, ContourReversal)),
    ) {
        let moment = self.course.push(measured);
        let reverses = |axis: usize| self.directions[axis] * measured.velocities[axis] < 0.0;
        let turned: Vec<usize> = (0..self.names.len())
            .filter(|axis| reverses(*axis))
            .collect();
        let mut at = 0;
        while at < self.open.len() {
            let open = &mut self.open[at];
            let is_over = match &mut open.window {
                Some(window) => !turned.contains(&open.axis) && window.push(&moment).is_continue(),
                None => false,
            };
            if is_over {
                open.reversal.current_units[1] = measured.added[open.axis];
                at += 1;
            } else {
                take(self.open.remove(at).finish());
            }
        }
        for axis in turned {
            self.begin(WindowEvent::Reversal, axis, measured);
        }
        for axis in self.switched(measured) {
            self.begin(WindowEvent::Switch, axis, measured);
        }
        for (direction, velocity) in self.directions.iter_mut().zip(measured.velocities) {
            if *velocity != 0.0 {
                *direction = velocity.signum();
            }
        }
        self.velocities.copy_from_slice(measured.velocities);
        self.added.copy_from_slice(measured.added);
        self.friction = Some(Arc::clone(&measured.cause.friction));
    }

    /// Returns the axes whose compensation is switched during their motion in a feed move.
    fn switched(&self, measured: &MeasuredCycle<'_>) -> Vec<usize> {
        let now = &measured.cause.friction;
        let Some(before) = self.friction.as_ref().filter(|before| before != &now) else {
            return Vec::new();
        };
        let is_feed = measured.cause.movement == Movement::Feed;
        let differs = |axis: &usize| {
            let states = [before.get(*axis), now.get(*axis)];
            let is_active = states.map(|state| state == Some(&State::Active));
            let is_known = states.iter().all(|state| *state != Some(&State::Unknown));
            is_known
                && is_active[0] != is_active[1]
                && self.velocities[*axis] * measured.velocities[*axis] > 0.0
        };
        let axes = (0..self.names.len()).filter(|_| is_feed);
        axes.filter(differs).collect()
    }

    fn begin(&mut self, event: WindowEvent, axis: usize, measured: &MeasuredCycle<'_>) {
        let along = self.course.direction();
        let share = along[axis];
        let window = (share.abs() <= ALONG).then(|| {
            let mut normal: Places = along.map(|it| -share * it);
            normal[axis] += 1.0;
            let length = (1.0 - share * share).sqrt();
            ReversalWindow::begin(&self.course, normal.map(|it| it / length))
        });
        self.open.push(Open {
            event,
            reversal: self.reversal(axis, measured),
            axis,
            window,
        });
    }

    fn reversal(&self, axis: usize, measured: &MeasuredCycle<'_>) -> ContourReversal {
        let cause = measured.cause;
        let change = measured.velocities[axis] - self.velocities[axis];
        ContourReversal {
            axis: self.names[axis].clone(),
            file: Arc::clone(&cause.file),
            line: cause.line,
            number: cause.number,
            seq: cause.seq,
            time_s: measured.time_s,
            positions: measured.positions.to_vec(),
            feed_mm_per_min: measured.path_velocity * 60.0,
            programmed_mm_per_min: (cause.movement == Movement::Feed)
                .then_some(measured.programmed_velocity * 60.0),
            acceleration_mm_per_s2: change / self.cycle_s,
            movement: cause.movement,
            state: cause.friction.get(axis).copied().unwrap_or(State::Unknown),
            current_units: [self.added[axis], measured.added[axis]],
            glitch_um: PerRun::default(),
            figure: GlitchFigure::AlongPath,
        }
    }
}
