//! Friction of a guideway: the static curve, and models that remember the history of the contact
//! (R5.10 to R5.12).
//!
//! A new model is a file next to [`lugre`], and its variants and arms in [`model`].

mod curve;
mod gms;
mod lugre;
mod model;
mod stribeck;

pub use curve::{Friction, GmsElement};
pub(super) use model::{Contact, Push};
pub use model::{FrictionModel, UnknownFrictionModel};
