//! Friction of a guideway: the static curve, and models that remember what the contact went
//! through (R5.10 to R5.12).
//!
//! A new model is a file beside [`lugre`], a variant of [`FrictionModel`] and an arm of
//! [`Contact`].

mod contact;
mod curve;
mod gms;
mod lugre;
mod model;
mod stribeck;

pub(super) use contact::{Contact, Push};
pub use curve::{Friction, GmsElement};
pub use model::{FrictionModel, UnknownFrictionModel};
