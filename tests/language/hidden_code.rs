//! Text that looks like a command and is not executed: R18.7.

use crate::support::Bench;

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
