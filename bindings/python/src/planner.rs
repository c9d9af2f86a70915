//! The cycles of a path.

use frictcomp_host::LoadedMachine;
use frictcomp_physics::motion::{PlannerOptions, check_cycle};

use crate::failure::Failure;

/// Cycles with the given time, otherwise that of the machine.
pub(crate) fn planner(
    cycle_s: Option<f64>,
    max_cycles: u64,
    loaded: &LoadedMachine,
) -> Result<PlannerOptions, Failure> {
    let of_machine = loaded.machine.cycle_time_ms.map(|ms| ms / 1000.0);
    let cycle = cycle_s.or(of_machine);
    let mut planner = PlannerOptions::default();
    let cycle_s = check_cycle(cycle.unwrap_or(planner.cycle_s));
    planner.cycle_s = cycle_s.map_err(|error| Failure::new(error.to_string()))?;
    planner.max_cycles = max_cycles;
    Ok(planner)
}
