//! The CNC cycle on the command line.

use clap::Args;

use super::failure::Failure;
use frictcomp_physics::motion::check_cycle;

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
    /// Returns the cycle in seconds, if it is given.
    pub(super) fn seconds(&self) -> Result<Option<f64>, Failure> {
        let milliseconds = self.cycle_time_ms.map(|cycle| cycle / 1000.0);
        let seconds = milliseconds.or(self.cycle_time);
        Ok(seconds.map(check_cycle).transpose()?)
    }
}
