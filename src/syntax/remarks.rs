//! Comment lines that are addressed to this tool, and the blocks below them (R9.24).

use super::fault::Fault;
use super::raw::{LineFault, LostRemarks, Remark};
use crate::diagnostic::MAX_MESSAGES;

/// Bytes that lines one above the other may have together.
const MAX_BYTES: usize = 1 << 16;

/// The comment lines that were read last, and those that no block followed.
#[derive(Debug, Default)]
pub(super) struct LatestRemarks {
    remark: Remark,
    /// The number of its last line; 0 where there is none.
    last: u32,
    /// Whether a block begins on the line after it.
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

    /// No block follows any more.
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
