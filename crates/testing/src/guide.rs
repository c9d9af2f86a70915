//! The friction of a guide way.

/// Friction of a guide way, by what a force gauge shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Guide {
    /// Friction of fast motion in N, without its viscous part.
    pub sliding_n: f64,
    /// Friction of very slow motion in N.
    pub sticking_n: f64,
    /// The speed in mm/s at which the difference between both has faded to 1/e.
    pub fading_mm_per_s: f64,
    /// Viscous friction in N for each mm/s.
    pub viscous_n_s_per_mm: f64,
    /// The contact before it slides.
    pub presliding: Presliding,
    /// The part by which friction forwards exceeds that backwards, half of it on each side.
    pub asymmetry: f64,
}

/// The motion of a contact before it slides.
#[derive(Debug, Clone, PartialEq)]
pub enum Presliding {
    /// A bristle (Canudas de Wit et al., 1995).
    Bristle {
        /// The deflection in µm at which it slides with the friction of fast motion.
        um: f64,
        /// Damping as a part of the aperiodic one of mass and bristle.
        damping: f64,
        /// The speed in mm/s at which the damping has faded to 1/e.
        damped_to_mm_per_s: f64,
    },
    /// Springs that slip one after another (Maxwell, Iwan): for each the deflection in µm at which it slips, and
    /// its share of the friction.
    Springs(Vec<[f64; 2]>),
    /// A spring that becomes softer (Dahl, 1968), with the deflection in µm as for the bristle.
    Softening {
        /// The deflection.
        um: f64,
    },
}

/// The state of a contact.
#[derive(Debug, Clone)]
pub(crate) struct Contact<'a> {
    guide: &'a Guide,
    /// The deflections in m: of the bristle, or of each spring.
    deflections: Vec<f64>,
    damping: f64,
}

const M_PER_UM: f64 = 1e-6;

impl<'a> Contact<'a> {
    /// Returns the contact of a mass at rest that has never moved.
    pub(crate) fn new(guide: &'a Guide, mass_kg: f64) -> Self {
        let count = match &guide.presliding {
            Presliding::Springs(springs) => springs.len(),
            _ => 1,
        };
        let damping = match guide.presliding {
            Presliding::Bristle { um, damping, .. } => {
                2.0 * damping * (guide.sliding_n / (um * M_PER_UM) * mass_kg).sqrt()
            }
            _ => 0.0,
        };
        Self {
            guide,
            deflections: vec![0.0; count],
            damping,
        }
    }

    /// Returns the friction in N at a speed in m/s that lasts for a step in s.
    pub(crate) fn force(&mut self, speed: f64, step: f64) -> f64 {
        let guide = self.guide;
        let mm_per_s = speed * 1000.0;
        let fading = (-mm_per_s.abs() / guide.fading_mm_per_s).exp();
        let side = 1.0 + guide.asymmetry / 2.0 * speed.signum();
        let level = side * (guide.sliding_n + (guide.sticking_n - guide.sliding_n) * fading);
        let viscous = guide.viscous_n_s_per_mm * mm_per_s;
        match &guide.presliding {
            Presliding::Bristle {
                um,
                damped_to_mm_per_s,
                ..
            } => {
                let stiffness = guide.sliding_n / (um * M_PER_UM);
                let rate = stiffness * speed.abs() / level;
                // Trapezoidal rule, which no stiffness makes unstable.
                let before = self.deflections[0];
                let half = rate * step / 2.0;
                let after = ((1.0 - half) * before + speed * step) / (1.0 + half);
                let after = after.clamp(-level / stiffness, level / stiffness);
                self.deflections[0] = after;
                let bending = speed - rate * f64::midpoint(before, after);
                let faded = (-(mm_per_s / damped_to_mm_per_s).powi(2)).exp();
                stiffness * after + self.damping * faded * bending + viscous
            }
            Presliding::Springs(springs) => {
                let mut force = viscous;
                for (deflection, [um, share]) in self.deflections.iter_mut().zip(springs) {
                    let stiffness = share * guide.sliding_n / (um * M_PER_UM);
                    let most = share * level / stiffness;
                    *deflection = (*deflection + speed * step).clamp(-most, most);
                    force += stiffness * *deflection;
                }
                force
            }
            Presliding::Softening { um } => {
                let stiffness = guide.sliding_n / (um * M_PER_UM);
                let before = self.deflections[0] * stiffness / level;
                let rate = 1.0 - before * speed.signum();
                let after = before + stiffness / level * speed * step * rate;
                let after = after.clamp(-1.0, 1.0);
                self.deflections[0] = after * level / stiffness;
                after * level + viscous
            }
        }
    }
}

impl Guide {
    /// Returns friction in N at a steady speed in mm/s.
    pub fn steady_n(&self, mm_per_s: f64) -> f64 {
        let fading = (-mm_per_s.abs() / self.fading_mm_per_s).exp();
        self.sliding_n
            + (self.sticking_n - self.sliding_n) * fading
            + self.viscous_n_s_per_mm * mm_per_s.abs()
    }
}
