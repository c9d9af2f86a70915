//! One feed drive: position loop, speed loop, current loop, mass and contact (chapter 5.2).

use super::clock::{SPEED_LOOP_S, STEP_S};
use super::coupling::DeadZone;
use super::friction::{Contact, FrictionModel, Push};
use super::parameters::DriveParameters;
use super::stiction::Stiction;
use crate::stiction::StictionParameters;

/// Setpoint of a drive from the fine interpolation, in a cycle of the position loop.
#[derive(Debug, Clone, Copy, Default)]
pub struct Setpoint {
    /// Position.
    pub position_m: f64,
    /// Velocity.
    pub velocity_m_per_s: f64,
    /// Acceleration.
    pub acceleration_m_per_s2: f64,
    /// Additive current in drive units.
    pub added_units: f64,
}

/// A feed drive with its state.
#[derive(Debug, Clone)]
pub struct Drive {
    parameters: DriveParameters,
    contact: Contact,
    coupling: DeadZone,
    /// Stiction compensation, if it acts.
    stiction: Option<Stiction>,
    /// Position of the motor in m; the position loop measures it.
    position: f64,
    /// Velocity in m/s.
    velocity: f64,
    /// Force of the motor in N.
    force: f64,
    /// Velocity in m/s that the position loop demands.
    target: f64,
    /// Force in N of the feed forward and the additive current.
    forward: f64,
    /// Force in N that the speed loop demanded last.
    asked: f64,
    /// Force in N that it demanded a cycle before: the dead time.
    command: f64,
    /// Integral part of the speed loop in N.
    integral: f64,
    /// Increment of the integral part by a velocity error of 1 m/s in a cycle, in N.
    integral_gain: f64,
    /// Rest of a difference of forces after a step of the current loop.
    current_decay: f64,
    /// The step divided by the mass, in s/kg.
    per_mass: f64,
    /// Cycles of the speed loop in which the force was limited.
    saturated: u64,
}

impl Drive {
    /// Returns a drive that has followed the setpoint for a long time: force and integral part carry the friction of
    /// its velocity.
    pub fn settled(parameters: &DriveParameters, model: FrictionModel, setpoint: Setpoint) -> Self {
        let friction = &parameters.friction;
        let force = friction.steady_n(setpoint.velocity_m_per_s);
        Self {
            contact: Contact::settled(friction, model, setpoint.velocity_m_per_s),
            coupling: DeadZone::settled(
                parameters.backlash_m,
                setpoint.position_m,
                setpoint.velocity_m_per_s,
            ),
            stiction: None,
            position: setpoint.position_m,
            velocity: setpoint.velocity_m_per_s,
            force,
            target: setpoint.velocity_m_per_s,
            forward: 0.0,
            asked: force,
            command: force,
            integral: force - parameters.force_per_unit_n * setpoint.added_units,
            integral_gain: parameters.speed_gain_n_s_per_m / parameters.integral_time_s
                * SPEED_LOOP_S,
            per_mass: STEP_S / parameters.mass_kg,
            current_decay: (-STEP_S / parameters.current_time_s).exp(),
            saturated: 0,
            parameters: parameters.clone(),
        }
    }

    /// Returns the drive with stiction compensation, which acts only with velocity feed forward (R8.2).
    #[must_use]
    pub fn with_stiction(mut self, parameters: &StictionParameters) -> Self {
        let drive = &self.parameters;
        self.stiction = (drive.velocity_forward > 0.0)
            .then(|| Stiction::new(parameters, drive.position_gain_per_s, 0.0));
        self
    }

    /// Returns the position of the motor; that of the load differs by at most half of the backlash.
    pub fn position_m(&self) -> f64 {
        self.position
    }

    /// Returns the velocity of the axis.
    pub fn velocity_m_per_s(&self) -> f64 {
        self.velocity
    }

    /// Returns the force of the motor; at constant velocity that is the friction.
    pub fn force_n(&self) -> f64 {
        self.force
    }

    /// Returns the number of cycles of the speed loop in which the force was limited.
    pub fn saturated_cycles(&self) -> u64 {
        self.saturated
    }

    /// Begins a cycle of the position loop: the velocity `Kv·(x_set - x) + k_ff·v_set`, plus the
    /// stiction compensation, is demanded from the speed loop; the force `k_a·m·a_set + k_I·I_added`
    /// is added to its output.
    #[inline]
    pub fn follow(&mut self, setpoint: Setpoint) {
        let drive = &self.parameters;
        let lag = setpoint.position_m - self.position;
        self.target =
            drive.position_gain_per_s * lag + drive.velocity_forward * setpoint.velocity_m_per_s;
        if let Some(stiction) = &mut self.stiction {
            self.target += stiction.added(lag);
        }
        self.forward = drive.acceleration_forward * drive.mass_kg * setpoint.acceleration_m_per_s2
            + drive.force_per_unit_n * setpoint.added_units;
    }

    /// Begins a cycle of the speed loop: `F = Kp·e + I + forward`, limited to the force of the drive.
    /// The integral part waits while it would drive the force further into its limit. The
    /// motor gets the force that was demanded a cycle ago.
    #[inline]
    pub fn control(&mut self) {
        self.command = self.asked;
        let drive = &self.parameters;
        let error = self.target - self.velocity;
        let asked = drive.speed_gain_n_s_per_m * error + self.integral + self.forward;
        self.asked = asked.clamp(-drive.max_force_n, drive.max_force_n);
        let is_cut = asked.abs() > drive.max_force_n;
        if is_cut {
            self.saturated += 1;
        }
        if !is_cut || asked * error < 0.0 {
            self.integral += self.integral_gain * error;
        }
    }

    /// Advances a simulation by a step: first the current loop, exactly, then the velocity, then the position. Returns
    /// the position of the load in m at its end.
    #[inline]
    pub fn step(&mut self) -> f64 {
        self.force = self.command + (self.force - self.command) * self.current_decay;
        self.velocity = self.contact.push(Push {
            velocity: self.velocity,
            force: self.force,
            per_mass: self.per_mass,
        });
        self.position += STEP_S * self.velocity;
        self.coupling.follow(self.position)
    }
}
