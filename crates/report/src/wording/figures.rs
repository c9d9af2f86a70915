//! Results as data: JSON and rows of CSV, their figures rounded in one place.

use std::io::{self, Write};

use frictcomp::text::shown_json;
use serde::Serialize;
use serde_json::Value;
use serde_json::ser::{CompactFormatter, Formatter, PrettyFormatter, Serializer};

use super::visible::{any_byte, is_command, visible, visible_line};

/// Bound below which a figure is the noise of its computation.
const LEAST: f64 = 1e-6;

/// Rounds a figure for reports: to six decimals, below 1 to six significant digits, and to 0 below 1e-6.
pub fn rounded(value: f64) -> f64 {
    let size = value.abs();
    if size < LEAST {
        return 0.0;
    }
    #[allow(clippy::cast_possible_truncation)] // at most 6
    let zeros = (-size.log10()).ceil().max(1.0) as i32;
    let scale = 10_f64.powi(5 + zeros);
    let rounded = (value * scale).round() / scale;
    if rounded.is_finite() { rounded } else { value }
}

/// Writes figures rounded, and everything else as another formatter does.
struct Rounding<F>(F);

impl<F: Formatter> Formatter for Rounding<F> {
    fn write_f64<W: Write + ?Sized>(&mut self, writer: &mut W, value: f64) -> io::Result<()> {
        self.0.write_f64(writer, rounded(value))
    }

    fn begin_array<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.begin_array(writer)
    }

    fn end_array<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_array(writer)
    }

    fn begin_array_value<W: Write + ?Sized>(
        &mut self,
        writer: &mut W,
        first: bool,
    ) -> io::Result<()> {
        self.0.begin_array_value(writer, first)
    }

    fn end_array_value<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_array_value(writer)
    }

    fn begin_object<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.begin_object(writer)
    }

    fn end_object<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_object(writer)
    }

    fn begin_object_key<W: Write + ?Sized>(
        &mut self,
        writer: &mut W,
        first: bool,
    ) -> io::Result<()> {
        self.0.begin_object_key(writer, first)
    }

    fn begin_object_value<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.begin_object_value(writer)
    }

    fn end_object_value<W: Write + ?Sized>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_object_value(writer)
    }
}

fn written(value: &impl Serialize, formatter: impl Formatter) -> String {
    let mut out = Vec::new();
    let serialized = value.serialize(&mut Serializer::with_formatter(
        &mut out,
        Rounding(formatter),
    ));
    serialized.expect("memory takes every byte, and numbers and texts are always JSON");
    out.push(b'\n');
    shown_json(&String::from_utf8_lossy(&out)).into_owned()
}

/// Returns a result as a JSON document without hidden characters.
pub fn to_json(value: &impl Serialize) -> String {
    written(value, PrettyFormatter::new())
}

/// Returns a result as one line of JSON without hidden characters.
pub(crate) fn to_json_line(value: &impl Serialize) -> String {
    written(value, CompactFormatter)
}

/// Appends a row of CSV; the cell of `null` is empty.
pub(crate) fn push_row(out: &mut Vec<u8>, cells: &[Value]) {
    for (at, cell) in cells.iter().enumerate() {
        if at > 0 {
            out.push(b',');
        }
        match cell {
            Value::Null => {}
            Value::String(text) => push_field(out, text),
            // A negative number is no text that a spreadsheet would compute (R9.76).
            Value::Number(number) if number.is_f64() => {
                let number = rounded(number.as_f64().unwrap_or_default());
                out.extend_from_slice(number.to_string().as_bytes());
            }
            other => out.extend_from_slice(other.to_string().as_bytes()),
        }
    }
    out.push(b'\n');
}

/// Appends a text as a field, quoted where it must be. Hidden characters have pictures; a text that
/// a spreadsheet would compute, once it has passed over what it takes for blanks, gets a `'` before it,
/// which makes it a text there (R9.76, R9.94).
pub(crate) fn push_field(out: &mut Vec<u8>, text: &str) {
    if text.is_empty() {
        return;
    }
    let is_special = |byte: u8| !(0x20..0x7f).contains(&byte) || matches!(byte, b',' | b'"');
    let computes = text.starts_with(['=', '+', '-', '@', '\t', '\r']);
    if !computes && !any_byte(text.as_bytes(), is_special) {
        out.extend_from_slice(text.as_bytes());
        return;
    }
    // A line of a cell is a line of the output, and none of those is a command of a runner.
    let text = if text.lines().skip(1).any(is_command) {
        visible_line(text)
    } else {
        visible(text)
    };
    let quoted = text.contains([',', '"', '\n']);
    if quoted {
        out.push(b'"');
    }
    if computes {
        out.push(b'\'');
    }
    for &byte in text.as_bytes() {
        if byte == b'"' {
            out.push(b'"');
        }
        out.push(byte);
    }
    if quoted {
        out.push(b'"');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_keep_six_digits() {
        // R18.26
        for (value, shown) in [
            (0.0, "0.0"),
            (-0.0, "0.0"),
            (-5.4e-7, "0.0"),
            (9.459_383_2e-6, "9.45938e-6"),
            (-0.097_222_222_2, "-0.0972222"),
            (0.1, "0.1"),
            (0.999_999_96, "1.0"),
            (122.548_678_908_539_9, "122.548679"),
            (-1e307, "-1e+307"),
            (f64::INFINITY, "null"),
        ] {
            assert_eq!(to_json_line(&value).trim_end(), shown);
        }
    }
}
