//! Whether a program needs its whole text at once.

use super::raw::MAX_LINE;

/// Looks through the bytes of a program, piece by piece, for anything that needs the whole text at
/// once: a `$` statement, `#IF`, a local subprogram (`%L name`), a call (`L name`), whose program may return to a block
/// further up, or which runs a part of this one (`L SEQUENCE`).
#[derive(Debug, Clone, Default)]
pub struct FlowScan {
    found: bool,
}

impl FlowScan {
    /// Looks through the next piece.
    pub fn feed(&mut self, piece: &[u8]) {
        let mut from = 0;
        while !self.found {
            let found = memchr::memchr3(b'$', b'%', b'L', &piece[from..]);
            let Some(at) = found.map(|at| from + at) else {
                break;
            };
            self.found = match piece[at] {
                b'$' => true,
                b'%' => Self::opens_subprogram(&piece[at + 1..]),
                _ => Self::calls_program(&piece[..at], &piece[at + 1..]),
            };
            from = at + 1;
        }
        // Three bytes are found at once, a fourth is not.
        let mut commands = memchr::memchr_iter(b'#', piece);
        self.found |= commands.any(|at| Self::opens_branch(&piece[at + 1..]));
    }

    /// Whether the whole text is needed.
    pub fn needs_whole_text(&self) -> bool {
        self.found
    }

    /// `L` alone with a separator after it, outside a comment; a piece that ends before that is taken as one.
    fn calls_program(before: &[u8], after: &[u8]) -> bool {
        let is_alone = before.last().is_none_or(|byte| !byte.is_ascii_alphabetic());
        let is_followed = after
            .first()
            .is_none_or(|byte| matches!(byte, b' ' | b'\t'));
        is_alone && is_followed && !Self::ends_in_comment(before)
    }

    /// Whether the last line is in a comment so far. A line that is longer than a block may be is not.
    fn ends_in_comment(text: &[u8]) -> bool {
        let near = &text[text.len().saturating_sub(MAX_LINE)..];
        let line = match memchr::memrchr2(b'\n', b'\r', near) {
            Some(end) => &near[end..],
            None if near.len() < MAX_LINE => near,
            None => return false,
        };
        let opened = memchr::memrchr(b'(', line);
        memchr::memchr(b';', line).is_some() || opened > memchr::memrchr(b')', line)
    }

    /// `#IF`; a piece that ends before that is taken as one.
    fn opens_branch(after: &[u8]) -> bool {
        let letters = after.iter().zip(b"IF");
        letters
            .into_iter()
            .all(|(found, letter)| found.eq_ignore_ascii_case(letter))
    }

    /// `%L` with a separator after it; a piece that ends before that is taken as one.
    fn opens_subprogram(after: &[u8]) -> bool {
        let mut rest = after.iter().skip_while(|byte| matches!(byte, b' ' | b'\t'));
        match (rest.next(), rest.next()) {
            (None, _) | (Some(b'L' | b'l'), None) => true,
            (Some(b'L' | b'l'), Some(next)) => matches!(next, b' ' | b'\t'),
            _ => false,
        }
    }
}
