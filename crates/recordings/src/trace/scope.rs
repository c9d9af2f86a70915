//! Exports of TwinCAT Scope: rows of attributes above the numbers (R6.2).
//!
//! The first cell of such a row is the name of an attribute. It is above a column of times, the cells
//! after it belong to channels that share these times, and where the name is repeated the next group
//! begins.

use super::cell::{Separator, is_data, text};
use super::channel::{Channel, CncObject, ScopeDrawing, parse_address};
use super::columns::{ChannelColumn, ColumnGroup, FileLine, TableColumns, TimeScale};
use super::error::TraceProblem;
use super::recording::{Layout, RowForm};

/// An export of TwinCAT Scope with rows of attributes.
const LAYOUT: Layout = Layout::new("TwinCAT Scope CSV", RowForm::Ragged);

/// The attributes of channels. A name that another one starts with comes after that one.
const ATTRIBUTES: [&str; 21] = [
    "Name",
    "SymbolComment",
    "SymbolName",
    "SymbolBased",
    "Data-Type",
    "SampleTime[ms]",
    "SampleTime",
    "VariableSize",
    "IndexGroup",
    "IndexOffset",
    "NetID",
    "NetId",
    "Port",
    "Offset",
    "ScaleFactor",
    "BitMask",
    "Unit ScaleFactor",
    "Unit Offset",
    "Unit",
    "Min",
    "Max",
];

/// Attributes that an export does not begin with: a table may have columns of these names.
const NEVER_FIRST: [&str; 2] = ["Min", "Max"];

/// The rows about the file, above those about channels.
const OF_FILE: [&str; 3] = ["File", "Starttime of export", "Endtime of export"];

/// Returns the name that a line begins with, and the separator after it.
fn key_of(line: &[u8]) -> Option<(&'static str, Option<u8>)> {
    let (bare, quote) = match line.strip_prefix(b"\"") {
        Some(bare) => (bare, &b"\""[..]),
        None => (line, &b""[..]),
    };
    let mut keys = OF_FILE.iter().chain(&ATTRIBUTES);
    keys.find_map(|key| {
        let after = bare.strip_prefix(key.as_bytes())?.strip_prefix(quote)?;
        match after.first() {
            None => Some((*key, None)),
            // `Unit Offset` begins like `Unit`, but is followed by a letter.
            Some(b' ')
                if after
                    .get(1)
                    .is_some_and(|it| key == &"Unit" && b"SO".contains(it)) =>
            {
                None
            }
            Some(&it @ (b'\t' | b';' | b',' | b'|' | b':' | b' ')) => Some((*key, Some(it))),
            Some(_) => None,
        }
    })
}

fn is_of_file(key: &str) -> bool {
    OF_FILE.contains(&key)
}

/// Returns the separator, if the lines are those of Scope.
pub(super) fn separator_of(above: &[FileLine]) -> Option<Separator> {
    let first = above
        .iter()
        .find(|line| !line.bytes.trim_ascii().is_empty())?;
    key_of(&first.bytes).filter(|(key, _)| !NEVER_FIRST.contains(key))?;
    above.iter().find_map(|line| {
        let (key, separator) = key_of(&line.bytes)?;
        let after = line.bytes.get(key.len()..).unwrap_or_default();
        match separator? {
            b' ' if after.starts_with(b"  ") => Some(Separator::Gaps),
            byte => Some(Separator::Byte(byte)),
        }
    })
}

/// Returns the rows of attributes, without those about the file.
fn attributes(above: &[FileLine]) -> impl Iterator<Item = (&'static str, &FileLine)> {
    let keyed = |line: &'_ FileLine| key_of(&line.bytes).map(|(key, _)| key);
    above.iter().enumerate().filter_map(move |(at, line)| {
        let key = keyed(line)?;
        let next = above.get(at + 1).and_then(keyed);
        // The name of the project is right above the name of the file.
        let is_project = key == "Name" && next.is_some_and(is_of_file);
        (!is_of_file(key) && !is_project).then_some((key, line))
    })
}

/// Returns whether channels are described.
pub(super) fn has_attributes(above: &[FileLine]) -> bool {
    separator_of(above).is_some() && attributes(above).next().is_some()
}

/// A row of attributes that may continue on the next line.
#[derive(Debug, Clone, Copy)]
pub(super) struct OpenRow {
    separator: u8,
    /// A cell began with a quote that is not closed.
    is_quoted: bool,
    cells: usize,
    /// Required number of cells: a comment without quotes continues until its row is as wide as the
    /// others.
    wanted: usize,
    /// Number of letters of the last cell, without the name of the attribute.
    letters: usize,
}

impl OpenRow {
    /// Returns the last of some lines, if it is a row of attributes.
    pub(super) fn last(above: &[FileLine]) -> Option<Self> {
        let Separator::Byte(separator) = separator_of(above)? else {
            return None;
        };
        let filled = above
            .iter()
            .rposition(|line| !line.bytes.trim_ascii().is_empty())?;
        let (last, before) = above[..=filled].split_last()?;
        let (key, _) = key_of(&last.bytes)?;
        if is_of_file(key) {
            return None;
        }
        let mut wanted = 0;
        if key == "SymbolComment" && separator != b' ' {
            let cells = attributes(before)
                .map(|(_, row)| Separator::Byte(separator).quoted_cells(&row.bytes).len());
            wanted = cells.max().unwrap_or(0);
        }
        let mut row = Self {
            separator,
            is_quoted: false,
            cells: 1,
            wanted,
            letters: 0,
        };
        row.take(&last.bytes);
        if last.bytes.trim_ascii_end().ends_with(key.as_bytes()) {
            row.letters = 0;
        }
        Some(row)
    }

    /// Returns whether a line belongs to the row.
    pub(super) fn continues(&self, line: &[u8]) -> bool {
        if self.is_quoted {
            return true;
        }
        if self.wanted == 0 || self.letters == 0 || key_of(line).is_some() {
            return false;
        }
        // The comment of the last channel ends where numbers begin.
        let is_more =
            !line.trim_ascii().is_empty() && !is_data(line, Some(Separator::Byte(self.separator)));
        self.cells < self.wanted || is_more
    }

    /// Counts the cells of a line, of which the first one continues the last one before.
    pub(super) fn take(&mut self, line: &[u8]) {
        let mut is_start = !self.is_quoted;
        let mut was_closed = false;
        for &byte in line {
            let mut closes = false;
            match byte {
                b'"' if self.is_quoted => {
                    self.is_quoted = false;
                    closes = true;
                }
                // Two quotes within quotes are one, and the quoted text continues.
                b'"' if is_start || was_closed => self.is_quoted = true,
                _ if byte == self.separator && !self.is_quoted => {
                    self.cells += 1;
                    self.letters = 0;
                }
                _ => self.letters += usize::from(!byte.is_ascii_whitespace()),
            }
            is_start = byte == self.separator && !self.is_quoted;
            was_closed = closes;
        }
    }
}

/// Returns the columns of an export with rows of attributes.
pub(super) fn columns(above: &[FileLine], first: &FileLine) -> Result<TableColumns, TraceProblem> {
    let separator = separator_of(above).unwrap_or(Separator::Byte(b'\t'));
    let of_numbers = separator.of_numbers();
    let in_row = width(&of_numbers.quoted_cells(&first.bytes));
    let rows: Vec<AttributeRow> = attributes(above)
        .map(|(key, line)| AttributeRow {
            key,
            cells: separator.quoted_cells(&line.bytes),
        })
        .collect();
    // Between blanks, rows that name channels may have too many cells, but symbols and types do not.
    let whole = rows.iter().filter(|row| width(&row.cells) == in_row);
    let lead = whole
        .filter(|_| separator == BLANK)
        .find(|row| row.key != "SymbolComment");
    let mut keys = ["Name", "SymbolName"].into_iter();
    let lead = lead.or_else(|| keys.find_map(|key| rows.iter().find(|row| row.key == key)));
    let lead = lead.or_else(|| rows.iter().find(|row| row.key != "SymbolComment"));
    let lead = lead.or(rows.first()).ok_or(TraceProblem::NoRows)?;
    let divided = Division::of(lead, &rows, separator, in_row)?;
    let count = divided.count.max(divided.starts.len());
    // Without time columns a row of numbers is shorter by the number of groups.
    let is_timed = in_row > count - divided.starts.len() || in_row == 0;
    let mut columns = TableColumns {
        layout: LAYOUT,
        separator: of_numbers,
        count: if is_timed {
            count
        } else {
            count - divided.starts.len()
        },
        described: Vec::new(),
        groups: Vec::new(),
        remark: None,
    };
    let rows: Vec<Vec<Vec<String>>> = rows.iter().map(|row| divided.segments(row)).collect();
    let keys: Vec<&str> = attributes(above).map(|(key, _)| key).collect();
    let mut at = 0;
    for (group, width) in divided.widths().into_iter().enumerate() {
        columns.groups.push(ColumnGroup {
            time: is_timed.then_some(at),
            scale: TimeScale::Scope,
        });
        at += usize::from(is_timed);
        for place in 0..width {
            let cell = |wanted: &str| {
                let row = keys.iter().position(|key| *key == wanted)?;
                let cell = rows[row].get(group)?.get(place)?.trim();
                (!cell.is_empty()).then(|| cell.to_owned())
            };
            columns.described.push(ChannelColumn {
                channel: channel(&cell, at),
                at,
                group,
            });
            at += 1;
        }
    }
    Ok(columns)
}

/// Returns the channel of a column by its attributes.
fn channel(cell: &dyn Fn(&str) -> Option<String>, at: usize) -> Channel {
    let symbol = cell("SymbolName").unwrap_or_default();
    let address = |key: &str| cell(key).as_deref().and_then(parse_address);
    let number = |key: &str| cell(key).and_then(|text| text.replace(',', ".").parse::<f64>().ok());
    let is_other = |key: &str, plain: f64| number(key).is_some_and(|it| (it - plain).abs() > 0.0);
    let or = |key: &str, plain: f64| number(key).unwrap_or(plain);
    let is_drawn_scaled = is_other("ScaleFactor", 1.0) || is_other("Offset", 0.0);
    let is_unit_scaled = is_other("Unit ScaleFactor", 1.0) || is_other("Unit Offset", 0.0);
    let name = cell("Name").or_else(|| (!symbol.is_empty()).then(|| symbol.clone()));
    Channel {
        name: name.unwrap_or_else(|| format!("column {}", at + 1)),
        comment: cell("SymbolComment").unwrap_or_default(),
        unit: cell("Unit").filter(|unit| !unit.starts_with('(')),
        object: address("IndexGroup")
            .zip(address("IndexOffset"))
            .map(|(group, offset)| CncObject { group, offset }),
        sample_time_s: number("SampleTime[ms]")
            .or_else(|| number("SampleTime"))
            .filter(|&ms| ms > 0.0 && ms.is_finite())
            .map(|ms| ms / 1000.0),
        is_drawn_scaled,
        drawn: is_drawn_scaled.then(|| ScopeDrawing {
            factor: or("ScaleFactor", 1.0),
            offset: or("Offset", 0.0),
            is_whole: cell("Data-Type").is_some_and(|it| is_whole(&it)),
            range: number("Min")
                .zip(number("Max"))
                .map(|(min, max)| [min, max]),
        }),
        unit_scale: is_unit_scaled.then(|| [or("Unit ScaleFactor", 1.0), or("Unit Offset", 0.0)]),
        symbol,
    }
}

/// Returns whether a type of a variable has no decimals.
fn is_whole(data_type: &str) -> bool {
    let name = data_type.trim().to_uppercase();
    let bare = name.trim_end_matches(|it: char| it.is_ascii_digit());
    [
        "INT", "SINT", "USINT", "UINT", "DINT", "UDINT", "LINT", "ULINT", "BYTE", "WORD", "DWORD",
    ]
    .contains(&bare)
}

/// A row of attributes.
struct AttributeRow {
    key: &'static str,
    cells: Vec<Vec<u8>>,
}

impl AttributeRow {
    fn is_key(&self, at: usize) -> bool {
        self.cells
            .get(at)
            .is_some_and(|cell| cell.trim_ascii() == self.key.as_bytes())
    }
}

/// Returns the number of cells of a row up to its last one that is not empty.
fn width(cells: &[Vec<u8>]) -> usize {
    let last = cells.iter().rposition(|cell| !cell.trim_ascii().is_empty());
    last.map_or(0, |last| last + 1)
}

/// Beginnings of the groups.
struct Division {
    /// The columns with the names of attributes.
    starts: Vec<usize>,
    count: usize,
    /// Whether names may contain the separator: each group is one channel, whatever its cells.
    is_joined: bool,
    /// Single blanks separate the cells.
    is_blank: bool,
}

/// A blank between two cells.
const BLANK: Separator = Separator::Byte(b' ');

impl Division {
    /// Divides by the leading row, and by the others if they are as wide: a channel may be called `Name`.
    fn of(
        lead: &AttributeRow,
        rows: &[AttributeRow],
        separator: Separator,
        in_row: usize,
    ) -> Result<Self, TraceProblem> {
        let own = width(&lead.cells);
        let mut starts = Vec::new();
        for at in 0..own {
            let follows_start = starts.last().is_some_and(|last| last + 1 == at);
            let others = rows
                .iter()
                .filter(|row| row.cells.len() == lead.cells.len());
            if lead.is_key(at) && !follows_start && others.clone().all(|row| row.is_key(at)) {
                starts.push(at);
            }
        }
        if starts.first() != Some(&0) {
            starts.insert(0, 0);
        }
        let fits = in_row <= own;
        if separator != BLANK || in_row == own {
            return Ok(Self {
                starts,
                // The last channel of a group may have no name.
                count: own.max(if fits { in_row } else { 0 }).max(2),
                is_joined: false,
                is_blank: separator == BLANK,
            });
        }
        let groups = starts.len();
        if in_row == 2 * groups {
            return Ok(Self {
                starts,
                count: in_row,
                is_joined: true,
                is_blank: true,
            });
        }
        Err(TraceProblem::Divided)
    }

    /// Returns the number of channels of each group.
    fn widths(&self) -> Vec<usize> {
        if self.is_joined {
            return vec![1; self.starts.len()];
        }
        let ends = self.starts.iter().skip(1).copied().chain([self.count]);
        let widths = self.starts.iter().zip(ends);
        widths.map(|(start, end)| end - start - 1).collect()
    }

    /// Returns the cells of a row, by group.
    fn segments(&self, row: &AttributeRow) -> Vec<Vec<String>> {
        let widths = self.widths();
        let filled = width(&row.cells);
        let is_aligned =
            !self.is_joined && filled <= self.count && self.starts.iter().all(|&at| row.is_key(at));
        if is_aligned {
            let groups = self.starts.iter().zip(&widths);
            return groups
                .map(|(&start, width)| {
                    let cells = (start + 1..=start + width).map(|at| row.cells.get(at));
                    cells
                        .map(|cell| text(cell.map_or(&[], Vec::as_slice)))
                        .collect()
                })
                .collect();
        }
        // A decimal comma between commas splits one cell in two: the cells are divided by the repeated name.
        let key_at: Vec<usize> = (0..filled).filter(|&at| row.is_key(at)).collect();
        if key_at.len() != widths.len() {
            return Vec::new();
        }
        let ends = key_at.iter().skip(1).copied().chain([filled]);
        let segments = key_at.iter().zip(ends).zip(&widths);
        segments
            .map(|((&start, end), &width)| {
                let cells: Vec<String> = row.cells[start + 1..end]
                    .iter()
                    .map(|it| text(it))
                    .collect();
                if width == 1 {
                    let between = if self.is_joined { " " } else { "," };
                    return vec![cells.join(between)];
                }
                if self.is_blank && cells.len() > width {
                    // The line does not show which words form a name.
                    return Vec::new();
                }
                if cells.len() == 2 * width {
                    return cells.chunks(2).map(|pair| pair.join(",")).collect();
                }
                cells
            })
            .collect()
    }
}
