//! A look over the text of programs before they run: which words stand in their code. What is a comment
//! or a string is decided as for the parser, and nothing is executed.

use std::collections::BTreeSet;
use std::ops::Range;

use super::axes::{AxisUse, uses_of};
use super::hash_words::hash_word;
use super::mask::{comment_end, mask};
use super::parse::parse_block;
use super::texts::Texts;

/// Bytes that the lines of a continued block may have together to be looked at.
const MAX_CONTINUED: usize = 64 * 1024;

/// The stretches of a line that are code: neither comment nor string nor quoted number, and not the name
/// of a program. What a macro stands for is code, too.
pub(crate) fn code_stretches(line: &[u8]) -> CodeStretches<'_> {
    let is_name = line.trim_ascii_start().first() == Some(&b'%');
    let line = if is_name { &[] } else { line };
    CodeStretches {
        line,
        texts: Texts::new(line),
        at: 0,
        text: None,
    }
}

/// See [`code_stretches`].
#[derive(Debug, Clone)]
pub(crate) struct CodeStretches<'a> {
    line: &'a [u8],
    texts: Texts<'a>,
    at: usize,
    /// Where the last string ended.
    text: Option<usize>,
}

impl Iterator for CodeStretches<'_> {
    type Item = Range<usize>;

    fn next(&mut self) -> Option<Range<usize>> {
        while let Some(byte) = self.line.get(self.at) {
            let start = self.at;
            match byte {
                b';' => self.at = self.line.len(),
                b'(' => self.at = comment_end(self.line, start),
                b'"' if self.texts.end(start).is_some() => {
                    let end = self.texts.end(start).unwrap_or(self.line.len());
                    self.at = end;
                    let last = self.text.replace(end);
                    let between = last.map(|last| self.line[last..start].trim_ascii());
                    if between == Some(b"=") {
                        return Some(start + 1..end - 1);
                    }
                }
                b'\'' => {
                    let rest = &self.line[start + 1..];
                    let length = memchr::memchr(b'\'', rest).unwrap_or_default();
                    self.at = start + length + 2;
                }
                _ => {
                    let rest = &self.line[start + 1..];
                    let ends = |byte: &u8| matches!(byte, b'"' | b'\'' | b';' | b'(');
                    self.at = start + 1 + rest.iter().position(ends).unwrap_or(rest.len());
                    return Some(start..self.at);
                }
            }
        }
        None
    }
}

/// Whether a place of a text is code.
fn is_code(text: &[u8], at: usize) -> bool {
    let start = memchr::memrchr2(b'\n', b'\r', &text[..at]).map_or(0, |end| end + 1);
    let end = memchr::memchr2(b'\n', b'\r', &text[at..]).map_or(text.len(), |end| at + end);
    code_stretches(&text[start..end]).any(|stretch| stretch.contains(&(at - start)))
}

/// Whether a text has an axis word of this name: the interpreter decides what is one.
pub(crate) fn has_axis_word(text: &[u8], name: &[u8]) -> bool {
    memchr::memmem::find_iter(text, name).any(|at| is_axis_word(text, at, name))
}

fn is_axis_word(text: &[u8], at: usize, name: &[u8]) -> bool {
    let before = at.checked_sub(1).map(|before| text[before]);
    if before.is_some_and(|it| it.is_ascii_alphabetic() || b"_.@[#$'".contains(&it)) {
        return false;
    }
    let mut rest = text[at + name.len()..].iter().copied();
    let next = rest.find(|byte| !b" \t".contains(byte));
    let then = rest.next();
    let has_value = match next {
        Some(b'.') => then.is_none_or(|it| !it.is_ascii_alphabetic()),
        Some(b'=') => then != Some(b'='),
        Some(b'P') => then.is_some_and(|it| it.is_ascii_digit() || it == b'P'),
        Some(b'V') => then == Some(b'.'),
        Some(b'@' | b'+' | b'-' | b'[' | b'(') => true,
        Some(digit) => name.len() == 1 && digit.is_ascii_digit(),
        None => false,
    };
    has_value && is_code(text, at)
}

/// Whether a text calls another file: `L name`, `L4712` (R2.74).
pub(crate) fn calls_files(text: &[u8]) -> bool {
    memchr::memchr2_iter(b'L', b'l', text).any(|at| {
        let before = at.checked_sub(1).map(|before| text[before]);
        let alone = before.is_none_or(|it| !it.is_ascii_alphabetic() && !b"%._#$@".contains(&it));
        let begins_name = |it: u8| {
            let is_second = it.eq_ignore_ascii_case(&b'L');
            (it.is_ascii_alphanumeric() && !is_second) || b" \t\"_./\\".contains(&it)
        };
        alone && text.get(at + 1).copied().is_some_and(begins_name) && is_code(text, at)
    })
}

/// The words of a line that may name variables and parameters.
pub(crate) fn code_words(line: &str) -> impl Iterator<Item = &str> {
    let is_part = |it: char| it.is_ascii_alphanumeric() || "_.@".contains(it);
    let stretches = code_stretches(line.as_bytes());
    let code = stretches.filter_map(|stretch| line.get(stretch));
    code.flat_map(move |code| code.split(move |it| !is_part(it)))
}

/// Finds the axes whose friction compensation a program switches.
///
/// Only blocks that may hold a COMP command are parsed. What a macro stands for counts.
#[derive(Debug, Default)]
pub(crate) struct SwitchScan {
    /// The lines of a block that goes on.
    open: String,
    /// Inside `#COMMENT BEGIN` … `#COMMENT END`.
    is_comment: bool,
    found: BTreeSet<String>,
}

impl SwitchScan {
    /// Looks at the next lines, which are whole.
    pub(crate) fn feed(&mut self, lines: &[u8]) {
        if !self.may_tell(lines) {
            return;
        }
        for line in lines.split(|byte| matches!(byte, b'\n' | b'\r')) {
            if self.may_tell(line) {
                self.take(line);
            }
        }
    }

    /// Whether there may be a command in a text, or something that tells how to read it.
    fn may_tell(&self, text: &[u8]) -> bool {
        let is_marked = || memchr::memchr2(b'#', b'\\', text).is_some();
        !self.open.is_empty() || (!self.is_comment && has_comp(text)) || is_marked()
    }

    fn take(&mut self, line: &[u8]) {
        let line = String::from_utf8_lossy(line);
        let mut code = String::new();
        let masked = mask(&line, &mut code);
        match hash_word(&code).as_deref() {
            Some("#COMMENT BEGIN") => self.is_comment = true,
            Some("#COMMENT END") => self.is_comment = false,
            _ => {}
        }
        if self.is_comment {
            return;
        }
        let is_open = !self.open.is_empty();
        self.open.push_str(&line);
        self.open.push('\n');
        let goes_on = masked.continues || (is_open && code.trim_ascii().is_empty());
        if goes_on && self.open.len() < MAX_CONTINUED {
            return;
        }
        if has_comp(self.open.as_bytes()) {
            let block = parse_block(&self.open);
            let switched = uses_of(&block, &self.open).into_iter();
            let switched = switched.filter(|(_, how)| *how == AxisUse::Switched);
            self.found.extend(switched.map(|(name, _)| name));
        }
        self.open.clear();
    }

    /// The axes, sorted.
    pub(crate) fn into_axes(self) -> Vec<String> {
        self.found.into_iter().collect()
    }
}

/// Whether a line may hold a command. Of the letters of the word the last one is the rarest in
/// programs.
fn has_comp(line: &[u8]) -> bool {
    memchr::memchr2_iter(b'P', b'p', line).any(|at| {
        let before = at.checked_sub(3).map(|start| &line[start..at]);
        before.is_some_and(|letters| letters.eq_ignore_ascii_case(b"COM"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_is_what_the_parser_sees() {
        // R9.74
        let code = |line: &str| {
            let stretches = code_stretches(line.as_bytes());
            let code: Vec<&str> = stretches.map(|stretch| line[stretch].trim()).collect();
            code.join("|")
        };
        assert_eq!(code("N10 X1 (Y2 (Z3) A4) B5 ; C6"), "N10 X1|B5");
        assert_eq!(code("V.P.A=\"(\" X1 ; \"Y"), "V.P.A=|X1");
        assert_eq!(code("#MSG [\"X1 ; (\"] Y2"), "#MSG [|] Y2");
        assert_eq!(code("\"M\" = \"X1\""), "=|X1");
        assert_eq!(code("P1 = 'H1B5' X2"), "P1 =|X2");
        assert_eq!(code("X1 \" Y2"), "X1|\" Y2");
        assert_eq!(code("%X1"), "");
    }

    #[test]
    fn calls_of_files_are_found() {
        // R2.74
        for text in [
            "L SUB.nc",
            "N10 L\"A.nc\"",
            "L4712",
            "LUP1.nc",
            "G0 X1\nl a.nc",
        ] {
            assert!(calls_files(text.as_bytes()), "{text}");
        }
        for text in [
            "LL SUB",
            "%L SUB",
            "V.L.A=1",
            "#LAH",
            "(L SUB)",
            "#MSG [\"L SUB\"]",
            "MULL X",
        ] {
            assert!(!calls_files(text.as_bytes()), "{text}");
        }
    }

    #[test]
    fn axes_that_are_switched_are_found() {
        // R1.37
        let axes = |text: &str| {
            let mut scan = SwitchScan::default();
            scan.feed(text.as_bytes());
            scan.into_axes()
        };
        assert_eq!(
            axes("N10 X[COMP OFF FRICT] Y [comp on LEAD FRICT]"),
            ["X", "Y"]
        );
        assert_eq!(axes("N10 (c) X1[COMP OFF_ALL] ; Z[COMP ON FRICT]"), ["X1"]);
        assert_eq!(
            axes("Z[COMP OFF \\ ; more\n\nN20 FRICT]\nX[COMP OFF LEAD]\n"),
            ["Z"]
        );
        assert_eq!(axes("X[ \\\r\nCOMP OFF FRICT]\r\n"), ["X"]);
        assert_eq!(axes("X1 ; end\rY[COMP ON FRICT]\rM30"), ["Y"]);
        assert_eq!(axes("S[COMP ON FRICT]\nG0 X[P1]\nFRICT COMP"), [""; 0]);
        assert_eq!(axes("#MSG [\"X[COMP OFF FRICT]\"]\n"), [""; 0]);
        assert_eq!(axes("V.P.A=\"(\" X[COMP ON FRICT]\n"), ["X"]);
        assert_eq!(axes("\"OFF\" = \"A[COMP OFF FRICT]\"\n\"OFF\"\n"), ["A"]);
        assert_eq!(
            axes("#COMMENT BEGIN\nX[COMP ON FRICT]\n#COMMENT END\nY[COMP ON FRICT]"),
            ["Y"]
        );
    }
}
