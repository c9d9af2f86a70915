//! Chapter 5.3: the findings from the shapes of simulated circles. A plant without backlash never
//! shows any, one with backlash always does, and axes that do not match are not friction.

use frictcomp::text::SourceFile;
use frictcomp_physics::circle::{
    Circle, CircleError, CircularTest, Comparison, Diagnosis, Direction, Finding, FoundAt, LapRun,
    Method, PlaneAxis, diagnose, diagnose_comparison,
};
use frictcomp_physics::current::{Reading, Switched};
use frictcomp_physics::simulation::{FrictionModel, Plant, Preset};

fn plant(text: &str) -> Plant {
    Plant::from_toml(SourceFile::new("p.toml", text)).expect("a plant")
}

fn test(plant: Plant, radius_mm: f64, feed_mm_per_min: f64) -> CircularTest {
    CircularTest {
        circle: Circle {
            radius_mm,
            feed_mm_per_min,
            ..Circle::default()
        },
        compensation: Method::of_plant(&plant),
        plant,
        model: FrictionModel::Lugre,
        reading: Reading::default(),
    }
}

/// Returns the findings without and with compensation.
fn advice(test: &CircularTest) -> [Vec<Diagnosis>; 2] {
    let comparison = test.compare().expect("a circle");
    let off = diagnose(&comparison.off.figures, Some(Switched::Off));
    [off, diagnose_comparison(&comparison)]
}

fn is_backlash(it: &Diagnosis) -> bool {
    matches!(
        it.finding,
        Finding::Backlash | Finding::OvercompensatedBacklash
    )
}

/// Returns the counter-clockwise circle without compensation; the clockwise one is its mirror image.
fn alone(test: &CircularTest) -> Result<Comparison, CircleError> {
    let job = LapRun {
        compensation: Switched::Off,
        direction: Direction::Ccw,
    };
    Ok(Comparison::of([test.run(job)?]))
}

#[test]
fn small_fast_circles_show_no_backlash() {
    // R5.22 R5.24: 5 mm at 1000 and 25 mm at 8000 mm/min are too fast for figures, 10 mm at 1200 is
    // not.
    for (radius, feed, has_figures) in [
        (5.0, 1000.0, false),
        (10.0, 1200.0, true),
        (25.0, 8000.0, false),
    ] {
        let test = test(Preset::Stiff.plant(), radius, feed);
        let comparison = test.compare().expect("a circle");
        let glitch = comparison.off.figures.glitch_max_um();
        assert_eq!(glitch.is_some(), has_figures, "{radius} {feed}");
        let [off, on] = advice(&test);
        assert!(
            !off.iter().chain(&on).any(is_backlash),
            "{radius} {feed}: {off:?} {on:?}"
        );
        if has_figures {
            assert!(off.iter().all(|it| it.finding == Finding::Friction));
            assert!(!off.is_empty());
        } else {
            assert!(off.is_empty() && on.is_empty());
        }
    }
    let limit = Circle::fastest_feed_for_glitches(5.0);
    assert!((785.0..786.0).contains(&limit), "{limit}");
}

#[test]
fn axes_that_do_not_match_make_no_glitch() {
    // R5.22 R5.24: no friction at all, and Y lags.
    let plant = plant("Fc = 1e-3\nFs = 1e-3\nfv = 0\n[y]\nk_ff = 0.98\n");
    let test = test(plant, 100.0, 5000.0);
    let comparison = test.compare().expect("a circle");
    for side in [&comparison.off, &comparison.on] {
        let glitch = side.figures.glitch_max_um().expect("a glitch");
        assert!(glitch < 0.5, "{glitch}");
    }
    for advice in advice(&test) {
        let findings: Vec<Finding> = advice.iter().map(|it| it.finding).collect();
        assert_eq!(findings, [Finding::GainMismatch], "{advice:?}");
    }
}

/// Checks on the grid of a test that no backlash is reported, at any radius and feed.
fn shows_none(plant: &Plant, radii: &[f64], feeds: &[f64]) {
    for (&radius, &feed) in radii.iter().flat_map(|r| feeds.iter().map(move |f| (r, f))) {
        let test = test(plant.clone(), radius, feed);
        if test.circle.check().is_err() {
            continue;
        }
        let comparison = match alone(&test) {
            Ok(comparison) => comparison,
            // Too heavy for the circle: no figures, so nothing that could be called backlash.
            Err(CircleError::NotFollowed {
                saturated_cycles, ..
            }) if saturated_cycles > 0 => continue,
            Err(error) => panic!("{} {radius} mm {feed} mm/min: {error}", plant.name),
        };
        let advice = diagnose(&comparison.off.figures, Some(Switched::Off));
        let what = format!("{} {radius} mm {feed} mm/min: {advice:?}", plant.name);
        assert!(!advice.iter().any(is_backlash), "{what}");
    }
}

#[test]
fn steep_friction_is_no_mismatch() {
    // R5.24: peaks that still bend the path where the ellipse is evaluated.
    let plant = plant("Fs = 1500\nvs = 0.0005\n[y]\nFc = 1000\nFs = 1200\nm = 3000\n");
    for radius in [5.0, 9.0] {
        for advice in advice(&test(plant.clone(), radius, 250.0)) {
            let ellipse = advice.iter().find(|it| it.place == FoundAt::Whole);
            assert_eq!(ellipse, None, "{radius}: {advice:?}");
        }
    }
}

#[test]
fn circles_that_are_over_before_the_drives_have_settled_are_driven() {
    // R5.20: the path closes later than the commanded one; nothing is unstable.
    let slow = plant("Kv = 8\nTi = 0.05\nbase = \"soft\"\n");
    let lagging = plant("k_ff = 0\nbase = \"mid\"\n");
    for plant in [slow, lagging] {
        for (radius, feed) in [(5.0, 20_000.0), (9.0, 20_000.0), (5.0, 14_000.0)] {
            let figures = alone(&test(plant.clone(), radius, feed)).map(|it| it.off.figures);
            let ccw = figures.expect("a circle").ccw.expect("a path");
            assert!(ccw.g_mz_um.is_finite() && ccw.shape.is_none(), "{ccw:?}");
        }
    }
}

#[test]
fn axes_that_are_too_heavy_for_a_circle_are_not_called_unstable() {
    // R5.20: the force is at its limit for most of the turn, and the path is a stroke.
    let heavy = plant("Fs = 1500\nvs = 0.0005\n[y]\nFc = 1000\nm = 3000\n");
    let error = alone(&test(heavy, 5.0, 14_000.0)).expect_err("not a circle");
    assert_eq!(
        error.to_string().split(", and").next(),
        Some(
            "the axes do not follow a circle of 5 mm at 14000 mm/min: their path does not close \
             around the centre"
        )
    );
    assert!(error.help().contains("lower feed"), "{}", error.help());
    assert!(
        matches!(error, CircleError::NotFollowed { saturated_cycles, .. } if saturated_cycles > 0),
        "{error}"
    );
}

#[test]
fn a_plant_without_backlash_shows_none() {
    // R5.24: the short form of the grid below.
    for preset in Preset::ALL {
        shows_none(
            &preset.plant(),
            &[5.0, 20.0, 127.0],
            &[2500.0, 9000.0, 20_000.0],
        );
    }
    // Slow loops: peaks last long.
    let slow = plant("Kv = 8\nTi = 0.05\nbase = \"soft\"\n");
    shows_none(&slow, &[10.0, 60.0], &[600.0, 3000.0, 9000.0]);
}

#[test]
#[ignore = "minutes"]
fn no_plant_without_backlash_shows_any_at_any_circle() {
    // R5.24: 5 to 500 mm, 0.1 to 20 m/min.
    let mut plants: Vec<Plant> = Preset::ALL.map(Preset::plant).into();
    plants.push(plant("Kv = 8\nTi = 0.05\nbase = \"soft\"\n"));
    plants.push(plant("Kv = 16.7\nKp = 245044\nTi = 0.03\n"));
    plants.push(plant("k_ff = 0\nbase = \"mid\"\n"));
    plants.push(plant("Fs = 1500\nvs = 0.0005\n[y]\nFc = 1000\nm = 3000\n"));
    let radii = [5.0, 9.0, 17.0, 31.0, 60.0, 110.0, 220.0, 500.0];
    let feeds = [
        100.0, 250.0, 600.0, 1500.0, 3500.0, 8000.0, 14_000.0, 20_000.0,
    ];
    for plant in plants {
        shows_none(&plant, &radii, &feeds);
    }
}

#[test]
fn a_dead_zone_between_motor_and_load_is_backlash() {
    // R5.24 R5.27: in addition to friction, each axis its own.
    let plant = plant("[x]\nbacklash_um = 8\n[y]\nbacklash_um = 2.5\n");
    let test = test(plant, 60.0, 3000.0);
    for advice in advice(&test) {
        let steps: Vec<_> = advice.iter().filter(|it| is_backlash(it)).collect();
        let [x, y] = &steps[..] else {
            panic!("{advice:?}");
        };
        assert_eq!(
            [x.place, y.place],
            [FoundAt::Axis(PlaneAxis::X), FoundAt::Axis(PlaneAxis::Y)]
        );
        assert!((x.size_um - 8.0).abs() < 0.3, "{x:?}");
        assert!((y.size_um - 2.5).abs() < 0.3, "{y:?}");
        assert!(
            !advice.iter().any(|it| it.place == FoundAt::Whole),
            "{advice:?}"
        );
    }
    let [off, _] = advice(&test);
    assert!(
        off.iter().any(|it| it.finding == Finding::Friction),
        "{off:?}"
    );
}

#[test]
fn a_negative_backlash_is_refused() {
    // R5.27
    let refused = |text: &str| {
        let error = Plant::from_toml(SourceFile::new("p.toml", text)).expect_err(text);
        error.diagnostic.message
    };
    assert!(refused("[x]\nbacklash_um = -1").contains("`backlash_um` is -1 µm"));
    assert!(refused("backlash_um = 5000").contains("between 0 and 1000"));
    let plant = plant("[y]\nbacklash_um = 3");
    assert!((plant.y.backlash_m - 3e-6).abs() < 1e-15);
    assert!(plant.x.backlash_m.abs() < 1e-15);
}
