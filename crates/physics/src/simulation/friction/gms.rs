//! The generalized Maxwell-slip model: elements in parallel, each sticking or slipping (R5.12).
//!
//! Al-Bender, Lampaert and Swevers, *The generalized Maxwell-slip model: a novel model for
//! friction simulation and compensation*, IEEE Transactions on Automatic Control 50 (2005):
//! `F = Σ (kᵢ·zᵢ + σᵢ·dzᵢ/dt) + fv·v`. The elements that stick share the damping, each by its part
//! of the stiffness.

use super::super::clock::STEP_S;
use super::curve::{Friction, GmsElement, LEAST_N};

/// A contact with its elements.
#[derive(Debug, Clone)]
pub(crate) struct Gms {
    friction: Friction,
    elements: Vec<Element>,
    /// Σ kᵢ in N/m.
    stiffness: f64,
}

#[derive(Debug, Clone)]
struct Element {
    is: GmsElement,
    /// The force kᵢ·zᵢ in N.
    force: f64,
    slips: bool,
}

impl Gms {
    pub(super) fn settled(friction: &Friction, velocity: f64) -> Self {
        let level = if velocity == 0.0 {
            0.0
        } else {
            friction.level_towards_n(velocity).copysign(velocity)
        };
        let settle = |&is: &GmsElement| Element {
            is,
            force: is.share * level,
            slips: velocity != 0.0,
        };
        Self {
            elements: friction.elements.iter().map(settle).collect(),
            stiffness: friction
                .elements
                .iter()
                .map(|it| it.stiffness_n_per_m)
                .sum(),
            friction: friction.clone(),
        }
    }

    /// Returns the friction in N over a step at this velocity in m/s.
    pub(super) fn friction(&mut self, velocity: f64) -> f64 {
        let level = self.friction.level_towards_n(velocity).max(LEAST_N);
        let damping = self.friction.micro_damping(velocity) * velocity / self.stiffness;
        let approach = (-self.friction.attraction_n_per_s / level * STEP_S).exp();
        let mut force = self.friction.viscous_n_s_per_m * velocity;
        for element in &mut self.elements {
            element.step(velocity, level, approach);
            force += element.force;
            if !element.slips {
                force += damping * element.is.stiffness_n_per_m;
            }
        }
        force
    }
}

impl Element {
    fn step(&mut self, velocity: f64, level: f64, approach: f64) {
        let limit = self.is.share * level;
        if self.slips && velocity * self.force <= 0.0 {
            self.slips = false;
        }
        if self.slips {
            let steady = limit.copysign(velocity);
            self.force = steady + (self.force - steady) * approach;
            return;
        }
        let stuck = self.force + self.is.stiffness_n_per_m * velocity * STEP_S;
        self.slips = stuck.abs() >= limit && velocity * stuck > 0.0;
        self.force = if self.slips {
            // An element that breaks loose keeps for a moment what it held.
            limit.max(self.force.abs()).copysign(stuck)
        } else {
            stuck
        };
    }
}
