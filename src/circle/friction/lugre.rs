//! The `LuGre` model: the contact is a bristle that bends before it slides (R5.11).

use super::{Friction, LEAST, STEP, fading};

/// A contact with its bristle.
#[derive(Debug, Clone)]
pub(in crate::circle) struct Lugre {
    friction: Friction,
    /// Deflection z in m.
    deflection: f64,
}

impl Lugre {
    pub(super) fn settled(friction: &Friction, velocity: f64) -> Self {
        let slides = if velocity == 0.0 { 0.0 } else { 1.0 };
        let deflection = slides * friction.level(velocity.abs()) / friction.stiffness;
        Self {
            friction: friction.clone(),
            deflection: deflection.copysign(velocity),
        }
    }

    /// The friction in N over a step at this velocity. The deflection follows its equation in
    /// closed form, z∞ + (z - z∞)·exp(-σ0|v|/g·dt), which no stiffness makes unstable.
    #[inline]
    pub(super) fn friction(&mut self, velocity: f64) -> f64 {
        let contact = &self.friction;
        let speed = velocity.abs();
        let level = contact.level(speed).max(LEAST);
        let rate = contact.stiffness * speed / level;
        let steady = (level / contact.stiffness).copysign(velocity);
        self.deflection = steady + (self.deflection - steady) * fading(rate * STEP);
        let bending = velocity - rate * self.deflection;
        contact.stiffness * self.deflection
            + contact.micro_damping(velocity) * bending
            + contact.viscous * velocity
    }
}
