//! Friction of a guideway: the static curve, and models that remember what the contact went
//! through (R5.10 to R5.12).

mod gms;
mod lugre;
mod stribeck;

use serde::Serialize;

use gms::Gms;
use lugre::Lugre;
use stribeck::Stribeck;

/// The simulation step in seconds (chapter 5.2 of the rules).
pub const STEP: f64 = 62.5e-6;

/// The friction in N that stands for none: the bristle's equation divides by it.
const LEAST: f64 = 1e-9;

/// How friction is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum FrictionModel {
    /// Coulomb, viscous and Stribeck friction without a memory (R5.10).
    Stribeck,
    /// One bristle (R5.11).
    #[default]
    Lugre,
    /// Generalized Maxwell-slip: elements that stick and slip (R5.12).
    Gms,
}

impl FrictionModel {
    /// The name on the command line and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stribeck => "stribeck",
            Self::Lugre => "lugre",
            Self::Gms => "gms",
        }
    }
}

/// One element of the Maxwell-slip model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct GmsElement {
    /// Its share of the friction, α; all shares together make 1.
    pub share: f64,
    /// Its stiffness k in N/m.
    pub stiffness: f64,
}

/// The friction of one axis, in SI units.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Friction {
    /// Coulomb friction Fc in N.
    pub coulomb: f64,
    /// Breakaway friction Fs in N.
    pub breakaway: f64,
    /// Stribeck velocity vs in m/s.
    pub stribeck_velocity: f64,
    /// Exponent δ of the Stribeck curve.
    pub shape: f64,
    /// Viscous friction fv in N·s/m.
    pub viscous: f64,
    /// Stiffness σ0 of the contact before it slides, in N/m.
    pub stiffness: f64,
    /// Damping σ1 of the contact before it slides, in N·s/m.
    pub damping: f64,
    /// Velocity vd in m/s above which that damping fades.
    pub damping_velocity: f64,
    /// The elements of the Maxwell-slip model.
    pub elements: Vec<GmsElement>,
    /// How fast slipping elements approach their share of the friction, C in N/s.
    pub attraction: f64,
}

impl Friction {
    /// The friction in N of a contact that slides at this speed in m/s, without the viscous part:
    /// g of R5.11.
    #[inline]
    pub fn level(&self, speed: f64) -> f64 {
        let ratio = speed / self.stribeck_velocity;
        // Most drives have the exponent 1, and a power costs more than the rest of the step.
        #[allow(clippy::float_cmp)] // exactly the value that is written
        let power = if self.shape == 1.0 {
            ratio
        } else {
            raised(ratio, self.shape)
        };
        self.coulomb + (self.breakaway - self.coulomb) * fading(power)
    }

    /// The friction in N at a constant velocity in m/s (R5.10); 0 at standstill.
    pub fn steady(&self, velocity: f64) -> f64 {
        if velocity == 0.0 {
            return 0.0;
        }
        self.level(velocity.abs()).copysign(velocity) + self.viscous * velocity
    }

    /// The same contact with more or less friction: every force of the curve times `factor`, the
    /// stiffness as it is.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            coulomb: self.coulomb * factor,
            breakaway: self.breakaway * factor,
            viscous: self.viscous * factor,
            ..self.clone()
        }
    }

    /// Damping σ1(v) in N·s/m, fading with the velocity (R5.11).
    #[inline]
    fn micro_damping(&self, velocity: f64) -> f64 {
        let ratio = velocity / self.damping_velocity;
        self.damping * fading(ratio * ratio)
    }
}

/// e to the power of `-exponent`, and 0 where nothing is left of it in the digits of a force.
#[inline]
fn fading(exponent: f64) -> f64 {
    const FADED: f64 = 40.0;
    if exponent > FADED {
        return 0.0;
    }
    (-exponent).exp()
}

/// A function of its own, so that it is not computed where it is not needed.
#[cold]
#[inline(never)]
fn raised(ratio: f64, exponent: f64) -> f64 {
    ratio.powf(exponent)
}

/// A contact with its state.
#[derive(Debug, Clone)]
pub(super) enum Contact {
    Stribeck(Stribeck),
    Lugre(Lugre),
    Gms(Gms),
}

/// A mass on its way through one step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Push {
    /// Velocity at the beginning in m/s.
    pub(super) velocity: f64,
    /// Driving force in N.
    pub(super) force: f64,
    /// The step divided by the mass, in s/kg.
    pub(super) per_mass: f64,
}

impl Contact {
    /// A contact that has slid at this velocity for long.
    pub(super) fn settled(friction: &Friction, model: FrictionModel, velocity: f64) -> Self {
        match model {
            FrictionModel::Stribeck => Self::Stribeck(Stribeck::new(friction)),
            FrictionModel::Lugre => Self::Lugre(Lugre::settled(friction, velocity)),
            FrictionModel::Gms => Self::Gms(Gms::settled(friction, velocity)),
        }
    }

    /// The velocity in m/s at the end of the step, m dv/dt = F - friction.
    #[inline]
    pub(super) fn push(&mut self, push: Push) -> f64 {
        let friction = match self {
            Self::Stribeck(contact) => return contact.push(push),
            Self::Lugre(contact) => contact.friction(push.velocity),
            Self::Gms(contact) => contact.friction(push.velocity),
        };
        push.velocity + push.per_mass * (push.force - friction)
    }
}
