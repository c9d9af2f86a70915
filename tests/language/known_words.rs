//! Words known by name, and the messages about unknown ones: R1.59, R1.60, R2.93, R2.94, R2.97.

use frictcomp::diagnostic::Code;
use frictcomp::syntax::parse_comp;

use crate::support::Bench;

fn said(program: &str) -> String {
    Bench::new().keep_going().said(program)
}

#[test]
fn words_of_axes_that_the_lists_lack_are_said_once() {
    // R2.94
    let mut bench = Bench::on("[[axis]]\nname = \"X\"\nfrict_comp = true\n");
    let program = "G1 X1 W5 F100\nG1 W6 Z1=3\nG4 Y2\nG92 Y0\nW7\nM30";
    assert_eq!(
        bench.said(program),
        "",
        "a configuration of frictcomp need not list all axes"
    );
    bench.machine.axes_are_listed = true;
    let found = bench.said(program);
    assert_eq!(found.matches("FC210").count(), 2, "{found}");
    assert!(
        found.contains("FC210 1:7 the lists of the machine name no axis `W`"),
        "{found}"
    );
    assert!(
        found.contains("FC210 2:7 the lists of the machine name no axis `Z1`"),
        "{found}"
    );
    assert!(bench.run(&[program]).contains("end 6 M30 X:ineffective"));
}

#[test]
fn every_spelling_of_the_program_end_has_the_fix() {
    // R1.59
    use frictcomp::session::{Findings, NoFiles, Program};
    use frictcomp::text::SourceFile;
    for end in [
        "M30",
        "M02",
        "M2",
        "M 30",
        "M=30",
        "M=P1",
        "m30",
        "M030",
        "N90 M 2 ; end",
        "M2 (end)",
    ] {
        let bench = Bench::new();
        let text = format!("P1=30\nX[COMP OFF FRICT]\n{end}\n");
        let mut findings = Findings::default();
        let source = Program::Whole(SourceFile::new("a.nc", text.as_str()));
        let _ = bench
            .session()
            .program("a.nc", source, &mut NoFiles, &mut findings);
        let left = findings.diagnostics().find(|it| it.code == Code::Fc401);
        let fix = left.and_then(|it| it.fixes.first());
        let start = fix.map(|fix| (fix.place.start().line, fix.text.as_str()));
        assert_eq!(start, Some((3, "X[COMP ON FRICT]\n")), "{end}");
    }
}

#[test]
fn no_slip_turns_a_selection_round() {
    // R1.60
    let of = |text: &str| {
        let fault = parse_comp(text).unwrap_err();
        let help: Vec<String> = fault.advice.iter().map(ToString::to_string).collect();
        let fixes: Vec<String> = fault.fixes.into_iter().map(|fix| fix.text).collect();
        (help.join(" / "), fixes.join(" / "))
    };
    for word in ["OF", "OFFF", "0FF", "FF", "of", "Off_"] {
        let found = of(&format!("X[COMP {word} FRICT]"));
        assert_eq!(
            found,
            ("did you mean `OFF`?".to_owned(), "OFF".to_owned()),
            "{word}"
        );
    }
    for word in ["OFN", "ONF", "NO"] {
        let found = of(&format!("X[COMP {word} FRICT]"));
        assert_eq!(
            found,
            ("did you mean `ON` or `OFF`?".to_owned(), String::new()),
            "{word}"
        );
    }
    assert!(!of("X[COMP ON_ALL]").1.contains("OFF"));
    // Other equally similar words are named, too.
    let found = said("#WCS TO WCS\nM30");
    assert!(
        found.contains("did you mean `#MCS TO WCS` or `#WCS TO MCS`?"),
        "{found}"
    );
    let machine = "[[axis]]\nname = \"X1\"\n[[axis]]\nname = \"X2\"\n";
    let found = Bench::on(machine).said("X3[COMP OFF FRICT]\nM30");
    assert!(found.contains("did you mean `X1` or `X2`?"), "{found}");
}

#[test]
fn a_program_of_another_control_is_said_to_be_one() {
    // R2.97
    let parts = (0..40)
        .map(|number| format!("R{number}=5\nN20 IF R{number}>3 GOTOF DONE\nG1 X{number} F100\n"));
    let text = format!("N10 G0 X0 Y0\n{}M30\n", parts.collect::<String>());
    let found = Bench::new().check_all().said(&text);
    let first = found.lines().next().unwrap_or_default();
    assert!(
        first.starts_with("FC326 1:1 this is a program for SINUMERIK, not for an ISG control"),
        "{found}"
    );
    assert!(first.contains("`R0=`, `IF`, `R1=`"), "{first}");
    let codes = found
        .lines()
        .filter(|line| line.starts_with("FC") || line.starts_with("P-ERR"));
    let others = codes.filter(|line| !line.starts_with("FC326") && !line.starts_with("FC905"));
    assert_eq!(others.count(), 20, "{found}");
    assert_eq!(found.matches("FC326").count(), 1);
    let plain = "%\nO1234\nN10 G90 G54 G17\nN20 G43 H1 Z50\nN40 G1 X5 F100\nN50 M30\n";
    assert!(!said(plain).contains("FC326"));
    assert!(!said("P1=1\n$IF P1==1\nR1=1\nR2=2\nR3=3\n$ENDIF\nM30\n").contains("FC326"));
}
