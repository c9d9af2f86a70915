//! A block as written in the file, and the comment lines above it that are addressed to this tool (R9.24).

use std::collections::BTreeMap;
use std::sync::Arc;

use super::ast::Block;
use super::parse::Fault;
use crate::diagnostic::{Code, Diagnostic, MAX_MESSAGES};
use crate::text::{Place, Span};

/// Characters that one line may have (R2.2).
pub const MAX_LINE: usize = 4000;

/// Kind of a stretch of source lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stretch {
    /// A block, parsed.
    Block,
    /// `%NAME`: a program begins.
    Program {
        /// The name of the program.
        name: Span,
        /// Whether the program is a local subprogram, `%L NAME`.
        local: bool,
    },
}

/// One block, or one `%` line, as written in the file.
#[derive(Debug, Clone, Copy)]
pub struct RawBlock<'a> {
    /// Kind of the stretch.
    pub stretch: Stretch,
    /// The source lines joined by `\n`, without trailing blanks.
    pub text: &'a str,
    /// The line on which it starts, from 1.
    pub line: u32,
    /// Offset of that line in bytes from the start of the text.
    pub offset: usize,
    /// Comments of the block.
    pub comments: Comments,
    /// Whether the block was parsed by hand, so that it consists of words with plain numbers.
    pub plain: bool,
    /// The comment line directly above that is addressed to this tool (R9.24).
    pub remark: Option<&'a Remark>,
}

impl RawBlock<'_> {
    /// Returns a place in its lines.
    pub(crate) fn place(&self, file: &Arc<str>, span: Span) -> Place {
        Place::in_block(file, self.text, self.line, span)
    }

    /// Returns the messages on a `%` line, which no run reaches.
    pub(crate) fn opening_said(&self, file: &Arc<str>, block: &Block) -> Vec<Diagnostic> {
        let faults = block.faults.iter();
        let said = faults.map(|fault| {
            let place = self.place(file, fault.span);
            fault.clone().into_diagnostic(place, |_| None)
        });
        said.collect()
    }
}

/// Comment lines, one right above the other, that are addressed to this tool.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Remark {
    /// The lines without trailing blanks, joined by `\n`.
    pub text: String,
    /// The number of the first one, from 1.
    pub line: u32,
}

impl Remark {
    /// Returns the lines with their numbers.
    pub fn lines(&self) -> impl Iterator<Item = (&str, u32)> {
        self.text.lines().zip(self.line..)
    }
}

/// Remarks that are not directly above a block.
#[derive(Debug, Clone, Default)]
pub struct LostRemarks {
    /// The first of them.
    pub remarks: Vec<Remark>,
    /// Number of further remarks.
    pub more: u64,
    /// The first faults of lines outside blocks.
    pub faults: Vec<LineFault>,
    /// The number of such faults beyond those, by their code.
    pub more_faults: BTreeMap<Code, u64>,
}

/// A fault of a line outside blocks.
#[derive(Debug, Clone)]
pub struct LineFault {
    /// The line without trailing blanks.
    pub text: String,
    /// Number, from 1.
    pub line: u32,
    /// The fault, whose span counts from the start of the line.
    pub fault: Fault,
}

/// Presence of comments in a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Comments {
    /// No comments.
    Absent,
    /// Possibly some comments.
    Possible,
}

impl Comments {
    /// Returns whether a whole block may have comments: one begins with `;`, `(` or `#COMMENT`.
    pub(super) fn of(block: &str) -> Self {
        match memchr::memchr3(b';', b'(', b'#', block.as_bytes()) {
            Some(_) => Self::Possible,
            None => Self::Absent,
        }
    }
}

/// Bytes that lines one above the other may have together.
const MAX_BYTES: usize = 1 << 16;

/// The comment lines that were read last, and those that no block followed.
#[derive(Debug, Default)]
pub(super) struct LatestRemarks {
    remark: Remark,
    /// The number of its last line; 0 where there is none.
    last: u32,
    /// Whether a block begins on the line after the last comment.
    is_heard: bool,
    lost: LostRemarks,
}

impl LatestRemarks {
    /// Takes a line.
    pub(super) fn take(&mut self, text: &str, line: u32) {
        let follows = self.last > 0 && self.last + 1 == line && !self.is_heard;
        if follows && self.remark.text.len() + text.len() < MAX_BYTES {
            self.remark.text.push('\n');
            self.remark.text.push_str(text);
        } else {
            self.end();
            text.clone_into(&mut self.remark.text);
            self.remark.line = line;
            self.is_heard = false;
        }
        self.last = line;
    }

    /// Takes the faults of a line outside blocks.
    pub(super) fn note(&mut self, text: &str, line: u32, faults: impl IntoIterator<Item = Fault>) {
        for fault in faults {
            if self.lost.faults.len() <= MAX_MESSAGES {
                let text = text.to_owned();
                self.lost.faults.push(LineFault { text, line, fault });
            } else {
                *self.lost.more_faults.entry(fault.code).or_default() += 1;
            }
        }
    }

    /// Returns the remark directly above a block that begins on a line.
    #[inline]
    pub(super) fn above(&mut self, line: u32) -> Option<&Remark> {
        if self.last == 0 {
            return None;
        }
        if self.last + 1 != line {
            self.end();
            return None;
        }
        self.is_heard = true;
        Some(&self.remark)
    }

    /// Returns the remark directly above the block read last.
    pub(super) fn heard(&self) -> Option<&Remark> {
        (self.last > 0 && self.is_heard).then_some(&self.remark)
    }

    /// Ends the text: a remark that no block has followed is lost.
    pub(super) fn end(&mut self) {
        if self.last > 0 && !self.is_heard {
            if self.lost.remarks.len() <= MAX_MESSAGES {
                self.lost.remarks.push(std::mem::take(&mut self.remark));
            } else {
                self.lost.more += 1;
            }
        }
        self.last = 0;
    }

    /// Returns the remarks that no block followed.
    pub(super) fn lost(&self) -> &LostRemarks {
        &self.lost
    }
}
