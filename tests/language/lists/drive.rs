//! Chapter 7: what a network of drives says about the torque of friction compensation.

use std::fmt::Write as _;

use frictcomp::diagnostic::{Code, Severity};
use frictcomp::drive_interface::{
    DriveReport, Evidence, Network, Presence, SlaveOfAxis, check_drive,
};
use frictcomp::machine::{NoLists, check_list};
use frictcomp::text::SourceFile;
use frictcomp_host::{read_devices, read_network};

/// Returns what is known of the drive of a configured axis whose list has these lines.
fn drive(lines: &str, evidence: &Evidence) -> DriveReport {
    let text = format!("kopf.log_achs_name X\nlr_param.frict_comp 1\n{lines}\nEnde");
    let report = check_list(SourceFile::new("a.lis", text), None, &mut NoLists);
    check_drive(&report.reports[0].listed_drive(None), evidence)
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
    let shown = evidence.to_string();
    assert!(shown.starts_with("net.xml:"), "{shown}");
    assert!(
        shown.ends_with("Slave[1]/ProcessData[1]/TxPdo[1]/Entry[2]"),
        "{shown}"
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

#[test]
fn a_drive_may_compensate_friction_by_itself() {
    // R7.10
    let slave = |name: &str, commands: &str| {
        let objects = pdos("RxPdo", &[(0x1600, &[0x6040, 0x60B2], true)]);
        let actual = pdos("TxPdo", &[(0x1A00, &[0x6041, 0x6077], true)]);
        format!(
            "<Slave><Info><Name>{name}</Name></Info><ProcessData>{objects}{actual}</ProcessData>\
             <Mailbox><CoE><InitCmds>{commands}</InitCmds></CoE></Mailbox></Slave>"
        )
    };
    let command = |index: &str, sub: u8, ccs: u8, data: &str| {
        format!(
            "<InitCmd><Ccs>{ccs}</Ccs><Index>{index}</Index><SubIndex>{sub}</SubIndex><Data>{data}</Data></InitCmd>"
        )
    };
    let found = |name: &str, commands: &str| {
        let mut evidence = Evidence::default();
        evidence.network = Some(network(&[slave(name, commands)]));
        let report = drive("kenngr.antr_typ 8", &evidence);
        let own = report.diagnostics.iter().find(|it| it.code == Code::Fc505);
        own.map(|it| it.severity)
    };
    let on = command("12612", 2, 1, "0000c03f");
    assert_eq!(found("Drive 1", &on), Some(Severity::Warning));
    assert_eq!(
        found("Drive 1", &command("#x3544", 3, 1, "0000c03f")),
        Some(Severity::Warning)
    );
    for off in [
        command("12612", 2, 2, "0000c03f"),
        command("12612", 4, 1, "0000c03f"),
        command("12613", 1, 1, "0000c03f"),
        command("12612", 1, 1, "00000000"),
        command("12612", 1, 1, "00000080"),
    ] {
        assert_eq!(found("Drive 1", &off), None, "{off}");
        assert_eq!(
            found("Drive 1 (AX8206)", &off),
            Some(Severity::Info),
            "{off}"
        );
    }
}
