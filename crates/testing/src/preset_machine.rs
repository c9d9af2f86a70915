//! Machines whose parameters differ from a preset and are known to no command, and their recorded circles.
//!
//! They are simulated with the drives of the physics: tests of a search, which is told neither the parameters nor the
//! noise, use them; tests of the drives themselves use a [`Machine`](crate::Machine).

use std::f64::consts::TAU;

use frictcomp::lists::{FrictionList, Points};
use frictcomp_physics::circle::{
    Circle, CircularTest, Comparison, Direction, LapRun, Method, RadialProfile, Ranges, Shaping,
    Task, TuningAim,
};
use frictcomp_physics::current::{Reading, Switched};
use frictcomp_physics::simulation::{DriveParameters, FrictionModel, Plant, Preset};

/// Pitch of the screws in mm.
pub const PITCH_MM: f64 = 10.0;

/// A machine, and its recorder.
#[derive(Debug, Clone)]
pub struct PresetMachine {
    /// The name in tables and test names.
    pub name: &'static str,
    /// The reference plant that a user has of it.
    pub reference: Preset,
    /// The true plant.
    pub plant: Plant,
    /// Radius of its circles in mm.
    pub radius_mm: f64,
    /// Noise of the positions in µm.
    pub noise_um: f64,
    /// Error of the screws in µm.
    pub screw_um: f64,
}

/// A row of a recording: the time in s, X and Y in mm.
pub type Row = [f64; 3];

impl PresetMachine {
    /// Returns a machine that differs from a preset by the `change` to both drives.
    fn of(name: &'static str, reference: Preset, change: fn(&mut DriveParameters)) -> Self {
        let mut plant = reference.plant();
        for drive in [&mut plant.x, &mut plant.y] {
            drive.friction.coulomb_n *= 1.02;
            drive.friction.breakaway_n *= 1.03;
            drive.friction.viscous_n_s_per_m *= 0.95;
            drive.speed_gain_n_s_per_m *= 0.93;
            change(drive);
        }
        plant.y.mass_kg *= 1.1;
        Self {
            name,
            reference,
            plant,
            radius_mm: 100.0,
            noise_um: 0.3,
            screw_um: 0.5,
        }
    }

    /// Returns the machine of the short test, on small and fast circles.
    pub fn small() -> Self {
        Self {
            radius_mm: 40.0,
            ..Self::of("small", Preset::Mid, |it| *it = it.with_contact(0.6))
        }
    }

    /// Returns a machine with half the stiffness that its reference has.
    pub fn half() -> Self {
        Self::of("half", Preset::Mid, |it| *it = it.with_contact(0.5))
    }

    /// Returns the machines of the long test.
    pub fn all() -> Vec<Self> {
        let stiff = Self::of("stiff", Preset::Stiff, |it| *it = it.with_contact(0.8));
        let mid = Self::of("mid", Preset::Mid, |it| *it = it.with_contact(1.2));
        let soft = Self::of("soft", Preset::Soft, |it| *it = it.with_contact(0.85));
        let mut uneven = Self::of("uneven", Preset::Mid, |_| {});
        uneven.plant.x = uneven.plant.x.uneven(0.1);
        uneven.plant.y = uneven.plant.y.uneven(-0.08);
        let noisy = Self {
            noise_um: 0.6,
            screw_um: 1.0,
            ..Self::of("noisy", Preset::Mid, |_| {})
        };
        let double = Self::of("double", Preset::Mid, |it| *it = it.with_contact(2.0));
        vec![stiff, mid, soft, uneven, noisy, Self::half(), double]
    }

    fn test(&self, feed: f64, lists: [Option<&FrictionList>; 2], friction: f64) -> CircularTest {
        CircularTest {
            circle: Circle {
                radius_mm: self.radius_mm,
                feed_mm_per_min: feed,
                cycle_time_s: 0.001,
            },
            plant: self.plant.with_friction(friction),
            model: FrictionModel::default(),
            compensation: lists.map(|it| it.cloned().map(Method::Current)),
            reading: Reading::default(),
        }
    }

    /// Returns the largest true glitch of X and of Y in µm with lists or without, over feeds.
    pub fn left_um(&self, feeds: &[f64], lists: [Option<&FrictionList>; 2]) -> [f64; 2] {
        let mut most = [0.0_f64; 2];
        for &feed in feeds {
            let job = LapRun {
                compensation: switched(lists),
                direction: Direction::Ccw,
            };
            let lap = self.test(feed, lists, 1.0).run(job).expect("a lap");
            let compared = Comparison::of([lap]);
            let side = match job.compensation {
                Switched::Off => compared.off,
                Switched::On => compared.on,
            };
            let shape = side.figures.ccw.and_then(|it| it.shape).expect("glitches");
            for glitch in shape.glitches {
                let at = usize::from(glitch.crossing.axis().as_str() == "Y");
                most[at] = most[at].max(glitch.height_um);
            }
        }
        most
    }

    /// Returns the search for the best lists at feeds, with knowledge of the machine.
    pub fn task(&self, feeds: &[f64]) -> Task {
        let circle = |&feed_mm_per_min: &f64| Circle {
            feed_mm_per_min,
            radius_mm: self.radius_mm,
            ..Circle::default()
        };
        Task {
            plant: self.plant.clone(),
            model: FrictionModel::default(),
            circles: feeds.iter().map(circle).collect(),
            ranges: Ranges::default(),
            reading: Reading::default(),
            points: Points::Whole,
            shaping: Shaping::Allowed,
            aim: TuningAim::Plant,
        }
    }

    /// Returns a recording at a feed: more than a turn in each direction, one row per ms. The friction is a little
    /// different each time.
    pub fn recorded(&self, feed: f64, lists: [Option<&FrictionList>; 2], seed: u64) -> Vec<Row> {
        let mut random = fastrand::Rng::with_seed(seed);
        let friction = 0.99 + 0.02 * random.f64();
        let test = self.test(feed, lists, friction);
        let compensation = switched(lists);
        let mut rows = Vec::new();
        for direction in Direction::ALL {
            let job = LapRun {
                compensation,
                direction,
            };
            let profile = test.run(job).expect("a lap").profile;
            self.drive(feed, (&profile, direction), &mut random, &mut rows);
        }
        rows
    }

    /// Appends a turn and a bit of a path.
    fn drive(
        &self,
        feed: f64,
        (profile, direction): (&RadialProfile, Direction),
        random: &mut fastrand::Rng,
        rows: &mut Vec<Row>,
    ) {
        let deviations = profile.deviations_m();
        let turning = feed / 60.0 / self.radius_mm;
        let count = (1.15 * TAU / turning * 1000.0) as usize;
        let begin = rows.len();
        for at in 0..count {
            let angle = direction.sign() * turning * at as f64 / 1000.0 - 0.4;
            let place = angle.rem_euclid(TAU) / TAU * deviations.len() as f64;
            let radius = self.radius_mm + 1000.0 * deviations[place as usize % deviations.len()];
            let screw = |at: f64| at + 1e-3 * self.screw_um * (TAU * at / PITCH_MM + 1.0).sin();
            let mut noise = || {
                let sum: f64 = (0..12).map(|_| random.f64()).sum();
                1e-3 * self.noise_um * (sum - 6.0)
            };
            let [x, y] = [radius * angle.cos(), radius * angle.sin()];
            let time = (begin + at) as f64 / 1000.0;
            rows.push([time, screw(x) + noise(), screw(y) + noise()]);
        }
    }
}

fn switched(lists: [Option<&FrictionList>; 2]) -> Switched {
    if lists[0].is_some() {
        Switched::On
    } else {
        Switched::Off
    }
}
