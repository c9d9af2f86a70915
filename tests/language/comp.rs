//! COMP as hosts see it: the reader of a command, and its state across resets.

use frictcomp::comp::{CompCommand, Kind, KindSet, Selection, State};
use frictcomp::machine::Machine;
use frictcomp::syntax::parse_comp;

use crate::support::MACHINE;

fn command(text: &str) -> CompCommand {
    let parsed = parse_comp(text).expect("no mistake");
    parsed.expect("a COMP command")
}

#[test]
fn what_is_no_comp_command_is_told_from_a_wrong_one() {
    // R1.1
    for text in [
        "X[INDP_ASYN G1 POS=5 FEED=100 SLOPE_TYPE=STEP]",
        "X[MC_MoveAbsolute POS=5",
        "V.E.OFFSET[2]",
        "V.E.COMP[2]",
        "[3+4]",
        "X[SIN[30]]",
        "G01 X10",
        "X10 (X[COMP",
        "",
        "[",
    ] {
        assert_eq!(parse_comp(text), Ok(None), "{text}");
    }
    for (text, code) in [
        ("X[COMP]", "FC201"),
        ("X[COMP OFF]", "FC201"),
        ("X[COMP ON FRIKT]", "FC202"),
        ("X[COMP OFF_ALL FRICT]", "FC203"),
        ("X[ comp on FRICT", "FC205"),
        ("X[KOMP ON FRICT]", "P-ERR-21301"),
        ("X[COMP ON FRICT] Y[COMP ON FRICT]", "FC207"),
        ("X[COMP ON FRICT] M30", "FC207"),
        // R13.16
        ("X[COMP ON FRICT]\nY[COMP ON FRICT]", "FC207"),
        ("G1 X5\r\nX[COMP ON FRICT]", "FC207"),
        ("/X[COMP ON FRICT]", "FC207"),
        ("/2 X[COMP ON FRICT]", "FC207"),
    ] {
        assert_eq!(parse_comp(text).unwrap_err().code.as_str(), code, "{text}");
    }
}

#[test]
fn a_command_may_end_its_line_and_go_on_in_the_next() {
    // R13.16
    for text in [
        "X[COMP ON FRICT]\r\n",
        "X[COMP \\\nON FRICT]\n\n",
        "N10 X[COMP ON FRICT] (X)",
    ] {
        assert_eq!(command(text).axis, "X", "{text}");
    }
    assert_eq!(parse_comp("G1 X5\nG1 X7\n"), Ok(None));
}

#[test]
fn one_selection_governs_all_kinds() {
    // R1.2 R1.3
    let kinds: KindSet = [Kind::Lead, Kind::Frict, Kind::Temp].into_iter().collect();
    let selected = command("X[COMP OFF LEAD FRICT TEMP]").selection;
    assert_eq!(selected, Selection::Off(kinds));
    assert_eq!(command("X[COMP OFF_ALL]").selection, Selection::OffAll);
}

#[test]
fn reset_keeps_the_state_a_restart_does_not() {
    // R1.28 R1.29
    let machine = Machine::from_toml(MACHINE).unwrap();
    let x = machine.find("X").unwrap();
    let mut state = machine.compensation();
    state.apply(&command("X[COMP OFF FRICT]")).unwrap();
    assert!(state.reset().is_empty());
    assert_eq!(state.state(x, Kind::Frict), State::Inactive);
    assert_eq!(machine.compensation().state(x, Kind::Frict), State::Active);
}
