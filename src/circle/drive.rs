//! One feed drive: position loop, speed loop, current loop, mass and contact (chapter 5.2).

use serde::Serialize;

use super::friction::{Contact, Friction, FrictionModel, Push, STEP};

/// The cycle of the position loop in seconds.
pub const POSITION_LOOP: f64 = 250e-6;

/// The cycle of the speed loop in seconds.
pub const SPEED_LOOP: f64 = 125e-6;

/// Simulation steps in a cycle of the position loop.
pub const STEPS: usize = 4;

/// Simulation steps in a cycle of the speed loop.
const STEPS_PER_SPEED_LOOP: usize = 2;

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
    /// Force that the speed loop asked for a cycle ago, in N: the dead time.
    asked: f64,
    /// Integral part of the speed loop in N.
    integral: f64,
    /// What is left of a difference of forces after a step of the current loop.
    current_decay: f64,
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
            asked: force,
            integral: force - parameters.force_per_unit * setpoint.added,
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

    /// In how many cycles of the speed loop the force was cut.
    pub fn saturated(&self) -> u64 {
        self.saturated
    }

    /// A cycle of the position loop. Gives the positions in m after each simulation step.
    #[inline]
    pub fn advance(&mut self, setpoint: Setpoint) -> [f64; STEPS] {
        let drive = &self.parameters;
        let target = drive.position_gain * (setpoint.position - self.position)
            + drive.velocity_forward * setpoint.velocity;
        let forward = drive.acceleration_forward * drive.mass * setpoint.acceleration
            + drive.force_per_unit * setpoint.added;
        let per_mass = STEP / drive.mass;
        let mut positions = [0.0; STEPS];
        for steps in positions.chunks_exact_mut(STEPS_PER_SPEED_LOOP) {
            let command = self.asked;
            self.control(target, forward);
            for position in steps {
                self.force = command + (self.force - command) * self.current_decay;
                self.velocity = self.contact.push(Push {
                    velocity: self.velocity,
                    force: self.force,
                    per_mass,
                });
                self.position += STEP * self.velocity;
                *position = self.position;
            }
        }
        positions
    }

    /// A cycle of the speed loop: F = Kp·e + I + forward, cut to what the drive can give. The
    /// integral part stands still while it would drive the force further into its limit.
    #[inline]
    fn control(&mut self, target: f64, forward: f64) {
        let drive = &self.parameters;
        let error = target - self.velocity;
        let asked = drive.speed_gain * error + self.integral + forward;
        self.asked = asked.clamp(-drive.max_force, drive.max_force);
        let is_cut = asked.abs() > drive.max_force;
        if is_cut {
            self.saturated += 1;
        }
        if !is_cut || asked * error < 0.0 {
            self.integral += drive.speed_gain / drive.integral_time * SPEED_LOOP * error;
        }
    }
}
