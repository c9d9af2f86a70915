//! Words known by name, and the messages about unknown ones: R1.59, R1.60, R2.93, R2.94, R2.97.

use frictcomp::diagnostic::{Code, Severity};
use frictcomp::syntax::parse_comp;

use crate::support::Bench;

fn run(program: &str) -> String {
    Bench::new().keep_going().run(&[program])
}

fn said(program: &str) -> String {
    Bench::new().keep_going().said(program)
}

#[test]
fn documented_commands_change_no_state() {
    // R2.93
    for text in [
        "#DIST TO GO BEGIN",
        "#DIST TO GO END",
        "#EXTCOMP ON",
        "#EXTCOMP OFF [ALL]",
        "#FF [50]",
        "#KIN TCP DEF [X=1]",
        "#KIN TCP DELETE",
        "#LAH [50]",
        "#LIMIT REFRESH",
        "#LIMIT LOAD ON",
        "#limit load off",
        "#LOCK",
        "#START [1]",
        "#SYNC IN [CONVEYOR=1]",
        "#SYNC OUT",
        "#TOOL LIFE DEF [1]",
        "#VIB GUARD [X]",
        "#MC_MovePath SYN [CH=1]",
        "O1234",
        "N10 O1234 ; part",
    ] {
        let found = run(&format!("{text}\nM30"));
        assert!(!found.contains("FC210"), "{text}: {found}");
        assert!(
            found.contains("X:active Y:active Z:unconfigured"),
            "{text}: {found}"
        );
        assert!(!found.contains("unknown"), "{text}: {found}");
    }
}

#[test]
fn a_program_number_stands_alone() {
    // R2.93: next to other words it is a typo for a zero
    for text in ["X1O5", "G1 O5", "O-1", "O1.5", "O1234 X1"] {
        let found = run(&format!("{text}\nM30"));
        assert!(
            found.contains("FC210") || found.contains("FC207"),
            "{text}: {found}"
        );
    }
}

#[test]
fn what_friction_commands_do_is_unknown() {
    // R2.93
    let found = run("#FRICTION ON [X]\nM30");
    assert!(
        found.contains("X:active>unknown|") || found.contains("X:active>unknown"),
        "{found}"
    );
    assert!(found.contains("Y:active Z:unconfigured"), "{found}");
    assert!(!found.contains("FC210"), "{found}");
    let found = said("#FRICTION [AX=Y]\nY[COMP ON FRICT]\nM30");
    assert!(found.contains("FC902 1:1 what `#FRICTION` does to friction compensation is not documented; `FRICT` of `Y` is unknown from here on"), "{found}");
    assert!(run("#FRICTION [AX=Y]\nY[COMP ON FRICT]\nM30").contains("end 3 M30 X:active Y:active"));
    let found = run("#FRICTION\nM30");
    assert!(
        found.contains("X:active>unknown Y:active>unknown"),
        "{found}"
    );
    // A command that may be executed.
    let found = run("$IF V.E.A\n#FRICTION ON [X]\n$ENDIF\nM30");
    assert!(found.contains("X:unknown Y:active"), "{found}");
}

#[test]
fn an_undescribed_exchange_makes_names_doubtful() {
    // R2.93
    let found = run("#ACHSTAUSCH [X, 1]\nX[COMP OFF FRICT]\nM30");
    assert!(!found.contains("FC210"), "{found}");
    assert!(
        found.contains("X:active>unknown Y:active>unknown"),
        "{found}"
    );
    assert!(run("#ACHSTAUSCH\nM30").contains("X:active Y:active"));
}

#[test]
fn a_word_that_calls_no_known_program_is_said_once() {
    // R2.94
    let found = said("G81 Z-5\nG81 Z-6\nG800[1, 2]\nG0 X1\nG81\nM30");
    assert_eq!(found.matches("FC325").count(), 2, "{found}");
    assert!(
        found.contains("FC325 1:1 no program is known for `G81`"),
        "{found}"
    );
    assert!(
        found.contains("FC325 3:1 no program is known for `G800`"),
        "{found}"
    );
    assert!(run("G81\nM30").contains("end 2 M30 X:unknown Y:unknown"));
    assert_eq!(Code::Fc325.severity(), Severity::Warning);
    // It is reported for each program.
    let found = Bench::new().said_in_session(&["G83\nM30", "G83\nM30"]);
    assert_eq!(found.matches("FC325").count(), 2, "{found}");
    // A word whose program is configured, and one that is declared harmless.
    let machine = "[machine]\nharmless = [\"G82\"]\n[machine.programs]\nG81 = \"drill.nc\"\n[[axis]]\nname = \"X\"\nfrict_comp = true\n";
    let bench = Bench::on(machine).file("drill.nc", "M17");
    assert_eq!(
        bench.said("G81\nG82\nG82[1]\nM30").matches("FC325").count(),
        0
    );
    assert_eq!(bench.said("G83\nM30").matches("FC325").count(), 1);
}

#[test]
fn an_unknown_g_function_changes_positions_alone() {
    // R2.94
    let found = said("G777\nG777\nG0 X1\nM30");
    assert_eq!(found.matches("FC210").count(), 1, "{found}");
    assert!(
        found.contains("`G777` is not known to frictcomp; every compensation keeps its state"),
        "{found}"
    );
    assert!(run("G777 X5\nM30").contains("end 2 M30 X:active Y:active"));
    let values = Bench::new().values("G0 X5\nP1=1\nG777", &["P1", "V.A.ABS.X"]);
    assert!(
        values.contains("P1 -> 1") && values.contains("V.A.ABS.X -> unknown"),
        "{values}"
    );
    let harmless = "[machine]\nharmless = [\"g777\"]\n[[axis]]\nname = \"X\"\n";
    assert_eq!(Bench::on(harmless).said("G777\nM30"), "");
    // Functions that the control has.
    for number in [
        4, 8, 9, 12, 13, 20, 25, 33, 51, 60, 61, 63, 66, 68, 74, 92, 98, 100, 108, 112, 129, 135,
        150, 160, 193, 200, 236, 260, 301, 351, 900,
    ] {
        let found = said(&format!("G{number}\nM30"));
        assert!(!found.contains("FC210"), "{found}");
    }
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
