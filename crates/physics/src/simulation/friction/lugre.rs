//! The `LuGre` model: the contact is a bristle that bends before it slides (R5.11).
//!
//! Canudas de Wit, Olsson, Åström and Lischinsky, *A new model for control of systems with
//! friction*, IEEE Transactions on Automatic Control 40 (1995):
//! `dz/dt = v - σ0·|v|/g(v)·z`, `F = σ0·z + σ1·dz/dt + fv·v`.

use super::super::clock::STEP_S;
use super::curve::{Friction, LEAST_N, fading};

/// A contact with its bristle.
#[derive(Debug, Clone)]
pub(crate) struct Lugre {
    friction: Friction,
    /// Reciprocal of the stiffness: a step multiplies where it would wait for a division.
    per_stiffness: f64,
    /// Reciprocal of the velocity above which the damping fades.
    per_damping_velocity: f64,
    /// Deflection z in m.
    deflection: f64,
}

impl Lugre {
    pub(super) fn settled(friction: &Friction, velocity: f64) -> Self {
        let slides = if velocity == 0.0 { 0.0 } else { 1.0 };
        let deflection = slides * friction.level_towards_n(velocity) / friction.stiffness_n_per_m;
        Self {
            friction: friction.clone(),
            per_stiffness: friction.stiffness_n_per_m.recip(),
            per_damping_velocity: friction.damping_velocity_m_per_s.recip(),
            deflection: deflection.copysign(velocity),
        }
    }

    /// Returns the friction in N over a step at this velocity in m/s. The deflection follows its equation in closed
    /// form, `z∞ + (z - z∞)·exp(-σ0·|v|/g·dt)`, which no stiffness makes unstable.
    #[inline]
    pub(super) fn friction(&mut self, velocity: f64) -> f64 {
        let contact = &self.friction;
        let speed = velocity.abs();
        let level = contact.level_towards_n(velocity).max(LEAST_N);
        let rate = contact.stiffness_n_per_m * speed / level;
        let steady = (level * self.per_stiffness).copysign(velocity);
        self.deflection = steady + (self.deflection - steady) * fading(rate * STEP_S);
        let bending = velocity - rate * self.deflection;
        // The damping fades with the velocity (R5.11).
        let ratio = velocity * self.per_damping_velocity;
        contact.stiffness_n_per_m * self.deflection
            + contact.damping_n_s_per_m * fading(ratio * ratio) * bending
            + contact.viscous_n_s_per_m * velocity
    }
}
