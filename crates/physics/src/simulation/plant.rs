//! A machine with two feed drives.

use std::str::FromStr;

use serde::Serialize;
use thiserror::Error;

use super::parameters::DriveParameters;
use frictcomp::diagnostic::did_you_mean;

/// Two feed drives, X and Y.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plant {
    /// Name in reports.
    pub name: String,
    /// The drive of X.
    pub x: DriveParameters,
    /// The drive of Y.
    pub y: DriveParameters,
}

frictcomp::words! {
    /// A plant whose values the rules give (chapter 5.2). They differ in the stiffness of the contact.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    #[non_exhaustive]
    pub enum Preset {
        /// 1000 N/µm.
        #[default]
        Stiff = "stiff",
        /// 300 N/µm.
        Mid = "mid",
        /// 80 N/µm.
        Soft = "soft",
    }
}

/// A word that is not the name of a preset.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("there is no plant `{0}`")]
pub struct UnknownPreset(pub String);

impl UnknownPreset {
    /// Returns the preset that was probably meant.
    pub fn near(&self) -> Option<&'static str> {
        did_you_mean(&self.0, Preset::ALL.map(Preset::as_str))
    }
}

impl Preset {
    /// Returns the names of all presets, for messages: `stiff, mid, soft`.
    pub fn names() -> String {
        Self::ALL.map(Self::as_str).join(", ")
    }

    /// Stiffness σ0 of the contact.
    pub fn stiffness_n_per_m(self) -> f64 {
        match self {
            Self::Stiff => 1e9,
            Self::Mid => 3e8,
            Self::Soft => 8e7,
        }
    }

    /// Returns the plant.
    pub fn plant(self) -> Plant {
        let drive = DriveParameters::of(self);
        Plant {
            name: self.to_string(),
            x: drive.clone(),
            y: drive,
        }
    }
}

impl FromStr for Preset {
    type Err = UnknownPreset;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        let mut presets = Self::ALL.into_iter();
        let found = presets.find(|preset| preset.as_str() == name);
        found.ok_or_else(|| UnknownPreset(name.to_owned()))
    }
}

impl DriveParameters {
    /// Returns the default axis with the contact of a preset.
    pub fn of(preset: Preset) -> Self {
        Self::with_stiffness(preset.stiffness_n_per_m())
    }
}

impl Plant {
    /// Returns the plant with more or less friction on both axes: every force of the curves times
    /// `factor`.
    #[must_use]
    pub fn with_friction(&self, factor: f64) -> Self {
        let scaled = |drive: &DriveParameters| DriveParameters {
            friction: drive.friction.scaled(factor),
            ..drive.clone()
        };
        Self {
            name: self.name.clone(),
            x: scaled(&self.x),
            y: scaled(&self.y),
        }
    }
}
