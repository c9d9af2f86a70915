//! The parameters of one feed drive, and the values that follow from others (chapter 5.2).

use std::f64::consts::TAU;

use serde::Serialize;

use super::friction::{Friction, GmsElement};
use crate::stiction::StictionParameters;

/// The rated force of the default axis; the rules leave it open.
pub const RATED_FORCE_N: f64 = 5000.0;

/// The force that a drive can give for a short time, in rated forces; the rules leave it open.
pub const PEAK_FORCE: f64 = 4.0;

/// Drive units per rated force.
const UNITS_PER_RATED_FORCE: f64 = 1000.0;

/// Bandwidth of the speed loop in Hz.
const SPEED_LOOP_BANDWIDTH: f64 = 45.0;

/// Damping of the contact as a part of the critical damping.
const CONTACT_DAMPING: f64 = 0.3;

/// Elements of the Maxwell-slip model unless a plant file gives them.
const ELEMENTS: u32 = 4;

/// The parameters of one feed drive.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct DriveParameters {
    /// Moved mass m.
    pub mass_kg: f64,
    /// Gain of the position loop Kv.
    pub position_gain_per_s: f64,
    /// Gain of the speed loop Kp.
    pub speed_gain_n_s_per_m: f64,
    /// Integral time of the speed loop Ti.
    pub integral_time_s: f64,
    /// Time constant of the current loop Tt.
    pub current_time_s: f64,
    /// Velocity feed forward, 1 for all of it.
    pub velocity_forward: f64,
    /// Acceleration feed forward, 1 for all of it.
    pub acceleration_forward: f64,
    /// Force of one drive unit of additive current.
    pub force_per_unit_n: f64,
    /// The largest force of the drive.
    pub max_force_n: f64,
    /// Backlash: the dead zone between motor and load (R5.27).
    pub backlash_m: f64,
    /// The friction of the guideway.
    pub friction: Friction,
    /// Stiction compensation by the control, if it has that (R8.6).
    pub stiction: Option<StictionParameters>,
}

/// Changes by a plant file.
impl DriveParameters {
    /// Changes the mass to `kg`, and the gain of the speed loop and the damping of the contact,
    /// which follow from it.
    pub(super) fn set_mass(&mut self, kg: f64) {
        self.mass_kg = kg;
        self.speed_gain_n_s_per_m = speed_gain(kg);
        self.friction.damping_n_s_per_m = damping(self.friction.stiffness_n_per_m, kg);
    }

    /// Changes the rated force to `newtons`, and the force of a drive unit and the largest force,
    /// which follow from it.
    pub(super) fn set_rated_force(&mut self, newtons: f64) {
        self.force_per_unit_n = newtons / UNITS_PER_RATED_FORCE;
        self.max_force_n = PEAK_FORCE * newtons;
    }

    /// Changes the stiffness of the contact to `n_per_m`, and its damping and its elements, which
    /// follow from it.
    pub(super) fn set_stiffness(&mut self, n_per_m: f64) {
        self.friction.stiffness_n_per_m = n_per_m;
        self.friction.damping_n_s_per_m = damping(n_per_m, self.mass_kg);
        self.friction.elements = elements(n_per_m);
    }
}

impl DriveParameters {
    /// Returns the friction in N at a constant velocity in m/s, above 0.
    pub fn friction_n(&self, speed: f64) -> f64 {
        self.friction.level_n(speed) + self.friction.viscous_n_s_per_m * speed
    }

    /// Returns the axis with the contact stiffness times this factor, its damping as a part of the critical one
    /// unchanged.
    #[must_use]
    pub fn with_contact(&self, factor: f64) -> Self {
        let mut axis = self.clone();
        let contact = &mut axis.friction;
        contact.stiffness_n_per_m *= factor;
        contact.damping_n_s_per_m *= factor.sqrt();
        for element in &mut contact.elements {
            element.stiffness_n_per_m *= factor;
        }
        axis
    }

    /// Returns the axis with more friction forwards than backwards, by this part of their mean.
    #[must_use]
    pub fn uneven(&self, part: f64) -> Self {
        let mut axis = self.clone();
        axis.friction.asymmetry = part;
        axis
    }

    /// Returns the default axis with a contact of this stiffness in N/m.
    pub(super) fn with_stiffness(stiffness: f64) -> Self {
        let mass = 1300.0;
        Self {
            mass_kg: mass,
            position_gain_per_s: 33.3,
            speed_gain_n_s_per_m: speed_gain(mass),
            integral_time_s: 0.012,
            current_time_s: 0.0006,
            velocity_forward: 1.0,
            acceleration_forward: 0.0,
            force_per_unit_n: RATED_FORCE_N / UNITS_PER_RATED_FORCE,
            max_force_n: PEAK_FORCE * RATED_FORCE_N,
            backlash_m: 0.0,
            friction: Friction {
                coulomb_n: 500.0,
                breakaway_n: 620.0,
                stribeck_velocity_m_per_s: 0.003,
                shape: 1.0,
                viscous_n_s_per_m: 4000.0,
                stiffness_n_per_m: stiffness,
                damping_n_s_per_m: damping(stiffness, mass),
                damping_velocity_m_per_s: 0.002,
                elements: elements(stiffness),
                attraction_n_per_s: 1e6,
                asymmetry: 0.0,
            },
            stiction: None,
        }
    }
}

/// Returns Kp in N·s/m that gives the speed loop its bandwidth with this mass in kg.
fn speed_gain(mass: f64) -> f64 {
    mass * TAU * SPEED_LOOP_BANDWIDTH
}

/// Returns σ1 in N·s/m of a contact with this stiffness in N/m under this mass in kg.
fn damping(stiffness: f64, mass: f64) -> f64 {
    2.0 * CONTACT_DAMPING * (stiffness * mass).sqrt()
}

/// Elements with equal shares of the friction whose stiffnesses fall as 1, 1/2, 1/3 … and add up
/// to the stiffness of the contact in N/m: they break loose one after the other.
fn elements(stiffness: f64) -> Vec<GmsElement> {
    let parts = || (1..=ELEMENTS).map(|number| 1.0 / f64::from(number));
    let whole: f64 = parts().sum();
    parts()
        .map(|part| GmsElement {
            share: 1.0 / f64::from(ELEMENTS),
            stiffness_n_per_m: stiffness * part / whole,
        })
        .collect()
}
