//! Reversals of axes, each with the glitch that it leaves (R11.2).

use std::sync::Arc;

use super::path::Distance;
use super::per_run::PerRun;
use crate::comp::State;
use crate::motion::{Cause, Movement};

const UM_PER_MM: f64 = 1000.0;

/// So long a glitch is looked for, in s.
const WINDOW_S: f64 = 0.2;

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
    /// The block number, where it is known.
    pub number: Option<i64>,
    /// The executed block.
    pub seq: u64,
    /// The time of the trace in s.
    pub time_s: f64,
    /// Where each driven axis is commanded to be, in mm.
    pub positions: Vec<f64>,
    /// The path velocity in mm/min.
    pub feed_mm_per_min: f64,
    /// The path velocity that the program asks for in mm/min; `None` in a rapid move.
    pub programmed_mm_per_min: Option<f64>,
    /// The acceleration of the axis in mm/s².
    pub acceleration_mm_per_s2: f64,
    /// Rapid or feed.
    pub movement: Movement,
    /// The friction compensation of the axis, as the program has it.
    pub state: State,
    /// The additive current in drive units before the reversal, and at the end of its window.
    pub current_units: [f64; 2],
    /// The largest change of the normal deviation in µm, as far as the path goes without a corner.
    pub glitch_um: PerRun<f64>,
}

impl ContourReversal {
    /// What compensation would gain at it, in µm.
    pub fn gain_um(&self) -> f64 {
        self.glitch_um.programmed - self.glitch_um.all_on
    }
}

/// What is measured in a cycle.
pub(super) struct Measured<'a> {
    pub(super) time_s: f64,
    pub(super) cause: &'a Arc<Cause>,
    /// Where the driven axes are commanded to be, in mm.
    pub(super) positions: &'a [f64],
    /// How fast, in mm/s.
    pub(super) velocities: &'a [f64],
    pub(super) path_velocity: f64,
    pub(super) programmed_velocity: f64,
    /// The additive currents of the programmed run.
    pub(super) added: &'a [f64],
    pub(super) distances: &'a [Distance; 3],
    /// The number of the point of the path from which each run is that far.
    pub(super) near: [u64; 3],
    /// The number of the last corner that was commanded.
    pub(super) corner: u64,
}

/// A reversal whose window has not ended.
struct Open {
    reversal: ContourReversal,
    axis: usize,
    /// The number of the corner that the path comes from.
    corner: u64,
    /// The deviation of each run at the reversal. After a corner it is the first one that is measured
    /// from the way out of it: the way in has another normal.
    from: [Option<f64>; 3],
}

impl Open {
    /// Follows the deviation of each run.
    fn follow(&mut self, measured: &Measured<'_>) {
        let runs = measured.distances.iter().zip(measured.near);
        let glitches = self.reversal.glitch_um.each_mut().into_iter();
        for (((distance, near), from), glitch) in runs.zip(&mut self.from).zip(glitches) {
            let deviation = value(distance, self.axis);
            if from.is_none() && near >= self.corner {
                *from = Some(deviation);
            }
            if let Some(from) = from {
                *glitch = glitch.max((deviation - *from).abs() * UM_PER_MM);
            }
        }
        self.reversal.current_units[1] = measured.added[self.axis];
    }

    /// Whether its window is over: a corner has another normal, and a rapid motion does not cut.
    fn is_over(&self, measured: &Measured<'_>) -> bool {
        let age = measured.time_s - self.reversal.time_s;
        let is_cut = self.reversal.movement != Movement::Rapid;
        age >= WINDOW_S
            || measured.corner > self.corner
            || (is_cut && measured.cause.movement == Movement::Rapid)
    }
}

/// Finds reversals and follows each to the end of its window.
pub(super) struct Reversals {
    names: Vec<String>,
    cycle_s: f64,
    /// The direction in which each axis moved last.
    directions: Vec<f64>,
    velocities: Vec<f64>,
    added: Vec<f64>,
    /// How far each run was from the path in the cycle before; `None` where the trace begins.
    distances: Option<[Distance; 3]>,
    /// From which points of the path.
    near: [u64; 3],
    open: Vec<Open>,
}

impl Reversals {
    pub(super) fn new(names: Vec<String>, cycle_s: f64) -> Self {
        let count = names.len();
        Self {
            names,
            cycle_s,
            directions: vec![0.0; count],
            velocities: vec![0.0; count],
            added: vec![0.0; count],
            distances: None,
            near: [0; 3],
            open: Vec::new(),
        }
    }

    /// The trace begins anew: no axis has a direction.
    pub(super) fn restart(&mut self, mut take: impl FnMut(ContourReversal)) {
        self.open.drain(..).for_each(|open| take(open.reversal));
        self.directions.fill(0.0);
        self.velocities.fill(0.0);
        self.added.fill(0.0);
        self.distances = None;
    }

    /// Takes a cycle, and gives out the reversals whose windows end.
    pub(super) fn push(&mut self, measured: &Measured<'_>, mut take: impl FnMut(ContourReversal)) {
        let reverses = |axis: &usize| self.directions[*axis] * measured.velocities[*axis] < 0.0;
        let turned: Vec<usize> = (0..self.names.len()).filter(reverses).collect();
        let open = std::mem::take(&mut self.open);
        for mut open in open {
            if turned.is_empty() && !open.is_over(measured) {
                open.follow(measured);
                self.open.push(open);
            } else {
                take(open.reversal);
            }
        }
        for axis in turned {
            let mut open = Open {
                reversal: self.reversal(axis, measured),
                axis,
                corner: measured.corner,
                from: self.at_reversal(axis, measured),
            };
            open.follow(measured);
            self.open.push(open);
        }
        for (direction, velocity) in self.directions.iter_mut().zip(measured.velocities) {
            if *velocity != 0.0 {
                *direction = velocity.signum();
            }
        }
        self.velocities.copy_from_slice(measured.velocities);
        self.added.copy_from_slice(measured.added);
        self.distances = Some(*measured.distances);
        self.near = measured.near;
    }

    /// The deviation of each run when an axis reverses: at the end of the cycle before, which must
    /// have been measured from the same way.
    fn at_reversal(&self, axis: usize, measured: &Measured<'_>) -> [Option<f64>; 3] {
        std::array::from_fn(|run| {
            let before = self.distances.filter(|_| self.near[run] >= measured.corner);
            before.map(|before| value(&before[run], axis))
        })
    }

    fn reversal(&self, axis: usize, measured: &Measured<'_>) -> ContourReversal {
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
        }
    }
}

/// The normal deviation that an axis of the plane, or a further one, disturbs.
fn value(distance: &Distance, axis: usize) -> f64 {
    if axis < 2 {
        distance.plane
    } else {
        distance.error[axis]
    }
}
