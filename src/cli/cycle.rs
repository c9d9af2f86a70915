//! The CNC cycle on the command line.

use clap::Args;

use super::failure::Failure;
use crate::diagnostic::Shown;

/// The shortest and the longest CNC cycle in ms.
const SHORTEST: f64 = 0.001;
const LONGEST: f64 = 1000.0;

/// The CNC cycle.
#[derive(Debug, Clone, Default, Args)]
pub(super) struct CycleArgs {
    /// The CNC cycle in ms, as in `frictcomp.toml`; by default that of the machine, else 1
    #[arg(long, value_name = "MS", allow_negative_numbers = true)]
    cycle_time_ms: Option<f64>,
    /// The same in seconds
    #[arg(
        long,
        value_name = "SECONDS",
        hide = true,
        allow_negative_numbers = true
    )]
    #[arg(conflicts_with = "cycle_time_ms")]
    cycle_time: Option<f64>,
}

impl CycleArgs {
    /// The cycle in seconds, where it is given.
    pub(super) fn seconds(&self) -> Result<Option<f64>, Failure> {
        let milliseconds = self.cycle_time_ms.map(|cycle| cycle / 1000.0);
        milliseconds.or(self.cycle_time).map(checked).transpose()
    }
}

/// A cycle in seconds that can be one.
pub(super) fn checked(seconds: f64) -> Result<f64, Failure> {
    let milliseconds = seconds * 1000.0;
    if (SHORTEST..=LONGEST).contains(&milliseconds) {
        return Ok(seconds);
    }
    Err(Failure::new(format!(
        "a CNC cycle of {} ms is not possible, it must be between {SHORTEST} and {LONGEST} ms",
        Shown(milliseconds)
    ))
    .with_help("write the milliseconds of a cycle, `--cycle-time-ms 1`"))
}
