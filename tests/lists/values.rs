//! The meaning of list values: references, bit codes, keys of a copied list, implausible values,
//! gantries, drives (R1.36, R1.41, R1.43, R3.5, R3.12, R3.40, R3.41).

use std::fmt::Write as _;

use frictcomp::comp::{Kind, KindSet};
use frictcomp::diagnostic::{Diagnostic, Severity};
use frictcomp::machine::{Configuration, ListsReport, check_list};
use frictcomp::text::SourceFile;

use super::host::{Memory, codes, judge, start};

/// Checks a start-up list with the lists that it names.
fn judge_all(lists: &[(&'static str, &'static str)]) -> ListsReport {
    let mut files = Memory(lists.iter().copied().collect());
    let (name, text) = lists[0];
    check_list(SourceFile::new(name, text), None, &mut files)
}

fn messages(diagnostics: &[Diagnostic]) -> Vec<&str> {
    diagnostics.iter().map(|it| it.message.as_str()).collect()
}

/// Returns the axis of a machine with only this axis list.
fn axis(list: &'static str) -> Configuration {
    start(&[("hochlauf.lis", "achs_mds[0] x.lis\nEnde"), ("x.lis", list)])
}

#[test]
fn a_value_may_refer_to_another_parameter() {
    // R3.40
    let found = axis(
        "kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.frict_comp P-AXIS-00175\nlr_param.ssfk TRUE\n\
         lr_param.crosscomp p-axis-00522.0 (as FRICT)\nEnde",
    );
    assert_eq!(codes(&found.diagnostics)[..1], ["FC303 4:15"]);
    let configured = found.machine.axes[0].configured;
    let expected: KindSet = [Kind::Frict, Kind::Lead, Kind::Cross].into_iter().collect();
    assert_eq!(configured, expected);
    let list = judge(
        "frict_comp.mode 3\nfrict_comp.table_entries 2\nfrict_comp.table[0].in 0\n\
         frict_comp.table[0].out P-COMP-00047.1\nfrict_comp.table[1].in 9000\n\
         frict_comp.table[1].out 77\nEnde",
    );
    assert_eq!(codes(&list.diagnostics), [""; 0]);
    assert!(
        list.accepted[0]
            .list
            .table
            .iter()
            .all(|it| (it.output - 77.0).abs() < 1e-9)
    );
}

#[test]
fn a_reference_to_nothing_or_round_in_a_circle_is_said() {
    // R3.40
    let report = judge(
        "lr_param.ssfk P-AXIS-00047\nlr_param.crosscomp P-AXIS-00174.0\nlr_param.crosscomp2 P-AXIS-00175\n\
         lr_param.temp_comp P-AXIS-00021\nlr_param.crosstalk P-AXIS-99999\n\
         cam_gear.a_max_slave P-AXIS-00008.0\nEnde",
    );
    assert_eq!(
        codes(&report.diagnostics),
        ["FC124 1:15", "FC124 4:20", "FC124 5:20"]
    );
    let said = messages(&report.diagnostics);
    assert!(said[0].contains("leads back to itself"), "{}", said[0]);
    assert!(
        said[1].contains("which no line of this list gives"),
        "{}",
        said[1]
    );
    assert!(said[2].contains("not known to frictcomp"), "{}", said[2]);
}

#[test]
fn a_selector_that_cannot_be_read_refuses_nothing() {
    // R1.41, R3.40
    let list = "kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.ssfk P-AXIS-00021\nlr_param.crosscomp ja\nEnde";
    let unselected = axis(list).machine.axes[0].unselected;
    assert!(!unselected.contains(Kind::Lead) && !unselected.contains(Kind::Cross));
    assert!(unselected.contains(Kind::Temp) && unselected.contains(Kind::Backlash));
}

#[test]
fn the_monitor_is_words_or_a_bit_code() {
    // R1.36
    let required = |value: &str| {
        let list = format!(
            "kopf.achs_nr 1\nkopf.log_achs_name X\n\
             lr_param.prog_movement_requires_compensations {value}\nEnde"
        );
        let found = axis(String::leak(list));
        (found.machine.axes[0].required, codes(&found.diagnostics))
    };
    let set = |kinds: &[Kind]| kinds.iter().copied().collect::<KindSet>();
    let (lead, both) = (set(&[Kind::Lead]), set(&[Kind::Backlash, Kind::Lead]));
    for value in [
        "LEAD",
        "lead |",
        "0x02",
        "2",
        "'16#2'",
        "16#02 # bit",
        "2#10",
        "\"LEAD\" (x",
    ] {
        assert_eq!(required(value), (lead, vec![]), "{value}");
    }
    for value in [
        "3",
        "0x3",
        "BACKLASH | LEAD |",
        "BACKLASH | 0x2 comment",
        "'16#3'",
    ] {
        assert_eq!(required(value), (both, vec![]), "{value}");
    }
    for value in ["0", "0x0", "NONE", ""] {
        assert_eq!(required(value), (KindSet::NONE, vec![]), "{value}");
    }
    let words = set(&[Kind::Frict, Kind::Crosstalk]);
    assert_eq!(required("FRICT | CROSSTALK"), (words, vec![]));
    // No document gives the kinds of the further bits: they are reported, and never dropped.
    let all = set(&[
        Kind::Backlash,
        Kind::Lead,
        Kind::Temp,
        Kind::Cross,
        Kind::Plane,
    ]);
    assert_eq!(required("0x3F"), (all, vec!["FC124 3:47".to_owned()]));
    assert_eq!(
        required("32"),
        (KindSet::NONE, vec!["FC124 3:47".to_owned()])
    );
    assert_eq!(
        required("FRIKT | LEAD"),
        (lead, vec!["FC124 3:47".to_owned()])
    );
}

#[test]
fn lost_underscores_are_said_once() {
    // R3.5: the text of a PDF has blanks in their place.
    let report = judge(
        "kopf.achs nr 1\nkopf.log achs name X\nfrict comp.mode   3\nfrict comp.table entries 1\n\
         frict comp.table[0].in 0\nfrict comp.table[0].out 120\nEnde",
    );
    assert_eq!(codes(&report.diagnostics), ["FC124 1:1"]);
    let said = messages(&report.diagnostics)[0];
    assert!(said.contains("underscores"), "{said}");
    assert!(
        said.contains("`kopf.achs nr` stands for `kopf.achs_nr`; 6 such lines"),
        "{said}"
    );
    let one = judge("frict_comp.mode 3\nfrict comp.table_entries 1\nEnde");
    assert_eq!(codes(&one.diagnostics)[0], "FC124 2:1");
}

#[test]
fn values_that_are_hardly_meant_are_said() {
    // R3.31, C13: the control accepts them all the same.
    let table = |points: &[(&str, &str)]| {
        let mut text = format!(
            "frict_comp.mode 3\nfrict_comp.table_entries {}\n",
            points.len()
        );
        for (at, (input, output)) in points.iter().enumerate() {
            writeln!(text, "frict_comp.table[{at}].in {input}").unwrap();
            writeln!(text, "frict_comp.table[{at}].out {output}").unwrap();
        }
        let report = judge(&(text + "Ende"));
        assert_eq!(report.accepted.len(), 1);
        codes(&report.diagnostics)
    };
    let signs = [("0", "120"), ("3000", "-105"), ("100000", "180")];
    assert_eq!(table(&signs), ["FC139 6:25"]);
    let millimetres = [("3", "120"), ("100", "180")];
    assert_eq!(table(&millimetres), ["FC139 5:24"]);
    let valley = [("0", "120"), ("3000", "20"), ("100000", "180")];
    assert_eq!(table(&valley), ["FC139 6:25"]);
    let peak = [("0", "50"), ("3000", "500"), ("100000", "60")];
    assert_eq!(table(&peak), ["FC139 6:25"]);
    let two_points = [
        ("0", "120"),
        ("2000", "11"),
        ("3000", "12"),
        ("9000", "115"),
    ];
    assert_eq!(table(&two_points), ["FC139 6:25"]);
    let nothing = [("0", "120"), ("3000", "0"), ("9000", "115")];
    assert_eq!(table(&nothing), ["FC139 6:25"]);
    for plausible in [
        &[
            ("0", "126"),
            ("3000", "112"),
            ("15000", "105"),
            ("166667", "168"),
        ][..],
        &[("0", "-62"), ("1800", "-48"), ("16667", "-55")],
        &[("0", "12")],
        &[("500", "200"), ("9000", "60"), ("90000", "20")],
        &[("0", "0"), ("20", "12"), ("9000", "10")],
        &[("0", "0"), ("20", "12"), ("9000", "5")],
        // A soft machine, for which a list was learned: below half only over several points.
        &[
            ("0", "140"),
            ("35", "92"),
            ("100", "66"),
            ("220", "103"),
            ("80000", "164"),
        ],
    ] {
        assert_eq!(table(plausible), [""; 0], "{plausible:?}");
    }
    let scaled = judge(
        "frict_comp.mode 3\nfrict_comp.table_entries 1\nfrict_comp.scaling_factor 15\nfrict_comp.table[0].out 9\nEnde",
    );
    assert_eq!(codes(&scaled.diagnostics), ["FC139 3:27"]);
    let said = "`frict_comp.scaling_factor` is 15, which is 1.5 %: the largest output, 9, reaches the drive as 0.135";
    assert_eq!(messages(&scaled.diagnostics), [said]);
    assert_eq!(scaled.diagnostics[0].severity, Severity::Info);
}

#[test]
fn all_errors_of_a_list_are_said_at_once() {
    // R3.20, R3.24, R3.26, R3.31
    let report = judge(
        "frict_comp.mode 3\nfrict_comp.table_entries 6\nfrict_comp.delay_cycles x\n\
         frict_comp.table[0].in -3\nfrict_comp.table[1].in 100\nfrict_comp.table[2].in 50\n\
         frict_comp.table[3].in 9000\nfrict_comp.table[3].out y\nfrict_comp.table[5].in 9000\n\
         frict_comp.table[5].out 1\nEnde",
    );
    assert_eq!(
        codes(&report.diagnostics),
        [
            "FC130 3:25",
            "FC133 2:26",
            "FC130 8:25",
            "P-ERR-110591 4:24",
            "P-ERR-110591 6:24"
        ]
    );
    let rejected = |it: &&Diagnostic| it.help().iter().any(|help| help.contains("rejected"));
    assert_eq!(report.diagnostics.iter().filter(rejected).count(), 1);
}

#[test]
fn negative_distances_and_times_count_as_zero() {
    // R3.25
    for key in ["position_delay", "reversal_lookahead", "delay_cycles"] {
        let text = format!(
            "frict_comp.mode 3\nfrict_comp.table_entries 1\nfrict_comp.{key} -2\nfrict_comp.table[0].out 9\nEnde"
        );
        let report = judge(&text);
        assert_eq!(report.diagnostics.len(), 1, "{key}");
        assert_eq!(
            report.diagnostics[0].help(),
            ["a negative value counts as 0"]
        );
        let list = &report.accepted[0].list;
        assert_eq!(
            (
                list.position_delay,
                list.reversal_lookahead,
                list.delay_cycles
            ),
            (0, 0, 0)
        );
    }
}

#[test]
fn a_spindle_with_friction_compensation_is_said() {
    // R3.30
    let list = "kopf.achs_nr 1\nkopf.log_achs_name S\nkenngr.achs_typ 4\nkenngr.antr_typ 2\nlr_param.frict_comp 1\nEnde";
    assert_eq!(codes(&judge(list).diagnostics), ["FC138 5:21"]);
    assert_eq!(codes(&axis(list).diagnostics), ["FC138 5:21"]);
}

#[test]
fn a_simulated_drive_takes_no_additive_torque() {
    // R3.41
    const OWN: &str = "kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.frict_comp 1\nEnde";
    const HEAD: &str = "kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.frict_comp 1\n";
    let list = |more: &str| judge(&format!("{HEAD}{more}Ende"));
    for drive in ["4", "16", "ANTR_TYP_SIMU"] {
        let report = list(&format!("kenngr.antr_typ {drive}\n"));
        assert_eq!(codes(&report.diagnostics), ["FC503 4:17"], "{drive}");
        assert_eq!(report.diagnostics[0].severity, Severity::Error);
    }
    // Without a type the control uses 4, unless TwinCAT fills in another one.
    let alone = list("");
    assert_eq!(codes(&alone.diagnostics), ["FC503 3:21"]);
    assert_eq!(alone.diagnostics[0].severity, Severity::Warning);
    for fine in [
        "kenngr.antr_typ 2\n",
        "kenngr.antr_typ 8\n",
        "antr.sercos.mdt[0].ident_nr 81\n",
    ] {
        let found = list(fine);
        assert!(
            found
                .diagnostics
                .iter()
                .all(|it| it.code.as_str() != "FC503"),
            "{fine}"
        );
    }
    let start = "achs_mds[0] x.lis\ndefault_achs_mds d.lis\nEnde";
    let of_default = |default: &'static str| {
        let report = judge_all(&[("hochlauf.lis", start), ("x.lis", OWN), ("d.lis", default)]);
        codes(&report.diagnostics).contains(&"FC503 3:21".to_owned())
    };
    assert!(!of_default("kenngr.antr_typ 8\nEnde"));
    assert!(of_default("kopf.achs_nr 0\nlr_param.ssfk 0\nEnde"));
}

#[test]
fn a_gantry_slave_is_no_axis_of_a_program() {
    // R1.43
    let lists: [(&'static str, &'static str); 6] = [
        (
            "hochlauf.lis",
            "achs_mds[0] y.lis\nachs_mds[1] y2.lis\nsda_mds[0] c.lis\nachs_kw[0] k.lis\n\
             achs_kw_log_ax_nr[0] 1\nachs_kw[1] k2.lis\nachs_kw_log_ax_nr[1] 2\nEnde",
        ),
        (
            "c.lis",
            "gruppe[0].achse[0].log_achs_nr 1\ngruppe[0].achse[0].bezeichnung Y\nEnde",
        ),
        (
            "y.lis",
            "kopf.achs_nr 1\nkopf.log_achs_name Y\nkenngr.antr_typ 8\nlr_param.frict_comp 1\nEnde",
        ),
        (
            "y2.lis",
            "kopf.achs_nr 2\nkopf.log_achs_name Y2\nkenngr.antr_typ 8\nkenngr.gantry_ax_nr 1\n\
             lr_param.frict_comp 1\nEnde",
        ),
        (
            "k.lis",
            "kopf.achs_nr 1\nfrict_comp.mode 3\nfrict_comp.table_entries 1\nfrict_comp.table[0].out 9\nEnde",
        ),
        (
            "k2.lis",
            "kopf.achs_nr 2\nfrict_comp.mode 3\nfrict_comp.table_entries 1\nfrict_comp.table[0].out 8\nEnde",
        ),
    ];
    let found = start(&lists);
    let names: Vec<&str> = found
        .machine
        .axes
        .iter()
        .map(|axis| axis.name.as_str())
        .collect();
    assert_eq!(names, ["Y"]);
    assert_eq!(found.machine.gantry_slaves[0].name, "Y2");
    assert_eq!(codes(&found.diagnostics), ["FC140 4:21"]);
    assert!(messages(&found.diagnostics)[0].ends_with("their value lists differ in `table`"));
    let shown: Vec<&str> = found.reports.iter().map(|it| it.axis.as_str()).collect();
    assert_eq!(shown, ["Y", "Y2"]);
    let mut same = lists;
    same[5].1 = "kopf.achs_nr 2\nfrict_comp.mode 3\nfrict_comp.table_entries 1\nfrict_comp.table[0].out 9\nEnde";
    assert_eq!(codes(&start(&same).diagnostics), [""; 0]);
}

#[test]
fn a_folder_that_is_not_here_is_said_once() {
    // R3.12
    let missing =
        "achs_mds[0] ./listen/a.lis\nachs_mds[1] .\\listen\\b.lis\nsda_mds[0] ./listen/c.lis\nEnde";
    let report = judge_all(&[("hochlauf.lis", missing)]);
    assert_eq!(codes(&report.diagnostics), ["FC123 1:13"]);
    assert_eq!(report.missing, 3);
    let said = messages(&report.diagnostics)[0];
    assert_eq!(
        said,
        "the folder `listen`, in which `hochlauf.lis` names 3 lists, is not here"
    );
    // If one of them exists, each of the others is reported as missing by itself.
    let axis = "kopf.achs_nr 1\nkopf.log_achs_name X\nEnde";
    let some = judge_all(&[("hochlauf.lis", missing), ("listen/a.lis", axis)]);
    assert_eq!(codes(&some.diagnostics), ["FC123 2:13", "FC123 3:12"]);
}

#[test]
fn lists_that_say_nothing_about_compensation_are_no_matter() {
    // R3.12: the vendor's templates.
    for text in [
        "g53_verfuegbar 0\ndefault_index 0\nEnde",
        "interrupt_source 3\nthread[0].name CNC\nEnde",
        "name_rd_global cnc_ve_%s_r\nEnde",
    ] {
        assert_eq!(codes(&judge(text).diagnostics), [""; 0], "{text}");
    }
    let empty = judge("# a template\n\nEnde\n");
    assert_eq!(messages(&empty.diagnostics), ["this list has no entries"]);
    assert_eq!(empty.diagnostics[0].severity, Severity::Info);
}
