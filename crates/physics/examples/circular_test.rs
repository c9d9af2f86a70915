//! A circle on a simulated machine, with friction compensation off and on.
//!
//! `cargo run --example circular_test`

use frictcomp_physics::circle::{Circle, CircularTest, Method};
use frictcomp_physics::current::Reading;
use frictcomp_physics::simulation::{FrictionModel, Preset};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let plant = "stiff".parse::<Preset>()?.plant();
    let test = CircularTest {
        circle: Circle {
            radius_mm: 20.0,
            feed_mm_per_min: 2000.0,
            ..Circle::default()
        },
        compensation: Method::of_plant(&plant),
        plant,
        model: FrictionModel::Lugre,
        reading: Reading::default(),
    };
    let comparison = test.compare()?;
    let (off, on) = (&comparison.off.figures, &comparison.on.figures);
    let glitches = off.glitch_max_um().zip(on.glitch_max_um());
    let (off, on) = glitches.ok_or("the circle is too fast for glitches")?;
    say(&format!("largest glitch: {off:.1} µm off, {on:.1} µm on"));
    assert!(on < off);
    Ok(())
}

#[test]
fn it_runs() {
    main().expect("a circle");
}

#[allow(clippy::print_stdout, reason = "an example shows what happens")]
fn say(text: &str) {
    println!("{text}");
}
