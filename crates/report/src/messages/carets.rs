//! Source lines with carets, in the manner of rustc.

use crate::document::Headline;
use crate::wording::{Look, fitted, render};
use frictcomp::diagnostic::Diagnostic;

use super::message_format::MessageFormat;

/// Messages as people read them, with an empty line between them.
#[derive(Debug)]
pub(super) struct Carets {
    look: Look,
    is_begun: bool,
}

impl Carets {
    pub(super) fn new(look: Look) -> Self {
        let is_begun = false;
        Self { look, is_begun }
    }

    fn append(&mut self, out: &mut Vec<u8>, text: &str) {
        if self.is_begun {
            out.push(b'\n');
        }
        self.is_begun = true;
        out.extend_from_slice(text.as_bytes());
    }
}

impl MessageFormat for Carets {
    fn message(&mut self, out: &mut Vec<u8>, message: &Diagnostic) {
        self.append(out, &render(message, self.look));
    }

    fn headline(&mut self, out: &mut Vec<u8>, headline: &Headline) {
        self.append(out, &fitted(&format!("{headline}\n"), self.look.width));
    }
}
