//! Chapter 7: whether the torque of friction compensation reaches the drive.

use std::fmt::Write as _;

use frictcomp::drive_interface::{
    DriveReport, Evidence, Network, Presence, SlaveOfAxis, check_drive,
};
use frictcomp::lists::{FrictionList, TablePoint};
use frictcomp::machine::{AxisReport, Parameterisation};
use frictcomp::text::SourceFile;
use frictcomp_drives::{read_devices, read_network};
use frictcomp_physics::current::{AdditiveCurrent, Reading};

use super::host::{judge, start};

/// Returns the report of an axis list with these lines, for a configured axis.
fn axis(lines: &str) -> AxisReport {
    let text = format!("kopf.log_achs_name X\nlr_param.frict_comp 1\n{lines}\nEnde");
    judge(&text).reports.remove(0)
}

fn drive(lines: &str, evidence: &Evidence) -> DriveReport {
    check_drive(&axis(lines).listed_drive(None), evidence)
}

/// Returns the codes, with those of open questions in brackets.
fn said(report: &DriveReport) -> String {
    let sure = report.diagnostics.iter().map(|it| it.code.to_string());
    let open = report.open.iter().map(|it| format!("[{}]", it.code));
    sure.chain(open).collect::<Vec<_>>().join(" ")
}

/// Returns what is known about the additive and the actual torque, one letter each.
fn known(report: &DriveReport) -> String {
    let letter = |presence: &Presence| match presence {
        Presence::Present { .. } => 'p',
        Presence::Missing { .. } => 'm',
        Presence::Unknown { .. } => '?',
        Presence::NotApplicable => '-',
    };
    [&report.additive_torque, &report.actual_torque]
        .map(letter)
        .iter()
        .collect()
}

#[test]
fn telegrams_of_sercos_are_read() {
    // R7.1, R7.5
    let both = "antr.sercos.mdt[1].nc_ref S-0-0081\nantr.sercos.at[1].nc_ref TORQUE_FEEDBACK_VALUE";
    let cases = [
        (both, "pp", ""),
        (
            "antr.sercos.mdt[3].ident_nr 81\nantr.sercos.at[0].ident_nr 84",
            "pp",
            "",
        ),
        (
            "antr.sercos.mdt[0].nc_ref S_0_0081 (additive)\nantr.sercos.at[0].nc_ref \"STROMIST_WERT\"",
            "pp",
            "",
        ),
        (
            "antr.sercos.mdt[0].nc_ref LAGESOLL_WERT\nantr.sercos.at[0].nc_ref MOMENT_IST_WERT",
            "mp",
            "FC501",
        ),
        (
            "antr.sercos.mdt[0].nc_ref MOMENT_SOLL_WERT\nantr.sercos.at[0].nc_ref S-0-0051",
            "mm",
            "FC501 FC502",
        ),
        ("antr.sercos.mdt[0].nc_ref S-0-0081", "p?", "[FC504]"),
        ("antr.sercos.ringnummer 1", "??", "[FC504] [FC504]"),
        ("antr.sercos.mdt[0].nc_ref", "??", "[FC504] [FC504]"),
    ];
    for (lines, what, codes) in cases {
        let report = drive(&format!("kenngr.antr_typ 2\n{lines}"), &Evidence::default());
        assert_eq!(
            (known(&report), said(&report)),
            (what.into(), codes.into()),
            "{lines}"
        );
    }
    let command = drive(
        "antr.sercos.mdt[0].nc_ref TORQUE_COMMAND_VALUE",
        &Evidence::default(),
    );
    assert!(
        command.diagnostics[0]
            .message
            .starts_with("this is the torque command itself")
    );
}

#[test]
fn telegrams_of_canopen_are_read() {
    // R7.2
    let cases = [
        (
            "antr.canopen.out[0].nc_ref 60B2_00\nantr.canopen.in[0].nc_ref TORQUE_ACT",
            "pp",
        ),
        (
            "antr.canopen.out[2].nc_ref 70B2_00\nantr.canopen.in[0].nc_ref 7077_00",
            "pp",
        ),
        (
            "antr.canopen.out[0].nc_ref POS_NOM\nantr.canopen.out[1].nc_ref 60b1_00",
            "m?",
        ),
        (
            "antr.canopen.out[0].nc_ref 60B3_00\nantr.canopen.in[0].nc_ref 6078_00",
            "mm",
        ),
        (
            "antr.canopen.out[0].nc_ref 6071_00\nantr.canopen.in[0].nc_ref 6077_00",
            "mp",
        ),
    ];
    for (lines, what) in cases {
        let report = drive(&format!("kenngr.antr_typ 8\n{lines}"), &Evidence::default());
        assert_eq!(known(&report), what, "{lines}");
    }
}

#[test]
fn drive_types_decide_whether_there_is_anything_to_ask() {
    // R7.6
    let cases = [
        ("kenngr.antr_typ 4", "--", ""),
        ("kenngr.antr_typ 0x10", "--", ""),
        ("kenngr.antr_typ ANTR_TYP_VIRTUELL", "--", ""),
        ("kenngr.antr_typ 2\nkenngr.drive_simulation 1", "--", ""),
        ("kenngr.antr_typ 3", "--", "FC503"),
        ("kenngr.antr_typ ANTR_TYP_LIGHTBUS", "--", "FC503"),
        ("kenngr.antr_typ ANTR_TYP_SERCOS", "??", "[FC504] [FC504]"),
        ("kenngr.antr_typ SERCOS", "??", "FC130 [FC504] [FC504]"),
        ("kenngr.antr_typ 9", "??", "FC130 [FC504] [FC504]"),
        ("", "??", "[FC504] [FC504]"),
    ];
    for (lines, what, codes) in cases {
        let report = drive(lines, &Evidence::default());
        assert_eq!(
            (known(&report), said(&report)),
            (what.into(), codes.into()),
            "{lines}"
        );
    }
    // Without P-AXIS-00522 nothing is sent, and nothing is missing.
    let off = judge("kenngr.antr_typ 3\nlr_param.frict_comp 0\nEnde")
        .reports
        .remove(0);
    assert_eq!(
        said(&check_drive(&off.listed_drive(None), &Evidence::default())),
        ""
    );
}

/// Process data objects of a device: index, what they hold, whether they are assigned.
type Pdo<'a> = (u16, &'a [u16], bool);

fn pdos(tag: &str, pdos: &[Pdo<'_>]) -> String {
    pdos.iter()
        .fold(String::new(), |mut text, (index, entries, assigned)| {
            let manager = if *assigned { " Sm=\"2\"" } else { "" };
            let _ = write!(
                text,
                "<{tag}{manager}><Index>#x{index:04x}</Index><Name>O</Name>"
            );
            for entry in *entries {
                let _ = write!(
                    text,
                    "<Entry><Index>#x{entry:04X}</Index><SubIndex>0</SubIndex></Entry>"
                );
            }
            let _ = writeln!(text, "</{tag}>");
            text
        })
}

fn slave(name: &str, mailbox: &str, outputs: &[Pdo<'_>], inputs: &[Pdo<'_>]) -> String {
    format!(
        "<Slave><Info><Name>{name}</Name><VendorId>2</VendorId><ProductCode>7</ProductCode></Info>\n\
         <ProcessData>{}{}</ProcessData><Mailbox><{mailbox}/></Mailbox></Slave>\n",
        pdos("RxPdo", outputs),
        pdos("TxPdo", inputs)
    )
}

fn network(slaves: &[String]) -> Network {
    let text = format!(
        "<EtherCATConfig><Config>\n{}</Config></EtherCATConfig>",
        slaves.concat()
    );
    read_network(&SourceFile::new("net.xml", text)).expect("a network")
}

fn within(slaves: &[String], of_axis: Option<(&str, Option<u8>)>) -> Evidence {
    let mut evidence = Evidence::default();
    evidence.network = Some(network(slaves));
    evidence
        .slaves
        .extend(of_axis.map(|(slave, channel)| SlaveOfAxis {
            axis: "X".to_owned(),
            slave: slave.to_owned(),
            channel,
        }));
    evidence
}

#[test]
fn a_network_says_what_is_exchanged() {
    // R7.3, R7.5
    let ax5000 = |name: &str, idns: &[u16]| {
        slave(
            name,
            "SoE",
            &[(0x18, idns, true)],
            &[(0x10, &[0x33, 0x54], true)],
        )
    };
    let with = ax5000("A", &[0x86, 0x2f, 0x51]);
    let without = ax5000("B", &[0x86, 0x2f]);
    let ds402 = slave(
        "C",
        "CoE",
        &[
            (0x1600, &[0x6040, 0x607A, 0x6840, 0x60B2], true),
            (0x1601, &[0x68B2], false),
        ],
        &[(0x1A00, &[0x6041, 0x6077, 0x6877], true)],
    );
    let unassigned = slave("D", "CoE", &[(0x1600, &[0x6040, 0x60B2], false)], &[]);
    let terminal = slave("E", "CoE", &[(0x1600, &[0x7000], true)], &[]);
    let both = || [with.clone(), without.clone(), terminal.clone()];
    let cases = [
        ("2", within(std::slice::from_ref(&with), None), "pp"),
        ("2", within(std::slice::from_ref(&without), None), "mp"),
        ("2", within(&both(), None), "?p"),
        ("2", within(&both(), Some(("A", None))), "pp"),
        ("2", within(&both(), Some(("B", Some(1)))), "mp"),
        ("2", within(&both(), Some(("B", Some(2)))), "??"),
        ("2", within(&both(), Some(("E", None))), "??"),
        ("2", within(&both(), Some(("nobody", None))), "??"),
        (
            "8",
            within(&[with.clone(), ds402.clone()], Some(("C", Some(1)))),
            "pp",
        ),
        (
            "8",
            within(&[with.clone(), ds402.clone()], Some(("C", Some(2)))),
            "mp",
        ),
        ("8", within(&[with.clone(), ds402.clone()], None), "?p"),
        ("2", within(&[with.clone(), ds402], None), "pp"),
        ("8", within(std::slice::from_ref(&with), None), "??"),
        ("8", within(&[unassigned], None), "??"),
        ("8", within(&[], None), "??"),
    ];
    for (number, (kind, evidence, what)) in cases.into_iter().enumerate() {
        let report = drive(&format!("kenngr.antr_typ {kind}"), &evidence);
        assert_eq!(known(&report), what, "case {number}: {report:?}");
        let open = what.matches('?').count();
        assert_eq!(report.open.len(), open, "case {number}");
    }
    // The axis list comes first; sources that contradict it are not ignored.
    let listed = "kenngr.antr_typ 2\nantr.sercos.mdt[0].nc_ref S-0-0081";
    assert_eq!(known(&drive(listed, &within(&[with], None))), "pp");
    let contradicted = drive(listed, &within(&[without], None));
    assert_eq!(
        (known(&contradicted), said(&contradicted)),
        ("?p".into(), "[FC504]".into())
    );
    let Presence::Present { evidence } = contradicted.actual_torque else {
        panic!("{contradicted:?}");
    };
    assert!(evidence.starts_with("net.xml:"), "{evidence}");
    assert!(
        evidence.ends_with("Slave[1]/ProcessData[1]/TxPdo[1]/Entry[2]"),
        "{evidence}"
    );
}

#[test]
fn a_device_description_names_what_could_be_selected() {
    // R7.4
    let text = format!(
        "<EtherCATInfo><Vendor><Id>2</Id></Vendor><Descriptions><Devices>\
         <Device><Type ProductCode=\"#x7\">Drive &amp; more</Type>{}</Device></Devices>\
         <Modules><Module><Type ModuleIdent=\"8\">Axis module</Type>{}</Module></Modules>\
         </Descriptions></EtherCATInfo>",
        pdos(
            "RxPdo",
            &[(0x1600, &[0x607A], true), (0x1601, &[0x60B2], false)]
        ),
        pdos("TxPdo", &[(0x1A00, &[0x6077], true)]),
    );
    let devices = read_devices(&SourceFile::new("esi.xml", text)).expect("devices");
    let names: Vec<_> = devices
        .iter()
        .map(|it| (it.name.as_str(), it.product))
        .collect();
    assert_eq!(names, [("Drive & more", Some(7)), ("Axis module", Some(8))]);
    let drive_slave = slave(
        "A",
        "CoE",
        &[(0x1600, &[0x6040], true)],
        &[(0x1A00, &[0x6041], true)],
    );
    let mut evidence = within(&[drive_slave], Some(("A", None)));
    evidence.devices = devices;
    let report = drive("kenngr.antr_typ 8", &evidence);
    assert_eq!(said(&report), "FC501 FC502");
    let help = report.diagnostics[0].help().join("; ");
    assert!(
        help.contains("select PDO 1601h (`O`) of Drive & more"),
        "{help}"
    );
    // The module is a different product from the device in the network.
    assert_eq!(report.diagnostics[1].help().len(), 1);
}

#[test]
fn files_that_are_no_descriptions_are_refused() {
    // R7.9
    let cases = [
        (
            "",
            "not well-formed XML: the document does not have a root node",
        ),
        (
            "<EtherCATConfig><Config>",
            "the root node was opened but never closed",
        ),
        (
            "<EtherCATConfig></Config>",
            "expected 'EtherCATConfig' tag, not 'Config' at 1:17",
        ),
        ("<EtherCATInfo/>", "this is a device description (ESI)"),
        ("<TcSmProject/>", "not `<EtherCATConfig>`"),
        (
            "<!DOCTYPE a [<!ENTITY b \"c\">]><EtherCATConfig/>",
            "a document type is not read",
        ),
        (
            "<EtherCATConfig>&b;</EtherCATConfig>",
            "unknown entity reference 'b' at 1:17",
        ),
        ("kopf.achs_nr 1", "unknown token at 1:1"),
    ];
    for (text, why) in cases {
        let error = read_network(&SourceFile::new("a.xml", text)).expect_err(text);
        assert!(error.reason.contains(why), "{text}: {error}");
    }
    let deep = ["<a>", "</a>"].map(|tag| tag.repeat(200_000)).concat();
    let deep = format!("<EtherCATConfig>{deep}</EtherCATConfig>");
    let network = read_network(&SourceFile::new("a.xml", deep)).expect("elements of no device");
    assert!(network.slaves.is_empty());
    let line = read_network(&SourceFile::new("a.xml", "<EtherCATConfig>\n\n<a></b>"));
    assert_eq!(line.expect_err("a mistake").line, 3);
}

#[test]
fn a_description_that_ends_anywhere_is_refused_at_its_end() {
    // R7.9
    let text = slave(
        "Ä",
        "SoE",
        &[(0x18, &[0x51], true)],
        &[(0x10, &[0x54], true)],
    );
    let text = format!("<EtherCATConfig><Config>\n{text}</Config></EtherCATConfig>\n");
    let whole = text.trim_end().len();
    for (end, _) in text.char_indices() {
        let read = read_network(&SourceFile::new("a.xml", &text[..end]));
        assert_eq!(read.is_ok(), end >= whole, "{end}");
    }
}

fn values(output: f64) -> FrictionList {
    FrictionList {
        position_delay: 0,
        reversal_lookahead: 0,
        scaling_factor: 2000,
        delay_cycles: 0,
        max_points: 20,
        table: vec![TablePoint { input: 0.0, output }],
    }
}

#[test]
fn the_largest_torque_fits_the_interface() {
    // R7.7
    let sent = |lines: &str, output: f64| {
        let axis = axis(lines);
        let list = values(output);
        let report = check_drive(&axis.listed_drive(Some(&list)), &Evidence::default());
        let codes: Vec<_> = report
            .diagnostics
            .iter()
            .map(|it| it.code.as_str())
            .collect();
        (report.largest_torque, codes)
    };
    let sercos = "kenngr.antr_typ 2";
    assert_eq!(sent(sercos, -500.0), (Some(1000.0), vec![]));
    assert_eq!(sent(sercos, 501.0), (Some(1002.0), vec!["FC132"]));
    assert_eq!(sent("kenngr.antr_typ 8", 501.0), (Some(1002.0), vec![]));
    let scaled = "kenngr.antr_typ 8\nantr.torque_scale_num 100\nantr.torque_scale_denom 3";
    assert_eq!(sent(scaled, 600.0), (Some(40_000.0), vec!["FC137"]));
}

#[test]
fn torque_parameters_are_checked_as_by_the_control() {
    // R7.8
    let cases = [
        ("antr.torque_scale_num 3\nantr.torque_scale_denom 2", ""),
        ("antr.torque_scale_denom 0", "P-ERR-110465"),
        ("antr.torque_scale_denom -1", "FC130"),
        ("antr.torque_scale_num 1.5", "FC130"),
        (
            "kenngr.antr_typ 4\ngetriebe[0].torque_offset 100",
            "P-ERR-110464",
        ),
        ("kenngr.antr_typ 5\ngetriebe[1].torque_offset 100", "FC503"),
        ("kenngr.antr_typ 4\ngetriebe[0].torque_offset 0", ""),
        ("getriebe[0].torque_offset 100", ""),
        ("getriebe[0].torque_offset -5", "FC132"),
        ("getriebe[0].torque_offset 40000", "FC130"),
    ];
    for (lines, codes) in cases {
        let report = drive(lines, &Evidence::default());
        let found: Vec<_> = report
            .diagnostics
            .iter()
            .map(|it| it.code.as_str())
            .collect();
        assert_eq!(found.join(" "), codes, "{lines}");
    }
}

#[test]
fn the_output_for_the_drive_is_scaled() {
    // R7.8
    let mut current = AdditiveCurrent::new(&values(50.0), Reading::default()).scaled(1.5);
    let added = current.step(0.0, 1000.0, &[]);
    assert!((added.current_units - 100.0).abs() < 1e-12);
    assert_eq!(added.output, 150);
    let machine = start(&[
        (
            "hochlauf.lis",
            "achs_mds[0] x.lis\nachs_kw[0] c.lis\nachs_kw_log_ax_nr[0] 1\nEnde",
        ),
        (
            "x.lis",
            "kopf.achs_nr 1\nkopf.log_achs_name X\nlr_param.frict_comp 1\nkenngr.antr_typ 3\n\
             antr.torque_scale_num 3\nantr.torque_scale_denom 2\nEnde",
        ),
        (
            "c.lis",
            "kopf.achs_nr 1\nfrict_comp.mode 3\nfrict_comp.table_entries 1\nfrict_comp.table[0].out 9\nEnde",
        ),
    ]);
    let axis = &machine.machine.axes[0];
    assert!((axis.torque_scale.factor() - 1.5).abs() < 1e-12);
    assert!(matches!(axis.friction, Parameterisation::Accepted(_)));
    // It is reported wherever the lists of a machine are read.
    assert!(
        machine
            .diagnostics
            .iter()
            .any(|it| it.code.as_str() == "FC503")
    );
}
