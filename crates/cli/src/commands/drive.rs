//! `frictcomp drive`: checks whether the torque of friction compensation reaches the drives.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::args::{ListingArgs, NamedLists};
use crate::output::{Console, Failure, Failures, Outputs, Printed, exit, parts};
use frictcomp::diagnostic::{Diagnostic, Severity};
use frictcomp::drive_interface::{DriveReport, Evidence, SlaveOfAxis, check_drive};
use frictcomp::lists::ListKind;
use frictcomp::machine::ListsReport;
use frictcomp::text::shown_path;
use frictcomp_host::{Disk, FileRegistry, XmlError, read_devices, read_list, read_network};
use frictcomp_report::results::drives::{drives_headline, render_drives};
use frictcomp_report::{ListingFormat, command_line};

/// Check that the torque of compensation reaches the drives
///
/// Checks also that the actual torque comes back. The axis lists come first, then the network information of the master (ENI), then the
/// device descriptions (ESI).
#[derive(Debug, Args)]
pub(crate) struct DriveArgs {
    #[command(flatten)]
    lists: NamedLists,
    /// The network information of the master, an ENI file
    #[arg(long, value_name = "FILE")]
    eni: Option<PathBuf>,
    /// A device description, an ESI file, to name the process data objects that could be selected
    #[arg(long, value_name = "FILE")]
    esi: Vec<PathBuf>,
    /// The device of the network that drives an axis; `:2` is its second axis
    #[arg(long, value_name = "AXIS=NAME", value_parser = parse_slave, requires = "eni")]
    slave: Vec<SlaveOfAxis>,
    #[command(flatten)]
    listing: ListingArgs,
}

/// Reads `X=Drive 1` or `Y=Drive 1:2`.
fn parse_slave(text: &str) -> Result<SlaveOfAxis, String> {
    let Some((axis, slave)) = text.split_once('=') else {
        return Err(
            "write `AXIS=NAME`, with the name that the device has in the network".to_owned(),
        );
    };
    let (slave, channel) = match slave.rsplit_once(':') {
        Some((name, channel)) => match channel.parse() {
            Ok(channel) => (name, Some(channel)),
            Err(_) => (slave, None),
        },
        None => (slave, None),
    };
    Ok(SlaveOfAxis {
        axis: axis.trim().to_owned(),
        slave: slave.trim().trim_matches('"').to_owned(),
        channel,
    })
}

/// Returns the sources in addition to the lists.
fn evidence(args: &DriveArgs, registry: &FileRegistry) -> Result<Evidence, Failure> {
    let mut evidence = Evidence::default();
    let disk = Disk::default();
    if let Some(path) = &args.eni {
        registry.reads("network", path);
        let network = read_network(&read_list(path, &disk)?).map_err(|error| unread(&error))?;
        for given in &args.slave {
            let drives = network.drives();
            if !network.slaves.iter().any(|slave| slave.name == given.slave) {
                let names: Vec<String> = drives.map(|it| format!("`{}`", it.name)).collect();
                return Err(Failure::new(format!(
                    "there is no device `{}` in `{}`",
                    given.slave,
                    shown_path(path)
                ))
                .with_help(format!("its drives are {}", names.join(", "))));
            }
        }
        evidence.network = Some(network);
    }
    for path in &args.esi {
        registry.reads("device description", path);
        let devices = read_devices(&read_list(path, &disk)?).map_err(|error| unread(&error))?;
        evidence.devices.extend(devices);
    }
    evidence.slaves.clone_from(&args.slave);
    Ok(evidence)
}

fn unread(error: &XmlError) -> Failure {
    Failure::new(error.to_string()).with_help(
        "`--eni` takes the network information of the master, `--esi` a device description",
    )
}

/// Returns the evidence on the drives of a list.
fn drives(report: &ListsReport, evidence: &Evidence) -> Vec<DriveReport> {
    let of_axis = |axis: &str| report.accepted.iter().find(|it| it.axis == axis);
    let drives = report.reports.iter().map(|axis| {
        let list = of_axis(&axis.axis).map(|accepted| &accepted.list);
        let mut drive = check_drive(&axis.listed_drive(list), evidence);
        report.embedded.rename_evidence(&mut drive);
        drive
    });
    drives.collect()
}

/// Collects the messages about a list: why it cannot be read, then those about its drives. What is certain
/// from the axis list alone is in both.
fn collect(report: &ListsReport, drives: &[DriveReport], said: &mut Vec<Diagnostic>) {
    let of_list = report.diagnostics.iter();
    said.extend(of_list.filter(|it| it.severity == Severity::Error).cloned());
    for drive in drives {
        for diagnostic in drive.diagnostics.iter().chain(&drive.open) {
            if !said.contains(diagnostic) {
                said.push(diagnostic.clone());
            }
        }
    }
}

fn no_axis(path: &Path) -> Failure {
    Failure::new(format!("`{}` describes no axis", shown_path(path)))
        .with_help("name a start-up list, axis lists or a `frictcomp.toml`")
}

/// Reports which `--slave` names no axis of the lists.
fn check_axes(args: &DriveArgs, reports: &[DriveReport]) -> Result<(), Failure> {
    let is_known = |given: &&SlaveOfAxis| reports.iter().any(|report| report.axis == given.axis);
    match args.slave.iter().find(|given| !is_known(given)) {
        Some(given) => {
            let names: Vec<String> = reports.iter().map(|it| format!("`{}`", it.axis)).collect();
            Err(
                Failure::new(format!("no list describes an axis `{}`", given.axis))
                    .with_help(format!("the lists have {}", names.join(", "))),
            )
        }
        None => Ok(()),
    }
}

/// Runs the command.
pub(crate) fn run(args: &DriveArgs, console: Console) -> Result<u8, Failure> {
    let console = args.listing.console(console)?;
    Failures::of(console, |failures| judge(args, console, failures))
}

fn judge(args: &DriveArgs, console: Console, failures: &mut Failures) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    let codes = args.listing.severities.filter()?;
    let files = args.lists.files(|kind| kind == ListKind::Axis)?;
    let allowed_roots = args.lists.allowed_roots(&files);
    let evidence = evidence(args, &registry)?;
    let mut outputs = Outputs::new(&registry, console);
    let target = outputs.result(args.listing.output.as_deref())?;
    let (mut reports, mut said) = (Vec::new(), Vec::new());
    for path in &files {
        registry.reads("list", path);
        match args.lists.check(path) {
            Ok(report) => {
                for file in &report.files {
                    registry.reads("list", Path::new(&**file));
                }
                let drives = drives(&report, &evidence);
                collect(&report, &drives, &mut said);
                report.embedded.explain(&mut said);
                if drives.is_empty() {
                    failures.push(no_axis(path));
                }
                reports.extend(drives);
            }
            Err(failure) => failures.push(failure),
        }
    }
    check_axes(args, &reports)?;
    allowed_roots.conceal(&mut said);
    codes.sift(&mut said);
    outputs.check()?;
    let mut listing = args.listing.lister(target)?;
    if !reports.is_empty() {
        listing.headline(drives_headline(&reports));
    }
    for _ in &files {
        listing.file();
    }
    for diagnostic in &mut said {
        diagnostic.reword(Some(command_line));
        if listing.diagnostic(diagnostic).is_break() {
            break;
        }
    }
    listing.drives(&reports);
    let printed = listing.finish()?;
    if printed == Printed::Unread && failures.is_empty() {
        return Ok(exit::CLEAN);
    }
    if args.listing.format == ListingFormat::Text && !reports.is_empty() {
        console.print_painted(&format!("\n{}", render_drives(&reports)), parts)?;
    }
    outputs.finish()?;
    if args.listing.format == ListingFormat::Text {
        listing.hint().iter().for_each(|hint| console.remark(hint));
    }
    if reports.iter().any(DriveReport::is_idle) {
        return Ok(listing.status().max(exit::FOUND));
    }
    Ok(listing.status())
}
