//! A recorder: what a recording of a run holds, with its faults.

use std::fmt::Write as _;

use super::machine::Run;
use super::random::Random;

/// A recorder with its faults; the default records what the machine does, every cycle.
#[derive(Debug, Clone)]
pub struct Recorder {
    /// Seed of the noise.
    pub seed: u64,
    /// Standard deviation of the noise of actual positions in µm.
    pub noise_um: f64,
    /// The step of actual positions in µm.
    pub step_um: f64,
    /// Standard deviation of the noise of the torque in drive units.
    pub noise_units: f64,
    /// The amplitude in µm of the error of the screws, and their pitch in mm.
    pub screw: (f64, f64),
    /// Cycles between two rows.
    pub every: usize,
    /// Whether the actual positions are the commanded ones.
    pub is_commanded: bool,
    /// Number of cycles over which actual positions are means.
    pub averaged: usize,
    /// Cycles by which Y is recorded after X.
    pub y_late: usize,
    /// A factor on the actual positions of Y about their first.
    pub y_factor: f64,
    /// Whether X and Y are exchanged.
    pub is_exchanged: bool,
    /// Parts of the recording in which rows are missing, each from one to another.
    pub missing: Vec<[f64; 2]>,
    /// Number of drive units at which the torque is cut.
    pub clipped_units: f64,
    /// A factor on the torque.
    pub torque_factor: f64,
    /// Whether the places are those of the motors.
    pub is_motor: bool,
}

impl Default for Recorder {
    fn default() -> Self {
        Self {
            seed: 1,
            noise_um: 0.3,
            step_um: 0.1,
            noise_units: 1.0,
            screw: (0.0, 10.0),
            every: 1,
            is_commanded: false,
            averaged: 1,
            y_late: 0,
            y_factor: 1.0,
            is_exchanged: false,
            missing: Vec::new(),
            clipped_units: f64::INFINITY,
            torque_factor: 1.0,
            is_motor: false,
        }
    }
}

impl Recorder {
    /// Returns the rows of a recording as a table; positions in mm, velocities in mm/s.
    pub fn table(&self, run: &Run, axes: [&str; 2]) -> String {
        let mut random = Random::new(self.seed);
        let rows = run.commanded.places[0].len();
        let mut actual = [0, 1].map(|axis| self.actual(run, axis, &mut random));
        if self.is_exchanged {
            actual.swap(0, 1);
        }
        let mut text = String::from("t [s]");
        for axis in axes {
            write!(
                text,
                ",{axis}.SetPos [mm],{axis}.SetVelo [mm/s],{axis}.ActPos [mm],{axis}.ActTorque"
            )
            .expect("text");
        }
        text.push('\n');
        let is_missing = |at: usize| {
            let part = at as f64 / rows as f64;
            self.missing
                .iter()
                .any(|[from, to]| (*from..*to).contains(&part))
        };
        for at in (0..rows).step_by(self.every) {
            if is_missing(at) {
                continue;
            }
            write!(text, "{:.6}", at as f64 * run.cycle_s).expect("text");
            for (axis, actual) in actual.iter().enumerate() {
                let torque =
                    self.torque_factor * run.units[axis][at] + self.noise_units * random.normal();
                let torque = torque
                    .clamp(-self.clipped_units, self.clipped_units)
                    .round();
                write!(
                    text,
                    ",{:.6},{:.6},{:.5},{torque}",
                    run.commanded.places[axis][at], run.commanded.velocities[axis][at], actual[at]
                )
                .expect("text");
            }
            text.push('\n');
        }
        text
    }

    fn actual(&self, run: &Run, axis: usize, random: &mut Random) -> Vec<f64> {
        let places = if self.is_commanded {
            &run.commanded.places[axis]
        } else if self.is_motor {
            &run.motor_mm[axis]
        } else {
            &run.load_mm[axis]
        };
        let late = if axis == 1 { self.y_late } else { 0 };
        let factor = if axis == 1 { self.y_factor } else { 1.0 };
        let (amplitude, pitch) = self.screw;
        let mut measured = |place: &f64| {
            let screw = 1e-3 * amplitude * (std::f64::consts::TAU * place / pitch + 1.0).sin();
            let place = places[0] + factor * (place - places[0]) + screw;
            place + 1e-3 * self.noise_um * random.normal()
        };
        let measured: Vec<f64> = places.iter().map(&mut measured).collect();
        let step = 1e-3 * self.step_um;
        let row = |at: usize| {
            let from = at.saturating_sub(late);
            let mean = &measured[from.saturating_sub(self.averaged - 1)..=from];
            let place = mean.iter().sum::<f64>() / mean.len() as f64;
            if step > 0.0 {
                (place / step).round() * step
            } else {
                place
            }
        };
        (0..places.len()).map(row).collect()
    }
}
