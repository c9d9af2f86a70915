//! Recordings of a closed-loop feed drive, made without the crate: position loop, speed loop, current
//! loop, mass, a bristle with Stribeck friction, weight, asymmetry, ripple along the travel; then noise
//! and the resolution of the drive.

/// The recorded drive.
#[derive(Debug, Clone)]
pub struct Bench {
    /// Seed of the noise.
    pub seed: u64,
    /// Standard deviation of the noise in N.
    pub noise_n: f64,
    /// Time constant of the noise in s, 0 for white noise.
    pub colour_s: f64,
    /// Amplitude of the ripple along the travel in N.
    pub ripple_n: f64,
    /// The part by which friction changes over the recording.
    pub drift: f64,
    /// Noise of the recorded velocity in mm/s; with any, the actual velocity is recorded.
    pub velocity_noise: Option<f64>,
    /// Viscous friction grows less than in proportion.
    pub is_concave: bool,
    /// Whether the speeds are driven upwards, then downwards.
    pub is_up_and_down: bool,
    /// Speeds in mm/s.
    pub speeds: Vec<f64>,
    /// Whether both directions are recorded, or only forwards.
    pub is_both: bool,
    /// Length of the recording in s.
    pub length_s: f64,
}

/// Coulomb friction in N.
pub const FC: f64 = 512.5;
/// Static friction in N.
pub const FS: f64 = 632.5;
/// Stribeck velocity in mm/s.
pub const VS: f64 = 3.0;
/// Viscous friction in N per mm/s.
pub const FV: f64 = 4.0;
/// Weight in N.
pub const WEIGHT: f64 = 150.0;
/// Difference of friction between the directions in N.
pub const ASYMMETRY: f64 = 25.0;
/// N per drive unit.
pub const UNIT: f64 = 5.0;

impl Default for Bench {
    fn default() -> Self {
        Self {
            seed: 1,
            noise_n: 100.0,
            colour_s: 0.0,
            ripple_n: 20.0,
            drift: 0.0,
            velocity_noise: None,
            is_concave: false,
            is_up_and_down: false,
            speeds: (0..14)
                .map(|at| 0.2 * 1000_f64.powf(f64::from(at) / 13.0))
                .collect(),
            is_both: true,
            length_s: 117.0,
        }
    }
}

/// Columns in the units of lists and traces.
#[derive(Debug, Clone, Default)]
pub struct Recorded {
    /// Times in s.
    pub t: Vec<f64>,
    /// Velocities in µm/s.
    pub v: Vec<f64>,
    /// Actual positions in 0.1 µm.
    pub x: Vec<f64>,
    /// Commanded positions.
    pub commanded: Vec<f64>,
    /// Torques in drive units.
    pub torque: Vec<f64>,
}

/// Random numbers of the noise.
pub(crate) struct Noise(u64);

impl Noise {
    pub(crate) fn of_seed(seed: u64) -> Self {
        let mut noise = Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        for _ in 0..20 {
            noise.uniform();
        }
        noise
    }

    fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * self.uniform().max(1e-300).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

impl Bench {
    /// Returns the friction in N at a speed in mm/s.
    pub fn friction(&self, speed: f64) -> f64 {
        Self::level(speed) + self.viscous(speed)
    }

    fn level(speed: f64) -> f64 {
        FC + (FS - FC) * (-speed / VS).exp()
    }

    fn viscous(&self, speed: f64) -> f64 {
        if self.is_concave {
            FV * 60.0 * ((speed / 60.0 + 0.0025).powf(0.6) - 0.0025_f64.powf(0.6))
        } else {
            FV * speed
        }
    }

    /// Returns the commanded velocities in mm/s, one per millisecond.
    pub fn commanded(&self) -> Vec<f64> {
        const ACCELERATION: f64 = 1000.0;
        const PAUSE: usize = 100;
        let mut plan = self.speeds.clone();
        if self.is_up_and_down {
            plan.extend(self.speeds.iter().rev());
        }
        let signs: &[f64] = if self.is_both { &[1.0, -1.0] } else { &[1.0] };
        let moves = (plan.len() * signs.len()) as f64;
        let ramps: f64 =
            plan.iter().map(|v| 2.0 * v / ACCELERATION).sum::<f64>() * signs.len() as f64;
        let steady = (self.length_s - ramps - 0.001 * PAUSE as f64 * moves) / moves;
        let mut v = Vec::new();
        for speed in &plan {
            for sign in signs {
                let ramp = (speed / ACCELERATION * 1000.0).ceil() as usize;
                let rising = (0..ramp).map(|at| sign * speed * at as f64 / ramp as f64);
                let rising: Vec<f64> = rising.collect();
                v.extend(&rising);
                v.extend(std::iter::repeat_n(
                    sign * speed,
                    (steady * 1000.0) as usize,
                ));
                v.extend(rising.iter().rev());
                v.extend(std::iter::repeat_n(0.0, PAUSE));
            }
        }
        v
    }

    /// Returns a recording of the speeds.
    pub fn record(&self) -> Recorded {
        self.record_along(&self.commanded())
    }

    /// Returns a recording of an axis that follows velocities in mm/s.
    pub fn record_along(&self, commanded: &[f64]) -> Recorded {
        self.record_with(commanded, &[])
    }

    /// Returns a recording with a current in drive units that the control adds at each velocity.
    pub fn record_with(&self, commanded: &[f64], added: &[f64]) -> Recorded {
        const STEP: f64 = 62.5e-6;
        const MASS: f64 = 1300.0;
        const KV: f64 = 33.3;
        const TI: f64 = 0.012;
        const STIFFNESS: f64 = 1e9;
        let kp = MASS * std::f64::consts::TAU * 45.0;
        let decay = (-STEP / 0.0006_f64).exp();
        let mut random = Noise::of_seed(self.seed);
        let (mut x, mut v, mut z) = (0.0_f64, 0.0_f64, 0.0_f64);
        let (mut force, mut asked, mut command, mut integral) = (0.0, 0.0, 0.0, 0.0);
        let (mut target, mut reference, mut noise) = (0.0, 0.0, 0.0);
        let mut recorded = Recorded::default();
        for (at, &speed) in commanded.iter().enumerate() {
            let progress = at as f64 / commanded.len() as f64 - 0.5;
            let factor = 1.0 + self.drift * progress;
            let added_n = UNIT * added.get(at).copied().unwrap_or(0.0);
            let before: f64 = reference;
            let way = speed * 1e-6;
            reference += way;
            for step in 0..16 {
                if step % 4 == 0 {
                    let place = before + way * f64::from(step) / 16.0;
                    target = KV * (place - x) + speed * 1e-3;
                }
                if step % 2 == 0 {
                    command = asked;
                    let error = target - v;
                    asked = (kp * error + integral).clamp(-20_000.0, 20_000.0);
                    integral += kp / TI * 125e-6 * error;
                }
                let wanted = command + added_n;
                force = wanted + (force - wanted) * decay;
                let level = Self::level(v.abs() * 1e3) * factor;
                if v != 0.0 {
                    let steady = level / STIFFNESS * v.signum();
                    z = steady + (z - steady) * (-STIFFNESS * v.abs() / level * STEP).exp();
                }
                let sliding = (z * STIFFNESS / level).clamp(-1.0, 1.0);
                let viscous = self.viscous(v.abs() * 1e3) * factor * v.signum();
                let ripple = self.ripple_n * (std::f64::consts::TAU * x * 1e3 / 10.0).sin();
                let load = WEIGHT + ASYMMETRY * sliding.abs() + ripple;
                v += STEP / MASS * (force - STIFFNESS * z - viscous - load);
                x += STEP * v;
            }
            noise = if self.colour_s > 0.0 {
                let kept = (-0.001 / self.colour_s).exp();
                kept * noise + (1.0 - kept * kept).sqrt() * random.normal()
            } else {
                random.normal()
            };
            recorded.t.push(at as f64 * 0.001);
            recorded
                .torque
                .push(((force + self.noise_n * noise) / UNIT).round());
            recorded.v.push(match self.velocity_noise {
                Some(noise) => v * 1e6 + noise * 1e3 * random.normal(),
                None => speed * 1e3,
            });
            recorded.x.push(x * 1e7);
            recorded.commanded.push(reference * 1e7);
        }
        recorded
    }
}
