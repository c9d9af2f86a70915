//! A machine with two feed drives.

use serde::Serialize;

use super::drive::DriveParameters;
use super::friction::{Friction, GmsElement};

/// Two feed drives, X and Y.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plant {
    /// What it is called in reports.
    pub name: String,
    /// The drive of X.
    pub x: DriveParameters,
    /// The drive of Y.
    pub y: DriveParameters,
}

/// A plant whose values the rules give (chapter 5.2). They differ in the stiffness of the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Preset {
    /// 1000 N/µm.
    #[default]
    Stiff,
    /// 300 N/µm.
    Mid,
    /// 80 N/µm.
    Soft,
}

/// The rated force in N of the default axis; the rules leave it open.
pub const RATED_FORCE: f64 = 5000.0;

/// The force that a drive can give for a short time, in rated forces; the rules leave it open.
pub const PEAK: f64 = 4.0;

/// Elements of the Maxwell-slip model unless a plant file gives them.
const ELEMENTS: u32 = 4;

impl Preset {
    /// Every preset, the stiffest first.
    pub const ALL: [Self; 3] = [Self::Stiff, Self::Mid, Self::Soft];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stiff => "stiff",
            Self::Mid => "mid",
            Self::Soft => "soft",
        }
    }

    /// The preset with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|preset| preset.name() == name)
    }

    /// Stiffness σ0 of the contact in N/m.
    pub fn stiffness(self) -> f64 {
        match self {
            Self::Stiff => 1e9,
            Self::Mid => 3e8,
            Self::Soft => 8e7,
        }
    }

    /// The plant.
    pub fn plant(self) -> Plant {
        let drive = DriveParameters::of(self);
        Plant {
            name: self.name().to_owned(),
            x: drive.clone(),
            y: drive,
        }
    }
}

impl DriveParameters {
    /// The default axis with the contact of a preset.
    pub fn of(preset: Preset) -> Self {
        let mass = 1300.0;
        let stiffness = preset.stiffness();
        Self {
            mass,
            position_gain: 33.3,
            speed_gain: speed_gain(mass),
            integral_time: 0.012,
            current_time: 0.0006,
            velocity_forward: 1.0,
            acceleration_forward: 0.0,
            force_per_unit: RATED_FORCE / 1000.0,
            max_force: PEAK * RATED_FORCE,
            friction: Friction {
                coulomb: 500.0,
                breakaway: 620.0,
                stribeck_velocity: 0.003,
                shape: 1.0,
                viscous: 4000.0,
                stiffness,
                damping: damping(stiffness, mass),
                damping_velocity: 0.002,
                elements: elements(stiffness),
                attraction: 1e6,
            },
        }
    }
}

/// Kp for a bandwidth of 45 Hz with this mass, in N·s/m (chapter 5.2).
pub(super) fn speed_gain(mass: f64) -> f64 {
    mass * std::f64::consts::TAU * 45.0
}

/// σ1 that damps this mass on its contact with 0.3 of the critical damping, in N·s/m (chapter
/// 5.2).
pub(super) fn damping(stiffness: f64, mass: f64) -> f64 {
    2.0 * 0.3 * (stiffness * mass).sqrt()
}

/// Elements with equal shares of the friction whose stiffnesses fall as 1, 1/2, 1/3 … and make
/// the stiffness of the contact together: they break loose one after the other.
pub(super) fn elements(stiffness: f64) -> Vec<GmsElement> {
    let parts = || (1..=ELEMENTS).map(|number| 1.0 / f64::from(number));
    let whole: f64 = parts().sum();
    parts()
        .map(|part| GmsElement {
            share: 1.0 / f64::from(ELEMENTS),
            stiffness: stiffness * part / whole,
        })
        .collect()
}

impl Plant {
    /// The same plant with more or less friction on both axes.
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
