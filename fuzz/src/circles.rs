//! Circles on valid plants: refused ones would prove nothing.

use std::fmt::Write as _;

use frictcomp::lists::{FrictionList, TablePoint};
use frictcomp::text::SourceFile;
use frictcomp_physics::circle::{
    Circle, CircleError, CircularTest, Comparison, Lap, LapRun, MIN_CYCLES, Method,
};
use frictcomp_physics::current::Reading;
use frictcomp_physics::simulation::{FrictionModel, Plant, STEP_S, plant_list};

use crate::Choices;

/// Simulates a circle on a plant, both with values from the whole accepted range.
pub fn check_circle(choices: &mut Choices<'_>) {
    let text = plant(choices);
    let plant = Plant::from_toml(SourceFile::new("plant.toml", text.as_str()))
        .unwrap_or_else(|error| panic!("a valid plant is refused: {error}\n{text}"));
    let circle = circle(choices);
    circle.check().expect("a valid circle");
    let test = CircularTest {
        circle,
        compensation: compensation(choices, &plant),
        model: [FrictionModel::Lugre, FrictionModel::Gms][choices.below(2)],
        plant,
        reading: Reading::default(),
    };
    let mut laps: Vec<Lap> = Vec::new();
    for job in LapRun::ALL {
        match test.run(job) {
            Ok(lap) => {
                let deviations = lap.profile.deviations_m();
                assert!(deviations.iter().all(|it| it.is_finite()), "{test:?}");
                laps.push(lap);
            }
            Err(CircleError::Unstable { angle_deg, .. }) => {
                assert!(angle_deg.is_finite(), "{test:?}");
                return;
            }
            Err(CircleError::NotFollowed { .. }) => return,
            Err(error) => panic!("a valid circle is refused: {error}"),
        }
    }
    let comparison = Comparison::of(laps);
    let figures = serde_json::to_string(&comparison.off.figures).expect("figures are JSON");
    let minus = figures.contains("\"g_b\":-") || figures.contains("\"h\":-");
    assert!(!minus, "a width is less than zero: {figures}\n{test:?}");
    assert!(!figures.contains("\"g_b\":null"), "{figures}\n{test:?}");
}

/// Returns a value between the ends, in equal steps of magnitude.
fn between(choices: &mut Choices<'_>, [least, most]: [f64; 2]) -> f64 {
    least * (most / least).powf(choices.share())
}

fn circle(choices: &mut Choices<'_>) -> Circle {
    let cycle_time_s = 0.000_25 * [1.0, 4.0, 8.0, 40.0][choices.below(4)];
    let radius_mm = between(choices, [0.1, 1e5]);
    // The number of cycles in a turn.
    let cycles = between(choices, [MIN_CYCLES * 1.01, 600.0]);
    let turn_s = cycles * cycle_time_s;
    let feed = std::f64::consts::TAU * radius_mm / turn_s * 60.0;
    let feed_mm_per_min = feed.clamp(0.1, 1e6);
    // A feed at the end of its range needs another radius.
    let radius_mm = feed_mm_per_min / 60.0 * turn_s / std::f64::consts::TAU;
    Circle {
        radius_mm,
        feed_mm_per_min,
        cycle_time_s,
    }
}

/// Returns the compensation of the plant, or value lists.
fn compensation(choices: &mut Choices<'_>, plant: &Plant) -> [Option<Method>; 2] {
    if choices.below(2) == 0 {
        return Method::of_plant(plant);
    }
    let lists = [list(choices, plant_list(&plant.x)), plant_list(&plant.y)];
    lists.map(|list| Some(list.into()))
}

fn list(choices: &mut Choices<'_>, mut list: FrictionList) -> FrictionList {
    list.position_delay = [0, 1, 9, 10][choices.below(4)];
    list.reversal_lookahead = [0, 1, 2, 4][choices.below(4)];
    list.delay_cycles = [0, 1, 7, 248][choices.below(4)];
    list.scaling_factor = [1000, 0, -32766, 32766][choices.below(4)];
    match choices.below(4) {
        0 => list.table.truncate(1),
        1 => {
            list.table = vec![
                TablePoint {
                    input: 0.0,
                    output: -32768.0,
                },
                TablePoint {
                    input: 1.0,
                    output: 32767.0,
                },
            ];
        }
        _ => {}
    }
    list
}

/// Returns a plant file. Values that depend on each other are chosen to match.
fn plant(choices: &mut Choices<'_>) -> String {
    let mut text = String::new();
    let mass = between(choices, [0.01, 1e6]);
    let coulomb = [0.0, between(choices, [0.001, 1e6])][choices.below(2)];
    let breakaway = coulomb * between(choices, [1.0, 10.0]);
    let stiffness = between(choices, [1e3, 1e12_f64.min(mass / (STEP_S * STEP_S))]);
    let strongest = mass / STEP_S;
    let damping = 0.4 * strongest * choices.share();
    let viscous = (0.4 * strongest * choices.share() * choices.share()).min(1e8);
    let mut number = |key: &str, value: f64| {
        writeln!(text, "{key} = {value:e}").expect("a text takes everything");
    };
    number("m", mass);
    number("Fc", coulomb);
    number("Fs", breakaway.min(1e7));
    number(
        "sigma0",
        stiffness.min(0.99 * mass / (STEP_S * STEP_S)).max(1e3),
    );
    number("sigma1", damping.min(1e10));
    number("fv", viscous);
    for (key, range) in [
        ("Kv", [0.1, 2000.0]),
        ("Ti", [1e-4, 1e6]),
        ("Tt", [1e-5, 0.1]),
        ("k_ff", [1e-3, 2.0]),
        ("k_a", [1e-3, 2.0]),
        ("rated_force", [0.01, 1e7]),
        ("vs", [1e-6, 1.0]),
        ("delta", [0.1, 10.0]),
        ("vd", [1e-6, 10.0]),
        ("gms_C", [1.0, 1e12]),
    ] {
        // Plants that keep some of their default values are stable more often.
        if choices.below(3) == 0 {
            number(key, between(choices, range));
        }
    }
    if choices.below(3) == 0 {
        number("Kp", between(choices, [0.1, 1e10]));
    }
    if choices.below(3) == 0 {
        text.push_str("[stiction]\n");
        for (key, range) in [
            ("mp1511", [1.0, 16_777_215.0]),
            ("mp1512", [0.1, 1e6]),
            ("gp", [1e-3, 1e4]),
            ("mp1513", [1e-3, 1000.0]),
        ] {
            let _ = writeln!(text, "{key} = {}", between(choices, range));
        }
        let _ = writeln!(text, "tc = {}", 250 * [1, 4, 12, 400][choices.below(4)]);
    }
    text
}
