//! Where the lines of a text begin.

use super::span::Span;

/// Where the lines of a text begin.
#[derive(Debug, Clone)]
pub struct LineIndex {
    starts: Vec<u32>,
    /// The number of the first line.
    pub(super) first: u32,
}

impl LineIndex {
    /// Indexes a text whose lines end in LF, CRLF or CR.
    pub fn new(text: &str) -> Self {
        let bytes = text.as_bytes();
        let mut starts = vec![0];
        for at in memchr::memchr2_iter(b'\n', b'\r', bytes) {
            let crlf = bytes[at] == b'\r' && bytes.get(at + 1) == Some(&b'\n');
            if !crlf {
                starts.push(Span::new(at + 1, at + 1).start);
            }
        }
        Self { starts, first: 1 }
    }

    /// The number of the line that holds a byte offset.
    pub fn line(&self, offset: u32) -> u32 {
        let before = self.starts.partition_point(|&start| start <= offset);
        let behind_first = u32::try_from(before.max(1) - 1).unwrap_or(u32::MAX);
        self.first.saturating_add(behind_first)
    }

    /// The span in `text` of the line with a number, without its line end.
    pub fn line_span(&self, text: &str, line: u32) -> Span {
        let index = line.saturating_sub(self.first) as usize;
        let Some(&start) = self.starts.get(index) else {
            return Span::new(text.len(), text.len());
        };
        let end = self
            .starts
            .get(index + 1)
            .map_or(text.len(), |&next| next as usize);
        let line = text.get(start as usize..end).unwrap_or_default();
        let trimmed = line.trim_end_matches(['\r', '\n']);
        Span::new(start as usize, start as usize + trimmed.len())
    }

    /// The number of the first line: 1, unless the text is the rest of a longer one.
    pub fn first(&self) -> u32 {
        self.first
    }

    /// How many lines the text has; a text without any line end has one.
    pub fn lines(&self) -> usize {
        self.starts.len()
    }
}
