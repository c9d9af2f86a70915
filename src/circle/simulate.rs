//! The drives on the circle.

use super::drive::{Drive, SPEED_LOOPS, STEPS, Setpoint};
use super::reference::{Circle, CircleError, Stretch};
use super::{CircularTest, Compensation};
use crate::current::{AdditiveCurrent, Reading};
use crate::lists::FrictionList;

/// A point of the path and the place on the stretch that was commanded there.
pub(super) struct Sample {
    /// Actual position of X in m.
    pub(super) x: f64,
    /// Actual position of Y in m.
    pub(super) y: f64,
}

/// What a simulation has to say besides its points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Remarks {
    /// Cycles of the speed loop in which a force was cut.
    pub(super) saturated: u64,
}

/// Units of 0.1 µm in a metre.
const POSITION_UNITS: f64 = 1e7;

/// µm/s in m/s.
const VELOCITY_UNITS: f64 = 1e6;

/// The additive current of one axis, with the velocities that it looks ahead to.
struct Additive {
    current: Option<AdditiveCurrent>,
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
        let position = position * POSITION_UNITS;
        current.step(position, self.velocities[k], upcoming).current
    }
}

/// Follows a stretch with both drives and hands out the position after every step, with the
/// number of its CNC cycle.
///
/// # Errors
/// A drive that leaves the circle by more than its radius.
pub(super) fn simulate(
    test: &CircularTest,
    compensation: Compensation,
    stretch: Stretch,
    mut take: impl FnMut(usize, Sample),
) -> Result<Remarks, CircleError> {
    let circle = &test.circle;
    let cycles = circle.cycles(stretch.length);
    let velocity = |axis: usize| {
        (0..=cycles)
            .map(|k| circle.at(stretch, k)[axis].1 * VELOCITY_UNITS)
            .collect()
    };
    let mut added = [0, 1].map(|axis| {
        let list = match compensation {
            Compensation::On => Some(&test.lists[axis]),
            Compensation::Off => None,
        };
        Additive::new(list, test.reading, velocity(axis))
    });
    let plants = [&test.plant.x, &test.plant.y];
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
    let slope = |to: f64, from: f64| (to - from) / circle.cycle_time;
    let mut drives = [0, 1].map(|axis| {
        let setpoint = Setpoint {
            position: from[axis].0,
            velocity: slope(to[axis].0, from[axis].0),
            added: already[axis],
            ..Setpoint::default()
        };
        Drive::settled(plants[axis], test.model, setpoint)
    });
    let mut slopes = [0, 1].map(|axis| slope(to[axis].0, from[axis].0));
    for k in begin..cycles {
        to = circle.at(stretch, k + 1);
        let cycle = [0, 1].map(|axis| {
            let velocity = slope(to[axis].0, from[axis].0);
            let setpoint = Setpoint {
                position: from[axis].0,
                velocity,
                acceleration: (velocity - slopes[axis]) / circle.cycle_time,
                added: added[axis].at(k, from[axis].0),
            };
            slopes[axis] = velocity;
            setpoint
        });
        follow(circle, cycle, &mut drives, |x, y| take(k, Sample { x, y }));
        check(circle, &drives, k)?;
        from = to;
    }
    Ok(Remarks {
        saturated: drives.iter().map(Drive::saturated).sum(),
    })
}

/// One CNC cycle: the fine interpolation goes on linearly from its first setpoint.
#[inline]
fn follow(
    circle: &Circle,
    cycle: [Setpoint; 2],
    drives: &mut [Drive; 2],
    mut take: impl FnMut(f64, f64),
) {
    let [mut x, mut y] = cycle;
    let ticks = circle.ticks();
    let part = circle.cycle_time / f64::from(ticks);
    let [first, second] = drives;
    for _ in 0..ticks {
        first.follow(x);
        second.follow(y);
        for _ in 0..SPEED_LOOPS {
            first.control();
            second.control();
            for _ in 0..STEPS {
                take(first.step(), second.step());
            }
        }
        x.position += part * x.velocity;
        y.position += part * y.velocity;
    }
}

fn check(circle: &Circle, drives: &[Drive; 2], k: usize) -> Result<(), CircleError> {
    let limit = 2.0 * circle.radius_m();
    for (drive, axis) in drives.iter().zip(["X", "Y"]) {
        // Also what is no number is outside.
        let is_inside = drive.position().abs() <= limit;
        if !is_inside {
            #[allow(clippy::cast_precision_loss)] // far below 2^52 cycles
            let time = k as f64 * circle.cycle_time;
            let angle = (time * circle.angular_velocity()).to_degrees();
            return Err(CircleError::Unstable { axis, angle });
        }
    }
    Ok(())
}
