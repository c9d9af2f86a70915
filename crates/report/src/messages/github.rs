//! Workflow commands that GitHub shows next to the changed lines of a pull request.

use frictcomp::diagnostic::{Diagnostic, Severity};

use crate::wording::{integer, visible};

use super::message_format::MessageFormat;

/// Messages as workflow commands.
#[derive(Debug)]
pub(super) struct GitHub;

impl MessageFormat for GitHub {
    fn message(&mut self, out: &mut Vec<u8>, message: &Diagnostic) {
        append(out, message);
    }
}

/// Appends a diagnostic as a workflow command.
fn append(out: &mut Vec<u8>, diagnostic: &Diagnostic) {
    let (start, end) = (diagnostic.place.start(), diagnostic.place.end());
    let command: &[u8] = match diagnostic.severity {
        Severity::Error => b"::error",
        Severity::Warning => b"::warning",
        Severity::Info => b"::notice",
    };
    out.extend_from_slice(command);
    out.extend_from_slice(b" file=");
    escape(out, &diagnostic.place.file.replace('\\', "/"), b"%\r\n:,");
    out.extend_from_slice(b",line=");
    integer(out, start.line);
    // GitHub accepts columns only for annotations within one line.
    if start.line == end.line {
        out.extend_from_slice(b",col=");
        integer(out, start.column);
        out.extend_from_slice(b",endColumn=");
        integer(out, end.column);
    } else {
        out.extend_from_slice(b",endLine=");
        integer(out, end.line);
    }
    out.extend_from_slice(b",title=");
    escape(out, diagnostic.code.as_str(), b"%\r\n:,");
    out.extend_from_slice(b"::");
    escape(out, &diagnostic.message, b"%\r\n");
    if !diagnostic.reached_from.is_empty() {
        out.extend_from_slice(b"%0Anote: ");
        escape(out, &diagnostic.reached_from.to_string(), b"%\r\n");
    }
    for advice in &diagnostic.advice {
        out.extend_from_slice(b"%0Ahelp: ");
        escape(out, &advice.to_string(), b"%\r\n");
    }
    out.push(b'\n');
}

/// Appends a text with the special bytes as `%` and two digits, and pictures for characters that cannot
/// be seen.
fn escape(out: &mut Vec<u8>, text: &str, special: &[u8]) {
    for byte in visible(&text.replace('\r', "\n")).bytes() {
        if special.contains(&byte) {
            out.extend_from_slice(format!("%{byte:02X}").as_bytes());
        } else {
            out.push(byte);
        }
    }
}
