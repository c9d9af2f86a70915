//! Rows of numbers, of which only the requested columns are read.

use super::cell::{CellValue, Decimals, Separator, is_data, switch, text, value};
use super::channel::Channel;
use super::choice::{Demand, TimeSource};
use super::columns::{ColumnGroup, TableColumns, TimeScale};
use super::error::TraceProblem;
use super::recording::{ChannelSamples, Layout, RowForm, TraceRecording};

/// A table whose header is known.
pub(super) struct ChannelTable {
    layout: Layout,
    separator: Separator,
    count: usize,
    channels: Vec<Channel>,
    groups: Vec<Times>,
    wanted: Vec<WantedChannel>,
    /// Cell in the current row for each column that is read.
    read: Vec<usize>,
    rows: usize,
    most_rows: usize,
    decimals: Decimals,
    /// The first time in units of 100 ns.
    origin: Option<u64>,
    is_after_blank: bool,
    is_over: bool,
    /// Remark on the assumptions about the columns.
    remark: Option<&'static str>,
    remarks: Vec<String>,
}

/// The times of channels that were sampled together.
struct Times {
    column: Option<usize>,
    scale: TimeScale,
    values: Vec<f64>,
}

/// A requested channel.
struct WantedChannel {
    channel: usize,
    column: usize,
    group: usize,
    holds: Holds,
    samples: ChannelSamples,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Holds {
    Numbers,
    Switches,
}

impl ChannelTable {
    pub(super) fn new(
        columns: TableColumns,
        demand: &mut Demand<'_>,
    ) -> Result<Self, TraceProblem> {
        let channels: Vec<Channel> = columns
            .described
            .iter()
            .map(|it| it.channel.clone())
            .collect();
        let choice = (demand.choose)(&channels)?;
        let one_clock = match choice.time {
            TimeSource::Layout => None,
            TimeSource::Channel(pick) => Some(ColumnGroup {
                time: columns
                    .described
                    .get(pick.channel.0)
                    .map(|column| column.at),
                scale: match columns.layout.rows {
                    RowForm::Ragged if pick.is_unit_assumed => TimeScale::Scope,
                    _ => TimeScale::Seconds(pick.unit.factor),
                },
            }),
        };
        let groups = one_clock.map_or(columns.groups, |group| vec![group]);
        let switches = choice.switches.iter().map(|it| (it.0, Holds::Switches));
        let chosen = choice
            .values
            .iter()
            .map(|it| (it.0, Holds::Numbers))
            .chain(switches);
        let wanted: Vec<WantedChannel> = chosen
            .filter_map(|(channel, holds)| {
                let column = columns.described.get(channel)?;
                let group = if one_clock.is_some() { 0 } else { column.group };
                let clock = groups.get(group).filter(|it| it.time.is_some());
                Some(WantedChannel {
                    channel,
                    column: column.at,
                    group,
                    holds,
                    samples: ChannelSamples {
                        clock: clock.map(|_| group),
                        ..ChannelSamples::default()
                    },
                })
            })
            .collect();
        let is_used = |group: usize| wanted.iter().any(|it| it.group == group);
        let groups: Vec<Times> = groups
            .iter()
            .enumerate()
            .map(|(at, group)| Times {
                column: group.time.filter(|_| is_used(at)),
                scale: group.scale,
                values: Vec::new(),
            })
            .collect();
        let mut read: Vec<usize> = groups.iter().filter_map(|it| it.column).collect();
        read.extend(wanted.iter().map(|it| it.column));
        read.sort_unstable();
        read.dedup();
        Ok(Self {
            layout: columns.layout,
            separator: columns.separator,
            count: columns.count,
            channels,
            groups,
            wanted,
            read,
            rows: 0,
            most_rows: demand.most_rows,
            decimals: Decimals::Unseen,
            origin: None,
            is_after_blank: false,
            is_over: false,
            remark: columns.remark,
            remarks: Vec::new(),
        })
    }

    /// Takes a line below the header.
    pub(super) fn row(&mut self, line: u64, row: &[u8]) -> Result<(), TraceProblem> {
        if self.is_over {
            return Ok(());
        }
        if row.trim_ascii().is_empty() && !row.contains(&b'\t') {
            self.is_after_blank = true;
            return Ok(());
        }
        if row.trim_ascii() == b"EOF" {
            self.is_over = true;
            return Ok(());
        }
        let may_end = self.layout.rows == RowForm::Ragged && self.is_after_blank && self.rows > 0;
        if may_end && !is_data(row, Some(self.separator)) {
            self.is_over = true;
            self.remarks.push(format!(
                "line {line} and those after it are not read: they are not rows of numbers"
            ));
            return Ok(());
        }
        self.is_after_blank = false;
        if self.rows == self.most_rows {
            return Err(TraceProblem::TooLong {
                most: self.most_rows,
            });
        }
        self.rows += 1;
        if memchr::memchr(b'"', row).is_some() {
            let cells = self.separator.quoted_cells(row);
            return self.cells(line, cells.iter().map(Vec::as_slice));
        }
        self.cells(line, self.separator.cells(row))
    }

    fn cells<'a>(
        &mut self,
        line: u64,
        cells: impl Iterator<Item = &'a [u8]>,
    ) -> Result<(), TraceProblem> {
        // Most tables have few columns that are read; their cells need no separate memory.
        let mut small: [&[u8]; 16] = [&[]; 16];
        let mut large = Vec::new();
        let found: &mut [&[u8]] = if self.read.len() <= small.len() {
            &mut small
        } else {
            large.resize(self.read.len(), &[][..]);
            &mut large
        };
        let mut next = 0;
        let mut count = 0;
        let mut filled = 0;
        for cell in cells {
            if self.read.get(next) == Some(&count) {
                found[next] = cell;
                next += 1;
            }
            count += 1;
            if count <= self.count || !cell.trim_ascii().is_empty() {
                filled = count;
            }
        }
        self.check_width(line, filled)?;
        let place = |column: usize| self.read.binary_search(&column).unwrap_or_default();
        let mut is_sampled = [true; 16];
        let mut more_sampled = Vec::new();
        let sampled: &mut [bool] = if self.groups.len() <= is_sampled.len() {
            &mut is_sampled
        } else {
            more_sampled.resize(self.groups.len(), true);
            &mut more_sampled
        };
        for (at, times) in self.groups.iter_mut().enumerate() {
            let Some(column) = times.column else {
                continue;
            };
            let cell = found[place(column)];
            let time = match times.scale {
                TimeScale::Scope => scope_time(cell, &mut self.origin),
                TimeScale::Seconds(factor) => scaled(cell, factor),
            };
            let (time, mark) = time;
            match time {
                CellValue::Number(time) => {
                    note(&mut self.decimals, mark, line)?;
                    // Scope repeats the row of a slow channel until its next sample.
                    let is_repeated =
                        self.layout.rows == RowForm::Ragged && times.values.last() == Some(&time);
                    sampled[at] = !is_repeated;
                    if !is_repeated {
                        times.values.push(time);
                    }
                }
                CellValue::Missing if self.layout.rows == RowForm::Ragged => sampled[at] = false,
                _ => return Err(not_a_number(line, "time", cell)),
            }
        }
        for wanted in &mut self.wanted {
            if !sampled[wanted.group] {
                continue;
            }
            let cell = found[place(wanted.column)];
            let (found, mark) = match wanted.holds {
                Holds::Numbers => value(cell),
                Holds::Switches => (
                    switch(cell).map_or(CellValue::Other, CellValue::Number),
                    Decimals::Unseen,
                ),
            };
            match found {
                CellValue::Number(number) => {
                    note(&mut self.decimals, mark, line)?;
                    wanted.samples.values.push(number);
                }
                CellValue::Missing => {
                    let missing = &mut wanted.samples.missing;
                    if missing.count == 0 {
                        missing.line = line;
                        missing.text = text(cell);
                    }
                    missing.count += 1;
                    wanted.samples.values.push(f64::NAN);
                }
                CellValue::Other => {
                    let column = &self.channels[wanted.channel].name;
                    return Err(match (wanted.holds, not_a_number(line, column, cell)) {
                        (Holds::Switches, TraceProblem::Number { line, column, text }) => {
                            TraceProblem::Switch { line, column, text }
                        }
                        (_, problem) => problem,
                    });
                }
            }
        }
        Ok(())
    }

    /// Checks that a row is as wide as the header. Rows of Scope may be short.
    fn check_width(&self, line: u64, cells: usize) -> Result<(), TraceProblem> {
        let columns = self.count;
        let may_be_short = self.layout.rows == RowForm::Ragged;
        if cells == columns || cells < columns && may_be_short {
            return Ok(());
        }
        if cells > columns && self.separator == Separator::Byte(b',') {
            return Err(TraceProblem::DecimalComma {
                line,
                cells,
                columns,
            });
        }
        Err(TraceProblem::Row {
            line,
            cells,
            columns,
        })
    }

    /// Returns the channels with their samples.
    pub(super) fn finish(mut self) -> TraceRecording {
        let mut samples: Vec<Option<ChannelSamples>> = vec![None; self.channels.len()];
        let mut clocks: Vec<Vec<f64>> = self.groups.into_iter().map(|it| it.values).collect();
        for mut wanted in self.wanted {
            let found = &mut wanted.samples;
            // A channel that is shorter than others ends; its samples are not missing.
            while found.values.last().is_some_and(|value| value.is_nan())
                && self.layout.rows == RowForm::Ragged
            {
                found.values.pop();
                found.missing.count -= 1;
            }
            if found.clock.is_none()
                && let Some(step) = self.channels[wanted.channel].sample_time_s
            {
                #[allow(clippy::cast_precision_loss)] // rows of a file
                let times = (0..found.values.len()).map(|row| row as f64 * step);
                found.clock = Some(clocks.len());
                clocks.push(times.collect());
            }
            samples[wanted.channel] = Some(wanted.samples);
        }
        for clock in &mut clocks {
            clock.shrink_to_fit();
        }
        self.remarks.extend(self.remark.map(str::to_owned));
        TraceRecording {
            layout: self.layout,
            channels: self.channels,
            samples,
            clocks,
            remarks: self.remarks,
        }
    }
}

/// Returns a time as Scope writes it, in seconds.
fn scope_time(cell: &[u8], origin: &mut Option<u64>) -> (CellValue, Decimals) {
    /// Fewer digits count milliseconds: a hundred thousand years of them.
    const FILETIME_DIGITS: usize = 15;
    /// Units of 100 ns in a second.
    const TICKS_PER_S: f64 = 1e7;
    let bare = cell.trim_ascii();
    if bare.len() >= FILETIME_DIGITS && bare.iter().all(u8::is_ascii_digit) {
        let ticks = std::str::from_utf8(bare)
            .ok()
            .and_then(|text| text.parse::<u64>().ok());
        let Some(ticks) = ticks else {
            return (CellValue::Other, Decimals::Unseen);
        };
        let origin = *origin.get_or_insert(ticks);
        let forward = ticks >= origin;
        #[allow(clippy::cast_precision_loss)] // recordings of some hours
        let apart = ticks.abs_diff(origin) as f64 / TICKS_PER_S;
        return (
            CellValue::Number(if forward { apart } else { -apart }),
            Decimals::Unseen,
        );
    }
    scaled(cell, 1e-3)
}

fn scaled(cell: &[u8], factor: f64) -> (CellValue, Decimals) {
    let (found, mark) = value(cell);
    match found {
        CellValue::Number(number) => (CellValue::Number(number * factor), mark),
        other => (other, mark),
    }
}

/// Notes a decimal mark: a file has one.
fn note(seen: &mut Decimals, mark: Decimals, line: u64) -> Result<(), TraceProblem> {
    if mark == Decimals::Unseen || mark == *seen {
        return Ok(());
    }
    if *seen == Decimals::Unseen {
        *seen = mark;
        return Ok(());
    }
    let found = if mark == Decimals::Comma {
        "comma"
    } else {
        "point"
    };
    Err(TraceProblem::MixedDecimals { line, found })
}

fn not_a_number(line: u64, column: &str, cell: &[u8]) -> TraceProblem {
    const SHOWN: usize = 60;
    TraceProblem::Number {
        line,
        column: column.to_owned(),
        text: text(cell).chars().take(SHOWN).collect(),
    }
}
