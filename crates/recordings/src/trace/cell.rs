//! Cells of a row and the numbers in them.

/// Separator of two cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Separator {
    /// The given byte.
    Byte(u8),
    /// Any number of blanks, as in tables that are aligned.
    Blanks,
    /// Two blanks or more, as in the header of such a table: a single one belongs to a name.
    Gaps,
}

impl Separator {
    /// Returns the separator of the numbers below a header with this separator: some aligned
    /// columns have only one blank between them.
    pub(super) fn of_numbers(self) -> Self {
        match self {
            Self::Gaps => Self::Blanks,
            other => other,
        }
    }

    /// Returns the cells of a row without quotes.
    pub(super) fn cells(self, row: &[u8]) -> Cells<'_> {
        Cells {
            rest: match self {
                Self::Byte(_) => Some(row),
                Self::Blanks | Self::Gaps => Some(row.trim_ascii()).filter(|row| !row.is_empty()),
            },
            separator: self,
        }
    }

    /// Returns the cells of a row in which some may be in quotes, without these.
    pub(super) fn quoted_cells(self, row: &[u8]) -> Vec<Vec<u8>> {
        let mut cells = Vec::new();
        let mut rest = Some(row);
        while let Some(row) = rest {
            let is_blank = |byte: &&u8| **byte == b' ' && self != Self::Byte(b' ');
            let start = row.iter().take_while(is_blank).count();
            if row.get(start) != Some(&b'"') {
                let mut plain = self.cells(row);
                match plain.next() {
                    Some(cell) => cells.push(cell.trim_ascii().to_vec()),
                    None => return cells,
                }
                rest = plain.rest;
                continue;
            }
            let (cell, after) = unquoted(&row[start + 1..]);
            cells.push(cell);
            let mut tail = self.cells(after);
            tail.next();
            rest = tail.rest;
        }
        cells
    }
}

/// Returns the text up to the closing quote, and what follows it. Two quotes are one.
fn unquoted(row: &[u8]) -> (Vec<u8>, &[u8]) {
    let mut cell = Vec::new();
    let mut at = 0;
    while let Some(length) = memchr::memchr(b'"', &row[at..]) {
        cell.extend(&row[at..at + length]);
        at += length + 1;
        if row.get(at) != Some(&b'"') {
            return (cell, &row[at..]);
        }
        cell.push(b'"');
        at += 1;
    }
    cell.extend(&row[at..]);
    (cell, &[])
}

/// The cells of a row one after the other.
pub(super) struct Cells<'a> {
    rest: Option<&'a [u8]>,
    separator: Separator,
}

impl<'a> Iterator for Cells<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let row = self.rest?;
        let end = match self.separator {
            Separator::Byte(byte) => memchr::memchr(byte, row),
            Separator::Blanks => row.iter().position(|byte| matches!(byte, b' ' | b'\t')),
            Separator::Gaps => row.windows(2).position(|pair| pair == b"  "),
        };
        let Some(end) = end else {
            self.rest = None;
            return Some(row);
        };
        let after = &row[end + 1..];
        self.rest = Some(match self.separator {
            Separator::Byte(_) => after,
            Separator::Blanks | Separator::Gaps => after.trim_ascii_start(),
        });
        Some(&row[..end])
    }
}

/// Value of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum CellValue {
    /// A number.
    Number(f64),
    /// No value, or a computer's word for a missing number.
    Missing,
    /// Any other text.
    Other,
}

/// Decimal marks found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Decimals {
    /// No decimal mark yet.
    #[default]
    Unseen,
    /// Points.
    Point,
    /// Commas.
    Comma,
}

/// Maximum length of a number that is read without further memory.
const MOST_DIGITS: usize = 64;

/// Returns the value of a cell, and the decimal mark in it.
pub(super) fn value(cell: &[u8]) -> (CellValue, Decimals) {
    let cell = cell.trim_ascii();
    if cell.is_empty() {
        return (CellValue::Missing, Decimals::Unseen);
    }
    if !starts_number(cell) {
        return (word(cell), Decimals::Unseen);
    }
    let mut seen = Decimals::Unseen;
    let mut digits = [0; MOST_DIGITS];
    let Some(number) = digits.get_mut(..cell.len()) else {
        return (CellValue::Other, seen);
    };
    for (digit, &byte) in number.iter_mut().zip(cell) {
        let mark = match byte {
            b'.' => Decimals::Point,
            b',' => Decimals::Comma,
            _ => Decimals::Unseen,
        };
        if mark != Decimals::Unseen {
            if seen != Decimals::Unseen {
                return (CellValue::Other, Decimals::Unseen);
            }
            seen = mark;
        }
        *digit = if byte == b',' { b'.' } else { byte };
    }
    let number = std::str::from_utf8(number).ok();
    let number = number.and_then(|text| text.parse::<f64>().ok());
    match number {
        Some(number) if number.is_finite() => (CellValue::Number(number), seen),
        _ if is_no_number(cell) => (CellValue::Missing, Decimals::Unseen),
        _ => (CellValue::Other, Decimals::Unseen),
    }
}

/// Returns whether a cell begins as numbers do.
pub(super) fn starts_number(cell: &[u8]) -> bool {
    let digits = cell.strip_prefix(b"-").or_else(|| cell.strip_prefix(b"+"));
    match digits.unwrap_or(cell) {
        [b'0'..=b'9', ..] => true,
        [b'.' | b',', digit, ..] => digit.is_ascii_digit(),
        _ => false,
    }
}

/// Words for numbers, and for missing ones.
fn word(cell: &[u8]) -> CellValue {
    let is = |word: &str| cell.eq_ignore_ascii_case(word.as_bytes());
    if is("true") {
        CellValue::Number(1.0)
    } else if is("false") {
        CellValue::Number(0.0)
    } else if is_no_number(cell) {
        CellValue::Missing
    } else {
        CellValue::Other
    }
}

/// Returns whether a cell is a word for a missing number: `NaN`, `-inf`, `1.#QNAN`.
fn is_no_number(cell: &[u8]) -> bool {
    let cell = cell.trim_ascii();
    let cell = cell
        .strip_prefix(b"-")
        .or_else(|| cell.strip_prefix(b"+"))
        .unwrap_or(cell);
    let is = |word: &str| cell.eq_ignore_ascii_case(word.as_bytes());
    cell.starts_with(b"1.#")
        || is("nan")
        || is("inf")
        || is("infinity")
        || cell == "\u{221e}".as_bytes()
}

/// Returns the state of a switch as a number: 1 for `on`, `true` and `1`, 0 for `off`, `false` and `0`.
pub(super) fn switch(cell: &[u8]) -> Option<f64> {
    let cell = cell.trim_ascii();
    let is = |word: &str| cell.eq_ignore_ascii_case(word.as_bytes());
    if is("on") || is("true") || cell == b"1" {
        Some(1.0)
    } else if is("off") || is("false") || cell == b"0" {
        Some(0.0)
    } else {
        None
    }
}

/// Returns whether a line is a row of numbers: its first cell is one, and so are at least half of its cells.
pub(super) fn is_data(line: &[u8], separator: Option<Separator>) -> bool {
    let is_value = |cell: &[u8]| {
        let cell = cell.trim_ascii();
        let cell = cell.strip_prefix(b"\"").unwrap_or(cell);
        let cell = cell.strip_suffix(b"\"").unwrap_or(cell);
        // `12:30:05` is the time of a clock in a column that is not read.
        let is_clock = starts_number(cell) && cell.contains(&b':');
        value(cell).0 != CellValue::Other || switch(cell).is_some() || is_clock
    };
    let is_between: &dyn Fn(&u8) -> bool = match separator {
        Some(Separator::Byte(byte)) => &move |it| *it == byte,
        _ if line.iter().any(|it| b"\t;|".contains(it)) => &|it| b"\t;|".contains(it),
        _ => &|it| b", ".contains(it),
    };
    let cells = line.split(is_between).map(<[u8]>::trim_ascii);
    let mut filled = cells.filter(|cell| !cell.is_empty()).peekable();
    let begins = filled.peek().is_some_and(|first| is_value(first));
    let (values, others) = filled.fold((0, 0), |(values, others), cell| {
        if is_value(cell) {
            (values + 1, others)
        } else {
            (values, others + 1)
        }
    });
    begins && values >= others
}

/// Returns a text of a header.
pub(super) fn text(cell: &[u8]) -> String {
    let text = match std::str::from_utf8(cell) {
        Ok(text) => text.to_owned(),
        Err(_) => of_old_systems(cell),
    };
    text.trim().to_owned()
}

/// Decodes letters of one byte, as old systems write them: code page 1252.
pub(super) fn of_old_systems(bytes: &[u8]) -> String {
    let (text, _) = encoding_rs::WINDOWS_1252.decode_without_bom_handling(bytes);
    text.into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_with_either_mark() {
        // R6.1
        for (cell, number) in [
            ("0,2", 0.2),
            (" -1.5e3 ", -1500.0),
            ("+.5", 0.5),
            ("132959733843760000", 132_959_733_843_760_000.0),
            ("True", 1.0),
        ] {
            assert_eq!(
                value(cell.as_bytes()).0,
                CellValue::Number(number),
                "{cell}"
            );
        }
        for cell in ["", "  ", "NaN", "-inf", "1.#QNAN"] {
            assert_eq!(value(cell.as_bytes()).0, CellValue::Missing, "{cell}");
        }
        for cell in ["1.234,5", "one", "1e999", "0x1F", "1 2", "-", "\u{0}1"] {
            assert_eq!(value(cell.as_bytes()).0, CellValue::Other, "{cell}");
        }
        assert_eq!(value(&[b'1'; 500]).0, CellValue::Other);
    }

    #[test]
    fn headers_of_old_systems_are_in_their_code_page() {
        // R6.1: as in lists and programs.
        assert_eq!(
            text(b"Kraft \x80 \x96 \xb5m"),
            "Kraft \u{20ac} \u{2013} \u{b5}m"
        );
        assert_eq!(text("Kraft €".as_bytes()), "Kraft €");
    }

    #[test]
    fn cells_may_stand_in_quotes() {
        let cells = |row: &str, separator: Separator| -> Vec<String> {
            let cells = separator.quoted_cells(row.as_bytes());
            cells
                .into_iter()
                .map(|it| String::from_utf8(it).unwrap())
                .collect()
        };
        let semicolon = Separator::Byte(b';');
        assert_eq!(
            cells("a;\"b;\"\"c\"\"\";;d", semicolon),
            ["a", "b;\"c\"", "", "d"]
        );
        assert_eq!(cells("\"a\"", semicolon), ["a"]);
        assert_eq!(cells("15\" screw;x", semicolon), ["15\" screw", "x"]);
        assert_eq!(cells("", semicolon), [""]);
        assert_eq!(cells("  1   2 ", Separator::Blanks), ["1", "2"]);
        assert_eq!(cells("a;", semicolon), ["a", ""]);
        assert_eq!(
            cells("a\t\t\"b\nc\"", Separator::Byte(b'\t')),
            ["a", "", "b\nc"]
        );
    }
}
