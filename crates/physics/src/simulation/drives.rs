//! Drives in a CNC cycle.

use super::clock::{POSITION_LOOP_S, SPEED_LOOPS_PER_POSITION_LOOP, STEPS_PER_SPEED_LOOP};
use super::drive::{Drive, Setpoint};
use super::friction::FrictionModel;
use super::parameters::DriveParameters;
use crate::stiction::StictionParameters;

/// `N` drives that move together.
#[derive(Debug, Clone)]
pub struct Drives<const N: usize> {
    axes: [Drive; N],
    /// Cycles of the position loop in a CNC cycle.
    ticks: u32,
    /// Seconds of the fine interpolation from tick to tick.
    tick_s: f64,
}

impl<const N: usize> Drives<N> {
    /// Drives that have followed their setpoints for a long time, under a control with CNC cycles of
    /// `cycle_s` seconds: a whole multiple of [`POSITION_LOOP_S`].
    pub fn settled(
        parameters: [&DriveParameters; N],
        model: FrictionModel,
        setpoints: [Setpoint; N],
        cycle_s: f64,
    ) -> Self {
        let ticks = ticks(cycle_s);
        let settle = |axis| Drive::settled(parameters[axis], model, setpoints[axis]);
        Self {
            axes: std::array::from_fn(settle),
            ticks,
            tick_s: cycle_s / f64::from(ticks),
        }
    }

    /// Adds stiction compensation to the drives that have it.
    #[must_use]
    pub fn with_stiction(mut self, parameters: [Option<&StictionParameters>; N]) -> Self {
        for (drive, parameters) in self.axes.iter_mut().zip(parameters) {
            if let Some(parameters) = parameters {
                *drive = drive.clone().with_stiction(parameters);
            }
        }
        self
    }

    /// Follows one CNC cycle from its setpoints on, which the fine interpolation continues linearly. `take` gets the
    /// positions of the loads in m after every simulation step.
    #[inline]
    pub fn follow(&mut self, mut setpoints: [Setpoint; N], mut take: impl FnMut([f64; N])) {
        let part = self.tick_s;
        for _ in 0..self.ticks {
            for (drive, setpoint) in self.axes.iter_mut().zip(setpoints) {
                drive.follow(setpoint);
            }
            for _ in 0..SPEED_LOOPS_PER_POSITION_LOOP {
                self.axes.iter_mut().for_each(Drive::control);
                for _ in 0..STEPS_PER_SPEED_LOOP {
                    take(self.axes.each_mut().map(Drive::step));
                }
            }
            for setpoint in &mut setpoints {
                setpoint.position_m += part * setpoint.velocity_m_per_s;
            }
        }
    }

    /// Returns the drives, in their order.
    pub fn drives(&self) -> &[Drive; N] {
        &self.axes
    }

    /// Returns the number of cycles of the speed loop in which a force was limited, of all drives together.
    pub fn saturated_cycles(&self) -> u64 {
        self.axes.iter().map(Drive::saturated_cycles).sum()
    }
}

/// Cycles of the position loop in a CNC cycle in seconds, at least one.
fn ticks(cycle_s: f64) -> u32 {
    let ticks = (cycle_s / POSITION_LOOP_S).round();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
    let ticks = ticks as u32;
    ticks.max(1)
}
