//! The audit of all dropped programs (chapter 10 of the rules).

use std::collections::BTreeMap;
use std::path::PathBuf;

use frictcomp::audit::AxisAudit;
use frictcomp::interpreter::Options;
use frictcomp_host::{ArchiveAuditor, AuditOptions, FileRegistry, Input, LeftOutFiles, Machines};
use frictcomp_report::html::render_with_lines;
use frictcomp_report::results::audit::{AuditReport, MachineAudit, Word, document};
use frictcomp_report::{Headline, Standing};
use serde::Serialize;

use crate::dropped::{Dropped, Kind};
use crate::refusal::Refusal;
use crate::run::{Texts, json};

/// The findings, and the programs that could not be checked.
struct Audited {
    report: AuditReport,
    failures: Vec<Refusal>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct AuditAnswer<'a> {
    headline: Headline,
    /// The files that read as programs and are not taken as such, counted by kind (R18.5).
    not_checked: Option<&'a str>,
    machines: Vec<MachineAnswer<'a>>,
    failures: &'a [Refusal],
    /// The words of the table and what they mean.
    words: Vec<(&'static str, &'static str)>,
}

#[derive(Serialize)]
struct MachineAnswer<'a> {
    origin: Option<&'a str>,
    axes: Vec<AxisAnswer<'a>>,
    programs: Vec<ProgramAnswer<'a>>,
}

#[derive(Serialize)]
struct AxisAnswer<'a> {
    axis: &'a str,
    leavers: usize,
    inheritors: usize,
    unknown: usize,
    hazards: u64,
    cure: &'static str,
}

#[derive(Serialize)]
struct ProgramAnswer<'a> {
    file: &'a str,
    cells: Vec<Cell<'a>>,
}

#[derive(Serialize)]
struct Cell<'a> {
    word: &'static str,
    #[serde(flatten)]
    audit: &'a AxisAudit,
}

/// Audits every program, each on the machine of its folder.
fn audit(dropped: &mut Dropped, enable: &[String]) -> Audited {
    // Machines are found in one way at a time: those without a configuration take the only start-up list.
    let mut groups: BTreeMap<Option<PathBuf>, Vec<Input>> = BTreeMap::new();
    let mut failures = Vec::new();
    let mut left_out = LeftOutFiles::default();
    for (path, kind) in dropped.files() {
        if kind == Kind::Other {
            left_out.files.extend(dropped.left_out(&path));
        }
        if kind != Kind::Program {
            continue;
        }
        match dropped.program(&path) {
            Ok(input) => {
                let startup = dropped.options(input.folder(), enable).startup;
                groups.entry(startup).or_default().push(input);
            }
            Err(failure) => failures.push(failure),
        }
    }
    let mut report = AuditReport {
        not_checked: left_out.in_words(),
        ..AuditReport::default()
    };
    for inputs in groups.into_values() {
        let folder = inputs.first().map_or("".as_ref(), Input::folder);
        let options = dropped.options(folder, enable);
        let mut machines =
            Machines::new(options, &FileRegistry::default()).on_disk(&dropped.disk());
        let options = AuditOptions::new(Options::default());
        let (auditor, errors) = ArchiveAuditor::new(inputs, &mut machines, options);
        let (archives, unread) = auditor.audit();
        failures.extend(errors.into_iter().chain(unread).map(Refusal::from));
        let of_group = AuditReport::new(auditor.described(), archives, None);
        report.machines.extend(of_group.machines);
    }
    Audited { report, failures }
}

/// Returns the findings and the table of programs and axes.
pub(crate) fn answer(dropped: &mut Dropped, enable: &[String]) -> Vec<u8> {
    let Audited { report, failures } = audit(dropped, enable);
    let mut headline = report.headline();
    let is_whole = failures.is_empty() && report.not_checked.is_none();
    if headline.standing == Standing::Good && !is_whole {
        headline.standing = Standing::Open;
    }
    json(&AuditAnswer {
        headline,
        not_checked: report.not_checked.as_deref(),
        machines: report.machines.iter().map(machine).collect(),
        failures: &failures,
        words: Word::ALL.map(|it| (it.as_str(), it.meaning())).to_vec(),
    })
}

/// Returns the report as a page, the same as that of `frictcomp audit --html`.
pub(crate) fn report(dropped: &mut Dropped, enable: &[String]) -> Result<Vec<u8>, Refusal> {
    let Audited { report, failures } = audit(dropped, enable);
    // A report that leaves programs out would look like an all-clear.
    if let Some(failure) = failures.into_iter().next() {
        return Err(failure);
    }
    let mut written = Vec::new();
    render_with_lines(&document(&report), &mut Texts(dropped.disk()), &mut written)
        .map_err(|error| Refusal::new(error.to_string()))?;
    Ok(written)
}

fn machine(machine: &MachineAudit) -> MachineAnswer<'_> {
    let findings = machine.findings.iter();
    let programs = machine.archive.programs().iter();
    MachineAnswer {
        origin: machine.origin.as_deref(),
        axes: findings
            .map(|finding| AxisAnswer {
                axis: &finding.axis,
                leavers: finding.leavers.len(),
                inheritors: finding.inheritors.len(),
                unknown: finding.unknown.len(),
                hazards: finding.hazards(),
                cure: finding.cure().as_str(),
            })
            .collect(),
        programs: programs
            .map(|program| ProgramAnswer {
                file: &program.file,
                cells: program.axes.iter().map(cell).collect(),
            })
            .collect(),
    }
}

fn cell(audit: &AxisAudit) -> Cell<'_> {
    Cell {
        word: Word::of(audit).as_str(),
        audit,
    }
}
