//! Commanded traces of one axis that were recorded or constructed (chapter 4 of the rules).

use super::additive::{Added, AdditiveCurrent, Switched};
use super::columns::TraceColumns;
use super::cycles::{CyclesError, Resampling, check, cycle_of, resample};
use super::standstill::DeadBand;
use super::units::{POSITION_UNITS_PER_MM, VELOCITY_UNITS_PER_MM_PER_S};

/// Units of position that one unit of velocity covers in a second.
const POSITION_PER_VELOCITY: f64 = POSITION_UNITS_PER_MM / VELOCITY_UNITS_PER_MM_PER_S;

/// Units of velocity that cover one unit of position in a second.
const VELOCITY_PER_POSITION: f64 = VELOCITY_UNITS_PER_MM_PER_S / POSITION_UNITS_PER_MM;

/// A commanded trace of one axis.
#[derive(Debug, Clone, PartialEq)]
pub struct CommandedTrace {
    times_s: Vec<f64>,
    positions: Vec<f64>,
    velocities: Vec<f64>,
    switched: Vec<Switched>,
    remarks: Vec<String>,
}

/// One cycle of a commanded trace.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct CommandedRow {
    /// The time of the cycle.
    pub time_s: f64,
    /// Position in 0.1 µm or 0.0001°.
    pub position: f64,
    /// Velocity in µm/s or 0.001°/s.
    pub velocity: f64,
    /// State of the compensation.
    pub switched: Switched,
}

/// Options of the conversion of rows of a trace to CNC cycles.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct TraceOptions {
    /// The CNC cycle; by default the usual step of the times, otherwise 1 ms.
    pub cycle_s: Option<f64>,
    /// Treatment of times that are not those of cycles.
    pub resampling: Resampling,
    /// Velocities that count as standstill.
    pub dead_band: DeadBand,
}

impl TraceOptions {
    /// Sets [`cycle_s`](Self::cycle_s).
    pub fn with_cycle_s(mut self, cycle_s: Option<f64>) -> Self {
        self.cycle_s = cycle_s;
        self
    }

    /// Sets [`resampling`](Self::resampling).
    pub fn with_resampling(mut self, resampling: Resampling) -> Self {
        self.resampling = resampling;
        self
    }

    /// Sets [`dead_band`](Self::dead_band).
    pub fn with_dead_band(mut self, dead_band: DeadBand) -> Self {
        self.dead_band = dead_band;
        self
    }
}

impl CommandedTrace {
    /// Creates a trace; missing columns are computed from the others.
    ///
    /// # Errors
    /// A row that is not a cycle after the one above it, unless the rows are resampled.
    pub fn new(columns: TraceColumns, options: TraceOptions) -> Result<Self, CyclesError> {
        let cycle_s = cycle_of(columns.times_s.as_deref(), options.cycle_s)?;
        let (columns, mut remarks) = match options.resampling {
            Resampling::Refused => {
                check(columns.times_s.as_deref().unwrap_or_default(), cycle_s)?;
                (columns, Vec::new())
            }
            Resampling::Done => resample(columns, cycle_s)?,
        };
        let TraceColumns {
            times_s,
            positions,
            velocities,
            switched,
        } = columns;
        #[allow(clippy::cast_precision_loss)] // rows of a file
        let times = || {
            (0..switched.len())
                .map(|row| row as f64 * cycle_s)
                .collect()
        };
        let mut velocities = velocities.unwrap_or_else(|| {
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
        let standstills = options.dead_band.settle(&mut velocities, &positions);
        remarks.extend(standstills.told(options.dead_band));
        Ok(Self {
            times_s: times_s.unwrap_or_else(times),
            positions,
            velocities,
            switched,
            remarks,
        })
    }

    /// Adds remarks on an earlier treatment of the rows.
    pub fn after(mut self, remarks: Vec<String>) -> Self {
        self.remarks.splice(0..0, remarks);
        self
    }

    /// Returns the treatment of the rows, each step a sentence in lower case.
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// Returns the cycles in their order.
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

    /// Returns the cycles in their order, with the addition of `current` in each.
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
