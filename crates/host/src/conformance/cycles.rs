//! Expected currents, CNC cycle by CNC cycle (chapter 4).

use std::fmt::{self, Write as _};

use frictcomp_physics::current::{Added, AdditiveCurrent, Switched};

/// Expected currents for a commanded motion that is given as numbers.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ExpectedCycles {
    /// Name of the axis.
    pub axis: String,
    /// Commanded positions in 0.1 µm or 0.0001°, one per CNC cycle.
    pub positions: Vec<f64>,
    /// Commanded velocities in µm/s or 0.001°/s.
    pub velocities: Vec<f64>,
    /// State of the compensation in each cycle.
    pub switched: Vec<Switched>,
    /// The currents in drive units.
    pub currents: Vec<f64>,
    /// The whole numbers sent to the drive, where a case gives them.
    pub outputs: Option<Vec<i16>>,
}

/// Cycles as written in a case.
pub(super) struct WrittenCycles {
    pub(super) positions: Vec<f64>,
    pub(super) velocities: Vec<f64>,
    pub(super) comp: Option<Vec<bool>>,
    pub(super) currents: Vec<f64>,
    pub(super) outputs: Option<Vec<i16>>,
}

/// Returns whether a current is the expected one.
pub(super) fn is_near(found: f64, expected: f64, tolerance: f64) -> bool {
    (found - expected).abs() <= tolerance * expected.abs().max(1.0)
}

impl ExpectedCycles {
    pub(super) fn new(axis: String, written: WrittenCycles) -> Result<Self, String> {
        let count = written.positions.len();
        let comp = written.comp.unwrap_or_else(|| vec![true; count]);
        let outputs = written.outputs.as_ref().map_or(count, Vec::len);
        let counts = [
            written.velocities.len(),
            comp.len(),
            written.currents.len(),
            outputs,
        ];
        if count == 0 || counts.iter().any(|it| *it != count) {
            return Err(format!(
                "`positions`, `velocities`, `comp`, `currents` and `outputs` have one number per cycle; \
                 `positions` has {count}"
            ));
        }
        let switched = comp
            .into_iter()
            .map(|is_on| if is_on { Switched::On } else { Switched::Off });
        Ok(Self {
            axis,
            positions: written.positions,
            velocities: written.velocities,
            switched: switched.collect(),
            currents: written.currents,
            outputs: written.outputs,
        })
    }

    /// Returns the currents of these cycles.
    pub(super) fn run(&self, current: &mut AdditiveCurrent) -> Vec<Added> {
        let rows = self
            .positions
            .iter()
            .zip(&self.velocities)
            .zip(&self.switched);
        let added = rows
            .enumerate()
            .map(|(at, ((position, velocity), switched))| {
                current.switch(*switched);
                current.step(*position, *velocity, &self.velocities[at + 1..])
            });
        added.collect()
    }

    /// Returns the first of these currents and outputs that differs from the expected one.
    pub(super) fn differs(&self, added: &[Added]) -> Option<String> {
        let currents: Vec<f64> = added.iter().map(|it| it.current_units).collect();
        self.differs_in(&currents, 1e-9).or_else(|| {
            let outputs = self.outputs.iter().flatten();
            let mut pairs = outputs.zip(added).enumerate();
            let (at, (_, found)) = pairs.find(|(_, (output, it))| it.output != **output)?;
            Some(format!("output {} in cycle {at}", found.output))
        })
    }

    /// Returns the first of some currents that differs from the expected one.
    pub(super) fn differs_in(&self, currents: &[f64], tolerance: f64) -> Option<String> {
        let expected = self.currents.len();
        if currents.len() != expected {
            return Some(format!("{} currents, not {expected}", currents.len()));
        }
        let mut pairs = currents.iter().zip(&self.currents).enumerate();
        let (at, (found, _)) = pairs.find(|(_, (found, it))| !is_near(**found, **it, tolerance))?;
        Some(format!("{found} drive units in cycle {at}"))
    }

    /// Returns the commanded motion as a table that `frictcomp current --recording` reads.
    pub(super) fn table(&self) -> String {
        let mut text = "x,v,comp\n".to_owned();
        for ((position, velocity), switched) in self
            .positions
            .iter()
            .zip(&self.velocities)
            .zip(&self.switched)
        {
            let comp = if *switched == Switched::On {
                "on"
            } else {
                "off"
            };
            let _ = writeln!(text, "{position},{velocity},{comp}");
        }
        text
    }
}

impl fmt::Display for ExpectedCycles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let currents: Vec<String> = self.currents.iter().map(f64::to_string).collect();
        write!(
            f,
            "{} {} drive units, cycle by cycle",
            self.axis,
            currents.join(" ")
        )
    }
}
