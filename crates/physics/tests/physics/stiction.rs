//! Chapter 8: stiction compensation of a simulated drive.

use frictcomp::lists::Points;
use frictcomp::text::SourceFile;
use frictcomp_physics::circle::{
    Circle, CircularTest, Comparison, Direction, FreeParameter, LapRun, Method, Ranges, Shaping,
    Task, Tuned, TuningAim, tune,
};
use frictcomp_physics::current::{Reading, Switched};
use frictcomp_physics::simulation::{FrictionModel, Plant};

/// The drive of the acceptance: 16.7 1/s, a speed loop of 30 Hz with 30 ms, the stiff contact.
const DRIVE: &str = "Kv = 16.7\nKp = 245044.227\nTi = 0.03\n";

fn plant(stiction: &str) -> Plant {
    let text = format!("{DRIVE}{stiction}");
    Plant::from_toml(SourceFile::new("p.toml", text)).expect("a plant")
}

fn circle(feed_mm_per_min: f64) -> Circle {
    Circle {
        feed_mm_per_min,
        ..Circle::default()
    }
}

/// Returns the largest glitch in µm of the counter-clockwise circle with the plant's own compensation.
fn glitch(plant: Plant, circle: Circle, compensation: Switched) -> f64 {
    let test = CircularTest {
        circle,
        compensation: Method::of_plant(&plant),
        plant,
        model: FrictionModel::Lugre,
        reading: Reading::default(),
    };
    let job = LapRun {
        compensation,
        direction: Direction::Ccw,
    };
    let comparison = Comparison::of([test.run(job).expect("a circle")]);
    let side = match compensation {
        Switched::Off => comparison.off,
        Switched::On => comparison.on,
    };
    side.figures.glitch_max_um().expect("a glitch")
}

fn within(found: f64, expected: f64) {
    assert!(
        (found / expected - 1.0).abs() < 0.05,
        "{found} is not {expected}"
    );
}

#[test]
fn the_glitches_are_those_of_the_acceptance() {
    // R8.6: R 100 mm, t_C 3 ms, MP1511 10 000 µs.
    let compensated = || plant("[stiction]\nmp1511 = 10000\ntc = 3000\n");
    for (feed, off, on) in [(500.0, 42.5, 40.8), (1000.0, 57.0, 53.7)] {
        within(glitch(compensated(), circle(feed), Switched::Off), off);
        within(glitch(compensated(), circle(feed), Switched::On), on);
    }
}

#[test]
fn above_mp1513_and_without_feed_forward_nothing_is_added() {
    // R8.2 R8.6: 3 m/min is the last feed at which it acts.
    let circle = Circle {
        radius_mm: 20.0,
        ..circle(3000.0)
    };
    let both = |stiction: &str| {
        [Switched::Off, Switched::On].map(|switched| glitch(plant(stiction), circle, switched))
    };
    let [off, on] = both("[stiction]\nmp1511 = 10000\nmp1513 = 3\n");
    assert!(on < 0.95 * off, "{on} {off}");
    let same = |[off, on]: [f64; 2]| assert!((off - on).abs() < 1e-9, "{on} {off}");
    same(both("[stiction]\nmp1511 = 10000\nmp1513 = 2.999\n"));
    same(both("k_ff = 0\n[stiction]\nmp1511 = 10000\n"));
    // MP1511 of 0 switches it off, and with a limit of 0 it has no effect.
    same(both("[stiction]\nmp1513 = 3\n"));
    same(both("[stiction]\nmp1511 = 10000\nmp1512 = 0\n"));
}

#[test]
fn a_lower_limit_adds_less() {
    // R8.1: the change of the lag is clipped to MP1512 · GP / 256.
    let circle = Circle {
        radius_mm: 20.0,
        ..circle(3000.0)
    };
    let on = |limit: &str| {
        let text = format!("[stiction]\nmp1511 = 10000\n{limit}\n");
        glitch(plant(&text), circle, Switched::On)
    };
    let [free, little, same] = [
        on("mp1512 = 400"),
        on("mp1512 = 8"),
        on("mp1512 = 4\ngp = 40"),
    ];
    assert!(free < little - 0.5, "{free} {little}");
    assert!((little - same).abs() < 1e-9, "{little} {same}");
}

#[test]
fn axes_may_differ_and_values_are_checked() {
    // R8.6
    let plant = plant("[stiction]\nmp1511 = 8000\ngp = 10\n[y.stiction]\nmp1511 = 6000\n");
    let [x, y] = [&plant.x, &plant.y].map(|drive| drive.stiction.expect("stiction"));
    assert_eq!((x.mp1511_us, y.mp1511_us), (8000.0, 6000.0));
    assert_eq!((x.gp_um, y.gp_um), (10.0, 10.0));
    let one = Plant::from_toml(SourceFile::new("p.toml", "[x.stiction]\nmp1511 = 8000\n"));
    let [x, y] = Method::of_plant(&one.expect("a plant"));
    assert!(matches!(x, Some(Method::Stiction(_))) && y.is_none());
    let refused = |text: &str| {
        let source = SourceFile::new("p.toml", text);
        let error = Plant::from_toml(source).expect_err(text);
        error.diagnostic.message.clone()
    };
    let cases = [
        (
            "[stiction]\nmp1511 = 16777216\n",
            "`mp1511` is 16777216 µs; it must be between 0 and 16777215",
        ),
        (
            "[stiction]\ntc = 3100\n",
            "`tc` is 3100 µs; it must be a multiple of 250 µs",
        ),
        ("[stiction]\nmp1512 = -1\n", "`mp1512` is -1 counting steps"),
        ("[stiction]\nmp1512 = \"x\"\n", "`mp1512` is a number"),
        (
            "[stiction]\nmp1514 = 1\n",
            "`[stiction]` has no key `mp1514`",
        ),
        ("stiction = 5\n", "stiction"),
    ];
    for (text, said) in cases {
        assert!(refused(text).contains(said), "{}", refused(text));
    }
}

#[test]
fn mp1511_and_mp1512_are_tuned() {
    // R8.6: within the guidelines, or beyond them.
    let task = |ranges: Ranges| Task {
        plant: plant("[stiction]\ntc = 3000\n"),
        model: FrictionModel::Lugre,
        circles: vec![Circle {
            radius_mm: 20.0,
            ..circle(3000.0)
        }],
        ranges,
        reading: Reading::default(),
        points: Points::Whole,
        shaping: Shaping::Allowed,
        aim: TuningAim::Plant,
    };
    let found = |tuned: &Tuned| *tuned.axes[0].stiction().expect("stiction");
    let tuned = tune(&task(Ranges::default())).expect("a circle");
    let best = found(&tuned);
    assert!(
        tuned.is_stiction() && best.guidelines().is_empty(),
        "{best:?}"
    );
    let row = tuned.feeds[0];
    assert!(row.glitch_on_um < 0.95 * row.glitch_off_um, "{row:?}");
    // The tuned parameters leave the reported glitch.
    let text = format!(
        "[stiction]\nmp1511 = {}\nmp1512 = {}\n",
        best.mp1511_us, best.mp1512
    );
    let left = glitch(
        plant(&text),
        task(Ranges::default()).circles[0],
        Switched::On,
    );
    assert!((left - row.glitch_on_um).abs() < 1e-9, "{left} {row:?}");
    let ranges = Ranges::default().free(FreeParameter::Mp1511);
    let free = tune(&task(ranges.free(FreeParameter::Mp1512))).expect("a circle");
    assert!(free.feeds[0].glitch_on_um < row.glitch_on_um, "{free:?}");
    assert!(found(&free).mp1511_us > 10_000.0, "{free:?}");
}
