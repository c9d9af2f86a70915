//! The CNC cycle on the command line.

use clap::Args;

use super::quantities;
use crate::output::Failure;
use frictcomp_physics::motion::check_cycle;

/// The CNC cycle.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct CycleArgs {
    /// The CNC cycle in ms; by default that of the machine, else 1
    #[arg(long, value_name = "MS", value_parser = quantities::ms, allow_negative_numbers = true)]
    cycle_time: Option<f64>,
}

impl CycleArgs {
    /// Returns the cycle in seconds, if it is given.
    pub(crate) fn seconds(&self) -> Result<Option<f64>, Failure> {
        let seconds = self.cycle_time.map(|cycle| cycle / 1000.0);
        Ok(seconds.map(check_cycle).transpose()?)
    }
}
