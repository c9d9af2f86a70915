//! Chapter 5.3: tuned value lists (R5.25).

mod deviating;
mod independent;

use frictcomp::lists::Points;
use frictcomp::text::SourceFile;
use frictcomp_host::{Watch, tune as tune_on_all_processors};
use frictcomp_physics::circle::{
    Circle, CircleError, CircularTest, Comparison, Direction, FeedResult, LapRun, Ranges, Shaping,
    Task, Tuned, TunedAxis, TuningAim, tune,
};
use frictcomp_physics::current::{Reading, Switched};
use frictcomp_physics::simulation::{FrictionModel, Plant, Preset, plant_list};

fn task(plant: Plant, feeds: &[f64]) -> Task {
    let circle = |&feed_mm_per_min: &f64| Circle {
        feed_mm_per_min,
        ..Circle::default()
    };
    Task {
        plant,
        model: FrictionModel::Lugre,
        circles: feeds.iter().map(circle).collect(),
        ranges: Ranges::default(),
        reading: Reading::default(),
        points: Points::Whole,
        shaping: Shaping::None,
        aim: TuningAim::Plant,
    }
}

/// Returns the largest glitch of a whole circle with the lists found for its axes.
fn left(task: &Task, feed: f64, axes: &[TunedAxis; 2]) -> f64 {
    let test = CircularTest {
        circle: Circle {
            feed_mm_per_min: feed,
            ..Circle::default()
        },
        plant: task.plant.clone(),
        model: task.model,
        compensation: axes.each_ref().map(|axis| axis.compensation.clone()),
        reading: task.reading,
    };
    let job = LapRun {
        compensation: Switched::On,
        direction: Direction::Ccw,
    };
    let comparison = Comparison::of([test.run(job).expect("a circle")]);
    let glitch = comparison.on.figures.glitch_max_um();
    glitch.expect("a glitch")
}

/// Returns the output of a tuned list at standstill.
fn first_output(axis: &TunedAxis) -> f64 {
    axis.list().expect("a list").table[0].output
}

#[test]
fn axes_with_other_friction_get_lists_of_their_own() {
    // R5.25: X and Y are independent of each other.
    let text = "[y]\nFc = 900\nFs = 1100\nsigma0 = 4e8\n";
    let plant = Plant::from_toml(SourceFile::new("p.toml", text)).expect("a plant");
    let task = task(plant, &[9000.0]);
    let tuned = tune(&task).expect("a circle");
    let [x, y] = &tuned.axes;
    assert!(first_output(y) > 1.5 * first_output(x));
    let row = tuned.feeds[0];
    assert!(row.glitch_on_um < 0.2 * row.glitch_off_um, "{row:?}");
    assert_eq!(left(&task, 9000.0, &tuned.axes), row.glitch_on_um);
    // The list of X on both axes leaves more.
    let both = [x.clone(), x.clone()];
    assert!(left(&task, 9000.0, &both) > 2.0 * row.glitch_on_um);
}

#[test]
fn the_result_does_not_depend_on_who_makes_the_simulations() {
    // R5.25 R9.16
    let mut task = task(Preset::Mid.plant(), &[14_000.0]);
    task.circles[0].cycle_time_s = 0.002;
    let alone = tune(&task).expect("a circle");
    let on_all = tune_on_all_processors(&task, &Watch::default()).expect("a circle");
    assert_eq!(alone, on_all);
}

#[test]
fn circles_without_glitches_are_not_tuned() {
    // R5.22 R5.25
    let mut task = task(Preset::Stiff.plant(), &[1000.0]);
    task.circles[0].radius_mm = 5.0;
    let refused = tune(&task).expect_err("too fast");
    assert!(matches!(refused, CircleError::NoGlitch { .. }), "{refused}");
}

#[test]
fn what_counts_is_the_acceleration() {
    // R5.25: a = v²/R, and the range of the tuning.
    let circle = Circle {
        radius_mm: 25.0,
        feed_mm_per_min: 3000.0,
        ..Circle::default()
    };
    assert_eq!(circle.acceleration_mm_per_s2(), 100.0);
    let row = |acceleration_mm_per_s2: f64, glitch_on_um: f64| FeedResult {
        feed_mm_per_min: 1000.0,
        radius_mm: 100.0,
        acceleration_mm_per_s2,
        glitch_off_um: 5.0,
        glitch_on_um,
        glitch_friction_minus20_um: 0.0,
        glitch_friction_plus20_um: 0.0,
    };
    let drive = Preset::Stiff.plant().x;
    let axis = TunedAxis {
        compensation: Some(plant_list(&drive).into()),
        is_shaped: false,
    };
    let tuned = Tuned {
        axes: [axis.clone(), axis],
        feeds: vec![row(70.0, 2.0), row(0.7, 6.0)],
        check: Vec::new(),
        robust: None,
        trials: 0,
    };
    assert_eq!(tuned.accelerations(), [0.7, 70.0]);
    assert_eq!(tuned.worst_um(), 6.0);
    let worse: Vec<bool> = tuned.feeds.iter().map(FeedResult::is_worse).collect();
    assert_eq!(worse, [false, true]);
}

#[test]
fn what_is_said_of_a_list_holds_between_its_circles() {
    // R5.29: between the two accelerations, whole circles of both axes leave no more than the check predicts.
    let circle = |acceleration: f64| {
        // A radius of 100 mm.
        Circle::default().with_acceleration(acceleration)
    };
    let mut task = task(Preset::Mid.plant(), &[]);
    task.circles = [100.0, 400.0].map(circle).to_vec();
    let tuned = tune_on_all_processors(&task, &Watch::default()).expect("circles");
    assert_eq!(tuned.check.len(), 25);
    let [first, last] = [tuned.check[0], tuned.check[24]].map(|it| it.acceleration_mm_per_s2);
    assert!((first - 100.0).abs() < 1e-6 && (last - 400.0).abs() < 1e-6);
    assert!(tuned.check.iter().all(|it| !it.is_worse()));
    let said = tuned.worst_um();
    for acceleration in [118.0, 155.0, 201.0, 263.0, 341.0] {
        let test = CircularTest {
            circle: circle(acceleration),
            plant: task.plant.clone(),
            model: task.model,
            compensation: tuned.axes.each_ref().map(|axis| axis.compensation.clone()),
            reading: task.reading,
        };
        let job = LapRun {
            compensation: Switched::On,
            direction: Direction::Ccw,
        };
        let comparison = Comparison::of([test.run(job).expect("a circle")]);
        let left = comparison.on.figures.glitch_max_um().expect("a glitch");
        assert!(left <= 1.05 * said, "{left} at {acceleration}, {said} said");
    }
    // Deviating machines are shown as well, and do not affect the tuning.
    let row = tuned.check[12];
    assert!(
        row.glitch_half_stiff_um > 0.0 && row.glitch_double_stiff_um > 0.0,
        "{row:?}"
    );
    assert!(row.glitch_uneven_um < 2.0 * row.glitch_off_um, "{row:?}");
}

#[test]
fn a_robust_list_is_taken_only_where_it_gains() {
    // R5.29
    let mut task = task(Preset::Mid.plant(), &[9000.0]);
    task.aim = TuningAim::Robust;
    let tuned = tune_on_all_processors(&task, &Watch::default()).expect("circles");
    let robust = tuned.robust.expect("a comparison");
    let all = |it: &frictcomp_physics::circle::RemainingGlitch| {
        it.glitch_on_um
            .max(it.glitch_half_stiff_um)
            .max(it.glitch_double_stiff_um)
            .max(it.glitch_uneven_um)
    };
    let left = tuned.check.iter().map(all).fold(0.0, f64::max);
    if robust.is_taken {
        assert!(robust.robust_um <= 0.95 * robust.plain_um, "{robust:?}");
        assert_eq!(left, robust.robust_um);
    } else {
        assert_eq!(left, robust.plain_um);
    }
}

#[test]
#[ignore = "minutes without optimization"]
fn lists_are_as_good_as_those_that_were_found_elsewhere() {
    // R5.25 R5.29 R5.37: from 0.5 to 5 m/min, within the documented ranges.
    let feeds = [500.0, 1000.0, 2000.0, 5000.0];
    for (preset, most) in [
        (Preset::Stiff, 1.05),
        (Preset::Mid, 2.75),
        (Preset::Soft, 5.9),
    ] {
        let mut task = task(preset.plant(), &feeds);
        task.shaping = Shaping::Allowed;
        let tuned = tune_on_all_processors(&task, &Watch::default()).expect("circles");
        let worst = tuned.worst_um();
        assert!(worst <= most, "{preset}: {worst} {:?}", tuned.feeds);
        assert!(
            tuned.feeds.iter().all(|it| !it.is_worse()),
            "{:?}",
            tuned.feeds
        );
        let [x, _] = &tuned.axes;
        let list = x.list().expect("a list");
        assert!((0..=10).contains(&list.position_delay));
        assert!(list.reversal_lookahead <= 4);
        assert!((0..=248).contains(&list.delay_cycles));
        assert!(list.table.len() <= 20);
        if preset == Preset::Stiff {
            let fast = left(&task, 12_000.0, &tuned.axes);
            assert!(fast <= 2.3, "{fast}");
        }
    }
}
