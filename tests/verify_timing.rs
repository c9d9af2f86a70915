//! Whether a list acted in a recording, and whether it came early or late (R6.22): recordings of the
//! simulated drives, with lists that are right, early, late, and others.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "rows and times of recordings that the tests make themselves"
)]

use std::f64::consts::TAU;

use frictcomp::current::{AdditiveCurrent, Reading};
use frictcomp::identify::{Predictor, Timing, Track, Verified, verify, verify_followed};
use frictcomp::lists::FrictionList;
use frictcomp::simulation::{
    Drive, FrictionModel, POSITION_LOOP_S, Preset, SPEED_LOOP_S, STEP_S, Setpoint, plant_list,
};

/// The CNC cycle in s, and the time between two rows.
const CYCLE_S: f64 = 0.001;

const RADIUS_MM: f64 = 30.0;

/// A recorded axis.
struct Recorded {
    track: Track,
    errors: Vec<f64>,
}

/// What is recorded of an axis that drives circles with a list, or without one.
fn record(plant: Preset, list: Option<&FrictionList>, feed: f64) -> Recorded {
    let plant = plant.plant();
    let drive = &plant.x;
    let omega = feed / 60.0 / RADIUS_MM;
    let length_s = 1.2 * TAU / omega;
    let cycles = 0..(length_s / CYCLE_S).round() as u32;
    let reference = |time: f64| {
        let (sine, cosine) = (omega * time).sin_cos();
        let radius = RADIUS_MM / 1000.0;
        Setpoint {
            position_m: radius * cosine,
            velocity_m_per_s: -radius * omega * sine,
            acceleration_m_per_s2: -radius * omega * omega * cosine,
            ..Setpoint::default()
        }
    };
    let commanded: Vec<Setpoint> = cycles
        .map(|it| reference(0.4 / omega + f64::from(it) * CYCLE_S))
        .collect();
    let added: Vec<f64> = match list {
        None => vec![0.0; commanded.len()],
        Some(list) => {
            let positions: Vec<f64> = commanded.iter().map(|it| it.position_m * 1e7).collect();
            let speeds: Vec<f64> = commanded
                .iter()
                .map(|it| it.velocity_m_per_s * 1e6)
                .collect();
            let mut current = AdditiveCurrent::new(list, Reading::default());
            let added = current.trace(&positions, &speeds);
            added.iter().map(|it| it.current_units).collect()
        }
    };
    let mut axis = Drive::settled(drive, FrictionModel::Lugre, commanded[0]);
    let mut recorded = Recorded {
        track: Track {
            step_s: CYCLE_S,
            velocities: Some(Vec::new()),
            positions: Some(Vec::new()),
            ..Track::default()
        },
        errors: Vec::new(),
    };
    let parts = (CYCLE_S / POSITION_LOOP_S).round() as u32;
    for (at, pair) in commanded.windows(2).enumerate() {
        let units = axis.force_n() / drive.force_per_unit_n;
        recorded.track.times_s.push(at as f64 * CYCLE_S);
        recorded.track.torques.push(units.round());
        let error = pair[0].position_m - axis.position_m();
        recorded.errors.push((error * 1e8).round() / 10.0);
        let [velocities, positions] = [
            &mut recorded.track.velocities,
            &mut recorded.track.positions,
        ];
        velocities
            .as_mut()
            .expect("velocities")
            .push(pair[0].velocity_m_per_s * 1e6);
        positions
            .as_mut()
            .expect("positions")
            .push(pair[0].position_m * 1e7);
        for part in 1..=parts {
            let share = f64::from(part) / f64::from(parts);
            axis.follow(Setpoint {
                position_m: pair[0].position_m + share * (pair[1].position_m - pair[0].position_m),
                added_units: added[at],
                ..pair[0]
            });
            for step in 0..(POSITION_LOOP_S / STEP_S).round() as usize {
                if step % (SPEED_LOOP_S / STEP_S).round() as usize == 0 {
                    axis.control();
                }
                axis.step();
            }
        }
    }
    recorded
}

fn verified(recorded: &Recorded, list: &FrictionList) -> Verified {
    let predictor = Predictor {
        list,
        reading: Reading::default(),
        cycle_s: None,
    };
    verify_followed(&recorded.track, &recorded.errors, &predictor).expect("a verdict")
}

/// The list of a plant with other delays.
fn list(plant: Preset, lookahead: u16, delay: i16) -> FrictionList {
    FrictionList {
        reversal_lookahead: lookahead,
        delay_cycles: delay,
        ..plant_list(&plant.plant().x)
    }
}

#[test]
fn a_list_acted_or_not() {
    // R6.22: three plants, two feeds.
    for plant in [Preset::Stiff, Preset::Mid, Preset::Soft] {
        let right = list(plant, 2, 1);
        for feed in [1500.0, 3000.0] {
            let off = record(plant, None, feed);
            let found = verified(&off, &right);
            let what = format!("{plant:?} {feed}: {:?}", found.timing);
            assert!(
                matches!(found.timing, Timing::Off { share } | Timing::Other { share } if share < 0.3),
                "{what}"
            );
            assert!(
                !found
                    .verdict()
                    .iter()
                    .any(|it| it.contains("early") || it.contains("late")),
                "{what}"
            );
            let on = record(plant, Some(&right), feed);
            let found = verified(&on, &right);
            let what = format!("{plant:?} {feed}: {:?}", found.timing);
            assert!(
                matches!(found.timing, Timing::On { share, .. } if (share - 1.0).abs() < 0.2),
                "{what}"
            );
            // Half of it acted.
            let half = FrictionList {
                scaling_factor: 500,
                ..right.clone()
            };
            let found = verified(&record(plant, Some(&half), feed), &right);
            let what = format!("{plant:?} {feed}: {:?}", found.timing);
            assert!(!matches!(found.timing, Timing::Off { .. }), "{what}");
        }
    }
}

#[test]
fn the_following_error_tells_early_and_late() {
    // R6.22
    for plant in [Preset::Stiff, Preset::Mid, Preset::Soft] {
        for feed in [2000.0] {
            for (lookahead, delay, word) in [(10, 0, "early"), (0, 50, "late")] {
                let given = list(plant, lookahead, delay);
                let recorded = record(plant, Some(&given), feed);
                let found = verified(&recorded, &given);
                let what = format!("{plant:?} {feed} {word}: {:?}", found.timing);
                assert_eq!(found.timing.early_or_late(), Some(word), "{what}");
                assert!(found.verdict().iter().any(|it| it.contains(word)), "{what}");
                let predictor = Predictor {
                    list: &given,
                    reading: Reading::default(),
                    cycle_s: None,
                };
                let open = verify(&recorded.track, &predictor).expect("a verdict");
                assert_eq!(open.timing, Timing::Open);
            }
        }
    }
}
