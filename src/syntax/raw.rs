//! A block as written in the file.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::ast::Block;
use super::fault::Fault;
use crate::diagnostic::{Code, Diagnostic};
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
        /// Whether it is a local subprogram, `%L NAME`.
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
    /// Whether it has comments.
    pub comments: Comments,
    /// Whether it was parsed by hand, so that it is made of words with plain numbers.
    pub plain: bool,
    /// The comment line directly above that is addressed to this tool (R9.24).
    pub remark: Option<&'a Remark>,
}

impl RawBlock<'_> {
    /// A place in its lines.
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
    /// The lines with their numbers.
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
    /// Its number, from 1.
    pub line: u32,
    /// The fault, whose span counts from the start of the line.
    pub fault: Fault,
}

/// Whether a text has comments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Comments {
    /// It has none.
    Absent,
    /// It may have some.
    Possible,
}
