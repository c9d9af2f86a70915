//! A contact in motion, whatever its model.

use super::curve::Friction;
use super::gms::Gms;
use super::lugre::Lugre;
use super::model::FrictionModel;
use super::stribeck::Stribeck;

/// A contact with its state.
#[derive(Debug, Clone)]
pub(in crate::simulation) enum Contact {
    Stribeck(Stribeck),
    Lugre(Lugre),
    Gms(Gms),
}

/// A mass at the beginning of a step, and the force that drives it.
#[derive(Debug, Clone, Copy)]
pub(in crate::simulation) struct Push {
    /// Velocity at the beginning of the step in m/s.
    pub(in crate::simulation) velocity: f64,
    /// Driving force in N.
    pub(in crate::simulation) force: f64,
    /// The step divided by the mass, in s/kg.
    pub(in crate::simulation) per_mass: f64,
}

impl Contact {
    /// A contact that has slid at this velocity, in m/s, for a long time.
    pub(in crate::simulation) fn settled(
        friction: &Friction,
        model: FrictionModel,
        velocity: f64,
    ) -> Self {
        match model {
            FrictionModel::Stribeck => Self::Stribeck(Stribeck::new(friction)),
            FrictionModel::Lugre => Self::Lugre(Lugre::settled(friction, velocity)),
            FrictionModel::Gms => Self::Gms(Gms::settled(friction, velocity)),
        }
    }

    /// The velocity in m/s at the end of the step, from `m·dv/dt = F - friction`.
    #[inline]
    pub(in crate::simulation) fn push(&mut self, push: Push) -> f64 {
        let friction = match self {
            Self::Stribeck(contact) => {
                return contact.velocity_after(push.velocity, push.force, push.per_mass);
            }
            Self::Lugre(contact) => contact.friction(push.velocity),
            Self::Gms(contact) => contact.friction(push.velocity),
        };
        push.velocity + push.per_mass * (push.force - friction)
    }
}
