//! The ends of the texts `"…"` of a line or a block.

use std::cell::OnceCell;

/// Finds where texts end, in one pass over all of them.
#[derive(Debug, Clone)]
pub(super) struct Texts<'a> {
    bytes: &'a [u8],
    /// The last quote without a `\` before it; texts that begin at or after it hold no `\"`.
    last: OnceCell<Option<usize>>,
}

impl<'a> Texts<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            last: OnceCell::new(),
        }
    }

    /// One past the quote that closes the text at `start`. A `\"` stands for a quote inside; where that
    /// leaves the text open, it was the text's own last character.
    pub(super) fn end(&self, start: usize) -> Option<usize> {
        if !self.is_closed(start) {
            let rest = &self.bytes[start + 1..];
            return memchr::memchr(b'"', rest).map(|length| start + length + 2);
        }
        let mut at = start + 1;
        while let Some(length) = memchr::memchr(b'"', &self.bytes[at..]) {
            at += length + 1;
            if !self.is_escaped(at - 1) {
                return Some(at);
            }
        }
        None
    }

    /// Whether a quote after a place has no `\` before it.
    pub(super) fn is_closed(&self, start: usize) -> bool {
        let last = self.last.get_or_init(|| {
            let mut quotes = memchr::memrchr_iter(b'"', self.bytes);
            quotes.find(|at| !self.is_escaped(*at))
        });
        last.is_some_and(|last| last > start)
    }

    fn is_escaped(&self, quote: usize) -> bool {
        quote > 0 && self.bytes[quote - 1] == b'\\'
    }
}
