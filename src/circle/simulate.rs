//! The drives on the circle.

use super::reference::{Circle, CircleError, Stretch};
use super::test::CircularTest;
use crate::current::{
    AdditiveCurrent, POSITION_UNITS_PER_MM, Reading, Switched, VELOCITY_UNITS_PER_MM_PER_S,
};
use crate::lists::FrictionList;
use crate::simulation::{Drive, DrivePair, Setpoint};

/// What a simulation has to say besides its points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Remarks {
    /// Cycles of the speed loop in which a force was limited.
    pub(super) saturated_cycles: u64,
}

/// Millimetres in a metre.
const MM_PER_M: f64 = 1000.0;

/// The additive current of one axis, with the velocities that it looks ahead to.
struct Additive {
    current: Option<AdditiveCurrent>,
    /// In units of the list.
    velocities: Vec<f64>,
}

impl Additive {
    fn new(list: Option<&FrictionList>, reading: Reading, velocities: Vec<f64>) -> Self {
        let current = list.map(|list| AdditiveCurrent::new(list, reading));
        Self {
            current,
            velocities,
        }
    }

    /// The current of CNC cycle `k` in drive units, at a position in m.
    fn at(&mut self, k: usize, position: f64) -> f64 {
        let Some(current) = &mut self.current else {
            return 0.0;
        };
        let end = self.velocities.len().min(k + 1 + current.lookahead());
        let upcoming = self.velocities.get(k + 1..end).unwrap_or_default();
        let position = position * (MM_PER_M * POSITION_UNITS_PER_MM);
        current
            .step(position, self.velocities[k], upcoming)
            .current_units
    }
}

/// Follows a stretch with both drives and hands out the number of the CNC cycle and the actual
/// positions of X and Y in m after every simulation step.
///
/// # Errors
/// A drive that leaves the circle by more than its radius.
pub(super) fn simulate(
    test: &CircularTest,
    compensation: Switched,
    stretch: Stretch,
    mut take: impl FnMut(usize, f64, f64),
) -> Result<Remarks, CircleError> {
    let circle = &test.circle;
    let cycles = circle.cycles(stretch.length);
    let velocity = |axis: usize| {
        (0..=cycles)
            .map(|k| circle.at(stretch, k)[axis].1 * (MM_PER_M * VELOCITY_UNITS_PER_MM_PER_S))
            .collect()
    };
    let mut added = [0, 1].map(|axis| {
        let list = match compensation {
            Switched::On => Some(&test.lists[axis]),
            Switched::Off => None,
        };
        Additive::new(list, test.reading, velocity(axis))
    });
    // Before the drives begin the additive current has already seen the motion of the lead.
    let mut already = [0.0; 2];
    for k in 0..stretch.lead {
        for (axis, added) in added.iter_mut().enumerate() {
            already[axis] = added.at(k, circle.at(stretch, k)[axis].0);
        }
    }
    let begin = stretch.lead;
    let mut from = circle.at(stretch, begin);
    let mut to = circle.at(stretch, begin + 1);
    let slope = |to: f64, from: f64| (to - from) / circle.cycle_time_s;
    let mut slopes = [0, 1].map(|axis| slope(to[axis].0, from[axis].0));
    let settled = [0, 1].map(|axis| Setpoint {
        position_m: from[axis].0,
        velocity_m_per_s: slopes[axis],
        added_units: already[axis],
        ..Setpoint::default()
    });
    let mut drives = DrivePair::settled(&test.plant, test.model, settled, circle.cycle_time_s);
    for k in begin..cycles {
        to = circle.at(stretch, k + 1);
        let cycle = [0, 1].map(|axis| {
            let velocity = slope(to[axis].0, from[axis].0);
            let setpoint = Setpoint {
                position_m: from[axis].0,
                velocity_m_per_s: velocity,
                acceleration_m_per_s2: (velocity - slopes[axis]) / circle.cycle_time_s,
                added_units: added[axis].at(k, from[axis].0),
            };
            slopes[axis] = velocity;
            setpoint
        });
        drives.follow(cycle, |x, y| take(k, x, y));
        check(circle, drives.drives(), k)?;
        from = to;
    }
    Ok(Remarks {
        saturated_cycles: drives.saturated_cycles(),
    })
}

fn check(circle: &Circle, drives: &[Drive; 2], k: usize) -> Result<(), CircleError> {
    let limit = 2.0 * circle.radius_m();
    for (drive, axis) in drives.iter().zip(["X", "Y"]) {
        // What is not a number is outside, too.
        let is_inside = drive.position_m().abs() <= limit;
        if !is_inside {
            #[allow(clippy::cast_precision_loss)] // far below 2^52 cycles
            let time = k as f64 * circle.cycle_time_s;
            let angle_deg = (time * circle.angular_velocity()).to_degrees();
            return Err(CircleError::Unstable { axis, angle_deg });
        }
    }
    Ok(())
}
