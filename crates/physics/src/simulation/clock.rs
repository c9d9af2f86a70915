//! The cycles in which drives are simulated (chapter 5.2 of the rules).

/// Simulation steps in a cycle of the speed loop.
pub(super) const STEPS_PER_SPEED_LOOP: usize = 2;

/// Cycles of the speed loop in a cycle of the position loop.
pub(super) const SPEED_LOOPS_PER_POSITION_LOOP: usize = 2;

/// The simulation step in seconds.
pub const STEP_S: f64 = 62.5e-6;

/// The cycle of the speed loop in seconds.
pub const SPEED_LOOP_S: f64 = 125e-6;

/// The cycle of the position loop in seconds.
pub const POSITION_LOOP_S: f64 = 250e-6;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cycle_is_a_whole_number_of_shorter_ones() {
        let times = |seconds: f64, count: usize| (0..count).map(|_| seconds).sum::<f64>();
        let close = |one: f64, other: f64| (one - other).abs() < 1e-15;
        assert!(close(times(STEP_S, STEPS_PER_SPEED_LOOP), SPEED_LOOP_S));
        let position_loop = times(SPEED_LOOP_S, SPEED_LOOPS_PER_POSITION_LOOP);
        assert!(close(position_loop, POSITION_LOOP_S));
    }
}
