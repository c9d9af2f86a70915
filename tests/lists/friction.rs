//! Friction parameters and their checks, R3.11 and R3.20 to R3.29, and the readings C1 to C10.

use frictcomp::diagnostic::{Code, Severity};
use frictcomp::lists::{DEFAULT_MAX_POINTS, FrictionList, TablePoint};
use frictcomp::machine::{Axis, Parameterisation};

use super::host::{Disk, codes, judge, judge_for, meant, parameterise, start};

/// Returns a list with mode 3 and the given further lines.
fn list(lines: &str) -> String {
    format!("frict_comp.mode 3\n{lines}\nEnde")
}

const TWO: &str = "frict_comp.table_entries 2\nfrict_comp.table[0].in 0\nfrict_comp.table[0].out 9\n\
                   frict_comp.table[1].in 9000\nfrict_comp.table[1].out 8\n";

/// Returns the messages about the further lines of a list; tests/lists/values.rs has FC139.
fn judged(lines: &str) -> Vec<String> {
    let mut found = judge(&list(lines)).diagnostics;
    found.retain(|diagnostic| diagnostic.code != Code::Fc139);
    codes(&found)
}

fn accepted(text: &'static str) -> FrictionList {
    match parameterise(text) {
        Parameterisation::Accepted(list) => list,
        other => panic!("not accepted: {other:?}"),
    }
}

fn rejected(text: &'static str) -> String {
    match parameterise(text) {
        Parameterisation::Rejected { file, code } => {
            assert_eq!(file, "c.lis");
            code
        }
        other => panic!("not rejected: {other:?}"),
    }
}

#[test]
fn the_sample_loads() {
    // C1, C2, C4, C13, R3.25, R3.28: the manual's sample, which sends 1 % of its outputs and ends at
    // one third of a mm/s.
    let sample = Disk::open("mill3/sample/comp_x.lis");
    let report = judge(sample.text());
    assert_eq!(
        codes(&report.diagnostics),
        ["FC132 6:33", "FC136 12:33", "FC139 8:33", "FC139 14:33"]
    );
    let late = &report.diagnostics[1];
    for figure in ["114 ms", "316 \u{b5}m/s", "100 mm", "1000 mm/min"] {
        assert!(late.message.contains(figure), "{}", late.message);
    }
    let text = sample.text().to_owned().leak();
    let point = |input, output| TablePoint { input, output };
    let expected = FrictionList {
        position_delay: 30,
        reversal_lookahead: 4,
        scaling_factor: 10,
        delay_cycles: 9,
        max_points: 20,
        table: vec![point(0.0, 0.0), point(316.0, 3722.0), point(333.0, 3884.0)],
    };
    assert_eq!(accepted(text), expected);
}

#[test]
fn defaults_hold_where_nothing_is_written() {
    // R3.11, C7
    let list = accepted(
        "kopf.achs_nr 1\nfrict_comp.mode 3\nfrict_comp.table_entries 1\n\
                         frict_comp.table[0].out 5\nEnde",
    );
    assert_eq!(list.position_delay, 0);
    assert_eq!(list.reversal_lookahead, 0);
    assert_eq!(list.scaling_factor, 1000);
    assert_eq!(list.delay_cycles, 0);
    assert_eq!(list.max_points, DEFAULT_MAX_POINTS);
    assert_eq!(
        list.table,
        [TablePoint {
            input: 0.0,
            output: 5.0
        }]
    );
}

#[test]
fn velocities_are_not_negative_and_ascend() {
    // R3.20, C4, C5
    let at = |points: [&str; 3]| {
        let lines: Vec<_> = (0..3)
            .map(|i| {
                format!(
                    "frict_comp.table[{i}].in {}\nfrict_comp.table[{i}].out 9",
                    points[i]
                )
            })
            .collect();
        judged(&format!("frict_comp.table_entries 3\n{}", lines.join("\n")))
    };
    assert_eq!(at(["0", "1", "2"]), [""; 0]);
    assert_eq!(at(["-1", "1", "2"]), ["P-ERR-110591 3:24"]);
    assert_eq!(at(["0", "5", "5"]), ["P-ERR-110591 7:24"]);
    assert_eq!(at(["0", "5", "4.9"]), ["P-ERR-110591 7:24"]);
    let code = rejected(
        "kopf.achs_nr 1\nfrict_comp.mode 3\nfrict_comp.table_entries 1\nfrict_comp.table[0].in -3\nEnde",
    );
    assert_eq!(code, "P-ERR-110591");
}

#[test]
fn the_mode_is_0_or_3_and_3_needs_values() {
    // R3.21, C3, C8
    for mode in ["1", "2", "4", "65535"] {
        let report = judge(&format!("frict_comp.mode {mode}\n{TWO}Ende"));
        assert_eq!(codes(&report.diagnostics), ["P-ERR-110592 1:17"], "{mode}");
    }
    assert_eq!(judged(""), ["P-ERR-110592 1:17"]);
    assert_eq!(
        judged("frict_comp.table[0].in 0\nfrict_comp.table[0].out 1"),
        ["P-ERR-110592 1:17"]
    );
    assert_eq!(
        rejected("kopf.achs_nr 1\nfrict_comp.mode 3\nEnde"),
        "P-ERR-110592"
    );
    let off = parameterise("kopf.achs_nr 1\nfrict_comp.mode 0\nEnde");
    assert_eq!(off, Parameterisation::Off);
    let unset = parameterise("kopf.achs_nr 1\nfrict_comp.delay_cycles 3\nEnde");
    assert_eq!(unset, Parameterisation::Off);
    assert_eq!(
        parameterise("kopf.achs_nr 1\nEnde"),
        Parameterisation::Missing
    );
}

fn machine_with(max_points: &str) -> Axis {
    let text = format!("kopf.achs_nr 1\n{max_points}\n{}", list(TWO)).leak();
    let files = [
        ("hochlauf.lis", "achs_mds[0] x.lis\nachs_kw[0] c.lis\nEnde"),
        (
            "x.lis",
            "kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.frict_comp 1\nEnde",
        ),
        ("c.lis", &*text),
    ];
    start(&files).machine.axes.remove(0)
}

#[test]
fn the_reserved_size_never_changes() {
    // R3.22
    let axis = machine_with("frict_comp.max_points 30");
    assert_eq!(axis.check_max_points(30), None);
    let changed = axis.check_max_points(20).expect("a difference");
    assert_eq!(changed.code, Code::PErr110641);
    assert_eq!(changed.axis.as_deref(), Some("X"));
    assert!(
        changed.message.contains("axis number 1"),
        "{}",
        changed.message
    );
    assert!(changed.message.contains("`c.lis`"), "{}", changed.message);
    assert_eq!(meant(&changed), "30");

    let silent = machine_with("frict_comp.max_points 0");
    assert_eq!(silent.max_points, DEFAULT_MAX_POINTS);
    assert_eq!(silent.check_max_points(20), None);
    let unsaid = machine_with("").check_max_points(30).expect("a difference");
    assert_eq!(unsaid.place.start().line, 3);
    assert_eq!(Axis::new("X").check_max_points(30), None);
}

#[test]
fn the_table_fits_into_the_reserved_size() {
    // R3.23, C2, C6, C7, C10
    assert_eq!(judged("frict_comp.table_entries 30"), ["FC131 2:26"]);
    assert_eq!(
        judged("frict_comp.max_points 1\nfrict_comp.table_entries 2"),
        ["FC131 3:26"]
    );
    assert_eq!(judged(&format!("frict_comp.max_points 2\n{TWO}")), [""; 0]);
    assert_eq!(judge_for("3.1.3079.06", &list(TWO)).diagnostics, []);
    let code = rejected("kopf.achs_nr 1\nfrict_comp.mode 3\nfrict_comp.table_entries 21\nEnde");
    assert_eq!(code, "FC131");
}

#[test]
fn numbers_have_their_types() {
    // R3.24
    for line in [
        "frict_comp.mode 3.0",
        "frict_comp.mode -1",
        "frict_comp.mode 65536",
        "frict_comp.mode three",
        "frict_comp.mode",
        "frict_comp.table_entries 1e0",
        "frict_comp.position_delay 2147483648",
        "frict_comp.reversal_lookahead -32769",
        "frict_comp.scaling_factor 32767",
        "frict_comp.scaling_factor -32768",
        "frict_comp.delay_cycles 32768",
        "frict_comp.max_points 4294967296",
        "frict_comp.max_points 99999999999999999999",
    ] {
        let report = judge(&format!("{line}\nEnde"));
        let codes: Vec<_> = report.diagnostics.iter().map(|d| d.code).collect();
        assert_eq!(codes, [Code::Fc130], "{line}");
        assert_eq!(report.diagnostics[0].severity, Severity::Error);
    }
    for line in [
        "frict_comp.scaling_factor 32766",
        "frict_comp.scaling_factor -32767",
        "frict_comp.max_points 4294967295",
        "frict_comp.mode 0x0",
    ] {
        assert_eq!(judge(&format!("{line}\nEnde")).diagnostics, [], "{line}");
    }
    for value in ["x", "1e999", "2147483647", "-2147483648", "nan"] {
        let text = format!("frict_comp.table_entries 1\nfrict_comp.table[0].out {value}");
        assert_eq!(judged(&text), ["FC130 3:25"], "{value}");
    }
    let code = rejected(
        "kopf.achs_nr 1\nfrict_comp.mode 3\nfrict_comp.table_entries 1\nfrict_comp.table[0].in 1,5\nEnde",
    );
    assert_eq!(code, "FC130");
}

#[test]
fn real_points_need_a_build_that_reads_them() {
    // R3.24, C9, C10
    let text = list(
        "frict_comp.table_entries 1\nfrict_comp.table[0].in 1666.7\n\
                     frict_comp.table[0].out 1e1",
    );
    assert_eq!(judge(&text).diagnostics, []);
    for build in ["3.1.3132.0", "V3.1.3140.2", "4.29.0", "4.30"] {
        assert_eq!(judge_for(build, &text).diagnostics, [], "{build}");
    }
    for build in ["2.11.2022.05", "3.1.3131.99", "4.28.9", "V3.1.3079.06"] {
        let found = codes(&judge_for(build, &text).diagnostics);
        assert_eq!(found, ["FC130 3:24", "FC130 4:25"], "{build}");
    }
}

#[test]
fn negative_delays_count_as_0() {
    // R3.25
    let text = "kopf.achs_nr 1\nfrict_comp.mode 3\nfrict_comp.table_entries 1\n\
                frict_comp.table[0].out 1\nfrict_comp.position_delay -7\n\
                frict_comp.reversal_lookahead -2\nfrict_comp.delay_cycles -32768\nEnde";
    let report = judge(text);
    let found = codes(&report.diagnostics);
    assert_eq!(found, ["FC132 5:27", "FC132 6:31", "FC132 7:25"]);
    for diagnostic in &report.diagnostics {
        assert_eq!(diagnostic.help(), ["a negative value counts as 0"]);
    }
    let list = accepted(text);
    let delays = (
        list.position_delay,
        list.reversal_lookahead,
        list.delay_cycles,
    );
    assert_eq!(delays, (0, 0, 0));
    let shown = |key: &str| {
        let rows = &report.reports[0].parameters;
        rows.iter()
            .find(|row| row.key == key)
            .unwrap()
            .value
            .clone()
    };
    assert_eq!(shown("frict_comp.position_delay"), "0");
    assert_eq!(shown("frict_comp.delay_cycles"), "0");
}

#[test]
fn values_outside_the_documented_range_are_used() {
    // R3.25, C1
    let text = "kopf.achs_nr 1\nfrict_comp.mode 3\nfrict_comp.table_entries 1\n\
                frict_comp.table[0].out 1\nfrict_comp.position_delay -1\n\
                frict_comp.reversal_lookahead 5\nfrict_comp.delay_cycles 249\nEnde";
    let found = codes(&judge(text).diagnostics);
    assert_eq!(found, ["FC132 5:27", "FC132 6:31", "FC132 7:25"]);
    let list = accepted(text);
    assert_eq!(
        (
            list.position_delay,
            list.reversal_lookahead,
            list.delay_cycles
        ),
        (0, 5, 249)
    );
    let edge = "frict_comp.position_delay 10\nfrict_comp.reversal_lookahead 4\nfrict_comp.delay_cycles 248";
    assert_eq!(judged(&format!("{edge}\n{TWO}")), [""; 0]);
}

#[test]
fn lines_and_entries_agree() {
    // R3.26
    let hole = "frict_comp.table_entries 3\nfrict_comp.table[0].in 0\nfrict_comp.table[2].in 5";
    let report = judge(&list(hole));
    assert_eq!(codes(&report.diagnostics), ["FC133 2:26"]);
    assert!(
        report.diagnostics[0]
            .message
            .contains("`frict_comp.table[1]`")
    );
    assert_eq!(
        judged(&TWO.replace("entries 2", "entries 3")),
        ["FC133 2:26"]
    );
    assert_eq!(
        judged(&TWO.replace("entries 2", "entries 1")),
        ["FC134 5:24"]
    );
    assert_eq!(
        judged(&format!("{TWO}frict_comp.table[4000000000].in 7")),
        ["FC134 7:33"]
    );
    let used = accepted(
        "kopf.achs_nr 1\nfrict_comp.mode 3\nfrict_comp.table_entries 1\nfrict_comp.table[0].out 1\n\
         frict_comp.table[1].in 1\nfrict_comp.table[1].out 1\nEnde",
    );
    assert_eq!(used.table.len(), 1);
}

#[test]
fn a_first_point_at_zero_comes_too_late() {
    // R3.28
    let second = |input: &str| {
        judged(&format!(
            "frict_comp.table_entries 2\nfrict_comp.table[0].in 0\nfrict_comp.table[1].in {input}\n\
             frict_comp.table[1].out 9"
        ))
    };
    // a = v²/r = (1000/60 mm/s)² / 100 mm = 2778 µm/s²: 10 ms are 27.8 µm/s.
    assert_eq!(second("27"), [""; 0]);
    assert_eq!(second("28"), ["FC136 4:24"]);
    assert_eq!(judged(TWO), [""; 0], "the first point has a current");
    let off = format!("frict_comp.mode 0\n{}Ende", TWO.replace("out 9", "out 0"));
    assert_eq!(judge(&off).diagnostics, []);
}

#[test]
fn currents_fit_into_16_bit() {
    // R3.29
    let out = |value: &str, scaling: &str| {
        let table = TWO.replace("out 8", &format!("out {value}"));
        judged(&format!("{table}frict_comp.scaling_factor {scaling}"))
    };
    assert_eq!(out("32767", "1000"), [""; 0]);
    assert_eq!(out("32768", "1000"), ["FC137 6:25"]);
    assert_eq!(out("-32768", "1000"), ["FC137 6:25"]);
    assert_eq!(out("327670", "100"), [""; 0]);
    assert_eq!(out("20000", "-2000"), ["FC137 6:25"]);
}
