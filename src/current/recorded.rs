//! Commanded traces of one axis that were recorded or made up (chapter 4 of the rules).

use super::additive::{Added, AdditiveCurrent, Switched};
use super::units::{POSITION_UNITS_PER_MM, VELOCITY_UNITS_PER_MM_PER_S};
use crate::motion::{CycleError, check_cycle};

/// Units of position that one unit of velocity covers in a second.
const POSITION_PER_VELOCITY: f64 = POSITION_UNITS_PER_MM / VELOCITY_UNITS_PER_MM_PER_S;

/// Units of velocity that cover one unit of position in a second.
const VELOCITY_PER_POSITION: f64 = VELOCITY_UNITS_PER_MM_PER_S / POSITION_UNITS_PER_MM;

/// The cycle of a trace that says nothing about time.
const DEFAULT_CYCLE_S: f64 = 0.001;

/// The columns of a recorded trace, a CNC cycle a row. Positions or velocities must be there.
#[derive(Debug, Clone, Default)]
pub struct TraceColumns {
    /// The time of each cycle.
    pub times_s: Option<Vec<f64>>,
    /// In 0.1 µm or 0.0001°.
    pub positions: Option<Vec<f64>>,
    /// In µm/s or 0.001°/s.
    pub velocities: Option<Vec<f64>>,
    /// Whether the compensation is on, for every cycle.
    pub switched: Vec<Switched>,
}

/// A commanded trace of one axis.
#[derive(Debug, Clone)]
pub struct CommandedTrace {
    times_s: Vec<f64>,
    positions: Vec<f64>,
    velocities: Vec<f64>,
    switched: Vec<Switched>,
}

/// One cycle of a commanded trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommandedRow {
    /// The time of the cycle.
    pub time_s: f64,
    /// In 0.1 µm or 0.0001°.
    pub position: f64,
    /// In µm/s or 0.001°/s.
    pub velocity: f64,
    /// Whether the compensation is on.
    pub switched: Switched,
}

impl CommandedTrace {
    /// A trace with the columns that are missing computed from the others. Without a cycle time, the
    /// first two times give it.
    ///
    /// # Errors
    /// A cycle that no control has.
    pub fn new(columns: TraceColumns, cycle_s: Option<f64>) -> Result<Self, CycleError> {
        let TraceColumns {
            times_s,
            positions,
            velocities,
            switched,
        } = columns;
        let cycle_s = check_cycle(cycle_s.unwrap_or_else(|| match times_s.as_deref() {
            Some([first, second, ..]) if second > first => second - first,
            _ => DEFAULT_CYCLE_S,
        }))?;
        #[allow(clippy::cast_precision_loss)] // rows of a file
        let times = || {
            (0..switched.len())
                .map(|row| row as f64 * cycle_s)
                .collect()
        };
        let velocities = velocities.unwrap_or_else(|| {
            let steps = positions.as_deref().unwrap_or_default();
            let steps = steps.windows(2).map(|pair| pair[1] - pair[0]);
            let moving = steps.map(|step| VELOCITY_PER_POSITION * step / cycle_s);
            std::iter::once(0.0)
                .chain(moving)
                .take(switched.len())
                .collect()
        });
        let positions = positions.unwrap_or_else(|| {
            let steps = velocities.iter().scan(0.0, |position, velocity| {
                *position += velocity * cycle_s * POSITION_PER_VELOCITY;
                Some(*position)
            });
            steps.collect()
        });
        Ok(Self {
            times_s: times_s.unwrap_or_else(times),
            positions,
            velocities,
            switched,
        })
    }

    /// The cycles in their order.
    pub fn rows(&self) -> impl Iterator<Item = CommandedRow> {
        let numbers = self.times_s.iter().zip(&self.positions);
        let numbers = numbers.zip(&self.velocities).zip(&self.switched);
        numbers.map(
            |(((&time_s, &position), &velocity), &switched)| CommandedRow {
                time_s,
                position,
                velocity,
                switched,
            },
        )
    }

    /// The cycles in their order, with what `current` adds in each.
    pub fn currents(
        &self,
        current: &mut AdditiveCurrent,
    ) -> impl Iterator<Item = (CommandedRow, Added)> {
        let lookahead = current.lookahead();
        self.rows().enumerate().map(move |(at, row)| {
            current.switch(row.switched);
            let end = self.velocities.len().min(at + 1 + lookahead);
            let ahead = &self.velocities[at + 1..end];
            (row, current.step(row.position, row.velocity, ahead))
        })
    }
}
