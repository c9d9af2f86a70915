//! The friction models: their names, and a contact in motion whatever its model.

use std::str::FromStr;

use serde::Serialize;
use thiserror::Error;

use super::curve::Friction;
use super::gms::Gms;
use super::lugre::Lugre;
use super::stribeck::Stribeck;

frictcomp::words! {
    /// Model of friction.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
    #[serde(rename_all = "lowercase")]
    #[non_exhaustive]
    pub enum FrictionModel {
        /// Coulomb, viscous and Stribeck friction without memory (R5.10).
        Stribeck = "stribeck",
        /// One bristle (R5.11).
        #[default]
        Lugre = "lugre",
        /// Generalized Maxwell slip: elements that stick and slip (R5.12).
        Gms = "gms",
    }
}

/// A word that is not the name of a friction model.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("there is no friction model `{0}`; the models are {all}", all = FrictionModel::ALL.map(FrictionModel::as_str).join(", "))]
pub struct UnknownFrictionModel(pub String);

impl FrictionModel {
    /// Returns the meaning in a few words.
    pub fn title(self) -> &'static str {
        match self {
            Self::Stribeck => "The static Stribeck curve",
            Self::Lugre => "LuGre, a single bristle",
            Self::Gms => "Generalized Maxwell-slip, elements that stick and slip",
        }
    }
}

impl FromStr for FrictionModel {
    type Err = UnknownFrictionModel;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        let mut models = Self::ALL.into_iter();
        let found = models.find(|model| model.as_str() == name);
        found.ok_or_else(|| UnknownFrictionModel(name.to_owned()))
    }
}

/// A contact with its state.
#[derive(Debug, Clone)]
pub(crate) enum Contact {
    Stribeck(Stribeck),
    Lugre(Lugre),
    Gms(Gms),
}

/// A mass at the beginning of a step, and the force that drives it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Push {
    /// Velocity at the beginning of the step in m/s.
    pub(crate) velocity: f64,
    /// Driving force in N.
    pub(crate) force: f64,
    /// The step divided by the mass, in s/kg.
    pub(crate) per_mass: f64,
}

impl Contact {
    /// Returns a contact that has slid at this velocity, in m/s, for a long time.
    pub(crate) fn settled(friction: &Friction, model: FrictionModel, velocity: f64) -> Self {
        match model {
            FrictionModel::Stribeck => Self::Stribeck(Stribeck::new(friction)),
            FrictionModel::Lugre => Self::Lugre(Lugre::settled(friction, velocity)),
            FrictionModel::Gms => Self::Gms(Gms::settled(friction, velocity)),
        }
    }

    /// Returns the velocity in m/s at the end of the step, from `m·dv/dt = F - friction`.
    #[inline]
    pub(crate) fn push(&mut self, push: Push) -> f64 {
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
