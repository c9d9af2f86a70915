//! The coupling between the motor, where the position is measured, and the load (R5.27).

/// A dead zone: the load follows the motor only when the play is used up.
#[derive(Debug, Clone)]
pub(super) struct DeadZone {
    /// Half of the play in m.
    half: f64,
    /// Position of the load in m.
    load: f64,
}

impl DeadZone {
    /// Creates a coupling with a play in m whose motor has driven the load for a long time; at
    /// standstill the load is in the middle.
    pub(super) fn settled(play: f64, position: f64, velocity: f64) -> Self {
        let half = play / 2.0;
        let behind = if velocity == 0.0 {
            0.0
        } else {
            half.copysign(velocity)
        };
        Self {
            half,
            load: position - behind,
        }
    }

    /// Returns the position of the load for a motor at `position`, both in m. The friction of the
    /// guideway holds the load while the motor crosses the play.
    #[inline]
    pub(super) fn follow(&mut self, position: f64) -> f64 {
        self.load = self
            .load
            .max(position - self.half)
            .min(position + self.half);
        self.load
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_load_stays_until_the_play_is_used_up() {
        // R5.27
        let mut coupling = DeadZone::settled(8e-6, 0.0, 1.0);
        let places = [0.0, 10e-6, 6e-6, 2e-6, 0.0].map(|position| coupling.follow(position));
        let expected = [-4e-6, 6e-6, 6e-6, 6e-6, 4e-6];
        for (place, expected) in places.into_iter().zip(expected) {
            assert!((place - expected).abs() < 1e-18, "{place} {expected}");
        }
    }

    #[test]
    fn without_play_the_load_is_where_the_motor_is() {
        let mut coupling = DeadZone::settled(0.0, 0.1, -1.0);
        for position in [0.1, 0.100_000_3, -7.0] {
            assert_eq!(coupling.follow(position).to_bits(), position.to_bits());
        }
    }
}
