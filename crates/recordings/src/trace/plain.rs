//! Tables with one row of names above the numbers, or with none.

use super::cell::{CellValue, Separator, text, value};
use super::channel::Channel;
use super::columns::{ChannelColumn, ColumnGroup, FileLine, TableColumns, TimeScale};
use super::error::TraceProblem;
use super::recording::{Layout, RowForm};
use super::unit::{Unit, split_unit};

/// A table with a header.
const WITH_NAMES: Layout = Layout::new("CSV with a header", RowForm::Whole);

/// Numbers without any header, taken as an export of TwinCAT Scope.
const WITHOUT_NAMES: Layout = Layout::new("CSV without a header", RowForm::Ragged);

/// The separators in the order in which they are tried.
const SEPARATORS: [Separator; 5] = [
    Separator::Byte(b'\t'),
    Separator::Byte(b';'),
    Separator::Byte(b'|'),
    Separator::Byte(b','),
    Separator::Blanks,
];

/// Returns the columns below a row of names.
pub(super) fn columns(above: &[FileLine], first: &FileLine) -> Result<TableColumns, TraceProblem> {
    let lines: Vec<&[u8]> = above
        .iter()
        .map(|line| line.bytes.trim_ascii().trim_start_matches_marks())
        .filter(|line| !line.is_empty())
        .collect();
    let Some(last) = lines.last() else {
        return Err(TraceProblem::NoRows);
    };
    for separator in SEPARATORS {
        let cells = cells_of(&first.bytes, separator);
        if cells.len() < 2 {
            continue;
        }
        let fits = |line: &&[u8]| cells_of(line, separator).len() == cells.len();
        if let Some(at) = lines.iter().rposition(fits) {
            return Ok(named(&lines[..=at], separator));
        }
    }
    // No row of names is as wide as the numbers.
    for separator in &SEPARATORS[..4] {
        let columns = cells_of(last, *separator).len();
        let cells = cells_of(&first.bytes, *separator).len();
        let line = first.number;
        if columns < 2 {
            continue;
        }
        return Err(if *separator == Separator::Byte(b',') && cells > columns {
            TraceProblem::DecimalComma {
                line,
                cells,
                columns,
            }
        } else {
            TraceProblem::Row {
                line,
                cells,
                columns,
            }
        });
    }
    Ok(named(&[last], Separator::Byte(b';')))
}

/// Returns the columns by the last of some rows, or by the one above it if the last holds units.
fn named(lines: &[&[u8]], separator: Separator) -> TableColumns {
    let mut rows = lines.iter().rev().map(|line| cells_of(line, separator));
    let mut names = rows.next().unwrap_or_default();
    let mut units = Vec::new();
    if let Some(above) = rows.next()
        && above.len() == names.len()
        && names.iter().all(|unit| is_unit(unit))
    {
        units = std::mem::replace(&mut names, above);
    }
    let count = names.len();
    let column = |(at, name): (usize, String)| {
        let name = if name.is_empty() {
            format!("column {}", at + 1)
        } else {
            name
        };
        let below = units
            .get(at)
            .map(|unit| unit.trim_matches(['[', ']', '(', ')']).to_owned());
        let within = || split_unit(&name).1.map(str::to_owned);
        ChannelColumn {
            channel: Channel {
                unit: below.filter(|unit| !unit.is_empty()).or_else(within),
                name,
                ..Channel::default()
            },
            at,
            group: 0,
        }
    };
    TableColumns {
        layout: WITH_NAMES,
        separator,
        count,
        described: names.into_iter().enumerate().map(column).collect(),
        groups: vec![ColumnGroup {
            time: None,
            scale: TimeScale::Seconds(1.0),
        }],
        remark: None,
    }
}

/// Returns whether a cell of a row below the names is a unit, in brackets or not, or a dash for none.
fn is_unit(cell: &str) -> bool {
    let bare = cell.trim_matches(['[', ']', '(', ')']);
    bare.is_empty() || bare == "-" || Unit::parse(bare).is_some()
}

/// Returns the columns of numbers without names: the first one is the time if it counts, and so is each that counts
/// like it.
pub(super) fn headless(rows: &[FileLine], separator: Option<Separator>) -> TableColumns {
    let separator = separator.unwrap_or_else(|| separator_of(&rows[0].bytes));
    let table: Vec<Vec<String>> = rows
        .iter()
        .map(|row| cells_of(&row.bytes, separator))
        .collect();
    let count = table.iter().map(Vec::len).max().unwrap_or_default();
    let numbers = |at: usize| -> Vec<f64> {
        let cells = table.iter().filter_map(|row| row.get(at));
        let numbers = cells.filter_map(|cell| match value(cell.as_bytes()).0 {
            CellValue::Number(number) => Some(number),
            _ => None,
        });
        numbers.collect()
    };
    let first = numbers(0);
    let has_times = count > 1 && counts(&first);
    let mut columns = TableColumns {
        layout: WITHOUT_NAMES,
        separator,
        count,
        described: Vec::new(),
        groups: Vec::new(),
        remark: Some(if has_times {
            "the file has no header: its first column is taken as the time in ms"
        } else {
            "the file has no header, and its first column does not count as times do"
        }),
    };
    for at in 0..count {
        let is_time = has_times && (at == 0 || counts_like(&numbers(at), &first));
        if is_time {
            columns.groups.push(ColumnGroup {
                time: Some(at),
                scale: TimeScale::Scope,
            });
            continue;
        }
        if columns.groups.is_empty() {
            columns.groups.push(ColumnGroup {
                time: None,
                scale: TimeScale::Scope,
            });
        }
        columns.described.push(ChannelColumn {
            channel: Channel {
                name: format!("column {}", at + 1),
                ..Channel::default()
            },
            at,
            group: columns.groups.len() - 1,
        });
    }
    columns
}

/// Returns whether numbers rise as times do: in steps that are alike.
fn counts(numbers: &[f64]) -> bool {
    /// The greatest step as a multiple of the least: a few samples may be missing.
    const ALIKE: f64 = 20.0;
    let steps = numbers.windows(2).map(|pair| pair[1] - pair[0]);
    let [least, most] = steps.fold([f64::INFINITY, 0.0_f64], |[least, most], step| {
        [least.min(step), most.max(step)]
    });
    // Times are repeated where channels of several tasks end.
    numbers.len() < 3 || least > 0.0 && most <= ALIKE * least
}

/// Returns whether numbers rise in equal steps from the start of the times, as times do.
fn counts_like(numbers: &[f64], times: &[f64]) -> bool {
    const ENOUGH: usize = 8;
    /// Ten seconds in units of 100 ns: the greatest distance between the starts of the times of two tasks.
    const FILETIME_APART: f64 = 1e8;
    let (Some(&begin), Some(&time)) = (numbers.first(), times.first()) else {
        return false;
    };
    let apart = if time > 1e15 { FILETIME_APART } else { 1e-9 };
    let steps: Vec<f64> = numbers
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .filter(|step| step.abs() > 0.0)
        .collect();
    let Some(&step) = steps.first() else {
        return false;
    };
    let is_even = |other: &f64| (other - step).abs() <= step.abs() * 1e-3 + time.abs() * 1e-15;
    (begin - time).abs() <= apart
        && step > 0.0
        && steps.len() >= ENOUGH
        && steps.iter().all(is_even)
}

/// Returns the separator of a row of numbers.
fn separator_of(row: &[u8]) -> Separator {
    let fits = |separator: &&Separator| cells_of(row, **separator).len() > 1;
    let found = SEPARATORS.iter().find(fits);
    found.copied().unwrap_or(Separator::Byte(b';'))
}

/// Returns the texts of a row; an empty one at the end is not a column.
fn cells_of(row: &[u8], separator: Separator) -> Vec<String> {
    let cells = separator.quoted_cells(row);
    let mut texts: Vec<String> = cells.iter().map(|cell| text(cell)).collect();
    if texts.len() > 1 && texts.last().is_some_and(String::is_empty) {
        texts.pop();
    }
    texts
}

/// The marks of comments.
trait Marked {
    /// Trims `#` or `%` at the start, with which some programs mark the names.
    fn trim_start_matches_marks(&self) -> &[u8];
}

impl Marked for [u8] {
    fn trim_start_matches_marks(&self) -> &[u8] {
        let bare = self.strip_prefix(b"#").or_else(|| self.strip_prefix(b"%"));
        bare.unwrap_or(self).trim_ascii()
    }
}
