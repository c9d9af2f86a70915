//! A look over programs before they run, piece by piece: blocks that may matter are parsed as in a
//! run, the rest is skipped. Nothing is executed. It also tells whether a program needs its whole text at once.

use std::collections::BTreeSet;

use super::ast::{Block, CallScope, Item};
use super::keywords::opening_command;
use super::names::{AxisUse, MAX_MACROS, own_uses, uses_of, with_macros};
use super::parse::parse_block;
use super::pieces::mask;
use super::raw::MAX_LINE;
use crate::language::HashAction;

/// Bytes that the lines of a continued block may have together to be looked at.
const MAX_CONTINUED: usize = 64 * 1024;

/// A question to a program.
pub trait ScanQuestion {
    /// Returns the first place of a text, from one on, at which a line may matter.
    fn next(&mut self, text: &[u8], from: usize) -> Option<usize>;

    /// Looks at a block that may matter.
    fn look(&mut self, block: &Block, text: &str);
}

/// Finds the blocks that answer a question; handles continued blocks and `#COMMENT` regions.
#[derive(Debug, Default)]
pub struct Scan<Q> {
    /// The question, with its findings.
    pub question: Q,
    /// The lines of a continued block.
    open: String,
    /// Inside `#COMMENT BEGIN` … `#COMMENT END`.
    is_comment: bool,
}

impl<Q: ScanQuestion> Scan<Q> {
    /// Returns a scan from the start of a program.
    pub fn new(question: Q) -> Self {
        Self {
            question,
            open: String::new(),
            is_comment: false,
        }
    }

    /// Looks at the next lines, which are whole.
    pub fn feed(&mut self, lines: &[u8]) {
        let (mut marked, mut told) = (Some(0), Some(0));
        let mut from = 0;
        while from < lines.len() {
            // These decide how to read on.
            if marked.is_some_and(|at| at < from || from == 0) {
                let mark = memchr::memchr2(b'#', b'\\', &lines[from..]);
                marked = mark.map(|at| from + at);
            }
            if told.is_some_and(|at| at < from || from == 0) {
                told = self.question.next(lines, from);
            }
            let is_open = !self.open.is_empty();
            let next = if is_open {
                Some(from)
            } else {
                marked.into_iter().chain(told).min()
            };
            let Some(at) = next else {
                return;
            };
            let before = memchr::memrchr2(b'\n', b'\r', &lines[from..at]);
            let start = before.map_or(from, |end| from + end + 1);
            let length = memchr::memchr2(b'\n', b'\r', &lines[at..]);
            let end = length.map_or(lines.len(), |length| at + length);
            let tells = told.is_some_and(|at| at < end);
            if is_open || tells || marked.is_some_and(|at| at < end) {
                self.take(&lines[start..end], tells);
            }
            from = end + 1;
        }
    }

    fn take(&mut self, line: &[u8], tells: bool) {
        let line = String::from_utf8_lossy(line);
        let mut code = String::new();
        let masked = mask(&line, &mut code);
        match opening_command(&code).and_then(|command| command.action()) {
            Some(HashAction::Comment) => self.is_comment = true,
            Some(HashAction::EndComment) => self.is_comment = false,
            _ => {}
        }
        if self.is_comment {
            return;
        }
        let is_open = !self.open.is_empty();
        if !is_open && !masked.continues {
            if tells {
                self.question.look(&parse_block(&line), &line);
            }
            return;
        }
        self.open.push_str(&line);
        self.open.push('\n');
        let goes_on = masked.continues || (is_open && code.trim_ascii().is_empty());
        if goes_on && self.open.len() < MAX_CONTINUED {
            return;
        }
        let text = std::mem::take(&mut self.open);
        self.question.look(&parse_block(&text), &text);
    }
}

/// The axes whose friction compensation a program switches. The code of macros counts.
#[derive(Debug, Default)]
pub struct SwitchedAxes(pub BTreeSet<String>);

impl ScanQuestion for SwitchedAxes {
    /// Returns `COMP`. Of its letters the last one is the rarest in programs.
    fn next(&mut self, text: &[u8], from: usize) -> Option<usize> {
        let mut places = memchr::memchr2_iter(b'P', b'p', &text[from..]);
        let is_word = |at: &usize| {
            let before = at
                .checked_sub(3)
                .map(|start| &text[from + start..from + at]);
            before.is_some_and(|letters| letters.eq_ignore_ascii_case(b"COM"))
        };
        places.find(is_word).map(|at| from + at)
    }

    fn look(&mut self, block: &Block, text: &str) {
        let switched = uses_of(block, text).into_iter();
        let switched = switched.filter(|(_, how)| *how == AxisUse::Switched);
        self.0.extend(switched.map(|(name, _)| name));
    }
}

/// The requested axes that a program names, and whether it may name more (R2.74).
#[derive(Debug, Default)]
pub struct NamedAxes {
    pending: Vec<PendingLabel>,
    found: BTreeSet<String>,
    /// Axes whose state of compensation the program reads.
    read: BTreeSet<String>,
    next_read: Option<usize>,
    calls: Calls,
    /// Whether a block that may name an axis has a fault and a bracket.
    is_faulty: bool,
}

/// Part of a variable that reads a state, `V.A.FRICT_COMP_ACTIVE.X`.
const STATE: &str = "_COMP_";

/// A name that was not found yet.
#[derive(Debug)]
struct PendingLabel {
    name: String,
    next: Option<usize>,
}

/// Calls found in a program.
#[derive(Debug, Default)]
struct Calls {
    is_found: bool,
    next: Option<usize>,
}

impl NamedAxes {
    /// Asks for these names.
    pub fn new<'a>(names: impl IntoIterator<Item = &'a str>) -> Self {
        let label = |name: &str| PendingLabel {
            name: name.to_owned(),
            next: None,
        };
        Self {
            pending: names.into_iter().map(label).collect(),
            ..Self::default()
        }
    }

    /// Returns the names that were found.
    pub fn into_names(self) -> BTreeSet<String> {
        self.found
    }

    /// Returns the axes whose state of compensation the program reads.
    pub fn read(&self) -> &BTreeSet<String> {
        &self.read
    }

    /// Returns whether the program may name further axes: it calls a file, or a block that may name one has a fault.
    pub fn may_name_more(&self) -> bool {
        self.calls.is_found || self.is_faulty
    }
}

impl ScanQuestion for NamedAxes {
    fn next(&mut self, text: &[u8], from: usize) -> Option<usize> {
        // Each place is looked for once, not again for each line before it.
        let is_known = |next: &Option<usize>| from > 0 && next.is_none_or(|at| at >= from);
        for label in &mut self.pending {
            if !is_known(&label.next) {
                label.next = axis_place(text, from, label.name.as_bytes());
            }
        }
        if !is_known(&self.calls.next) {
            let is_wanted = !self.calls.is_found;
            self.calls.next = is_wanted.then(|| call_place(text, from)).flatten();
        }
        if !is_known(&self.next_read) {
            let found = memchr::memmem::find(&text[from..], STATE.as_bytes());
            self.next_read = found.map(|at| from + at);
        }
        let places = self.pending.iter().filter_map(|label| label.next);
        places.chain(self.calls.next).chain(self.next_read).min()
    }

    fn look(&mut self, block: &Block, text: &str) {
        self.is_faulty |= !block.faults.is_empty() && text.contains('[');
        with_macros(block, text, MAX_MACROS, &mut |block, text| {
            for (name, _) in own_uses(block, text) {
                if let Some(at) = self.pending.iter().position(|label| label.name == name) {
                    self.pending.swap_remove(at);
                    self.found.insert(name);
                }
            }
            self.calls.is_found |= block.items.iter().any(calls_file);
            self.read.extend(axes_read(text));
        });
    }
}

/// Returns the axes whose state of compensation a block reads.
fn axes_read(text: &str) -> Vec<String> {
    if !text.contains(STATE) {
        return Vec::new();
    }
    let mut code = String::new();
    mask(text, &mut code);
    let after = code.split(STATE).skip(1).filter_map(|rest| {
        let name = rest
            .strip_prefix("ACTIVE.")
            .or(rest.strip_prefix("INIT."))?;
        let end = name.find(|it: char| !it.is_ascii_alphanumeric() && it != '_');
        Some(name[..end.unwrap_or(name.len())].to_owned())
    });
    after.collect()
}

/// Returns the next place where a name may begin a word.
fn axis_place(text: &[u8], from: usize, name: &[u8]) -> Option<usize> {
    let begins = |at: &usize| {
        let before = at.checked_sub(1).map(|before| text[from + before]);
        before.is_none_or(|it| !it.is_ascii_alphabetic() && !b"_.".contains(&it))
    };
    let mut places = memchr::memmem::find_iter(&text[from..], name);
    places.find(begins).map(|at| from + at)
}

/// Returns whether a text may call a file with `L`.
pub(crate) fn may_call_file(text: &[u8]) -> bool {
    call_place(text, 0).is_some()
}

/// Returns the next place where an `L` may begin a call of a file.
fn call_place(text: &[u8], from: usize) -> Option<usize> {
    let begins = |at: &usize| {
        let before = at.checked_sub(1).map(|before| text[from + before]);
        let next = text.get(from + at + 1);
        let is_local = next.is_some_and(|it| it.eq_ignore_ascii_case(&b'L'))
            && text.get(from + at + 2).is_none_or(u8::is_ascii_whitespace);
        before.is_none_or(|it| !it.is_ascii_alphabetic() && !b"%._#$".contains(&it))
            && next.is_some()
            && !is_local
    };
    let mut places = memchr::memchr2_iter(b'L', b'l', &text[from..]);
    places.find(begins).map(|at| from + at)
}

fn calls_file(item: &Item) -> bool {
    match item {
        Item::Call(call) => call.scope == CallScope::Global,
        Item::Sequence(part) => part.name.is_some(),
        _ => false,
    }
}

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

    /// Returns whether the whole text is needed.
    pub fn needs_whole_text(&self) -> bool {
        self.found
    }

    /// Returns whether the text has `L` alone with a separator after it, outside a comment; a piece that ends before
    /// that is taken as one.
    fn calls_program(before: &[u8], after: &[u8]) -> bool {
        let is_alone = before.last().is_none_or(|byte| !byte.is_ascii_alphabetic());
        let is_followed = after
            .first()
            .is_none_or(|byte| matches!(byte, b' ' | b'\t'));
        is_alone && is_followed && !Self::ends_in_comment(before)
    }

    /// Returns whether the last line is in a comment so far. A line that is longer than a block may be is not.
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

    /// Returns whether the text is `#IF`; a piece that ends before that is taken as one.
    fn opens_branch(after: &[u8]) -> bool {
        let letters = after.iter().zip(b"IF");
        letters
            .into_iter()
            .all(|(found, letter)| found.eq_ignore_ascii_case(letter))
    }

    /// Returns whether the text is `%L` with a separator after it; a piece that ends before that is taken as one.
    fn opens_subprogram(after: &[u8]) -> bool {
        let mut rest = after.iter().skip_while(|byte| matches!(byte, b' ' | b'\t'));
        match (rest.next(), rest.next()) {
            (None, _) | (Some(b'L' | b'l'), None) => true,
            (Some(b'L' | b'l'), Some(next)) => matches!(next, b' ' | b'\t'),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn switched(text: &str) -> Vec<String> {
        let mut scan = Scan::new(SwitchedAxes::default());
        scan.feed(text.as_bytes());
        scan.question.0.into_iter().collect()
    }

    fn named(pieces: &[&str]) -> (String, bool) {
        let mut scan = Scan::new(NamedAxes::new([
            "X", "Y", "Z", "A", "B", "U", "V", "W", "AX2",
        ]));
        for piece in pieces {
            scan.feed(piece.as_bytes());
        }
        let calls = scan.question.may_name_more();
        let names: Vec<String> = scan.question.into_names().into_iter().collect();
        (names.join(" "), calls)
    }

    #[test]
    fn axes_that_are_read_are_found() {
        // R9.74
        let mut scan = Scan::new(NamedAxes::new(["X"]));
        scan.feed(
            b"P1 = V.A.FRICT_COMP_ACTIVE.Y + V.A.LEAD_COMP_INIT.AX2\n(V.A.FRICT_COMP_ACTIVE.Z)\nX1 ;_COMP_ACTIVE.B\n",
        );
        let read: Vec<&String> = scan.question.read().iter().collect();
        assert_eq!(read, ["AX2", "Y"]);
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
            "N10L A.nc",
            "L CYCLE [NAME=a.cyc]",
            "L \\\nSUB.nc",
            "\"CALL\" = \"L A.nc\"",
        ] {
            assert!(named(&[text]).1, "{text}");
        }
        for text in [
            "LL SUB",
            "%L SUB",
            "V.L.A=1",
            "#LAH",
            "(L SUB)",
            "#MSG [\"L SUB\"]",
            "MULL X",
            "P1 = \"(\" ; L SUB",
            "#COMMENT BEGIN\nL SUB\n#COMMENT END",
            "L10=5",
        ] {
            assert!(!named(&[text]).1, "{text}");
        }
    }

    #[test]
    fn a_faulty_bracket_may_be_that_of_an_axis() {
        // R9.74
        assert!(named(&["N10 X[COMP OF FRICT]"]).1);
    }

    #[test]
    fn axes_that_are_named_are_found() {
        // R9.74
        let names = |text: &str| named(&[text]).0;
        assert_eq!(names("N10G1X1Y-2\nAX2=5"), "AX2 X Y");
        assert_eq!(names("#COMMENT BEGIN\nX1\n#COMMENT END\nY1"), "Y");
        assert_eq!(names("#MSG [\"(\"] \nY1 (X1 (Z1) A1) ; B1"), "Y");
        assert_eq!(names("P1='H(X1' Y1\nV.P.X=1 x1\nX_ACHSE=1"), "");
        assert_eq!(names("G1 \\ ; X1\n(Y1)\n N20 Z1\nU1"), "U Z");
        // A block that continues in the next piece.
        assert_eq!(named(&["G1 \\\n", "X1\nY1\n"]).0, "X Y");
    }

    #[test]
    fn axes_that_are_switched_are_found() {
        // R1.37
        assert_eq!(
            switched("N10 X[COMP OFF FRICT] Y [comp on LEAD FRICT]"),
            ["X", "Y"]
        );
        assert_eq!(
            switched("N10 (c) X1[COMP OFF_ALL] ; Z[COMP ON FRICT]"),
            ["X1"]
        );
        assert_eq!(
            switched("Z[COMP OFF \\ ; more\n\nN20 FRICT]\nX[COMP OFF LEAD]\n"),
            ["Z"]
        );
        assert_eq!(switched("X[ \\\r\nCOMP OFF FRICT]\r\n"), ["X"]);
        assert_eq!(switched("X1 ; end\rY[COMP ON FRICT]\rM30"), ["Y"]);
        assert_eq!(switched("S[COMP ON FRICT]\nG0 X[P1]\nFRICT COMP"), [""; 0]);
        assert_eq!(switched("#MSG [\"X[COMP OFF FRICT]\"]\n"), [""; 0]);
        assert_eq!(switched("V.P.A=\"(\" X[COMP ON FRICT]\n"), ["X"]);
        assert_eq!(
            switched("\"OFF\" = \"A[COMP OFF FRICT]\"\n\"OFF\"\n"),
            ["A"]
        );
        assert_eq!(
            switched("#COMMENT BEGIN\nX[COMP ON FRICT]\n#COMMENT END\nY[COMP ON FRICT]"),
            ["Y"]
        );
    }
}
