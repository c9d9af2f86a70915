//! The remarks on a recording, as text.

use std::fmt::Write;

use super::visible::visible_line;
use frictcomp_recordings::identify::TraceFinding;

/// Adds each finding with its severity, its code and what to do.
pub(super) fn write_findings<'a>(
    findings: impl IntoIterator<Item = &'a TraceFinding>,
    out: &mut impl Write,
) {
    for finding in findings {
        let _ = writeln!(
            out,
            "\n{}[{}]: {}\n  help: {}",
            finding.severity.as_str(),
            finding.code,
            visible_line(&finding.message),
            visible_line(&finding.help)
        );
    }
}
