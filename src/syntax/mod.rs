//! From text to blocks.

mod comp;

pub use comp::{CompCommand, Kind, KindSet, Membership, Selection};

use crate::codes::Code;
use crate::source::Span;

/// A statement about the text of one block: a diagnostic whose span counts from the block's start.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The code.
    pub code: Code,
    /// The bytes of the block's text that are meant.
    pub span: Span,
    /// One sentence in lower case.
    pub message: String,
    /// What to do.
    pub help: Vec<String>,
}

impl Fault {
    /// A fault without advice.
    pub fn new(code: Code, span: Span, message: impl Into<String>) -> Self {
        Self {
            code,
            span,
            message: message.into(),
            help: Vec::new(),
        }
    }

    /// The same with one more piece of advice.
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help.push(help.into());
        self
    }
}

/// Parses one COMP command, `X[COMP ON FRICT]`, and nothing else.
pub fn parse_comp(_text: &str) -> Result<CompCommand, Fault> {
    unimplemented!()
}
