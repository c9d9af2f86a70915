//! A feed axis: loops, one mass or two, and a guide way.

use super::guide::{Contact, Guide};
use super::random::Random;

/// The step of the mechanics in s.
const STEP_S: f64 = 31.25e-6;

/// Steps in a cycle of the speed loop and of the position loop: 125 µs and 250 µs.
const OF_SPEED: u32 = 4;
const OF_POSITION: u32 = 8;

/// A feed axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The moved mass in kg, with the motor as seen from the load.
    pub mass_kg: f64,
    /// The second mass, if motor and load are coupled by a spring.
    pub coupling: Option<Coupling>,
    /// The guide way, under the load.
    pub guide: Guide,
    /// Kv in 1/s.
    pub kv: f64,
    /// The part of the commanded velocity that is fed forward.
    pub forward: f64,
    /// The bandwidth of the speed loop in Hz: its gain is the mass times it.
    pub bandwidth_hz: f64,
    /// The reset time of the speed loop in s.
    pub reset_s: f64,
    /// The time constant of the current loop in s.
    pub current_loop_s: f64,
    /// Cycles of the speed loop by which the force is late.
    pub dead_cycles: usize,
    /// N of a drive unit.
    pub unit_n: f64,
    /// Weight in N, against the positive direction.
    pub weight_n: f64,
    /// Cogging: its amplitude in N, and its pitch in mm.
    pub cogging: (f64, f64),
    /// Backlash between motor and load in µm.
    pub backlash_um: f64,
    /// Largest force in N.
    pub most_n: f64,
}

/// A spring between motor and load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coupling {
    /// The part of the mass that is on the side of the motor.
    pub motor_part: f64,
    /// The stiffness in N/µm.
    pub n_per_um: f64,
    /// Damping as a part of the aperiodic one.
    pub damping: f64,
}

/// Record of the motion of an axis in each cycle of the control.
#[derive(Debug, Clone, Default)]
pub(crate) struct Followed {
    /// Place of the load in mm at the beginning of each cycle.
    pub(crate) load_mm: Vec<f64>,
    /// Place of the motor.
    pub(crate) motor_mm: Vec<f64>,
    /// Force in drive units.
    pub(crate) units: Vec<f64>,
}

impl Axis {
    /// Follows commanded places in mm, one for each cycle in s, with an added current in drive units.
    pub(crate) fn follow(&self, places: &[f64], added: &[f64], cycle_s: f64) -> Followed {
        let steps = (cycle_s / STEP_S).round() as u32;
        let (mass, load_mass) = match self.coupling {
            Some(it) => (
                self.mass_kg * it.motor_part,
                self.mass_kg * (1.0 - it.motor_part),
            ),
            None => (self.mass_kg, 0.0),
        };
        let gain = self.mass_kg * std::f64::consts::TAU * self.bandwidth_hz;
        let decay = (-STEP_S / self.current_loop_s).exp();
        let mut contact = Contact::new(&self.guide, self.mass_kg);
        let [mut x, mut v] = [places[0] / 1000.0, 0.0];
        let [mut load_x, mut load_v] = [x, v];
        let mut table = x;
        let [mut force, mut asked, mut target] = [self.weight_n; 3];
        let mut integral = self.weight_n;
        let mut waiting = vec![self.weight_n; self.dead_cycles + 1];
        let mut found = Followed::default();
        for (at, &place) in places.iter().enumerate() {
            let next = places.get(at + 1).copied().unwrap_or(place);
            let velocity = (next - place) / 1000.0 / cycle_s;
            let added_n = self.unit_n * added.get(at).copied().unwrap_or(0.0);
            let seen = if self.coupling.is_some() { load_x } else { x };
            let half = self.backlash_um * 0.5e-6;
            table = table.clamp(seen - half, seen + half);
            found.load_mm.push(table * 1000.0);
            found.motor_mm.push(x * 1000.0);
            found.units.push(force / self.unit_n);
            for step in 0..steps {
                if step % OF_POSITION == 0 {
                    let there = place / 1000.0 + velocity * f64::from(step) * STEP_S;
                    target = self.kv * (there - x) + self.forward * velocity;
                }
                if step % OF_SPEED == 0 {
                    let error = target - v;
                    let wanted = gain * error + integral + added_n;
                    waiting.push(wanted.clamp(-self.most_n, self.most_n));
                    asked = waiting.remove(0);
                    if wanted.abs() < self.most_n || wanted * error < 0.0 {
                        integral += gain / self.reset_s * error * f64::from(OF_SPEED) * STEP_S;
                    }
                }
                // Half a step of the place, the forces, the other half.
                x += v * STEP_S / 2.0;
                force = asked + (force - asked) * decay;
                let (amplitude, pitch) = self.cogging;
                let cogging = amplitude * (std::f64::consts::TAU * x * 1000.0 / pitch).sin();
                let load = self.weight_n + cogging;
                match self.coupling {
                    None => v += (force - load - contact.force(v, STEP_S)) / mass * STEP_S,
                    Some(it) => {
                        load_x += load_v * STEP_S / 2.0;
                        let stiffness = it.n_per_um * 1e6;
                        let damping =
                            2.0 * it.damping * (stiffness * mass * load_mass / self.mass_kg).sqrt();
                        let between = stiffness * (x - load_x) + damping * (v - load_v);
                        v += (force - between) / mass * STEP_S;
                        load_v +=
                            (between - load - contact.force(load_v, STEP_S)) / load_mass * STEP_S;
                        load_x += load_v * STEP_S / 2.0;
                    }
                }
                x += v * STEP_S / 2.0;
            }
        }
        found
    }

    /// Returns a steady friction in drive units at a speed in mm/s.
    pub fn friction_units(&self, mm_per_s: f64) -> f64 {
        self.guide.steady_n(mm_per_s) / self.unit_n
    }

    /// Returns friction that has changed by a part, as with the temperature.
    #[must_use]
    pub fn with_friction(mut self, factor: f64) -> Self {
        self.guide.sliding_n *= factor;
        self.guide.sticking_n *= factor;
        self.guide.viscous_n_s_per_mm *= factor;
        // The bristle stays as stiff as it is.
        match &mut self.guide.presliding {
            super::guide::Presliding::Bristle { um, .. }
            | super::guide::Presliding::Softening { um } => *um *= factor,
            super::guide::Presliding::Springs(springs) => {
                for spring in springs {
                    spring[0] *= factor;
                }
            }
        }
        self
    }

    /// Returns the axis of another machine of the same kind: every value differs by up to a part.
    #[must_use]
    pub fn varied(mut self, part: f64, random: &mut Random) -> Self {
        let mut factor = || random.between(1.0 - part, 1.0 + part);
        self.mass_kg *= factor();
        self.bandwidth_hz *= factor();
        let friction = factor();
        self.with_friction(friction)
    }
}
