//! One feed drive: position loop, speed loop, current loop, mass and contact (chapter 5.2).

use serde::Serialize;

use super::friction::{Contact, Friction, FrictionModel, Push, STEP};

/// The cycle of the position loop in seconds.
pub const POSITION_LOOP: f64 = 250e-6;

/// The cycle of the speed loop in seconds.
pub const SPEED_LOOP: f64 = 125e-6;

/// Cycles of the speed loop in one of the position loop.
pub(super) const SPEED_LOOPS: usize = 2;

/// Simulation steps in a cycle of the speed loop.
pub(super) const STEPS: usize = 2;

/// The parameters of one feed drive, in SI units.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DriveParameters {
    /// Moved mass m in kg.
    pub mass: f64,
    /// Gain of the position loop Kv in 1/s.
    pub position_gain: f64,
    /// Gain of the speed loop Kp in N·s/m.
    pub speed_gain: f64,
    /// Integral time of the speed loop Ti in s.
    pub integral_time: f64,
    /// Time constant of the current loop Tt in s.
    pub current_time: f64,
    /// Velocity feed forward, 1 for all of it.
    pub velocity_forward: f64,
    /// Acceleration feed forward, 1 for all of it.
    pub acceleration_forward: f64,
    /// Force in N of one drive unit of additive current.
    pub force_per_unit: f64,
    /// The force in N that the drive can give.
    pub max_force: f64,
    /// The friction of the guideway.
    pub friction: Friction,
}

/// What the fine interpolation asks of a drive in a cycle of the position loop.
#[derive(Debug, Clone, Copy, Default)]
pub struct Setpoint {
    /// Position in m.
    pub position: f64,
    /// Velocity in m/s.
    pub velocity: f64,
    /// Acceleration in m/s².
    pub acceleration: f64,
    /// Additive current in drive units.
    pub added: f64,
}

/// A feed drive with its state.
#[derive(Debug, Clone)]
pub struct Drive {
    parameters: DriveParameters,
    contact: Contact,
    /// Position of the axis in m.
    position: f64,
    /// Velocity in m/s.
    velocity: f64,
    /// Force of the motor in N.
    force: f64,
    /// Velocity in m/s that the position loop asks for.
    target: f64,
    /// Force in N of the feed forward and the additive current.
    forward: f64,
    /// Force in N that the speed loop asked for last.
    asked: f64,
    /// Force in N that it asked for a cycle before: the dead time.
    command: f64,
    /// Integral part of the speed loop in N.
    integral: f64,
    /// What a velocity error of 1 m/s adds to the integral part in a cycle, in N.
    integral_gain: f64,
    /// What is left of a difference of forces after a step of the current loop.
    current_decay: f64,
    /// The step divided by the mass, in s/kg.
    per_mass: f64,
    /// Cycles of the speed loop in which the force was cut.
    saturated: u64,
}

impl Drive {
    /// A drive that has followed the setpoint for long: force and integral part carry the
    /// friction of its velocity.
    pub fn settled(parameters: &DriveParameters, model: FrictionModel, setpoint: Setpoint) -> Self {
        let friction = &parameters.friction;
        let force = friction.steady(setpoint.velocity);
        Self {
            contact: Contact::settled(friction, model, setpoint.velocity),
            position: setpoint.position,
            velocity: setpoint.velocity,
            force,
            target: setpoint.velocity,
            forward: 0.0,
            asked: force,
            command: force,
            integral: force - parameters.force_per_unit * setpoint.added,
            integral_gain: parameters.speed_gain / parameters.integral_time * SPEED_LOOP,
            per_mass: STEP / parameters.mass,
            current_decay: (-STEP / parameters.current_time).exp(),
            saturated: 0,
            parameters: parameters.clone(),
        }
    }

    /// Position of the axis in m.
    pub fn position(&self) -> f64 {
        self.position
    }

    /// Velocity of the axis in m/s.
    pub fn velocity(&self) -> f64 {
        self.velocity
    }

    /// Force of the motor in N; at constant velocity that is the friction.
    pub fn force(&self) -> f64 {
        self.force
    }

    /// In how many cycles of the speed loop the force was cut.
    pub fn saturated(&self) -> u64 {
        self.saturated
    }

    /// Begins a cycle of the position loop.
    #[inline]
    pub fn follow(&mut self, setpoint: Setpoint) {
        let drive = &self.parameters;
        self.target = drive.position_gain * (setpoint.position - self.position)
            + drive.velocity_forward * setpoint.velocity;
        self.forward = drive.acceleration_forward * drive.mass * setpoint.acceleration
            + drive.force_per_unit * setpoint.added;
    }

    /// Begins a cycle of the speed loop: F = Kp·e + I + forward, cut to what the drive can give. The
    /// integral part stands still while it would drive the force further into its limit. The motor
    /// gets what was asked a cycle ago.
    #[inline]
    pub fn control(&mut self) {
        self.command = self.asked;
        let drive = &self.parameters;
        let error = self.target - self.velocity;
        let asked = drive.speed_gain * error + self.integral + self.forward;
        self.asked = asked.clamp(-drive.max_force, drive.max_force);
        let is_cut = asked.abs() > drive.max_force;
        if is_cut {
            self.saturated += 1;
        }
        if !is_cut || asked * error < 0.0 {
            self.integral += self.integral_gain * error;
        }
    }

    /// A simulation step. Gives the position in m at its end.
    #[inline]
    pub fn step(&mut self) -> f64 {
        self.force = self.command + (self.force - self.command) * self.current_decay;
        self.velocity = self.contact.push(Push {
            velocity: self.velocity,
            force: self.force,
            per_mass: self.per_mass,
        });
        self.position += STEP * self.velocity;
        self.position
    }
}
