//! Use of lists in motion and in later loads, and lists that are too long for a document.

use frictcomp::diagnostic::Code;
use frictcomp::lists::FeedUnit;
use frictcomp::lists::{DEFAULT_MAX_POINTS, FrictionList, TablePoint};
use frictcomp::machine::{Axis, Configuration, NoLists, check_list};
use frictcomp::text::SourceFile;
use frictcomp_physics::current::{AdditiveCurrent, Reading};

use super::host::{Memory, codes};

/// Returns the machine of a start-up list `s.lis` with one more list.
fn started(startup: &str, lists: &[(&str, &str)]) -> Configuration {
    let mut files = Memory(lists.iter().copied().collect());
    Configuration::from_startup(SourceFile::new("s.lis", startup), &mut files)
}

/// Returns the axis of a value list with this line.
fn axis_with(line: &str) -> Axis {
    let values = format!(
        "kopf.achs_nr 1\n{line}\nfrict_comp.mode 3\nfrict_comp.table_entries 1\nfrict_comp.table[0].out 9\nEnde"
    );
    let lists = [
        ("x.lis", "kopf.achs_nr 1\nkopf.log_achs_name X\nEnde"),
        ("c.lis", &values),
    ];
    let mut found = started(
        "achs_mds[0] x.lis\nachs_kw[0] c.lis\nzahl_mds 1\nzahl_kw 1\nEnde",
        &lists,
    );
    found.machine.axes.remove(0)
}

#[test]
fn the_reserved_size_never_changes() {
    // R3.22
    let axis = axis_with("frict_comp.max_points 30");
    assert_eq!(axis.check_max_points(30), None);
    let changed = axis.check_max_points(20).expect("a difference");
    assert_eq!(changed.code, Code::PErr110641);
    assert_eq!(changed.axis.as_deref(), Some("X"));
    assert!(changed.message.contains("`c.lis`"), "{}", changed.message);
    assert!(
        changed.message.contains("axis number 1"),
        "{}",
        changed.message
    );
    assert_eq!(changed.place.span.of(&changed.place.text), "30");
    let silent = axis_with("frict_comp.max_points 0");
    assert_eq!(silent.max_points, DEFAULT_MAX_POINTS);
    assert_eq!(silent.check_max_points(20), None);
    let unsaid = axis_with("").check_max_points(30).expect("a difference");
    assert_eq!(unsaid.place.start().line, 3);
    assert_eq!(Axis::new("X").check_max_points(30), None);
}

#[test]
fn the_channel_list_says_what_holds_for_motion() {
    // R3.13 R5.1
    let channel = |text: &str| {
        let found = started("zahl_mds 0\nsda_mds[0] c.lis\nEnde", &[("c.lis", text)]);
        found.machine.channel
    };
    let settings = channel(
        "prog_start.feedrate_factor 0.1 (m/min)\nprog_start.feedrate 1000\nprog_start.g_gruppe[0].nr 1\n\
         prog_start.g_gruppe[14].nr -1\nprog_start.g_gruppe[12].nr 70\nmain_spindle_ax_nr 6\n\
         main_spindle_name S\nspindel[0].bezeichnung S1\nspindel[0].log_achs_nr 6\n\
         spindel[1].bezeichnung S2\nspindel[1].log_achs_nr 11\nEnde\n",
    );
    assert_eq!(settings.feed_mm_per_min, Some(1000.0));
    assert!(!settings.lacks_feed);
    assert_eq!(settings.functions, [1, 70]);
    assert_eq!(settings.main_spindle, ["S", "S1"]);
    for (value, unit) in [
        ("100", FeedUnit::MillimetresPerMinute),
        ("-1", FeedUnit::MillimetresPerMinute),
        ("0", FeedUnit::MillimetresPerMinute),
        ("-5", FeedUnit::MillimetresPerMinute),
        ("0.1", FeedUnit::MetresPerMinute),
        ("1", FeedUnit::Unknown),
        ("2540", FeedUnit::Unknown),
        ("fast", FeedUnit::MillimetresPerMinute),
    ] {
        let found = channel(&format!("prog_start.feedrate_factor {value}\nEnde\n"));
        assert_eq!(found.feed_unit, unit, "{value}");
    }
}

#[test]
fn a_program_in_place_of_a_list_is_said_once_and_shortly() {
    // R3.1
    let program = "a.b 1\n".to_owned() + &"X[COMP ON FRICT]\n".repeat(500);
    let found = check_list(SourceFile::new("a.lis", program), None, &mut NoLists).diagnostics;
    let lines = codes(&found);
    let lines = lines.iter().filter(|code| code.starts_with("FC124"));
    assert_eq!(lines.count(), 22, "twenty lines, the rest, and the list");
    assert!(
        found
            .iter()
            .any(|said| said.message.starts_with("480 more lines"))
    );
}

#[test]
fn the_output_for_the_drive_is_scaled() {
    // R7.8
    let list = FrictionList {
        position_delay: 0,
        reversal_lookahead: 0,
        scaling_factor: 2000,
        delay_cycles: 0,
        max_points: 20,
        table: vec![TablePoint {
            input: 0.0,
            output: 50.0,
        }],
    };
    let mut current = AdditiveCurrent::new(&list, Reading::default()).scaled(1.5);
    let added = current.step(0.0, 1000.0, &[]);
    assert!((added.current_units - 100.0).abs() < 1e-12);
    assert_eq!(added.output, 150);
}
