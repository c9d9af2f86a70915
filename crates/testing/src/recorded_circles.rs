//! Recordings of an axis that drives circles, made without the crate: the additive current of chapter 4,
//! the loops and the bristle of chapter 5.2, then the noise of an encoder and the resolution of a drive.

use std::f64::consts::TAU;

use crate::recorded_drive::Noise;

/// The CNC cycle in s, and the time between two rows.
const CYCLE_S: f64 = 0.001;

/// The recorded drive.
#[derive(Debug, Clone, Copy)]
pub struct Bench {
    /// Stiffness of the bristle in N/m.
    pub stiffness: f64,
    /// Mass in kg.
    pub mass: f64,
    /// Gain of the position loop in 1/s.
    pub kv: f64,
    /// Bandwidth of the speed loop in Hz.
    pub bandwidth: f64,
    /// Reset time of the speed loop in s.
    pub reset_s: f64,
    /// Time constant of the current loop in s.
    pub current_loop_s: f64,
    /// Feed in mm/min.
    pub feed: f64,
    /// Radius in mm.
    pub radius_mm: f64,
    /// Number of turns.
    pub turns: f64,
    /// Part of the current of the list that acts.
    pub share: f64,
    /// Cycles before a reversal in which the current falls.
    pub lookahead: usize,
    /// Cycles by which the current is late.
    pub delay: usize,
    /// Noise of the recorded position in µm, and of the torque in units.
    pub noise: (f64, f64),
    /// Seed of the noise.
    pub seed: u64,
}

/// A stiff machine tool.
pub const STIFF: Bench = Bench {
    stiffness: 1e9,
    mass: 1300.0,
    kv: 33.3,
    bandwidth: 45.0,
    reset_s: 0.012,
    current_loop_s: 0.0006,
    feed: 3000.0,
    radius_mm: 30.0,
    turns: 2.2,
    share: 1.0,
    lookahead: 2,
    delay: 1,
    noise: (0.0, 0.0),
    seed: 1,
};

/// A machine tool of medium stiffness.
pub const MID: Bench = Bench {
    stiffness: 3e8,
    ..STIFF
};

/// A soft machine tool.
pub const SOFT: Bench = Bench {
    stiffness: 8e7,
    ..STIFF
};

/// A fast machine tool.
pub const FAST: Bench = Bench {
    kv: 60.0,
    bandwidth: 80.0,
    reset_s: 0.006,
    current_loop_s: 0.0003,
    ..MID
};

/// A slow one.
pub const SLOW: Bench = Bench {
    kv: 20.0,
    bandwidth: 25.0,
    reset_s: 0.03,
    current_loop_s: 0.0015,
    ..MID
};

/// N per drive unit.
const UNIT: f64 = 5.0;

/// µm after a reversal in which the current of the list builds up.
const BUILD_UP: f64 = 0.9;

/// Columns in the units of lists and traces.
#[derive(Debug, Default)]
pub struct Recorded {
    /// Times in s.
    pub t: Vec<f64>,
    /// Commanded velocities in µm/s.
    pub v: Vec<f64>,
    /// Commanded positions in 0.1 µm.
    pub x: Vec<f64>,
    /// Torques in drive units.
    pub torque: Vec<f64>,
    /// Commanded less actual position.
    pub error: Vec<f64>,
}

/// Returns the friction that slips at a speed in m/s, in N.
fn level(speed: f64) -> f64 {
    500.0 + 120.0 * (-speed.abs() / 0.003).exp()
}

/// Returns the friction at a steady speed in m/s, in drive units: the contents of the list.
pub fn units_at(speed: f64) -> f64 {
    (level(speed) + 4000.0 * speed.abs()) / UNIT
}

impl Bench {
    /// Returns commanded positions in m and velocities in m/s.
    fn commanded(&self) -> Vec<(f64, f64)> {
        let radius = self.radius_mm / 1000.0;
        let omega = self.feed / 60_000.0 / radius;
        let cycles = (self.turns * TAU / omega / CYCLE_S) as usize;
        let at = |cycle: usize| {
            let angle = omega * cycle as f64 * CYCLE_S + 0.4;
            (radius * angle.cos(), -radius * omega * angle.sin())
        };
        (0..=cycles).map(at).collect()
    }

    /// Returns the current of the whole list, cycle by cycle.
    fn currents(&self, motion: &[(f64, f64)]) -> Vec<f64> {
        let (mut direction, mut turned_at, mut is_building) = (0.0, 0.0, false);
        let mut raw = Vec::new();
        for (at, &(place, velocity)) in motion.iter().enumerate() {
            if velocity.signum() * direction <= 0.0 {
                direction = velocity.signum();
                turned_at = motion[at.saturating_sub(1)].0;
                is_building = true;
            }
            let way = (place - turned_at).abs() * 1e6;
            is_building &= way < BUILD_UP;
            let built = if is_building { way / BUILD_UP } else { 1.0 };
            let later = motion[at + 1..].iter().take(self.lookahead);
            let until = later
                .enumerate()
                .find(|(_, it)| it.1 * direction < 0.0)
                .map(|it| it.0);
            let left = until.map_or(1.0, |it| it as f64 / self.lookahead as f64);
            raw.push(direction * units_at(velocity) * built.min(left));
        }
        let late = |at: usize| at.checked_sub(self.delay).map_or(0.0, |it| raw[it]);
        (0..raw.len()).map(late).collect()
    }

    /// Returns a recording of the circles.
    pub fn record(&self) -> Recorded {
        const STEP: f64 = 62.5e-6;
        let kp = self.mass * TAU * self.bandwidth;
        let decay = (-STEP / self.current_loop_s).exp();
        let motion = self.commanded();
        let added = self.currents(&motion);
        let mut random = Noise::of_seed(self.seed);
        let (mut x, mut v) = motion[0];
        let steady = units_at(v) * UNIT * v.signum();
        let mut z = level(v) / self.stiffness * v.signum();
        let (mut force, mut asked, mut command, mut target) = (steady, steady, steady, v);
        let mut integral = steady - self.share * UNIT * added[0];
        let mut recorded = Recorded::default();
        for (at, pair) in motion.windows(2).enumerate() {
            let ((from, velocity), to) = (pair[0], pair[1].0);
            let (of_place, of_torque) = self.noise;
            let error = (from - x) * 1e7 + 10.0 * of_place * random.normal();
            let torque = force / UNIT + of_torque * random.normal();
            recorded.t.push(at as f64 * CYCLE_S);
            recorded.v.push(velocity * 1e6);
            recorded.x.push(from * 1e7);
            recorded.error.push((error * 10.0).round() / 10.0);
            recorded.torque.push(torque.round());
            for step in 0..16 {
                if step % 4 == 0 {
                    let place = from + (to - from) * f64::from(step) / 16.0;
                    target = self.kv * (place - x) + (to - from) / CYCLE_S;
                }
                if step % 2 == 0 {
                    command = asked;
                    asked = kp * (target - v) + integral + self.share * UNIT * added[at];
                    integral += kp / self.reset_s * 125e-6 * (target - v);
                }
                force = command + (force - command) * decay;
                let loss = self.stiffness * v.abs() / level(v);
                if v != 0.0 {
                    let steady = level(v) / self.stiffness * v.signum();
                    z = steady + (z - steady) * (-loss * STEP).exp();
                }
                let damping =
                    0.6 * (self.stiffness * self.mass).sqrt() * (-(v / 0.002).powi(2)).exp();
                let friction = self.stiffness * z + damping * (v - loss * z) + 4000.0 * v;
                v += (force - friction) / self.mass * STEP;
                x += v * STEP;
            }
        }
        recorded
    }
}
