//! Whether a program needs its whole text at once.

/// Looks through the bytes of a program, piece by piece, for anything that needs the whole text at
/// once: a `$` statement, `#IF`, a local subprogram (`%L name`), a part of the program (`L SEQUENCE`).
#[derive(Debug, Clone, Default)]
pub struct FlowScan {
    found: bool,
}

impl FlowScan {
    /// Looks through the next piece.
    pub fn feed(&mut self, piece: &[u8]) {
        let mut from = 0;
        while !self.found {
            let found = memchr::memchr3(b'$', b'%', b'Q', &piece[from..]);
            let Some(at) = found.map(|at| from + at) else {
                break;
            };
            self.found = match piece[at] {
                b'$' => true,
                b'%' => Self::opens_subprogram(&piece[at + 1..]),
                _ => Self::calls_part(&piece[..at], &piece[at + 1..]),
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

    /// The word `SEQUENCE` around its `Q`; the part in another piece is taken as fitting. Lower case is
    /// rare, and reported where a block of it was not kept.
    fn calls_part(before: &[u8], after: &[u8]) -> bool {
        let before = before.iter().rev().zip(b"ES");
        let after = after.iter().zip(b"UENCE");
        before
            .chain(after)
            .all(|(found, wanted)| found.eq_ignore_ascii_case(wanted))
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
