//! The value list that fits a plant without any tuning.

use super::drive::DriveParameters;
use crate::lists::{DEFAULT_MAX_POINTS, FrictionList, TablePoint};

/// The velocity of the second point, in µm/s.
const SLOWEST: f64 = 200.0;

/// The velocity of the last point, in µm/s: 30 m/min.
const FASTEST: f64 = 500_000.0;

/// The value list whose outputs are the friction of a drive at constant velocity, in drive units:
/// standstill and 19 velocities from 0.2 mm/s to 0.5 m/s, each the same factor above the one
/// before. The other values are those with which the rules give their reference figures:
/// `position_delay` 9, `reversal_lookahead` 2, `delay_cycles` 1, `scaling_factor` 1000.
pub fn plant_list(drive: &DriveParameters) -> FrictionList {
    let steps = DEFAULT_MAX_POINTS - 2;
    let factor = (FASTEST / SLOWEST).powf(1.0 / f64::from(steps));
    let moving = (0..=steps).map(|step| {
        let exponent = i32::try_from(step).expect("fewer than 20");
        (SLOWEST * factor.powi(exponent)).round()
    });
    let table = std::iter::once(0.0).chain(moving).map(|input| {
        let speed = input * 1e-6;
        let friction = &drive.friction;
        let force = friction.level(speed) + friction.viscous * speed;
        TablePoint {
            input,
            output: force / drive.force_per_unit,
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
