//! A place in a file that shows itself.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::span::{Position, Span};

/// A place in a file, together with the lines that show it.
///
/// It carries its lines itself, so that a program of any length can be streamed and forgotten.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Place {
    /// The file as the user named it.
    pub file: Arc<str>,
    /// The source lines to show, joined by `\n`.
    pub text: Arc<str>,
    /// The 1-based number of the first line of `text`.
    pub first_line: u32,
    /// The bytes of `text` that are meant.
    pub span: Span,
}

impl Place {
    /// The first character that is meant.
    pub fn start(&self) -> Position {
        self.position(self.span.start)
    }

    /// One past the last character that is meant.
    pub fn end(&self) -> Position {
        self.position(self.span.end)
    }

    fn position(&self, offset: u32) -> Position {
        let before = self.text.get(..offset as usize).unwrap_or(&self.text);
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        Position {
            line: self.first_line + count(before.matches('\n').count()),
            column: count(before[line_start..].chars().count()) + 1,
        }
    }
}
