//! The friction models by name.

use std::str::FromStr;

use serde::Serialize;
use thiserror::Error;

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

/// A word that names no friction model.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("there is no friction model `{0}`")]
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
