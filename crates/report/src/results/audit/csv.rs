//! An audit as a table: one row per program, axis and kind.

use serde_json::Value;

use super::subject::AuditReport;
use crate::wording::push_row;
use frictcomp::audit::Site;

const HEADER: &str = "machine,file,axis,kind,effect,by_file,by_line,reason,inherits,inherits_file,inherits_line,motion,inherits_if\n";

/// Returns one row per program, axis and kind, quoted according to RFC 4180.
pub fn render_csv(report: &AuditReport) -> String {
    let mut out = HEADER.as_bytes().to_vec();
    for machine in &report.machines {
        for program in machine.archive.programs() {
            for axis in &program.axes {
                let motion = axis.inherits.motion();
                let (by_file, by_line) = place(axis.by.as_ref());
                let (in_file, in_line) = place(motion.map(|motion| &motion.site));
                let when = axis.leaves_away_when(&program.file);
                let reason = axis.reason.as_ref().map(|it| it.message.as_str());
                let reason = reason.or(when.as_deref()).unwrap_or_default();
                let condition = motion.and_then(|motion| motion.condition(&program.file));
                let cells = [
                    machine.origin.as_deref().unwrap_or_default(),
                    &program.file,
                    &axis.axis,
                    axis.kind.as_str(),
                    axis.effect.as_str(),
                    by_file,
                    &by_line,
                    reason,
                    axis.inherits.as_str(),
                    in_file,
                    &in_line,
                    motion.map_or("", |motion| motion.motion.as_str()),
                    condition.as_deref().unwrap_or_default(),
                ];
                push_row(&mut out, &cells.map(Value::from));
            }
        }
    }
    String::from_utf8_lossy(&out).into_owned()
}

fn place(site: Option<&Site>) -> (&str, String) {
    site.map_or(("", String::new()), |site| {
        (&*site.file, site.line.to_string())
    })
}
