//! Source lines with carets, in the manner of rustc.

use crate::diagnostic::Diagnostic;
use crate::report::diagnostics::{Look, render};

use super::message_format::MessageFormat;

/// Messages as people read them.
#[derive(Debug)]
pub(super) struct Carets(pub(super) Look);

impl MessageFormat for Carets {
    fn message(&mut self, out: &mut Vec<u8>, message: &Diagnostic) {
        out.extend_from_slice(render(message, self.0).as_bytes());
        out.push(b'\n');
    }
}
