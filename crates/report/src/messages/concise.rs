//! One line per diagnostic: `file:line:column: severity[CODE] message`.

use frictcomp::diagnostic::Diagnostic;

use crate::wording::{integer, leading, visible_line};

use super::message_format::MessageFormat;

/// Returns a diagnostic as one line, without its end.
pub fn concise_line(diagnostic: &Diagnostic) -> String {
    let mut line = Vec::new();
    append(&mut line, diagnostic);
    String::from_utf8_lossy(&line).trim_end().to_owned()
}

/// Messages of one line each.
#[derive(Debug)]
pub(super) struct Concise;

impl MessageFormat for Concise {
    fn message(&mut self, out: &mut Vec<u8>, message: &Diagnostic) {
        append(out, message);
    }
}

/// Appends a diagnostic as one line.
fn append(out: &mut Vec<u8>, diagnostic: &Diagnostic) {
    let start = diagnostic.place.start();
    out.extend_from_slice(leading(&diagnostic.place.file).as_bytes());
    out.push(b':');
    integer(out, start.line);
    out.push(b':');
    integer(out, start.column);
    out.extend_from_slice(b": ");
    out.extend_from_slice(diagnostic.severity.as_str().as_bytes());
    out.push(b'[');
    out.extend_from_slice(diagnostic.code.as_str().as_bytes());
    out.extend_from_slice(b"] ");
    out.extend_from_slice(visible_line(&diagnostic.line()).as_bytes());
    out.push(b'\n');
}
