//! Two drives in a CNC cycle.

use super::clock::{POSITION_LOOP_S, SPEED_LOOPS_PER_POSITION_LOOP, STEPS_PER_SPEED_LOOP};
use super::drive::{Drive, Setpoint};
use super::friction::FrictionModel;
use super::plant::Plant;

/// The drives of X and Y in motion.
#[derive(Debug, Clone)]
pub struct DrivePair {
    drives: [Drive; 2],
    /// Cycles of the position loop in a CNC cycle.
    ticks: u32,
    /// Seconds of the fine interpolation from tick to tick.
    tick_s: f64,
}

impl DrivePair {
    /// Both drives of a plant, which have followed their setpoints for a long time, under a control
    /// with CNC cycles of `cycle_s` seconds: a whole multiple of [`POSITION_LOOP_S`].
    pub fn settled(
        plant: &Plant,
        model: FrictionModel,
        setpoints: [Setpoint; 2],
        cycle_s: f64,
    ) -> Self {
        let [x, y] = setpoints;
        let ticks = ticks(cycle_s);
        Self {
            drives: [
                Drive::settled(&plant.x, model, x),
                Drive::settled(&plant.y, model, y),
            ],
            ticks,
            tick_s: cycle_s / f64::from(ticks),
        }
    }

    /// One CNC cycle from its setpoints on, which the fine interpolation continues linearly. `take`
    /// gets the positions of X and Y in m after every simulation step.
    #[inline]
    pub fn follow(&mut self, setpoints: [Setpoint; 2], mut take: impl FnMut(f64, f64)) {
        let [mut x, mut y] = setpoints;
        let part = self.tick_s;
        let [first, second] = &mut self.drives;
        for _ in 0..self.ticks {
            first.follow(x);
            second.follow(y);
            for _ in 0..SPEED_LOOPS_PER_POSITION_LOOP {
                first.control();
                second.control();
                for _ in 0..STEPS_PER_SPEED_LOOP {
                    take(first.step(), second.step());
                }
            }
            x.position_m += part * x.velocity_m_per_s;
            y.position_m += part * y.velocity_m_per_s;
        }
    }

    /// The drives of X and Y.
    pub fn drives(&self) -> &[Drive; 2] {
        &self.drives
    }

    /// In how many cycles of the speed loop a force was limited, of both drives together.
    pub fn saturated_cycles(&self) -> u64 {
        self.drives.iter().map(Drive::saturated_cycles).sum()
    }
}

/// Cycles of the position loop in a CNC cycle of so many seconds, at least one.
fn ticks(cycle_s: f64) -> u32 {
    let ticks = (cycle_s / POSITION_LOOP_S).round();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
    let ticks = ticks as u32;
    ticks.max(1)
}
