//! Axis lists, start-up and channel lists, and checks that need two lists: R3.10 to R3.14, R3.27
//! and R3.30.

use frictcomp::comp::{Kind, KindSet};
use frictcomp::diagnostic::Code;
use frictcomp::lists::ListKind;
use frictcomp::machine::{AxisSet, AxisType, Configuration, Origin, Parameterisation, check_list};
use frictcomp_report::lists::render_parameters;

use super::host::{Disk, codes, judge, meant, start};

const VALUES: &str = "kopf.achs_nr 1\nfrict_comp.mode 3\nfrict_comp.table_entries 1\n\
                      frict_comp.table[0].out 9\nEnde";

/// Returns a machine with one axis list and the value list above.
fn one_axis(axis_list: &'static str) -> Configuration {
    start(&[
        (
            "hochlauf.lis",
            "achs_mds[0] x.lis\nachs_kw[0] c.lis\nachs_kw_log_ax_nr[0] 1\nEnde",
        ),
        ("x.lis", axis_list),
        ("c.lis", VALUES),
    ])
}

#[test]
fn an_axis_list_sets_what_compensation_needs() {
    // R3.10, R1.40
    let found = one_axis(
        "kopf.achs_nr 1\nkopf.log_achs_name X\nkenngr.achs_typ 2 rotary\nlr_param.frict_comp TRUE\n\
         lr_param.anwahl_losekomp 2\nlr_param.crosscomp 1\nlr_param.crosscomp2 0\n\
         lr_param.temp_comp_manual_activation 1\nkw.crosscomp.manual_activation 1\n\
         lr_param.prog_movement_requires_compensations FRICT | CROSS |\nother.key 7\nEnde",
    );
    assert_eq!(codes(&found.diagnostics), [""; 0]);
    let axis = &found.machine.axes[0];
    assert_eq!((axis.name.as_str(), axis.number), ("X", Some(1)));
    assert_eq!(axis.axis_type, AxisType::Rotary);
    let expected: KindSet = [Kind::Frict, Kind::Backlash, Kind::Cross]
        .into_iter()
        .collect();
    assert_eq!(axis.configured, expected);
    assert_eq!(axis.manual, [Kind::Temp, Kind::Cross].into_iter().collect());
    assert_eq!(
        axis.required,
        [Kind::Frict, Kind::Cross].into_iter().collect()
    );
    let origin = Origin::File {
        file: "x.lis".into(),
        line: 4,
    };
    assert_eq!(axis.frict_comp_origin, origin);
}

#[test]
fn wrong_axis_values_are_said() {
    // R3.10, R3.24
    let report = judge(
        "kopf.achs_nr X\nkenngr.achs_typ 3\nlr_param.frict_comp 2\nlr_param.ssfk ja\n\
         lr_param.prog_movement_requires_compensations FRIKT |\nEnde",
    );
    assert_eq!(
        codes(&report.diagnostics),
        [
            "FC130 1:14",
            "FC130 2:17",
            "FC130 3:21",
            "FC130 4:15",
            "FC124 5:47"
        ]
    );
    assert_eq!(report.diagnostics[4].help(), ["did you mean `FRICT`?"]);
}

#[test]
fn the_default_list_applies_first() {
    // R3.10
    let found = start(&[
        (
            "hochlauf.lis",
            "default_achs_mds d.lis\nachs_mds[0] x.lis\nachs_mds[1] y.lis\nEnde",
        ),
        (
            "d.lis",
            "kopf.achs_nr 0\nkopf.log_achs_name D\nlr_param.frict_comp 1\nkenngr.achs_typ 2\nEnde",
        ),
        (
            "x.lis",
            "kopf.achs_nr 1\nkopf.log_achs_name X\nkenngr.achs_typ 1\nEnde",
        ),
        (
            "y.lis",
            "kopf.achs_nr 2\nkopf.log_achs_name Y\nlr_param.frict_comp 0\nEnde",
        ),
    ]);
    let [x, y] = &found.machine.axes[..] else {
        panic!("two axes: {:?}", found.machine.axes)
    };
    assert_eq!(
        (x.axis_type, y.axis_type),
        (AxisType::Linear, AxisType::Rotary)
    );
    assert_eq!(
        x.frict_comp_origin,
        Origin::File {
            file: "d.lis".into(),
            line: 3
        }
    );
    assert!(x.configured.contains(Kind::Frict));
    assert!(!y.configured.contains(Kind::Frict));
    assert_eq!(
        y.frict_comp_origin,
        Origin::File {
            file: "y.lis".into(),
            line: 3
        }
    );
    assert_eq!(y.number, Some(2));
}

#[test]
fn a_value_list_has_manual_activation() {
    // R3.11, R1.40
    let found = Configuration::from_startup(Disk::open("mill3/hochlauf.lis"), &mut Disk);
    assert!(found.machine.axes[0].manual.contains(Kind::Lead));
    assert!(!found.machine.axes[1].manual.contains(Kind::Lead));
}

#[test]
fn the_start_up_list_names_the_others() {
    // R3.12, R3.13: relative paths, a Windows path by its file name, the channel's axis order
    let found = Configuration::from_startup(Disk::open("mill3/hochlauf.lis"), &mut Disk);
    assert_eq!(codes(&found.diagnostics), [""; 0]);
    let axes = &found.machine.axes;
    let names: Vec<_> = axes
        .iter()
        .map(|axis| (axis.name.as_str(), axis.number))
        .collect();
    assert_eq!(names, [("X", Some(1)), ("Y", Some(2)), ("Z", Some(3))]);
    assert_eq!(found.machine.axis_set, AxisSet::Configured);
    let accepted = |at: usize| matches!(axes[at].friction, Parameterisation::Accepted(_));
    assert!(accepted(0) && accepted(1) && !accepted(2));
    assert_eq!(axes[2].friction, Parameterisation::Missing);
    let files: Vec<_> = found.files.iter().map(|file| &**file).collect();
    assert_eq!(
        files,
        [
            "mill3/hochlauf.lis",
            "mill3/axis_default.lis",
            "mill3/axis_x.lis",
            "mill3/axis_y.lis",
            "mill3/axis_z.lis",
            "mill3/channel_1.lis",
            "mill3/comp_x.lis",
            "mill3/comp_y.lis",
        ]
    );
    assert!(
        found.reports[0]
            .drive
            .contains_key("antr.sercos.mdt[0].nc_ref")
    );
}

#[test]
fn the_number_of_lists_bounds_what_is_loaded() {
    // R3.12
    let found = start(&[
        (
            "hochlauf.lis",
            "zahl_mds 1\nachs_mds[0] x.lis\nachs_mds[1] y.lis\nEnde",
        ),
        ("x.lis", "kopf.achs_nr 1\nkopf.log_achs_name X\nEnde"),
        ("y.lis", "kopf.achs_nr 2\nkopf.log_achs_name Y\nEnde"),
    ]);
    assert_eq!(found.machine.axes.len(), 1);
    assert_eq!(codes(&found.diagnostics), ["FC124 3:1"]);
}

#[test]
fn the_channel_list_gives_names_and_order() {
    // R3.13
    let found = start(&[
        (
            "hochlauf.lis",
            "achs_mds[0] a.lis\nachs_mds[1] b.lis\nachs_mds[2] c.lis\nsda_mds[0] k.lis\nEnde",
        ),
        ("a.lis", "kopf.achs_nr 1\nkopf.log_achs_name Ax_1\nEnde"),
        ("b.lis", "kopf.achs_nr 2\nkopf.log_achs_name Y\nEnde"),
        ("c.lis", "kopf.achs_nr 3\nkopf.log_achs_name Z\nEnde"),
        (
            "k.lis",
            "gruppe[0].achse[0].log_achs_nr 2\ngruppe[0].achse[1].log_achs_nr 1\n\
             gruppe[0].achse[1].bezeichnung X\ngruppe[1].achse[0].bezeichnung S\nEnde",
        ),
    ]);
    let names: Vec<_> = found
        .machine
        .axes
        .iter()
        .map(|axis| axis.name.as_str())
        .collect();
    assert_eq!(names, ["Y", "X", "Z"]);
    assert_eq!(found.diagnostics, []);
}

#[test]
fn axis_numbers_agree() {
    // R3.14
    let found = start(&[
        (
            "hochlauf.lis",
            "achs_mds[0] x.lis\nachs_kw[0] c.lis\nachs_kw_log_ax_nr[0] 2\nEnde",
        ),
        (
            "x.lis",
            "kopf.achs_nr 2\nkopf.log_achs_name X\nlr_param.frict_comp 1\nEnde",
        ),
        ("c.lis", VALUES),
    ]);
    assert_eq!(
        codes(&found.diagnostics),
        ["P-ERR-110229 1:14", "FC303 3:21"]
    );
    assert_eq!(found.diagnostics[0].axis.as_deref(), Some("X"));
    let rejected = Parameterisation::Rejected {
        file: "c.lis".into(),
        code: "P-ERR-110229".into(),
    };
    assert_eq!(found.machine.axes[0].friction, rejected);
}

#[test]
fn the_start_up_and_channel_lists_have_the_same_numbers() {
    // R3.14
    let startup = start(&[
        (
            "hochlauf.lis",
            "achs_mds[0] x.lis\nachs_kw[0] c.lis\nachs_kw_log_ax_nr[0] 9\nEnde",
        ),
        ("x.lis", "kopf.achs_nr 1\nkopf.log_achs_name X\nEnde"),
        ("c.lis", VALUES),
    ]);
    assert_eq!(codes(&startup.diagnostics), ["P-ERR-110229 1:14"]);
    assert_eq!(startup.diagnostics[0].labels[0].place.start().line, 3);

    let channel = start(&[
        ("hochlauf.lis", "achs_mds[0] x.lis\nsda_mds[0] k.lis\nEnde"),
        (
            "x.lis",
            "kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.crosscomp 1\nEnde",
        ),
        (
            "k.lis",
            "gruppe[0].achse[0].log_achs_nr 4\ngruppe[0].achse[0].bezeichnung X\nEnde",
        ),
    ]);
    assert_eq!(codes(&channel.diagnostics), ["P-ERR-110229 1:14"]);
    assert_eq!(channel.machine.axes.len(), 1);
    assert!(channel.machine.axes[0].configured.contains(Kind::Cross));
}

#[test]
fn a_list_without_a_number_is_found_by_its_name() {
    // R3.13
    let found = start(&[
        (
            "hochlauf.lis",
            "achs_mds[0] x.lis\nsda_mds[0] k.lis\nachs_kw[0] c.lis\nEnde",
        ),
        ("x.lis", "kopf.log_achs_name X\nlr_param.frict_comp 1\nEnde"),
        ("c.lis", VALUES),
        (
            "k.lis",
            "gruppe[0].achse[0].log_achs_nr 1\ngruppe[0].achse[0].bezeichnung X\nEnde",
        ),
    ]);
    assert_eq!(found.diagnostics, []);
    assert_eq!(found.machine.axes[0].number, Some(1));
}

#[test]
fn a_value_list_without_its_axis_is_said() {
    // R3.14
    let found = start(&[
        ("hochlauf.lis", "achs_mds[0] x.lis\nachs_kw[0] c.lis\nEnde"),
        ("x.lis", "kopf.achs_nr 7\nkopf.log_achs_name X\nEnde"),
        ("c.lis", VALUES),
    ]);
    assert_eq!(codes(&found.diagnostics), ["FC135 1:14"]);
}

#[test]
fn a_missing_file_is_an_error_where_it_is_named() {
    // R3.14
    let found = start(&[
        (
            "hochlauf.lis",
            "# x\nachs_mds[0] lists/x.lis (X)\nachs_kw[0] D:\\cnc\\c.lis\nEnde",
        ),
        ("c.lis", "kopf.achs_nr 1\nEnde"),
    ]);
    assert_eq!(codes(&found.diagnostics), ["FC123 2:13", "FC135 1:14"]);
    let missing = &found.diagnostics[0];
    assert_eq!(meant(missing), "lists/x.lis");
    assert!(
        missing.message.contains("line 2 of `hochlauf.lis`"),
        "{}",
        missing.message
    );
    assert_eq!(found.machine.axis_set, AxisSet::AsTheyOccur);
}

#[test]
fn axis_list_and_value_list_want_the_same() {
    // R3.27
    let off = one_axis("kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.frict_comp 0\nEnde");
    assert_eq!(codes(&off.diagnostics), ["FC135 2:17"]);
    assert_eq!(off.diagnostics[0].labels[0].place.start().line, 3);
    let unset = one_axis("kopf.achs_nr 1\nkopf.log_achs_name X\nEnde");
    assert_eq!(codes(&unset.diagnostics), ["FC135 2:17"]);
    assert_eq!(unset.machine.axes[0].frict_comp_origin, Origin::Default);

    for (values, why) in [
        ("kopf.achs_nr 1\nEnde", "no value list"),
        ("kopf.achs_nr 1\nfrict_comp.mode 0\nEnde", "mode` is 0"),
        ("kopf.achs_nr 1\nfrict_comp.mode 7\nEnde", "P-ERR-110592"),
    ] {
        let found = start(&[
            ("hochlauf.lis", "achs_mds[0] x.lis\nachs_kw[0] c.lis\nEnde"),
            (
                "x.lis",
                "kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.frict_comp 1\nEnde",
            ),
            ("c.lis", values),
        ]);
        let last = found.diagnostics.last().expect("a diagnostic");
        assert_eq!(last.code, Code::Fc303);
        assert!(last.message.contains(why), "{}", last.message);
        assert_eq!(&*last.place.file, "x.lis");
    }
}

#[test]
fn spindles_have_no_friction_compensation() {
    // R3.30
    let found = one_axis("kopf.achs_nr 1\nkopf.log_achs_name S\nkenngr.achs_typ 4\nEnde");
    assert_eq!(codes(&found.diagnostics), ["FC138 2:17"]);
}

#[test]
fn lists_are_told_apart_by_their_keys() {
    // R3.10 to R3.13
    for (text, kind) in [
        ("zahl_mds 0\nEnde", Some(ListKind::Startup)),
        (
            "gruppe[0].achse[0].bezeichnung X\nEnde",
            Some(ListKind::Channel),
        ),
        (
            "kopf.achs_nr 1\nlr_param.frict_comp 1\nEnde",
            Some(ListKind::Axis),
        ),
        (
            "kopf.achs_nr 1\nfrict_comp.mode 0\nEnde",
            Some(ListKind::Value),
        ),
        ("N10 G01 X1\nEnde", None),
    ] {
        assert_eq!(judge(text).kind, kind, "{text}");
    }
}

#[test]
fn effective_parameters_are_shown_with_their_origin() {
    // R3.10, R3.11
    let report = check_list(Disk::open("mill3/hochlauf.lis"), None, &mut Disk);
    let mut table = String::new();
    render_parameters(&report.reports, &report.programs, 100, &mut table).unwrap();
    assert!(
        table.lines().all(|line| line.chars().count() <= 100),
        "{table}"
    );
    insta::assert_snapshot!(table);
}
