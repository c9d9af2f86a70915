//! Whether a program needs its whole text at once.

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

    /// `L` alone with a separator after it; a piece that ends before that is taken as one.
    fn calls_program(before: &[u8], after: &[u8]) -> bool {
        let is_alone = before.last().is_none_or(|byte| !byte.is_ascii_alphabetic());
        is_alone
            && after
                .first()
                .is_none_or(|byte| matches!(byte, b' ' | b'\t'))
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
