//! Friction without a memory: it always opposes the motion, and holds at rest (R5.10).

use super::{Friction, Push};

/// A contact without a state of its own.
#[derive(Debug, Clone)]
pub(in crate::circle) struct Stribeck {
    friction: Friction,
}

impl Stribeck {
    pub(super) fn new(friction: &Friction) -> Self {
        Self {
            friction: friction.clone(),
        }
    }

    /// The velocity at the end of a step. Friction takes away at most the whole velocity, so that
    /// a mass at rest stays there until the force exceeds the breakaway friction.
    #[inline]
    pub(super) fn push(&mut self, push: Push) -> f64 {
        let free = push.velocity + push.per_mass * push.force;
        let dry = push.per_mass * self.friction.level(push.velocity.abs());
        let rest = (free.abs() - dry).max(0.0);
        // The viscous part acts on the velocity at the end, which is stable for any step.
        (rest / (1.0 + push.per_mass * self.friction.viscous)).copysign(free)
    }
}
