//! Finds a free block number and writes it the way the program writes its own.

use std::collections::BTreeSet;

/// The largest block number that is generated.
const MOST: u64 = 999_999_999;

/// Step of block numbers if the program does not have two numbers that give one.
const USUAL_STEP: u64 = 10;

/// The block number of a line.
#[derive(Debug, Clone, Copy)]
struct LineNumber<'a> {
    /// Text before the digits: blanks and `N`.
    before: &'a str,
    /// The digits, with leading zeros.
    digits: &'a str,
    value: u64,
}

/// The lines of a program and their numbers.
pub(crate) struct Numbering<'a> {
    lines: Vec<&'a str>,
    taken: BTreeSet<u64>,
}

impl<'a> Numbering<'a> {
    pub(crate) fn of(text: &'a str) -> Self {
        let lines: Vec<&str> = lines(text).collect();
        let numbers = lines.iter().filter_map(|line| number(line));
        Self {
            taken: numbers.map(|number| number.value).collect(),
            lines,
        }
    }

    /// Returns the lines of the program, without their ends.
    pub(crate) fn lines(&self) -> &[&'a str] {
        &self.lines
    }

    /// Marks the number of a block as taken.
    pub(crate) fn take(&mut self, block: &str) {
        self.taken.extend(number(block).map(|number| number.value));
    }

    /// Returns a command as a block before a line (from 1), with a number that is taken from then
    /// on.
    pub(crate) fn block(&mut self, line: u32, command: &str) -> String {
        let at = usize::try_from(line.saturating_sub(1)).unwrap_or(usize::MAX);
        let at = at.min(self.lines.len());
        let (before, after) = self.lines.split_at(at);
        let last = before.iter().rev().find_map(|line| number(line));
        let next = after.first().and_then(|line| number(line));
        let above = || before.iter().rev().find(|line| !line.trim().is_empty());
        let pattern = match (next, after.first()) {
            (Some(next), _) => next,
            // At the end the last block serves as the pattern.
            (None, None) => match above().and_then(|line| number(line)) {
                Some(last) => last,
                None => return command.to_owned(),
            },
            (None, Some(line)) => {
                let blanks = line.len() - line.trim_start().len();
                let is_last = line.trim().is_empty();
                match above().and_then(|line| number(line)) {
                    Some(last) if is_last => last,
                    _ => return format!("{}{command}", &line[..blanks]),
                }
            }
        };
        let values = [last, next].map(|it| it.map(|it| it.value));
        let Some(free) = self.free(values[0], values[1]) else {
            return command.to_owned();
        };
        self.taken.insert(free);
        let width = pattern.digits.len();
        let zeros = if pattern.digits.starts_with('0') {
            width
        } else {
            0
        };
        // A lower-case `n` is no word of the control (R1.8).
        let before = pattern.before.to_ascii_uppercase();
        format!("{before}{free:0zeros$} {command}")
    }

    /// Returns a free number between two others, or else above all of them.
    fn free(&self, last: Option<u64>, next: Option<u64>) -> Option<u64> {
        let (from, to) = match (last, next) {
            (Some(last), Some(next)) if next > last + 1 => (last + 1, next),
            (None, Some(next)) if next > 0 => (0, next),
            _ => return self.above_all(last, next),
        };
        let middle = from + (to - from) / 2;
        let free = |number: &u64| !self.taken.contains(number);
        (middle..to)
            .find(free)
            .or_else(|| (from..middle).rev().find(free))
            .or_else(|| self.above_all(last, next))
    }

    fn above_all(&self, last: Option<u64>, next: Option<u64>) -> Option<u64> {
        let highest = *self.taken.last()?;
        let step = match (last, next) {
            (Some(last), Some(next)) if next > last => next - last,
            (Some(last), None) => {
                let earlier = self.taken.range(..last).next_back();
                earlier.map_or(USUAL_STEP, |earlier| last - earlier)
            }
            _ => USUAL_STEP,
        };
        let step = step.clamp(1, 1000);
        Some(highest + step).filter(|number| *number <= MOST)
    }
}

/// Returns the block number at the start of a line.
fn number(line: &str) -> Option<LineNumber<'_>> {
    let blanks = line.len() - line.trim_start().len();
    let rest = line[blanks..].strip_prefix(['N', 'n'])?;
    let length = rest.bytes().take_while(u8::is_ascii_digit).count();
    let digits = &rest[..length];
    Some(LineNumber {
        before: &line[..=blanks],
        digits,
        value: digits.parse().ok().filter(|value| *value <= MOST)?,
    })
}

/// Returns the lines of a text, which end with LF, CR LF or CR.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let end = rest.find(['\r', '\n']).unwrap_or(rest.len());
        let (line, after) = rest.split_at(end);
        let skip = if after.starts_with("\r\n") { 2 } else { 1 };
        rest = after.get(skip..).unwrap_or_default();
        Some(line)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(text: &str, line: u32) -> String {
        Numbering::of(text).block(line, "X[COMP ON FRICT]")
    }

    #[test]
    fn a_number_is_free_and_written_like_its_neighbours() {
        // R10.3, R12.20
        for (text, line, wanted) in [
            ("N10 X1\nN20 M30\n", 2, "N15 "),
            ("  n0010 X1\r\n  n0020 M30\r\n", 2, "  N0015 "),
            ("N1 X1\nN2 M30\n", 2, "N3 "),
            ("N10 X1\nN20 M30\nN15 X2\n", 2, "N16 "),
            ("N10 X1\nN12 M30\nN11 X2\n", 2, "N14 "),
            ("X1\nM30\n", 2, ""),
            ("  X1\n  M30\n", 2, "  "),
            ("N10 X1\nM30\n", 2, ""),
            ("N10 X1\nN20 X2", 3, "N30 "),
            ("N10 X1\nN20 X2\n\n", 3, "N30 "),
            ("N10 X1\n", 1, "N5 "),
            ("N999999999 M30", 2, ""),
            ("", 1, ""),
        ] {
            let command = "X[COMP ON FRICT]";
            assert_eq!(made(text, line), format!("{wanted}{command}"), "{text:?}");
        }
    }
}
