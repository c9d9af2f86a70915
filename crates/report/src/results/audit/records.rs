//! An audit as records: programs, axes, a summary (chapter 10.1).

use serde_json::{Map, Value, json};

use super::subject::{AuditReport, MachineAudit};
use frictcomp::audit::ProgramAudit;
use frictcomp::comp::Kind;
use frictcomp::timeline::SCHEMA;

/// Returns one record per program and kind, one per axis and kind, and a summary. The first one has `schema`.
pub fn records(report: &AuditReport) -> Vec<Value> {
    let mut records = Vec::new();
    for machine in &report.machines {
        let origin = report.origin_among_several(machine);
        for program in machine.archive.programs() {
            programs(program, origin, &mut records);
        }
    }
    for machine in &report.machines {
        axes(machine, report.origin_among_several(machine), &mut records);
    }
    let unknown = report
        .findings()
        .filter(|it| !it.unknown.is_empty())
        .count();
    let mut summary = json!({
        "record": "summary",
        "headline": report.headline(),
        "programs": report.programs(),
        "axes": report.findings().count(),
        "axes_with_hazards": report.findings().filter(|it| it.hazards() > 0).count(),
        "axes_with_unknown_programs": unknown,
        "hazards": report.hazards(),
        "possible_hazards": report.possible_hazards(),
    });
    let rests_on = report.rests_on();
    if !rests_on.is_empty() {
        summary["rests_on"] = json!(rests_on);
    }
    let assumptions: Vec<&str> = report.assumptions().collect();
    if !assumptions.is_empty() {
        summary["assuming"] = json!(assumptions);
    }
    records.push(summary);
    if let Some(Value::Object(first)) = records.first_mut() {
        first.insert("schema".to_owned(), SCHEMA.into());
    }
    records
}

/// Adds a record of each examined kind; friction compensation alone needs no name.
fn programs(program: &ProgramAudit, origin: Option<&str>, records: &mut Vec<Value>) {
    let mut kinds: Vec<Kind> = program.axes.iter().map(|axis| axis.kind).collect();
    kinds.sort_unstable();
    kinds.dedup();
    if kinds.is_empty() {
        kinds.push(Kind::Frict);
    }
    for &kind in &kinds {
        let own = program.axes.iter().filter(|axis| axis.kind == kind);
        let axes: Map<String, Value> = own.map(|axis| (axis.axis.clone(), json!(axis))).collect();
        let mut record = json!({ "record": "program", "file": program.file, "axes": axes });
        if kinds.len() > 1 {
            record["kind"] = kind.as_str().into();
        }
        if let Some(origin) = origin {
            record["machine"] = origin.into();
        }
        records.push(record);
    }
}

fn axes(machine: &MachineAudit, origin: Option<&str>, records: &mut Vec<Value>) {
    for finding in &machine.findings {
        let mut record = json!({
            "record": "axis",
            "axis": finding.axis,
            "kind": finding.kind.as_str(),
            "leavers": finding.leavers.len(),
            "inheritors": finding.inheritors.len(),
            "both": finding.both.len(),
            "unknown": finding.unknown.len(),
            "hazards": finding.hazards(),
            "possible_inheritors": finding.possible_inheritors.len(),
            "possible_hazards": finding.possible_hazards(),
            "cure": finding.cure(),
        });
        if let Some(origin) = origin {
            record["machine"] = origin.into();
        }
        records.push(record);
    }
}
