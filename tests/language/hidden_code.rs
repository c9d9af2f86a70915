//! Text that looks like a command and is not executed: R18.7.

use crate::support::{Bench, SourceMode};

fn said(program: &str) -> String {
    Bench::new().keep_going().check_all().said(program)
}

/// The places of FC211 and FC414.
fn codes(program: &str) -> Vec<String> {
    let said = said(program);
    let is_meant = |line: &&str| line.starts_with("FC211 ") || line.starts_with("FC414 ");
    let lines = said.lines().filter(is_meant);
    let codes = lines.map(|line| line.split(' ').take(2).collect::<Vec<_>>().join(" "));
    codes.collect()
}

#[test]
fn a_comment_in_place_of_a_bracket_is_reported() {
    // R18.7
    for (block, column) in [
        ("X(COMP OFF FRICT)", 1),
        ("N20 X (COMP OFF FRICT)", 5),
        ("Y0 X\t( comp off_all )", 4),
        ("X;COMP ON FRICT", 1),
        ("Y[COMP ON FRICT] X(COMP OFF FRICT)", 18),
        ("X(see the COMP table)", 1),
        ("X(COMP OFF FRICT", 1),
    ] {
        for end in ["\n", "\r\n", "\r"] {
            let program = format!("G0 Y0{end}{block}{end}M30{end}");
            assert_eq!(
                codes(&program),
                [format!("FC414 2:{column}")],
                "{program:?}"
            );
        }
    }
    let found = said("X(COMP OFF FRICT)\nM30");
    assert!(found.contains("`X[COMP OFF FRICT]`"), "{found}");
    // What follows is a value or a comment about something else.
    for block in [
        "X10 (COMP OFF FRICT before this)",
        "X(COMPENSATION)",
        "X10(COMP OFF FRICT)",
        "X[COMP ON FRICT](COMP OFF FRICT)",
    ] {
        assert!(!said(&format!("{block}\nM30")).contains("FC414"), "{block}");
    }
}

#[test]
fn a_comment_that_takes_in_a_command_is_reported() {
    // R18.7
    for (program, place) in [
        ("( X[COMP OFF FRICT]\nM30", "1:1"),
        ("N10 G1 X1 F1 (slow Y [ comp ON FRICT ]\nM30", "1:14"),
        ("(a (b) Q_1[COMP OFF FRICT]\nM30", "1:1"),
        ("%M (X[COMP OFF FRICT]\nM30", "1:4"),
        ("M30 (X[COMP OFF FRICT]", "1:5"),
        ("Y1 \\ (X[COMP OFF FRICT]\nX1\nM30", "1:6"),
        ("Y1 \\\nX1 (Z[COMP OFF FRICT]\nM30", "2:4"),
        ("M30\n( X[COMP OFF FRICT]", "2:1"),
    ] {
        assert_eq!(codes(program), [format!("FC414 {place}")], "{program}");
        let lines = Bench::new().keep_going().check_all();
        let lines = lines.handed(SourceMode::LineByLine).run(&[program]);
        assert!(lines.contains("FC414"), "{program}: {lines}");
    }
    for program in [
        "; here COMP OFF FRICT is used\nM30",
        "(COMP OFF FRICT is done later)\nM30",
        "(COMP OFF FRICT is done later\nM30",
        "( X[COMP OFF FRICT] )\nM30",
        "; X[COMP OFF FRICT]\nM30",
        "; ( X[COMP OFF FRICT]\nM30",
        "G0 X10 (Y[COMP OFF FRICT] before this)\nM30",
        "(a (b Y[COMP OFF FRICT]) c)\nM30",
        "( [COMP OFF FRICT]\nM30",
        "V.S.T = \"(X[COMP OFF FRICT]\"\nM30",
    ] {
        assert!(!said(program).contains("FC414"), "{program}");
    }
}

#[test]
fn a_comment_region_without_an_end_is_reported() {
    // R18.7
    for program in [
        "N10 Y0\n  #COMMENT BEGIN\nX[COMP OFF FRICT]\nM30",
        "N10 Y0\n#comment begin\n",
    ] {
        let found = said(program);
        assert_eq!(found.matches("FC414 2:").count(), 1, "{program}: {found}");
        assert!(found.contains("never executed"), "{found}");
    }
    let local = "%M\nM30\n%L SUB\n#COMMENT BEGIN\nX[COMP OFF FRICT]\nM17";
    assert!(said(local).contains("FC414 4:1"));
    let closed = "#COMMENT BEGIN\nX[COMP OFF FRICT]\n( Y[COMP OFF FRICT]\nX\n#COMMENT END\nM30";
    assert_eq!(said(closed), "");
}

#[test]
fn an_axis_word_without_a_value_is_reported() {
    // R18.7
    assert_eq!(codes("X\nM30"), ["FC211 1:1"]);
    assert_eq!(codes("G0 X Y10\nM30"), ["FC211 1:4"]);
    assert_eq!(
        codes("G90 X Y\nG92 X\nM30"),
        ["FC211 1:5", "FC211 1:7", "FC211 2:5"]
    );
    let unreached = "%M\nM30\n%L SUB\nX\nM17";
    assert_eq!(codes(unreached), ["FC211 4:1"]);
    // G functions that name axes, and words with a value of any form.
    for program in [
        "G74 X Y\nM30",
        "G201 X\nM30",
        "G101 X\nM30",
        "G0 X=1 YP1 Z[1+2]\nM30",
        "X[COMP ON FRICT]\nM30",
    ] {
        assert!(!said(program).contains("FC211"), "{program}");
    }
}

#[test]
fn no_word_switches_every_kind_on() {
    // R18.7, R1.60
    for (words, help) in [
        ("ON_ALL", "name the kinds to switch on"),
        ("ONALL FRICT", "name the kinds to switch on"),
        ("ON ALL", "name the kinds to switch on"),
        ("ALL_ON", "name the kinds to switch on"),
        ("OFF ALL", "did you mean `OFF_ALL`?"),
        ("ALL_OFF", "did you mean `OFF_ALL`?"),
    ] {
        let found = said(&format!("X[COMP {words}]\nM30"));
        assert!(found.starts_with("FC202 1:"), "{words}: {found}");
        assert!(found.contains(help), "{words}: {found}");
        let opposite = if help.contains("OFF_ALL") {
            "`ON"
        } else {
            "`OFF"
        };
        assert!(
            !found.contains(&format!("did you mean {opposite}")),
            "{found}"
        );
        for kind in ["BACKLASH", "FRICT", "CROSSTALK"] {
            assert!(found.contains(kind), "{words}: {found}");
        }
    }
}
