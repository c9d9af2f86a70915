//! One line a diagnostic: `file:line:column: severity[CODE] message`.

use crate::diagnostic::Diagnostic;

use super::strings::integer;

/// Appends a diagnostic as one line.
pub(super) fn append(out: &mut Vec<u8>, diagnostic: &Diagnostic) {
    let start = diagnostic.place.start();
    append_flat(out, &diagnostic.place.file);
    out.push(b':');
    integer(out, start.line);
    out.push(b':');
    integer(out, start.column);
    out.extend_from_slice(b": ");
    out.extend_from_slice(diagnostic.severity.word().as_bytes());
    out.push(b'[');
    out.extend_from_slice(diagnostic.code.text().as_bytes());
    out.extend_from_slice(b"] ");
    append_flat(out, &diagnostic.message);
    out.push(b'\n');
}

/// Line ends and other control characters would break the line.
fn append_flat(out: &mut Vec<u8>, text: &str) {
    let mut buffer = [0; 4];
    for letter in text.chars() {
        let shown = if letter.is_control() { ' ' } else { letter };
        out.extend_from_slice(shown.encode_utf8(&mut buffer).as_bytes());
    }
}
