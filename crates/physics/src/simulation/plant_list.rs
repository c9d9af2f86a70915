//! The value list that fits a plant without any tuning.

use super::parameters::DriveParameters;
use frictcomp::lists::{DEFAULT_MAX_POINTS, FrictionList, TablePoint};

/// The velocity of the second point.
const SLOWEST_UM_PER_S: f64 = 200.0;

/// The velocity of the last point: 30 m/min.
const FASTEST_UM_PER_S: f64 = 500_000.0;

/// Returns the value list whose outputs are the friction of a drive at constant velocity, in drive units: standstill
/// and 19 velocities from 0.2 mm/s to 0.5 m/s, each the same factor above the one before. The other values are those
/// with which the rules give their reference figures: `position_delay` 9, `reversal_lookahead` 2, `delay_cycles` 1,
/// `scaling_factor` 1000.
pub fn plant_list(drive: &DriveParameters) -> FrictionList {
    let steps = DEFAULT_MAX_POINTS - 2;
    let factor = (FASTEST_UM_PER_S / SLOWEST_UM_PER_S).powf(1.0 / f64::from(steps));
    let moving = (0..=steps).map(|step| {
        let exponent = i32::try_from(step).expect("fewer than 20");
        (SLOWEST_UM_PER_S * factor.powi(exponent)).round()
    });
    let inputs: Vec<f64> = std::iter::once(0.0).chain(moving).collect();
    plant_list_at(drive, &inputs)
}

/// Returns the value list of a drive with points at these velocities in µm/s.
pub(crate) fn plant_list_at(drive: &DriveParameters, inputs: &[f64]) -> FrictionList {
    let table = inputs.iter().map(|&input| {
        let speed = input * 1e-6;
        TablePoint {
            input,
            output: drive.friction_n(speed) / drive.force_per_unit_n,
        }
    });
    FrictionList {
        position_delay: 9,
        reversal_lookahead: 2,
        scaling_factor: 1000,
        delay_cycles: 1,
        max_points: DEFAULT_MAX_POINTS,
        table: table.collect(),
    }
}
