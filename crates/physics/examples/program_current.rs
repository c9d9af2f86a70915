//! The additive current of an axis of a program, CNC cycle by CNC cycle.
//!
//! `cargo run --example program_current`

use std::ops::ControlFlow;

use frictcomp::machine::Machine;
use frictcomp::text::SourceFile;
use frictcomp_physics::current::CurrentCycle;
use frictcomp_physics::currents;

const MACHINE: &str = r#"
[[axis]]
name = "X"
frict_comp = true
value = { mode = 3, table = [[0, 126], [3000, 112]] }
"#;

const PROGRAM: &str = "\
N10 G01 X0 F1500
N20 X5
N30 X0
N40 M30
";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut cycles = 0;
    let (mut least, mut most) = (f64::MAX, f64::MIN);
    let sink = |cycle: &CurrentCycle<'_>| {
        let x = &cycle.axes[0];
        if cycles % 50 == 0 {
            say(&format!(
                "{:.3} s, line {}: {:>8.1} µm/s, {:>6.1} drive units",
                cycle.time_s, cycle.cause.line, x.commanded.velocity_units, x.added.current_units
            ));
        }
        cycles += 1;
        least = least.min(x.added.current_units);
        most = most.max(x.added.current_units);
        ControlFlow::Continue(())
    };
    let program = SourceFile::new("a.nc", PROGRAM);
    let machine = Machine::from_toml(MACHINE)?;
    currents(program, machine, &["X".to_owned()], sink)?;
    say(&format!(
        "{cycles} cycles, from {least} to {most} drive units"
    ));
    // There and back: the current changes its sign with the direction.
    assert!(least < -100.0 && most > 100.0);
    Ok(())
}

#[test]
fn it_runs() {
    main().expect("currents");
}

#[allow(clippy::print_stdout, reason = "an example shows what happens")]
fn say(text: &str) {
    println!("{text}");
}
