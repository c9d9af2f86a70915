//! Chapter 1: the COMP command, rule by rule.

mod support;

use frictcomp::comp::{CompCommand, Kind, KindSet, Selection, State};
use frictcomp::machine::Machine;
use frictcomp::syntax::parse_comp;
use frictcomp::text::SourceFile;
use insta::assert_snapshot;
use support::{Bench, MACHINE};

/// Every kind is configured.
const ALL_KINDS: &str = r#"
[[axis]]
name = "X"
type = "T"
frict_comp = true
compensations = ["BACKLASH", "CROSS", "PLANE", "LEAD", "TEMP", "FRICT", "CROSSTALK"]
value = { mode = 3, table = [[0, 12], [1800, 10]] }
"#;

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
        ("X[COMP ON FRIKT]", "FC202"),
        ("X[ comp on FRICT", "FC205"),
        ("X[KOMP ON FRICT]", "P-ERR-21301"),
        ("X[COMP ON FRICT] Y[COMP ON FRICT]", "FC207"),
        ("X[COMP ON FRICT] M30", "FC207"),
    ] {
        assert_eq!(parse_comp(text).unwrap_err().code.as_str(), code, "{text}");
    }
}

#[test]
fn one_selection_governs_all_kinds() {
    // R1.2
    let command = command("X[COMP OFF LEAD FRICT TEMP]");
    let kinds: KindSet = [Kind::Lead, Kind::Frict, Kind::Temp].into_iter().collect();
    assert_eq!(command.selection, Selection::Off(kinds));
    assert_eq!(
        parse_comp("X[COMP OFF]").unwrap_err().code.as_str(),
        "FC201"
    );
}

#[test]
fn off_all_takes_no_kind() {
    // R1.3
    assert_eq!(command("X[COMP OFF_ALL]").selection, Selection::OffAll);
    assert_eq!(
        parse_comp("X[COMP OFF_ALL FRICT]")
            .unwrap_err()
            .code
            .as_str(),
        "FC203"
    );
    let bench = Bench::on(ALL_KINDS).kinds(&Kind::ALL);
    assert_snapshot!(bench.run(&["X[COMP OFF_ALL]\nM30"]), @"
    start X.BACKLASH:active X.CROSS:active X.PLANE:active X.LEAD:active X.TEMP:active X.FRICT:active X.CROSSTALK:active
    a.nc -
      1 line 1 - XBACKLASH:active>inactive XCROSS:active>inactive XPLANE:active>inactive XLEAD:active>inactive XTEMP:active>inactive XFRICT:active>inactive XCROSSTALK:active>inactive
      2 line 2 -
        FC401 1:1-16
        FC401 1:1-16
        FC401 1:1-16
        FC401 1:1-16
        FC401 1:1-16
        FC401 1:1-16
        FC401 1:1-16
      end 2 M30 X.BACKLASH:inactive X.CROSS:inactive X.PLANE:inactive X.LEAD:inactive X.TEMP:inactive X.FRICT:inactive X.CROSSTALK:inactive
    ");
}

#[test]
fn commands_are_continued() {
    // R1.5: comments and blanks after the sign, block numbers, comment and blank lines between.
    let program = "N10 X[COMP OFF \\ ; comment\nN20 (comment) FRICT] \\ (more)  \n; a line of its own\n\nN30 Y[ \\\nCOMP OFF\\\n\tFRICT]\nN40 M30";
    assert_snapshot!(Bench::new().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10 X:active>inactive Y:active>inactive
      2 line 8 N40
        FC401 1:5-2:21
        FC401 5:5-7:8
      end 2 M30 X:inactive Y:inactive Z:unconfigured B:ineffective
    ");
    assert_snapshot!(Bench::new().run(&["N10 X[COMP OFF FRICT \\\nN20 M30"]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 N10
        FC205 1:6-7
      end 1 error X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn blanks_and_tabs_are_free_a_comma_is_no_separator() {
    // R1.7
    let program = "X [\tCOMP  OFF\t FRICT ]\nX[ COMP ON FRICT]\nX[COMP OFF FRICT,LEAD]\nX[COMP,OFF FRICT]\nX[COMP OFF, FRICT]\nM30";
    assert_snapshot!(Bench::new().keep_going().run(&[program]), @"
    start X:active Y:active Z:unconfigured B:ineffective
    a.nc -
      1 line 1 - X:active>inactive
      2 line 2 - X:inactive>active
      3 line 3 -
        FC202 3:12-22
      4 line 4 -
        P-ERR-21301 4:3-11
      5 line 5 -
        FC202 5:8-12
      6 line 6 -
      end 6 M30 X:active Y:active Z:unconfigured B:ineffective
    ");
}

#[test]
fn near_misses_get_advice() {
    // 1.1: did you mean
    let advice = |text: &str| {
        let advice = parse_comp(text).unwrap_err().advice;
        let words: Vec<String> = advice.iter().map(ToString::to_string).collect();
        words.join(" / ")
    };
    assert_snapshot!(advice("X[COMP ON FRIKT]"), @"did you mean `FRICT`?");
    assert_snapshot!(advice("X[KOMP ON FRICT]"), @"did you mean `COMP`?");
    assert_snapshot!(advice("X[COMP OFFALL]"), @"did you mean `OFF_ALL`?");
    assert_snapshot!(advice("X[COMP ON BACKLASCH]"), @"did you mean `BACKLASH`?");
    assert_snapshot!(advice("X[COMP ON SOMETHING]"), @"the kinds are BACKLASH, CROSS, PLANE, LEAD, TEMP, FRICT, CROSSTALK");
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

/// X with an axis list of the control that selects FRICT and LEAD.
const LISTED: &str =
    "kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.frict_comp 1\nlr_param.ssfk 1\nEnde";

/// Returns a machine with X as [`LISTED`].
fn listed() -> Machine {
    struct Lists;
    impl frictcomp::machine::ListFiles for Lists {
        fn read(&mut self, _path: &str) -> Result<SourceFile, frictcomp::machine::NoList> {
            Ok(SourceFile::new("x.lis", LISTED))
        }
    }
    let startup = SourceFile::new("hochlauf.lis", "achs_mds[0] x.lis\nEnde");
    let mut found = frictcomp::machine::Configuration::from_startup(startup, &mut Lists);
    found.machine.enable("X");
    found.machine
}

#[test]
fn kinds_that_the_axis_list_does_not_select_are_refused() {
    // R1.41: each with its own number; FRICT and what the list selects are not.
    for (kind, code) in [
        ("TEMP", "P-ERR-70313"),
        ("CROSS", "P-ERR-70316"),
        ("PLANE", "P-ERR-70319"),
        ("CROSSTALK", "P-ERR-70631"),
        ("BACKLASH", "P-ERR-70637"),
    ] {
        let mut bench = Bench::new();
        bench.machine = listed();
        let on = bench.run(&[&format!("X[COMP ON FRICT LEAD {kind}]\nM30")]);
        assert!(on.contains(&format!("{code} 1:1")), "{kind}: {on}");
        let off = bench.run(&[&format!(
            "X[COMP OFF {kind}]\nX[COMP OFF_ALL]\nX[COMP ON FRICT LEAD]\nM30"
        )]);
        assert!(!off.contains("P-ERR"), "{kind}: {off}");
    }
    // frictcomp.toml alone does not prove that a kind is not selected.
    for kind in Kind::ALL {
        let run = Bench::new().run(&[&format!("X[COMP ON {kind}]\nM30")]);
        assert!(!run.contains("P-ERR"), "{kind}: {run}");
    }
    let lead = "[[axis]]\nname = \"X\"\n";
    assert!(
        Bench::on(lead)
            .run(&["X[COMP ON FRICT]"])
            .contains("P-ERR-70495")
    );
}
