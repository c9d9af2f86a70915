//! The motion of an axis (R10.7), and its consequences: hazards, cures.

use crate::folder::Bench;
use serde_json::Value;

const MACHINE: &str = "\
[[axis]]
name = \"X\"
number = 1
frict_comp = true
value = { mode = 3, table = [[0, 12], [1800, 10]] }
[[axis]]
name = \"Y\"
number = 2
frict_comp = true
value = { mode = 3, table = [[0, 12], [1800, 10]] }
[[axis]]
name = \"Z\"
number = 3
frict_comp = true
value = { mode = 3, table = [[0, 12], [1800, 10]] }
[[axis]]
name = \"X_LONG\"
number = 4
frict_comp = true
value = { mode = 3, table = [[0, 12], [1800, 10]] }
";

const LEAVER: &str = "N10 X[COMP OFF FRICT] X_LONG[COMP OFF FRICT]\nN20 M30\n";

fn bench(programs: &[(&str, &str)]) -> Bench {
    let bench = Bench::new(programs);
    bench.write("frictcomp.toml", MACHINE);
    bench
}

fn audit(bench: &Bench) -> Vec<Value> {
    let text = bench.stdout(&["audit", "--format", "ndjson"]);
    let lines = text.lines();
    lines
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect()
}

fn program<'a>(records: &'a [Value], file: &str, axis: &str) -> &'a Value {
    let mut programs = records.iter().filter(|it| it["record"] == "program");
    let program = programs.find(|it| it["file"] == file);
    &program.expect("the program")["axes"][axis]
}

fn finding<'a>(records: &'a [Value], name: &str) -> &'a Value {
    let mut axes = records.iter().filter(|it| it["record"] == "axis");
    axes.find(|it| it["axis"] == name).expect("the axis")
}

/// Returns the messages of a code in a session of two programs.
fn said(bench: &Bench, files: &[&str], code: &str) -> Vec<Value> {
    let arguments = [&["run", "--format", "ndjson"], files].concat();
    let text = bench.stdout(&arguments);
    let records = text
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"));
    records.filter(|it: &Value| it["code"] == code).collect()
}

#[test]
fn every_form_moves_the_axis() {
    // R10.7
    for (axis, body, motion) in [
        ("X", "G1 X5 F100", "feed"),
        ("X", "G0 X5", "rapid"),
        ("X", "G33 X5 K1", "feed"),
        ("X", "G100 X5 F100", "feed"),
        ("X", "G74 X1", "homing"),
        ("X", "g74 X1", "homing"),
        ("X", "X[INDP_ASYN G90 G01 FEED=10 POS=5]", "independent"),
        ("X", "X[indp_syn G91 \\\r\nN11 G00 POS=5]", "independent"),
        ("X", "X [ MC_MoveAbsolute POS=10 VEL=5 ]", "independent"),
        ("X", "X[MC_MoveVelocity Velocity=5]", "independent"),
        ("X", "X[MC_Home]", "homing"),
        ("X", "X[OSC ON 1ST_POS=1 2ND_POS=2 FEED=3]", "independent"),
        ("X", "X[POLY A0=0 A1=1 L=1]", "feed"),
        ("X", "X[DIST_CTRL ON]", "independent"),
        ("X", "X[LIFT_START POS_LIMIT=3]", "independent"),
        ("X", "X[SYNC IN G90 POS=3]", "independent"),
        ("X_LONG", "X_LONG[INDP_SYN G90 G00 POS=5]", "independent"),
        ("X_LONG", "X_LONG=5", "rapid"),
        (
            "X",
            "\"M\" = \"X[INDP_SYN G90 G00 POS=5]\"\r\n\"M\"",
            "independent",
        ),
        ("X", "#GANTRY ON [X,Y]\r\nG0 Y5", "coupled"),
        (
            "X",
            "#GANTRY ON [Y, X]\r\nY[INDP_SYN G90 G00 POS=5]",
            "coupled",
        ),
        (
            "X",
            "#GEAR LINK [TARGET=X AX1=Y NUM1=1 DENOM1=2]\r\nG0 Y5",
            "coupled",
        ),
        (
            "X",
            "#gear link [target=X ax1=Y num1=1 denom1=2]\r\nG0 Y5",
            "coupled",
        ),
        (
            "X",
            "#SET AX LINK [1, X=Y]\r\n#ENABLE AX LINK [1]\r\nG0 Y5",
            "coupled",
        ),
        (
            "X",
            "#AX LINK [1, [Z=Y,G], [X=Y,G]]\r\n#AX LINK ON [1]\r\nG0 Y5",
            "coupled",
        ),
        (
            "X",
            "X[MC_GearIn Master=2 RatioNumerator=1 RatioDenominator=1]\r\nG0 Y5",
            "coupled",
        ),
        ("X", "#GANTRY ON [X, Y]\r\nG74 Y1", "homing"),
        ("X", "#ROTATION ON [ANGLE=30]\r\nG1 Y5 F100", "frame"),
        ("X", "#ROTATION ON [ANGLE 30]\r\nG1 Y5 F100", "frame"),
    ] {
        let mover = format!("{body}\r\nM30\r\n");
        let bench = bench(&[("leaver.nc", LEAVER), ("mover.nc", &mover)]);
        let records = audit(&bench);
        let inherits = &program(&records, "mover.nc", axis)["inherits"];
        assert_eq!(inherits["motion"], motion, "{body}: {inherits}");
        assert_eq!(inherits["perhaps"], Value::Null, "{body}");
        assert_eq!(finding(&records, axis)["hazards"], 1, "{body}");
        let said = said(&bench, &["leaver.nc", "mover.nc"], "FC403");
        assert!(said.iter().any(|it| it["axis"] == axis), "{body}");
    }
}

#[test]
fn what_only_may_move_is_a_possible_hazard() {
    // R10.7
    for body in [
        "#CS ON [0,0,0,0,0,45]\nG1 Y5 F100",
        "#TRAFO ON\nG1 Z5 F100",
        "#KIN ID [9]\n#TRAFO ON\nG1 Z5 F100",
        "#ROTATION ON [ANGLE=V.E.A]\nG1 Y5 F100",
        "#ROTATION ON [ANGLE=90]\nG1 Y5 F100",
        "G68 R30 X1 Y1\nG1 Y5 F100",
        "G201 X1\nG1 Z5 F100",
        "$IF V.E.A == 1\n#GANTRY ON [X,Y]\n$ENDIF\nG0 Y5",
        "$IF V.E.A == 1\nX[INDP_SYN G90 G00 POS=5]\n$ENDIF",
        "$IF V.E.A == 1\nG0 X5\n$ENDIF",
    ] {
        let mover = format!("{body}\nM30\n");
        let bench = bench(&[("leaver.nc", LEAVER), ("mover.nc", &mover)]);
        let records = audit(&bench);
        let inherits = &program(&records, "mover.nc", "X")["inherits"];
        assert_eq!(inherits["perhaps"], true, "{body}: {inherits}");
        let finding = finding(&records, "X");
        assert_eq!(finding["hazards"], 0, "{body}");
        assert_eq!(finding["possible_hazards"], 1, "{body}");
        assert_eq!(finding["cure"], "leavers", "{body}");
        let text = bench.stdout(&["audit"]);
        let rows = text.lines().filter(|line| line.starts_with("mover.nc "));
        assert!(rows.clone().any(|row| row.contains("perhaps")), "{text}");
        assert_eq!(bench.status(&["audit", "--fail-on", "warning"]), Some(1));
    }
}

#[test]
fn what_does_not_move_is_no_motion() {
    // R10.7
    for body in [
        "X[OSC OFF]",
        "X[INDP_SYN DRY_RUN G90 G00 POS=5]",
        "X[MC_Stop]",
        "X[OVERRIDE FEED_FACT=50]",
        "G92 X5",
        "G04 X1",
        "G68 R30 X1 Y1",
        "#GANTRY ON [X,Y]\n#GANTRY OFF [X,Y]\nG0 Y5",
        "#SET AX LINK [1, X=Y]\nG0 Y5",
        "#SET AX LINK [1, X=Y]\n#ENABLE AX LINK [1]\n#DISABLE AX LINK [1]\nG0 Y5",
        "#SET AX LINK [1, Y=X]\n#ENABLE AX LINK [1]\nG0 Z5",
        "#ROTATION ON [ANGLE=30]\n#ROTATION OFF\nG1 Y5 F100",
        "#ROTATION ON [ANGLE=30]\nG1 Z5 F100",
    ] {
        let mover = format!("{body}\nM30\n");
        let bench = bench(&[("mover.nc", &mover)]);
        let records = audit(&bench);
        assert_eq!(
            program(&records, "mover.nc", "X")["inherits"],
            "no",
            "{body}"
        );
    }
}

#[test]
fn homing_counts_neither_for_the_second_run_nor_for_required_kinds() {
    // R10.7, R1.36
    let machine = MACHINE.replacen("number = 1\n", "number = 1\nrequired = [\"FRICT\"]\n", 1);
    for (body, fails, differs) in [
        ("G74 X1", false, false),
        ("X[MC_Home]", false, false),
        ("G0 X1", true, true),
        ("X[INDP_SYN G90 G00 POS=5]", true, true),
        ("#GANTRY ON [X,Y]\nG0 Y5", true, true),
        ("#ROTATION ON [ANGLE=30]\nG1 Y5 F100", true, true),
        ("#CS ON [0,0,0,0,0,45]\nG1 Y5 F100", false, false),
    ] {
        let before = format!("{body}\nX[COMP OFF FRICT]\nM30\n");
        let after = format!("X[COMP OFF FRICT]\n{body}\nX[COMP ON FRICT]\nM30\n");
        let bench = bench(&[("before.nc", &before), ("after.nc", &after)]);
        let second = said(&bench, &["before.nc"], "FC407");
        assert_eq!(!second.is_empty(), differs, "{body}");
        bench.write("frictcomp.toml", &machine);
        let missing = said(&bench, &["after.nc"], "P-ERR-70435");
        assert_eq!(!missing.is_empty(), fails, "{body}");
    }
}

#[test]
fn nothing_says_that_nothing_is_to_be_done_where_an_effect_is_unknown() {
    // R10.9
    let unknown = "L missing.nc\nM30\n";
    let bench = bench(&[("a.nc", unknown), ("heir.nc", "G01 X5 F100\nM30\n")]);
    let text = bench.stdout(&["audit", "--html", "report.html"]);
    let page = bench.read("report.html");
    let mut findings = page.split("<p>").filter(|it| it.starts_with("X: "));
    let finding = findings.next().expect("the finding of X");
    assert!(!finding.contains("nothing to do"), "{finding}");
    assert!(finding.contains("not known"), "{finding}");
    for told in [&text, &page] {
        assert!(!told.contains("X: no program leaves it off"), "{told}");
        assert!(
            told.contains("X: no program is known to leave it off"),
            "{told}"
        );
    }
}
