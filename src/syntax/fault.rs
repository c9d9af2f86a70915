//! What is wrong with the text of a block.

use crate::diagnostic::Code;
use crate::text::Span;

/// A statement about the text of one block: a diagnostic whose span counts from the block's start.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
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
