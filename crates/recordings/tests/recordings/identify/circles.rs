//! Friction identified on circles, and lists verified on them.

use frictcomp::lists::{FrictionList, ListHead, Points, TablePoint, write_value_list};
use frictcomp::text::SourceFile;
use frictcomp_physics::circle::{Circle, CircularTest, Comparison, Direction, LapRun};
use frictcomp_physics::current::{Reading, Switched};
use frictcomp_physics::simulation::{FrictionModel, Plant, plant_list};
use frictcomp_recordings::identify::{
    AxisRecording, IdentifyOptions, Predictor, Timing, Track, Verified, identify, identify_circles,
    verify,
};

use super::{identified, track};
use frictcomp_testing::recorded_drive::{ASYMMETRY, Bench, FC, UNIT, WEIGHT};

/// Velocities of one axis on circles of 100 mm, in mm/s, some turns at each feed in m/min.
fn circle(feed: f64, turns: f64) -> Vec<f64> {
    let speed = feed * 1000.0 / 60.0;
    let length = turns * std::f64::consts::TAU * 100.0 / speed;
    let run_in = 0.5;
    let at = |step: usize| {
        let time = step as f64 * 0.001;
        let rising = (time / run_in).min(1.0);
        speed * rising * (speed / 100.0 * time).sin()
    };
    (0..(length * 1000.0) as usize).map(at).collect()
}

#[test]
fn friction_is_found_on_circles() {
    // R6.19
    let bench = Bench {
        ripple_n: 0.0,
        ..Bench::default()
    };
    let record = |feed: f64, turns: f64| {
        AxisRecording::from(track(bench.record_along(&circle(feed, turns))))
    };
    let recordings = [0.5, 1.0, 2.0, 5.0].map(|feed| record(feed, 1.5));
    let found = identify_circles(&recordings).expect("friction");
    let off = found
        .points
        .iter()
        .map(|[speed, friction]| (friction * UNIT - bench.friction(*speed)).abs() / FC);
    let mean = off.sum::<f64>() / found.points.len() as f64 * 100.0;
    assert!(mean < 1.2, "{mean} %: {found:?}");
    assert!(
        (found.inertia * UNIT - 1.3).abs() < 0.1,
        "{}",
        found.inertia
    );
    assert!(
        (found.offset * UNIT - WEIGHT - ASYMMETRY).abs() < 5.0,
        "{}",
        found.offset
    );
    assert!(
        found
            .list()
            .table
            .windows(2)
            .all(|pair| pair[0].input < pair[1].input)
    );
    // A short recording has too few samples at some speeds, which are left out and named.
    let found = identify_circles(&[record(5.0, 0.4)]).expect("friction");
    assert!(!found.left_out.is_empty());
    assert!(identify_circles(&[]).is_err());
}

fn verified(track: &Track, list: &FrictionList) -> Verified {
    let predictor = Predictor {
        list,
        reading: Reading::default(),
        cycle_s: None,
    };
    verify(track, &predictor).expect("a verdict")
}

#[test]
fn a_list_is_verified() {
    // R6.20
    let bench = Bench {
        ripple_n: 0.0,
        noise_n: 20.0,
        length_s: 40.0,
        ..Bench::default()
    };
    let track = track(bench.record());
    let right = identify(&track, &IdentifyOptions::default())
        .expect("friction")
        .list();
    let verdict = |list: &FrictionList| verified(&track, list).verdict();
    assert_eq!(verdict(&right), [""; 0]);
    let mut inverted = right.clone();
    inverted.scaling_factor = -1000;
    assert_eq!(verdict(&inverted), ["the sign of the list is inverted"]);
    let mut low = right.clone();
    for point in low.table.iter_mut().filter(|point| point.input > 6000.0) {
        point.output *= 0.9;
    }
    let said = verdict(&low);
    assert!(
        said.iter()
            .any(|it| it.starts_with("the list is 10 % low from 7.60 to ")),
        "{said:?}"
    );
    assert_eq!(said.len(), 1, "{said:?}");
    let mut high = right;
    high.scaling_factor = 1100;
    assert!(verdict(&high).iter().all(|it| it.contains("% high")));
}

#[test]
fn torque_alone_tells_no_timing() {
    // R6.22: the friction of the list, some cycles later. The loops build it up like that, too.
    let list = FrictionList {
        position_delay: 0,
        reversal_lookahead: 0,
        scaling_factor: 1000,
        delay_cycles: 0,
        max_points: 20,
        table: vec![TablePoint {
            input: 0.0,
            output: 100.0,
        }],
    };
    for lag in [-4, 0, 15] {
        let velocity = |at: i32| 50.0 * (f64::from(at) * 0.002).sin();
        let torque = |at: i32| 100.0 * velocity(at - lag).signum();
        let track = Track {
            times_s: (0..20_000).map(|at| f64::from(at) * 0.001).collect(),
            velocities: Some((0..20_000).map(|at| velocity(at) * 1000.0).collect()),
            positions: None,
            torques: (0..20_000).map(torque).collect(),
            step_s: 0.001,
        };
        let found = verified(&track, &list);
        assert_eq!(found.timing, Timing::Open);
        let verdict = found.verdict().join(", ");
        assert!(
            !verdict.contains("early") && !verdict.contains("late"),
            "{verdict}"
        );
    }
}

#[test]
fn eight_points_leave_the_glitch_of_the_true_curve() {
    // R6.17: the written list, on a circle of the machine that was recorded.
    let machine = "Fc = 512.5\nFs = 632.5\nvs = 0.003\nfv = 4000\n";
    let plant = Plant::from_toml(SourceFile::new("p.toml", machine)).expect("a plant");
    let found = identified(&Bench::default()).list();
    assert_eq!(found.table.len(), 8);
    let list = write_value_list(&found, Points::Whole, &ListHead::default());
    let read = FrictionList::read(SourceFile::new("v.lis", list)).expect("a list");
    let tuned = plant_list(&plant.x);
    let written = FrictionList {
        table: read.list.table,
        ..tuned.clone()
    };
    for feed_mm_per_min in [1000.0, 5000.0] {
        let [of_curve, of_list] = [&tuned, &written].map(|list| {
            let test = CircularTest {
                circle: Circle {
                    feed_mm_per_min,
                    ..Circle::default()
                },
                compensation: [0, 1].map(|_| Some(list.clone().into())),
                plant: plant.clone(),
                model: FrictionModel::Lugre,
                reading: Reading::default(),
            };
            let on = LapRun {
                compensation: Switched::On,
                direction: Direction::Ccw,
            };
            let comparison = Comparison::of([test.run(on).expect("a circle")]);
            comparison.on.figures.glitch_max_um().expect("a glitch")
        });
        assert!(
            (of_list / of_curve - 1.0).abs() < 0.1,
            "{feed_mm_per_min}: {of_list} is not {of_curve}"
        );
    }
}
