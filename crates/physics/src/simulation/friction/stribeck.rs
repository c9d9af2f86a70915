//! Friction without memory: it always opposes the motion, and holds at rest (R5.10).

use super::curve::Friction;

/// A contact without a state.
#[derive(Debug, Clone)]
pub(crate) struct Stribeck {
    friction: Friction,
}

impl Stribeck {
    pub(super) fn new(friction: &Friction) -> Self {
        Self {
            friction: friction.clone(),
        }
    }

    /// Returns the velocity in m/s at the end of a step that begins with `velocity` in m/s, under a force in N;
    /// `per_mass` is the step divided by the mass, in s/kg. Friction takes away at most the whole velocity, so that a
    /// mass at rest stays there until the force exceeds the breakaway friction.
    #[inline]
    pub(super) fn velocity_after(&self, velocity: f64, force: f64, per_mass: f64) -> f64 {
        let free = velocity + per_mass * force;
        let dry = per_mass * self.friction.level_towards_n(velocity);
        let rest = (free.abs() - dry).max(0.0);
        // The viscous part acts on the velocity at the end, which is stable for any step.
        (rest / (1.0 + per_mass * self.friction.viscous_n_s_per_m)).copysign(free)
    }
}
