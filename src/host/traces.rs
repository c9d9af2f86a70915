//! Recorded traces: CSV files with a header, read row by row. What columns a trace has is decided
//! by who reads it; how a file, a header and a number look, only here.

use std::borrow::Cow;
use std::io::{self, Read, Seek};
use std::path::{Path, PathBuf};

use super::error::HostError;
use super::read::{open_regular, read_whole};
use super::trace_error::TraceError;
use crate::circle::{CommandedCircle, PathCentre, RecordedCircle, RecordedTrace, Recording};
use crate::current::{CommandedTrace, Switched, TraceColumns};
use crate::text::decode;

/// Rows of a recorded circle at most; they are kept in memory until the circle is evaluated.
const MAX_POINTS: usize = 4_000_000;

/// Rows of a commanded trace at most: eleven hours of cycles of 1 ms.
const MAX_CYCLES: usize = 40_000_000;

/// Reads a commanded trace: a column `x` of positions in 0.1 µm or 0.0001°, or `v` of velocities in
/// µm/s or 0.001°/s, or both; `t` in s and `comp` with `on` and `off` where they are there. Without
/// `t`, a row is a CNC cycle of so many seconds.
///
/// # Errors
/// The file cannot be read, or holds something else.
pub fn read_commanded(path: &Path, cycle_s: Option<f64>) -> Result<CommandedTrace, HostError> {
    let mut table = Table::open(path, MAX_CYCLES)?;
    let [times, positions, velocities, states] =
        ["t", "x", "v", "comp"].map(|name| table.column(|header| header == name));
    if positions.is_none() && velocities.is_none() {
        return Err(table
            .lacks(
                "neither a column `x` nor a column `v`",
                "name the columns `t` (s), `x` (0.1 µm or 0.0001°), `v` (µm/s or 0.001°/s), `comp`",
            )
            .into());
    }
    let mut columns = TraceColumns {
        times_s: times.map(|_| Vec::new()),
        positions: positions.map(|_| Vec::new()),
        velocities: velocities.map(|_| Vec::new()),
        switched: Vec::new(),
    };
    while table.next_row()? {
        let numbers = [
            (times, &mut columns.times_s),
            (positions, &mut columns.positions),
            (velocities, &mut columns.velocities),
        ];
        for (column, numbers) in numbers {
            if let (Some(column), Some(numbers)) = (column, numbers) {
                numbers.push(table.number(column)?);
            }
        }
        let switched = states.map(|column| table.switch(column)).transpose()?;
        columns.switched.push(switched.unwrap_or(Switched::On));
    }
    let trace = CommandedTrace::new(columns, cycle_s);
    trace.map_err(|error| TraceError::Cycle(error).into())
}

/// Reads one recorded circle, or one of each direction, in one file or two: columns `x` and `y` of
/// actual positions in mm, or with their unit, `x_um`, `X [mm]`; `t` in s where it is there. G(b)
/// and H are about `centre`.
///
/// # Errors
/// A file cannot be read, or holds no circle.
pub fn read_circles(
    paths: &[PathBuf],
    commanded: CommandedCircle,
    centre: PathCentre,
) -> Result<Recording, HostError> {
    Recording::check(paths.len(), commanded).map_err(TraceError::Circles)?;
    let mut circles = Vec::new();
    for path in paths {
        let trace = read_positions(path)?;
        let found = RecordedCircle::find(&trace, commanded.radius_mm).map_err(|reason| {
            let path = path.clone();
            HostError::from(TraceError::Circle { path, reason })
        })?;
        circles.extend(found);
    }
    Ok(Recording::new(circles, commanded, centre).map_err(TraceError::Circles)?)
}

/// The actual positions of two axes, in the order of the rows. Times that are no seconds are as
/// good as none.
fn read_positions(path: &Path) -> Result<RecordedTrace, HostError> {
    let mut table = Table::open(path, MAX_POINTS)?;
    let [x, y] = ["x", "y"].map(|axis| table.lengths(axis));
    let (Some(x), Some(y)) = (x, y) else {
        return Err(table
            .lacks(
                "no columns `x` and `y`",
                "name the columns `x` and `y` for mm, or `x_um` and `y_um` for µm",
            )
            .into());
    };
    let mut times = table.column(|header| ["t", "t [s]", "t_s"].contains(&header));
    let mut trace = RecordedTrace::default();
    while table.next_row()? {
        let mm = |(column, mm): (Column, f64)| table.number(column).map(|number| number * mm);
        trace.points_mm.push([mm(x)?, mm(y)?]);
        match times.map(|column| table.number(column)) {
            Some(Ok(time)) => trace.times_s.push(time),
            Some(Err(_)) => {
                times = None;
                trace.times_s.clear();
            }
            None => {}
        }
    }
    Ok(trace)
}

/// A column of a table.
#[derive(Debug, Clone, Copy)]
struct Column(usize);

/// A CSV file on its way in, one row at a time.
struct Table {
    path: PathBuf,
    reader: csv::Reader<Box<dyn Read>>,
    headers: Vec<String>,
    row: csv::ByteRecord,
    rows: usize,
    most: usize,
}

impl Table {
    fn open(path: &Path, most: usize) -> Result<Self, HostError> {
        let bytes = open_bytes(path).map_err(|error| HostError::read(path, error))?;
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .from_reader(bytes);
        let damaged = |reason| TraceError::Damaged {
            path: path.to_owned(),
            reason,
        };
        let headers = reader.byte_headers().map_err(damaged)?.iter();
        Ok(Self {
            headers: headers.map(|name| decode(name.to_vec())).collect(),
            path: path.to_owned(),
            reader,
            row: csv::ByteRecord::new(),
            rows: 0,
            most,
        })
    }

    /// The first column whose header fits.
    fn column(&self, fits: impl Fn(&str) -> bool) -> Option<Column> {
        self.headers.iter().position(|name| fits(name)).map(Column)
    }

    /// The column of an axis, and what makes millimetres of its numbers: its name alone for mm, or
    /// with a unit.
    fn lengths(&self, axis: &str) -> Option<(Column, f64)> {
        let column = self.column(|name| millimetres(name, axis).is_some())?;
        Some((column, millimetres(&self.headers[column.0], axis)?))
    }

    fn lacks(self, lacks: &'static str, help: &'static str) -> TraceError {
        TraceError::Columns {
            path: self.path,
            lacks,
            found: self.headers,
            help,
        }
    }

    /// Reads the next row. `false` at the end.
    fn next_row(&mut self) -> Result<bool, TraceError> {
        let read = self.reader.read_byte_record(&mut self.row);
        let is_row = read.map_err(|reason| TraceError::Damaged {
            path: self.path.clone(),
            reason,
        })?;
        if is_row && self.rows == self.most {
            return Err(TraceError::TooLong {
                path: self.path.clone(),
                most: self.most,
            });
        }
        self.rows += 1;
        Ok(is_row)
    }

    /// The number that stands in a column of this row.
    fn number(&self, column: Column) -> Result<f64, TraceError> {
        let number = std::str::from_utf8(self.bytes(column)).ok();
        let number = number.and_then(|text| text.parse::<f64>().ok());
        let number = number.filter(|number| number.is_finite());
        number.ok_or_else(|| TraceError::Number {
            path: self.path.clone(),
            line: self.line(),
            column: self.headers[column.0].clone(),
            text: self.text(column).into_owned(),
        })
    }

    /// The `on` or `off` that stands in a column of this row.
    fn switch(&self, column: Column) -> Result<Switched, TraceError> {
        let text = self.text(column);
        if text.eq_ignore_ascii_case("on") {
            return Ok(Switched::On);
        }
        if text.eq_ignore_ascii_case("off") {
            return Ok(Switched::Off);
        }
        Err(TraceError::Switch {
            path: self.path.clone(),
            line: self.line(),
            column: self.headers[column.0].clone(),
            text: text.into_owned(),
        })
    }

    fn bytes(&self, column: Column) -> &[u8] {
        self.row.get(column.0).unwrap_or_default()
    }

    fn text(&self, column: Column) -> Cow<'_, str> {
        let bytes = self.bytes(column);
        match std::str::from_utf8(bytes) {
            Ok(text) => Cow::Borrowed(text),
            Err(_) => Cow::Owned(decode(bytes.to_vec())),
        }
    }

    fn line(&self) -> u64 {
        self.row.position().map_or(0, csv::Position::line)
    }
}

/// The bytes of a trace: as they are, but UTF-16 as UTF-8.
fn open_bytes(path: &Path) -> io::Result<Box<dyn Read>> {
    let (mut file, metadata) = open_regular(path)?;
    let mut mark = Vec::new();
    (&mut file).take(2).read_to_end(&mut mark)?;
    file.rewind()?;
    if matches!(mark[..], [0xff, 0xfe] | [0xfe, 0xff]) {
        let text = decode(read_whole(file, metadata.len())?);
        return Ok(Box::new(io::Cursor::new(text)));
    }
    Ok(Box::new(file))
}

/// What makes millimetres of the numbers under a header, where it is that of an axis.
fn millimetres(header: &str, axis: &str) -> Option<f64> {
    let words: Vec<String> = header
        .split(|letter: char| !letter.is_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(str::to_lowercase)
        .collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let (first, unit) = words.split_first()?;
    if *first != axis {
        return None;
    }
    match unit {
        [] | ["mm"] => Some(1.0),
        // The Greek letter; the micro sign becomes it in lower case or stays.
        ["um" | "\u{b5}m" | "\u{3bc}m"] => Some(0.001),
        ["m"] => Some(1000.0),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(bytes: &[u8]) -> tempfile::NamedTempFile {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), bytes).unwrap();
        file
    }

    #[test]
    fn a_header_says_the_unit() {
        // R5.20
        for (header, factor) in [
            ("x", Some(1.0)),
            ("X [mm]", Some(1.0)),
            ("x_um", Some(0.001)),
            ("X (µm)", Some(0.001)),
            ("x m", Some(1000.0)),
            ("y", None),
            ("x inch", None),
            ("", None),
        ] {
            assert_eq!(millimetres(header, "x"), factor, "{header}");
        }
    }

    #[test]
    fn every_encoding_of_a_header_is_read() {
        // R2.2
        let wide: Vec<u8> = "\u{feff}x [µm],y [µm]\n1,2\n"
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect();
        let texts: [&[u8]; 3] = [
            "\u{feff}x [µm],y [µm]\n1,2\n".as_bytes(),
            b"x [\xb5m],y [\xb5m]\n1,2\n",
            &wide,
        ];
        for text in texts {
            let trace = read_positions(file(text).path()).unwrap();
            assert_eq!(trace.points_mm, [[0.001, 0.002]]);
        }
    }

    #[test]
    fn what_is_no_trace_is_said_with_its_line() {
        let said = |text: &str| {
            let error = read_commanded(file(text.as_bytes()).path(), None).unwrap_err();
            error.to_string()
        };
        assert!(said("x\n1\none\n").ends_with(":3: column `x` holds `one`, which is not a number"));
        assert!(said("v,comp\n1,ja\n").ends_with(":2: column `comp` holds `ja`"));
        assert!(said("a,b\n1,2\n").contains("neither a column `x` nor a column `v`, only a, b"));
        assert!(said("x,v\n1\n").contains("cannot be read"));
        assert!(said("t,x\n0,1\n5000,2\n").starts_with("a CNC cycle of 5000000 ms"));
    }

    #[test]
    fn missing_columns_are_computed() {
        let columns = |text: &str| {
            let trace = read_commanded(file(text.as_bytes()).path(), Some(0.002)).unwrap();
            let rows = trace.rows();
            rows.map(|row| [row.time_s, row.position, row.velocity])
                .collect::<Vec<_>>()
        };
        assert_eq!(
            columns("x\n0\n20\n"),
            [[0.0, 0.0, 0.0], [0.002, 20.0, 1000.0]]
        );
        assert_eq!(
            columns("v\n0\n1000\n"),
            [[0.0, 0.0, 0.0], [0.002, 20.0, 1000.0]]
        );
    }
}
