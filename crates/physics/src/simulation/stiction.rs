//! Stiction compensation in the position loop (R8.1).

use super::clock::POSITION_LOOP_S;
use crate::stiction::StictionParameters;

/// The compensation of one drive with its state.
#[derive(Debug, Clone)]
pub(super) struct Stiction {
    /// Cycles of the position loop in a control loop cycle.
    cycle: u32,
    /// Cycles of the position loop until the servo lag is sampled again.
    wait: u32,
    /// The servo lag in m when it was last sampled.
    lag: f64,
    /// The largest change that counts, in m.
    limit: f64,
    /// Velocity in m/s that a change of 1 m adds: `k_v · MP1511 / t_C`.
    gain: f64,
    /// Velocity in m/s that is added until the next sample.
    added: f64,
}

impl Stiction {
    /// Returns the compensation of a position loop with its gain in 1/s, at a servo lag in m.
    pub(super) fn new(parameters: &StictionParameters, position_gain: f64, lag: f64) -> Self {
        let cycle = (parameters.tc_us * 1e-6 / POSITION_LOOP_S).round();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
        let cycle = (cycle as u32).max(1);
        Self {
            cycle,
            wait: cycle,
            lag,
            limit: parameters.limit_um() * 1e-6,
            gain: position_gain * parameters.mp1511_us / parameters.tc_us,
            added: 0.0,
        }
    }

    /// Returns the velocity in m/s that is added in a cycle of the position loop with this servo lag in m. It does not
    /// change between two samples of the lag.
    #[inline]
    pub(super) fn added(&mut self, lag: f64) -> f64 {
        if self.wait == 0 {
            let change = (lag - self.lag).clamp(-self.limit, self.limit);
            self.added = self.gain * change;
            self.lag = lag;
            self.wait = self.cycle;
        }
        self.wait -= 1;
        self.added
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_control_loop_cycle_the_change_of_the_lag_adds_a_feed() {
        // R8.1: k_v 1.5 (m/min)/mm, 8000 µs and 2 µm in 3 ms give 0.008 m/min.
        let worked = StictionParameters {
            mp1511_us: 8000.0,
            mp1512: 50.0,
            ..StictionParameters::default()
        };
        let mut stiction = Stiction::new(&worked, 25.0, 0.0);
        let mut cycle = |lag: f64| -> Vec<f64> { (0..12).map(|_| stiction.added(lag)).collect() };
        assert_eq!(cycle(1e-6), [0.0; 12], "the lag is looked at after a cycle");
        let of = |micrometres: f64| 0.008 / 60.0 / 2.0 * micrometres;
        for (lag_um, change_um) in [(2.0, 2.0), (2.0, 0.0), (1.0, -1.0), (9.0, 3.906_25)] {
            for added in cycle(lag_um * 1e-6) {
                assert!((added - of(change_um)).abs() < 1e-12, "{lag_um}: {added}");
            }
        }
    }
}
