//! The current of one axis over time, as plain data.

use super::{Cycle, Moment};
use crate::compensation::State;

/// The commanded motion of one axis and the current that is added, cycle by cycle.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AxisTrace {
    /// The name of the axis.
    pub axis: String,
    /// Seconds.
    pub times: Vec<f64>,
    /// In 0.1 µm or 0.0001°.
    pub positions: Vec<f64>,
    /// In µm/s or 0.001°/s.
    pub velocities: Vec<f64>,
    /// Weights and currents.
    pub cycles: Vec<Cycle>,
    /// The friction compensation over time, without gaps.
    pub bands: Vec<Band>,
    /// Where the blocks begin.
    pub blocks: Vec<Boundary>,
}

/// A stretch of time in one state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Its first cycle, in seconds.
    pub from: f64,
    /// Its last cycle, in seconds.
    pub to: f64,
    /// The friction compensation.
    pub friction: State,
}

/// The first cycle of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Boundary {
    /// In seconds.
    pub time: f64,
    /// The line of the block, from 1.
    pub line: u32,
}

impl AxisTrace {
    /// An empty trace of an axis.
    pub fn new(axis: impl Into<String>) -> Self {
        Self {
            axis: axis.into(),
            ..Self::default()
        }
    }

    /// Adds a cycle, at its time and from the block on a line.
    pub fn push(&mut self, (time, line): (f64, u32), moment: &Moment) {
        let friction = moment.input.friction;
        match self.bands.last_mut() {
            Some(band) if band.friction == friction => band.to = time,
            _ => self.bands.push(Band {
                from: time,
                to: time,
                friction,
            }),
        }
        if self.blocks.last().is_none_or(|block| block.line != line) {
            self.blocks.push(Boundary { time, line });
        }
        self.times.push(time);
        self.positions.push(moment.input.position);
        self.velocities.push(moment.input.velocity);
        self.cycles.push(moment.cycle);
    }
}
