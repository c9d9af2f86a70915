//! Chapters 5.2 and 5.3: friction, drives, the circular test, its figures, advice and tuning.

use std::f64::consts::TAU;

use frictcomp::lists::{FrictionList, Points};
use frictcomp::text::SourceFile;
use frictcomp_physics::circle::{
    Circle, CircleError, CircularTest, Comparison, Direction, Figures, Finding, FoundAt,
    FreeParameter, Lap, LapRun, Method, PathFigures, PathShape, Ranges, Shaping, Task, Tuned,
    TuningAim, diagnose, diagnose_comparison, tune,
};
use frictcomp_physics::current::{Reading, Switched};
use frictcomp_physics::simulation::{
    Drive, DriveParameters, FrictionModel, POSITION_LOOP_S, Plant, Preset, Setpoint,
};
use proptest::prelude::{ProptestConfig, Strategy, proptest};

fn circular_test(feed: f64) -> CircularTest {
    let plant = Preset::Stiff.plant();
    CircularTest {
        circle: Circle {
            feed_mm_per_min: feed,
            ..Circle::default()
        },
        compensation: Method::of_plant(&plant),
        plant,
        model: FrictionModel::Lugre,
        reading: Reading::default(),
    }
}

/// Returns the value lists of a test.
fn lists(test: &mut CircularTest) -> impl Iterator<Item = &mut FrictionList> {
    test.compensation.iter_mut().flatten().map(|it| match it {
        Method::Current(list) => list,
        Method::Stiction(_) => panic!("no value list"),
    })
}

fn lap(test: &CircularTest, compensation: Switched, direction: Direction) -> Lap {
    test.run(LapRun {
        compensation,
        direction,
    })
    .expect("a circle that can be simulated")
}

/// Returns the figures of the counter-clockwise path alone.
fn figures(test: &CircularTest, compensation: Switched) -> Figures {
    let comparison = Comparison::of([lap(test, compensation, Direction::Ccw)]);
    match compensation {
        Switched::Off => comparison.off.figures,
        Switched::On => comparison.on.figures,
    }
}

/// Returns the largest glitch.
fn glitch(figures: &Figures) -> f64 {
    figures.glitch_max_um().expect("a glitch at each crossing")
}

/// Returns the shape of a path at its crossings.
fn shape(path: Option<&PathFigures>) -> &PathShape {
    path.and_then(|path| path.shape.as_ref()).expect("a shape")
}

fn within(found: f64, expected: f64, part: f64) {
    let error = (found / expected - 1.0).abs();
    assert!(error <= part, "{found} is not {expected} within {part}");
}

/// Drives one axis with setpoints of the position loop and returns its positions.
fn follow(drive: &mut Drive, setpoints: impl IntoIterator<Item = Setpoint>) -> Vec<f64> {
    let mut positions = Vec::new();
    for setpoint in setpoints {
        drive.follow(setpoint);
        for _ in 0..2 {
            drive.control();
            positions.push(drive.step());
            positions.push(drive.step());
        }
    }
    positions
}

fn constant_speed(speed: f64, ticks: u32) -> impl Iterator<Item = Setpoint> {
    (0..ticks).map(move |tick| Setpoint {
        position_m: f64::from(tick) * POSITION_LOOP_S * speed,
        velocity_m_per_s: speed,
        ..Setpoint::default()
    })
}

fn without_friction(drive: &DriveParameters) -> DriveParameters {
    let mut drive = drive.clone();
    drive.friction.coulomb_n = 0.0;
    drive.friction.breakaway_n = 0.0;
    drive.friction.viscous_n_s_per_m = 0.0;
    drive.friction.stiffness_n_per_m = 1e3;
    drive.friction.damping_n_s_per_m = 0.0;
    drive
}

#[test]
fn the_static_curve_is_that_of_the_equation() {
    // R5.10
    let mut friction = DriveParameters::of(Preset::Stiff).friction;
    // At vs the exponential is 1/e: 500 + 120/e + 4000·0.003.
    within(
        friction.steady_n(0.003),
        500.0 + 120.0 / 1f64.exp() + 12.0,
        1e-12,
    );
    assert_eq!(friction.steady_n(-0.003), -friction.steady_n(0.003));
    assert_eq!(friction.steady_n(0.0), 0.0);
    friction.shape = 2.0;
    within(
        friction.steady_n(0.006),
        500.0 + 120.0 * (-4f64).exp() + 24.0,
        1e-12,
    );
}

#[test]
fn a_sliding_contact_of_any_model_has_the_static_friction() {
    // R5.10 R5.11 R5.12: at constant velocity every model carries the same force, so the
    // position loop, whose speed loop integrates, holds the axis on its setpoint.
    for model in [
        FrictionModel::Stribeck,
        FrictionModel::Lugre,
        FrictionModel::Gms,
    ] {
        for speed in [0.001, -0.01, 0.08] {
            let parameters = DriveParameters::of(Preset::Mid);
            let start = Setpoint {
                velocity_m_per_s: speed,
                ..Setpoint::default()
            };
            let mut drive = Drive::settled(&parameters, model, start);
            follow(&mut drive, constant_speed(speed, 1200));
            let force = drive.force_n();
            within(force, parameters.friction.steady_n(speed), 1e-3);
        }
    }
}

#[test]
fn standstill_holds() {
    // R5.10 R5.11 R5.12: a force below the breakaway friction moves the axis only by the bend of its
    // contact.
    for (model, bend) in [
        (FrictionModel::Stribeck, 0.0),
        // 300 N on 1e9 N/m, and a little for the oscillation of the beginning.
        (FrictionModel::Lugre, 1e-6),
        (FrictionModel::Gms, 1e-6),
    ] {
        let mut parameters = DriveParameters::of(Preset::Stiff);
        // An open loop: only the additive current acts.
        parameters.position_gain_per_s = 0.0;
        parameters.speed_gain_n_s_per_m = 0.0;
        let mut drive = Drive::settled(&parameters, model, Setpoint::default());
        let pushed = Setpoint {
            added_units: 60.0,
            ..Setpoint::default()
        };
        let positions = follow(&mut drive, std::iter::repeat_n(pushed, 2000));
        let farthest = positions.iter().copied().fold(0.0, f64::max);
        assert!(farthest <= bend, "{model:?}: {farthest}");
        // And more than the breakaway friction moves it.
        let torn = Setpoint {
            added_units: 200.0,
            ..Setpoint::default()
        };
        let positions = follow(&mut drive, std::iter::repeat_n(torn, 400));
        assert!(positions.last().is_some_and(|&x| x > 1e-4), "{model:?}");
    }
}

#[test]
fn pure_coulomb_friction_brakes_evenly() {
    // R5.10: from 10 mm/s with 500 N on 1300 kg the axis stops after v²·m/(2·Fc) = 130 µm.
    let mut parameters = DriveParameters::of(Preset::Stiff);
    parameters.position_gain_per_s = 0.0;
    parameters.speed_gain_n_s_per_m = 0.0;
    parameters.friction.breakaway_n = 500.0;
    parameters.friction.viscous_n_s_per_m = 0.0;
    let start = Setpoint {
        velocity_m_per_s: 0.01,
        ..Setpoint::default()
    };
    let mut drive = Drive::settled(&parameters, FrictionModel::Stribeck, start);
    // The motor lets go: the force that the integral part holds against friction is taken back.
    let released = Setpoint {
        added_units: -100.0,
        ..Setpoint::default()
    };
    let positions = follow(&mut drive, std::iter::repeat_n(released, 400));
    // In the dead time and the current loop's 0.6 ms the motor still pushes.
    within(positions[positions.len() - 1], 130e-6 + 0.01 * 0.0007, 0.02);
    assert_eq!(drive.velocity_m_per_s(), 0.0);
}

#[test]
fn without_friction_the_circle_shrinks_as_the_linear_loop_says() {
    // R5.20 R5.21: without feed forward the position loop is nearly a first-order lag, so that
    // the radius shrinks to R/sqrt(1 + (ω/Kv)²) and both axes lag by the same angle. The speed
    // loop adds a term of second order: |1/(1 + jω/Kv·(1 + jωT) …)|, below 2 % of the shrink here.
    let mut test = circular_test(3000.0);
    for drive in [&mut test.plant.x, &mut test.plant.y] {
        *drive = without_friction(drive);
        drive.velocity_forward = 0.0;
    }
    let omega: f64 = 3000.0 / 60.0 / 100.0;
    let shrink = 100_000.0 * (1.0 / (1.0 + (omega / 33.3).powi(2)).sqrt() - 1.0);
    let figures = figures(&test, Switched::Off);
    let path = figures.ccw.expect("a path");
    within(path.d_um.expect("D"), shrink, 0.15);
    // No friction, no glitch: the ellipse of a linear loop with equal axes is a circle.
    assert!(path.g_mz_um < 0.02, "{path:?}");
    // With full feed forward nothing of first order is left.
    for drive in [&mut test.plant.x, &mut test.plant.y] {
        drive.velocity_forward = 1.0;
    }
    let path = self::figures(&test, Switched::Off).ccw.expect("a path");
    assert!(path.d_um.expect("D").abs() < 0.1 * shrink.abs(), "{path:?}");
}

#[test]
fn the_reference_figures_are_met() {
    // R5.11 R5.20 R5.22: feed, glitch without and with compensation.
    let reference = [
        (500.0, 10.6, 1.43),
        (1000.0, 14.8, 1.23),
        (2000.0, 19.2, 0.79),
        (5000.0, 23.3, 0.98),
    ];
    for (feed, off, on) in reference {
        let test = circular_test(feed);
        within(glitch(&figures(&test, Switched::Off)), off, 0.05);
        within(glitch(&figures(&test, Switched::On)), on, 0.05);
    }
}

#[test]
fn both_directions_meet_the_reference() {
    // R5.20 R5.21
    let comparison = circular_test(2000.0).compare().expect("a circle");
    let (off, on) = (&comparison.off.figures, &comparison.on.figures);
    within(off.ccw.as_ref().expect("ccw").g_mz_um, 19.16, 0.05);
    within(on.ccw.as_ref().expect("ccw").g_mz_um, 0.78, 0.05);
    within(off.h_um.expect("H"), 18.99, 0.05);
    within(on.h_um.expect("H"), 0.57, 0.05);
    // The clockwise circle is the mirror image.
    let mirrored = |figures: &Figures, crossing: usize| {
        shape(figures.cw.as_ref()).glitches[crossing].height_um
    };
    let straight = |figures: &Figures, crossing: usize| {
        shape(figures.ccw.as_ref()).glitches[crossing].height_um
    };
    for (ccw, cw) in [(0, 0), (1, 3), (2, 2), (3, 1)] {
        within(mirrored(on, cw), straight(on, ccw), 1e-6);
    }
    // R5.24
    let advice = diagnose(&comparison.off.figures, Some(Switched::Off));
    assert_eq!(advice.len(), 8, "{advice:?}");
    assert!(advice.iter().all(|it| it.finding == Finding::Friction));
    assert!(diagnose(&comparison.on.figures, Some(Switched::On)).is_empty());
}

#[test]
fn the_wrong_sign_makes_it_worse() {
    // R5.22
    let mut test = circular_test(1000.0);
    for list in lists(&mut test) {
        list.scaling_factor = -1000;
    }
    within(glitch(&figures(&test, Switched::On)), 24.8, 0.05);
    // R5.24: it is distinguished from a compensation that is too weak.
    let laps = [Switched::Off, Switched::On];
    let laps = laps.map(|compensation| lap(&test, compensation, Direction::Ccw));
    let advice = diagnose_comparison(&Comparison::of(laps));
    assert!(
        advice.iter().all(|it| it.finding == Finding::WrongSign),
        "{advice:?}"
    );
    assert_eq!(advice.len(), 4);
}

#[test]
fn shapes_tell_what_is_wrong() {
    // R5.24: strength and time of the compensation, wrong on purpose.
    type Change = fn(&mut FrictionList);
    let cases: [(Change, Finding); 4] = [
        (|list| list.scaling_factor = 1400, Finding::TooStrong),
        (|list| list.scaling_factor = 600, Finding::TooWeak),
        (|list| list.delay_cycles = 8, Finding::TooLate),
        (
            |list| {
                list.delay_cycles = 0;
                list.reversal_lookahead = 4;
                list.position_delay = 0;
            },
            Finding::TooEarly,
        ),
    ];
    for (change, finding) in cases {
        let mut test = circular_test(3000.0);
        lists(&mut test).for_each(change);
        let lap = lap(&test, Switched::On, Direction::Ccw);
        let comparison = Comparison::of([lap]);
        let advice = diagnose(&comparison.on.figures, Some(Switched::On));
        assert_eq!(advice.len(), 4, "{finding:?}: {advice:?}");
        assert!(advice.iter().all(|it| it.finding == finding), "{advice:?}");
    }
}

#[test]
fn axes_with_different_gains_make_an_ellipse_at_45_degrees() {
    // R5.24: without feed forward the lags v/Kv differ.
    let mut test = circular_test(4000.0);
    for (drive, gain) in [(&mut test.plant.x, 33.3), (&mut test.plant.y, 32.0)] {
        drive.velocity_forward = 0.0;
        drive.position_gain_per_s = gain;
    }
    let laps = Direction::ALL.map(|direction| lap(&test, Switched::Off, direction));
    let comparison = Comparison::of(laps);
    let advice = diagnose(&comparison.off.figures, Some(Switched::Off));
    let whole: Vec<_> = advice
        .iter()
        .filter(|it| it.place == FoundAt::Whole)
        .collect();
    assert!(
        whole.iter().any(|it| it.finding == Finding::GainMismatch),
        "{advice:?}"
    );
    assert!(
        whole.iter().all(|it| it.finding != Finding::Squareness),
        "{advice:?}"
    );
}

#[test]
fn circles_beyond_all_bounds_are_refused() {
    // R5.20
    let check = |radius: f64, feed: f64, cycle_time: f64| {
        let circle = Circle {
            radius_mm: radius,
            feed_mm_per_min: feed,
            cycle_time_s: cycle_time,
        };
        circle.check()
    };
    assert_eq!(check(100.0, 1000.0, 0.001), Ok(()));
    assert_eq!(check(100.0, 1000.0, 0.002), Ok(()));
    assert!(matches!(
        check(100.0, 0.0, 0.001),
        Err(CircleError::Feed(_))
    ));
    assert!(matches!(
        check(100.0, f64::NAN, 0.001),
        Err(CircleError::Feed(_))
    ));
    assert!(matches!(
        check(1e9, 1000.0, 0.001),
        Err(CircleError::Radius(_))
    ));
    assert!(matches!(
        check(100.0, 1000.0, 1.0),
        Err(CircleError::CycleTime(_))
    ));
    assert!(matches!(
        check(100.0, 1000.0, 1e-12),
        Err(CircleError::CycleTime(_))
    ));
    assert!(matches!(
        check(100.0, 1.0, 0.001),
        Err(CircleError::TooLong { .. })
    ));
    assert!(matches!(
        check(1.0, 50_000.0, 0.001),
        Err(CircleError::TooFast { .. })
    ));
    // A loop that does not settle is reported as such.
    let mut test = circular_test(5000.0);
    test.plant.x.position_gain_per_s = 1900.0;
    let limited = test.run(LapRun::ALL[0]).expect("held by the largest force");
    assert!(limited.saturated_cycles > 1000, "{limited:?}");
    test.plant.x.max_force_n = 1e12;
    let unstable = test.run(LapRun::ALL[0]).expect_err("an unstable loop");
    assert!(
        matches!(unstable, CircleError::Unstable { axis: "X", .. }),
        "{unstable}"
    );
}

#[test]
fn a_plant_file_overrides_what_it_names() {
    // R5.20
    let plant = |text: &str| Plant::from_toml(SourceFile::new("p.toml", text));
    let read = plant("base = \"soft\"\nm = 800\n[y]\nKv = 20.0\nFc = 300\n").expect("a plant");
    assert_eq!(
        (
            read.x.mass_kg,
            read.x.position_gain_per_s,
            read.y.position_gain_per_s
        ),
        (800.0, 33.3, 20.0)
    );
    assert_eq!(
        (read.x.friction.coulomb_n, read.y.friction.coulomb_n),
        (500.0, 300.0)
    );
    // Values that follow from the mass follow from the new one.
    within(read.x.speed_gain_n_s_per_m, 800.0 * TAU * 45.0, 1e-12);
    within(
        read.x.friction.damping_n_s_per_m,
        0.6 * (8e7_f64 * 800.0).sqrt(),
        1e-12,
    );
    for (text, message) in [
        ("Kw = 1", "no key `Kw`"),
        ("base = \"stif\"", "no plant `stif`"),
        ("m = -1", "`m` is -1 kg"),
        ("vs = 3.0", "`vs` is 3 m/s"),
        ("Fs = 100", "`Fs` is 100 N and less than `Fc`"),
        ("Kv = \"fast\"", "`Kv` is a number"),
        ("sigma0 = 1e12", "too stiff"),
        ("k_I = 5\nrated_force = 5000", "mean the same"),
        ("gms = [[0.5, 1e9]]", "add up to 0.5"),
        ("m = [", ""),
    ] {
        let error = plant(text).expect_err(text);
        assert!(
            error.diagnostic.message.contains(message),
            "{text}: {error}"
        );
        assert_eq!(error.diagnostic.code.as_str(), "FC110");
    }
}

#[test]
fn tuning_stays_in_its_ranges_and_finds_small_glitches() {
    // R5.25
    let task = Task {
        plant: Preset::Stiff.plant(),
        model: FrictionModel::Lugre,
        circles: vec![Circle {
            feed_mm_per_min: 4000.0,
            ..Circle::default()
        }],
        ranges: Ranges::default(),
        reading: Reading::default(),
        points: Points::Whole,
        shaping: Shaping::None,
        aim: TuningAim::Plant,
    };
    let tuned: Tuned = tune(&task).expect("a circle");
    let [x, y] = &tuned.axes;
    assert_eq!(x, y, "equal drives have one list");
    let best = x.list().expect("a list");
    assert!((0..=10).contains(&best.position_delay), "{best:?}");
    assert!(
        best.reversal_lookahead <= 4 && best.delay_cycles >= 0,
        "{best:?}"
    );
    let row = tuned.feeds[0];
    within(row.glitch_off_um, 22.7, 0.05);
    assert!(row.glitch_on_um <= 1.5, "{row:?}");
    assert!(row.glitch_friction_minus20_um > row.glitch_on_um, "{row:?}");
    assert!(row.glitch_friction_plus20_um > row.glitch_on_um, "{row:?}");
    assert_eq!(tune(&task).expect("a circle"), tuned, "the same again");
    let free = Ranges::default().free(FreeParameter::PositionDelay);
    assert_eq!(free.position_delay, 0..=2000);
    // The written list leaves the reported glitch.
    let mut test = circular_test(4000.0);
    test.compensation = [x, y].map(|axis| axis.compensation.clone());
    let left = glitch(&figures(&test, Switched::On));
    within(left, row.glitch_on_um, 1e-9);
    assert!(best.table.iter().all(|it| it.output.fract() == 0.0));
}

fn any_plant() -> impl Strategy<Value = Plant> {
    let values = (
        (50.0..5000.0, 5.0..60.0, 0.0..1.0),
        (0.0..2000.0, 0.0..800.0, 0.0005..0.02, 0.0..20_000.0),
        (1e7..2e9, 0.3..3.0),
    );
    values.prop_map(
        |((mass, gain, forward), (coulomb, more, vs, viscous), (sigma, shape))| {
            let text = format!(
                "m = {mass}\nKv = {gain}\nk_ff = {forward}\nFc = {}\nFs = {}\nvs = {vs}\n\
             fv = {viscous}\nsigma0 = {}\ndelta = {shape}\nsigma1 = {}\n",
                coulomb + 1.0,
                coulomb + more + 1.0,
                f64::min(sigma, mass * 1e7),
                f64::min(0.1 * mass / 62.5e-6, 1e6),
            );
            Plant::from_toml(SourceFile::new("random.toml", text))
                .expect("a plant within its limits")
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// R5.10 R5.11 R5.12: whatever the plant, a run ends, with numbers or with the reason.
    #[test]
    fn every_plant_gives_numbers_or_a_reason(plant in any_plant(), model in 0_usize..3) {
        let models = [FrictionModel::Stribeck, FrictionModel::Lugre, FrictionModel::Gms];
        let test = CircularTest {
            circle: Circle { radius_mm: 10.0, feed_mm_per_min: 3000.0, cycle_time_s: 0.002 },
            model: models[model],
            compensation: Method::of_plant(&plant),
            plant,
            reading: Reading::default(),
        };
        match test.run(LapRun::ALL[2]) {
            Ok(lap) => {
                let comparison = Comparison::of([lap]);
                let path = comparison.on.figures.ccw.expect("a path");
                assert!(path.g_mz_um.is_finite() && path.g_mz_um >= 0.0, "{path:?}");
                assert!(path.g_mz_um <= path.g_lsc_um + 1e-6, "{path:?}");
                assert!(path.g_lsc_um < 20_000.0, "inside twice the radius: {path:?}");
            }
            Err(error) => assert!(
                matches!(error, CircleError::Unstable { .. } | CircleError::NotFollowed { .. }),
                "{error}"
            ),
        }
    }
}
