//! The parameters of a contact, and its friction at constant velocity.

use serde::Serialize;

/// The friction in N that represents none: the equation of the bristle divides by it.
pub(super) const LEAST_N: f64 = 1e-9;

/// One element of the Maxwell-slip model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct GmsElement {
    /// Share of the friction, α; the shares of all elements add up to 1.
    pub share: f64,
    /// Stiffness k.
    pub stiffness_n_per_m: f64,
}

/// The friction of one axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Friction {
    /// Coulomb friction Fc.
    pub coulomb_n: f64,
    /// Breakaway friction Fs.
    pub breakaway_n: f64,
    /// Stribeck velocity vs.
    pub stribeck_velocity_m_per_s: f64,
    /// Exponent δ of the Stribeck curve.
    pub shape: f64,
    /// Viscous friction fv.
    pub viscous_n_s_per_m: f64,
    /// Stiffness σ0 of the contact before it slides.
    pub stiffness_n_per_m: f64,
    /// Damping σ1 of the contact before it slides.
    pub damping_n_s_per_m: f64,
    /// Velocity vd above which that damping fades.
    pub damping_velocity_m_per_s: f64,
    /// The elements of the Maxwell-slip model.
    pub elements: Vec<GmsElement>,
    /// Rate at which slipping elements approach their share of the friction, C.
    pub attraction_n_per_s: f64,
    /// The part by which a sliding contact has more friction forwards, and less backwards.
    #[serde(skip)]
    pub asymmetry: f64,
}

impl Friction {
    /// Returns the friction in N of a contact that slides at this speed, without the viscous part:
    /// `g(v) = Fc + (Fs - Fc)·exp(-(|v|/vs)^δ)` of R5.11.
    #[inline]
    pub fn level_n(&self, speed_m_per_s: f64) -> f64 {
        let ratio = speed_m_per_s / self.stribeck_velocity_m_per_s;
        // Most drives have the exponent 1, and a power costs more than the rest of the step.
        #[allow(clippy::float_cmp)] // exactly the value that is written
        let power = if self.shape == 1.0 {
            ratio
        } else {
            raised(ratio, self.shape)
        };
        self.coulomb_n + (self.breakaway_n - self.coulomb_n) * fading(power)
    }

    /// Returns the friction at a velocity with its direction.
    #[inline]
    pub(super) fn level_towards_n(&self, velocity_m_per_s: f64) -> f64 {
        self.level_n(velocity_m_per_s.abs())
            * (1.0 + self.asymmetry * 1.0_f64.copysign(velocity_m_per_s))
    }

    /// Returns the friction in N at a constant velocity, `sign(v)·g(v) + fv·v` (R5.10); 0 at standstill.
    pub fn steady_n(&self, velocity_m_per_s: f64) -> f64 {
        if velocity_m_per_s == 0.0 {
            return 0.0;
        }
        self.level_towards_n(velocity_m_per_s)
            .copysign(velocity_m_per_s)
            + self.viscous_n_s_per_m * velocity_m_per_s
    }

    /// Returns the contact with more or less friction: every force of the curve times `factor`, the
    /// stiffness unchanged.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            coulomb_n: self.coulomb_n * factor,
            breakaway_n: self.breakaway_n * factor,
            viscous_n_s_per_m: self.viscous_n_s_per_m * factor,
            ..self.clone()
        }
    }

    /// Returns the damping `σ1·exp(-(v/vd)²)` in N·s/m, which fades with the velocity (R5.11).
    #[inline]
    pub(super) fn micro_damping(&self, velocity: f64) -> f64 {
        let ratio = velocity / self.damping_velocity_m_per_s;
        self.damping_n_s_per_m * fading(ratio * ratio)
    }
}

/// Returns `exp(-exponent)`, and 0 if it is below the digits of a force.
#[inline]
pub(super) fn fading(exponent: f64) -> f64 {
    const FADED: f64 = 40.0;
    if exponent > FADED {
        return 0.0;
    }
    (-exponent).exp()
}

/// Returns a separate function, so that it is computed only if needed.
#[cold]
#[inline(never)]
fn raised(ratio: f64, exponent: f64) -> f64 {
    ratio.powf(exponent)
}
