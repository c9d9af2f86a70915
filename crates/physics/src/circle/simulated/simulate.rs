//! The drives on the circle.

use super::method::Method;
use crate::circle::geometry::PlaneAxis;
use crate::circle::geometry::{Circle, CircleArc, CircleError};
use crate::current::{
    AdditiveCurrent, POSITION_UNITS_PER_MM, Reading, VELOCITY_UNITS_PER_MM_PER_S,
};
use crate::simulation::{Drive, DriveParameters, Drives, FrictionModel, Setpoint};
use crate::stiction::StictionParameters;
use frictcomp::lists::FrictionList;

/// Remarks of a simulation, in addition to its points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct SimulationRemarks {
    /// Cycles of the speed loop in which a force was limited.
    pub(crate) saturated_cycles: u64,
}

/// Millimetres in a metre.
const MM_PER_M: f64 = 1000.0;

/// One axis of a simulation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AxisRun<'a> {
    pub(crate) axis: PlaneAxis,
    pub(crate) drive: &'a DriveParameters,
    /// Compensation of friction, if it is on.
    pub(crate) compensation: Option<&'a Method>,
}

/// Simulation of `N` axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AxesSimulation<'a, const N: usize> {
    pub(crate) circle: Circle,
    pub(crate) model: FrictionModel,
    pub(crate) reading: Reading,
    pub(crate) axes: [AxisRun<'a>; N],
}

/// The additive current of one axis, with the velocities that it looks ahead to.
struct Additive {
    current: Option<AdditiveCurrent>,
    /// Velocities in units of the list.
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

    /// Returns the current of CNC cycle `k` in drive units, at a position in m.
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

impl<'a> AxisRun<'a> {
    /// Returns the stiction compensation, if it acts at the feed of a circle (R8.2).
    fn stiction_at(&self, circle: &Circle) -> Option<&'a StictionParameters> {
        self.compensation?
            .stiction()
            .filter(|it| it.acts_at(circle.feed_mm_per_min / MM_PER_M))
    }
}

impl<const N: usize> AxesSimulation<'_, N> {
    /// Follows a stretch with the drives and passes on the number of the CNC cycle and the actual
    /// positions in m after every simulation step.
    ///
    /// # Errors
    /// A drive that leaves the circle by more than its radius.
    pub(crate) fn simulate(
        &self,
        stretch: CircleArc,
        mut take: impl FnMut(usize, [f64; N]),
    ) -> Result<SimulationRemarks, CircleError> {
        let circle = &self.circle;
        let cycles = circle.cycles(stretch.length);
        let at = |k: usize| {
            let places = circle.at(stretch, k);
            self.axes.map(|run| match run.axis {
                PlaneAxis::X => places[0],
                PlaneAxis::Y => places[1],
            })
        };
        let velocity = |axis: usize| {
            (0..=cycles)
                .map(|k| at(k)[axis].1 * (MM_PER_M * VELOCITY_UNITS_PER_MM_PER_S))
                .collect()
        };
        let mut added: [Additive; N] = std::array::from_fn(|axis| {
            let list = self.axes[axis].compensation.and_then(Method::list);
            Additive::new(list, self.reading, velocity(axis))
        });
        // Before the drives begin the additive current has already seen the motion of the lead.
        let mut already = [0.0; N];
        for k in 0..stretch.lead {
            let places = at(k);
            for (axis, added) in added.iter_mut().enumerate() {
                already[axis] = added.at(k, places[axis].0);
            }
        }
        let begin = stretch.lead;
        let mut from = at(begin);
        let mut to = at(begin + 1);
        let slope = |to: f64, from: f64| (to - from) / circle.cycle_time_s;
        let mut slopes: [f64; N] = std::array::from_fn(|axis| slope(to[axis].0, from[axis].0));
        let settled = std::array::from_fn(|axis| Setpoint {
            position_m: from[axis].0,
            velocity_m_per_s: slopes[axis],
            added_units: already[axis],
            ..Setpoint::default()
        });
        let parameters = self.axes.map(|run| run.drive);
        let mut drives = Drives::settled(parameters, self.model, settled, circle.cycle_time_s)
            .with_stiction(self.axes.map(|run| run.stiction_at(circle)));
        for k in begin..cycles {
            to = at(k + 1);
            let cycle = std::array::from_fn(|axis| {
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
            drives.follow(cycle, |places| take(k, places));
            self.check(drives.drives(), k)?;
            from = to;
        }
        Ok(SimulationRemarks {
            saturated_cycles: drives.saturated_cycles(),
        })
    }

    fn check(&self, drives: &[Drive; N], k: usize) -> Result<(), CircleError> {
        let limit = 2.0 * self.circle.radius_m();
        for (drive, run) in drives.iter().zip(self.axes) {
            // A value that is not a number is outside, too.
            let is_inside = drive.position_m().abs() <= limit;
            if !is_inside {
                #[allow(clippy::cast_precision_loss)] // far below 2^52 cycles
                let time = k as f64 * self.circle.cycle_time_s;
                let angle_deg = (time * self.circle.angular_velocity()).to_degrees();
                return Err(CircleError::Unstable {
                    axis: run.axis.as_str(),
                    angle_deg,
                });
            }
        }
        Ok(())
    }
}
