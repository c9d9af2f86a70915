//! Checks a program and applies the safe fixes.
//!
//! `cargo run --example check_and_fix`

use frictcomp::check;
use frictcomp::diagnostic::{Fix, Fixed, Safety};
use frictcomp::interpreter::NoFiles;
use frictcomp::machine::Machine;
use frictcomp::session::SessionOptions;
use frictcomp::text::SourceFile;

const PROGRAM: &str = "\
N10 X[COMP off FRICT]
N20 G01 X50 F1500
N30 X[COMP ON FRIKT]
N40 M30
";

fn main() {
    let program = SourceFile::new("a.nc", PROGRAM);
    let (machine, options) = (Machine::enabled(["X"]), SessionOptions::default());
    let findings = check(program.clone(), machine, options, &mut NoFiles);
    let mut safe: Vec<&Fix> = Vec::new();
    for said in findings.diagnostics() {
        let place = &said.place;
        say(&format!(
            "{}:{}: {} {}: {}",
            place.file,
            place.start(),
            said.severity,
            said.code,
            said.message
        ));
        safe.extend(said.fixes.iter().filter(|fix| fix.safety == Safety::Safe));
    }
    let fixed = Fixed::new(&program, safe);
    say(&fixed.text);
    // `FRICT` is only a guess, which the user has to review.
    assert!(fixed.text.starts_with("N10 X[COMP OFF FRICT]"));
    assert!(fixed.text.contains("FRIKT"));
}

#[test]
fn it_runs() {
    main();
}

#[allow(clippy::print_stdout, reason = "an example shows what happens")]
fn say(text: &str) {
    println!("{text}");
}
