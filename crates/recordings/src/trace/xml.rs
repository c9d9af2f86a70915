//! The XML that the trace of a SINUMERIK control writes.
//!
//! Signals are described by elements with a `key`, a `name` and a `description`; a `dataFrame` names
//! the signals of its records, and each `rec` has a `time` in s and the values `f1`, `f2` and so on: those
//! of the signals with these ids, or in their order. A value that a record leaves out is the last one
//! (R6.24). The bytes come piece by piece: an unfinished element waits for the next piece.

use std::collections::HashMap;

use quick_xml::Reader;
use quick_xml::escape::unescape;
use quick_xml::events::{BytesStart, Event};

use super::cell::{CellValue, of_old_systems, value};
use super::channel::Channel;
use super::choice::{Demand, TimeSource};
use super::error::TraceProblem;
use super::held::{Grid, HeldEntry, HeldSignal, StatedSamples, remarks};
use super::recording::{Layout, RowForm, TraceRecording};
use super::unit::Unit;

/// The XML of a SINUMERIK trace.
const LAYOUT: Layout = Layout::new("SINUMERIK trace XML", RowForm::Whole);

/// Maximum size of an element.
const MOST_ELEMENT: usize = 1 << 20;

/// Maximum number of signals of a trace.
const MOST_SIGNALS: usize = 4096;

/// Value that controls write in place of a missing number: the bits of such a number, as an
/// integer.
const NO_VALUE: f64 = 9.2e18;

/// A trace that is being read.
#[derive(Default)]
pub(super) struct Xml {
    waiting: Vec<u8>,
    lines: u64,
    /// Signals described anywhere in the file.
    described: Vec<Signal>,
    columns: Vec<RecordedSignal>,
    /// Index of the first column of the present frame.
    frame: usize,
    /// Column of each value of the records of the frame, where a signal has its number as id.
    places: HashMap<usize, usize>,
    grid: Grid,
    stated: StatedSamples,
    records: usize,
    records_of_frame: usize,
    remarks: Vec<String>,
    /// Whether the bytes are letters of an old code page.
    is_legacy: bool,
}

/// A signal by its attributes.
#[derive(Debug, Clone, Default)]
struct Signal {
    key: String,
    /// The number of its value in the records, from 0.
    place: Option<usize>,
    name: String,
    description: String,
    unit: String,
}

/// A recorded signal.
#[derive(Debug, Default)]
struct RecordedSignal {
    signal: Signal,
    held: HeldSignal,
}

/// Returns the number, from 0, of a value that is written as `f1`, `f2` and so on.
fn number_of_value(key: &str) -> Option<usize> {
    key.strip_prefix('f')?.parse::<usize>().ok()?.checked_sub(1)
}

impl Xml {
    /// Takes the next bytes.
    pub(super) fn feed(&mut self, piece: &[u8], demand: &Demand<'_>) -> Result<(), TraceProblem> {
        let mut bytes = std::mem::take(&mut self.waiting);
        self.append(&mut bytes, piece);
        let text = match std::str::from_utf8(&bytes) {
            Ok(text) => text,
            // A letter whose rest comes with the next piece.
            Err(error) => std::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default(),
        };
        let done = self.elements(text, demand)?;
        self.lines += memchr::memchr_iter(b'\n', &bytes[..done])
            .map(|_| 1)
            .sum::<u64>();
        bytes.drain(..done);
        if bytes.len() > MOST_ELEMENT + piece.len() {
            return Err(TraceProblem::Long {
                line: self.lines + 1,
                most: MOST_ELEMENT,
            });
        }
        self.waiting = bytes;
        Ok(())
    }

    /// Appends bytes as UTF-8. Once some are not UTF-8, each byte is a letter.
    fn append(&mut self, bytes: &mut Vec<u8>, piece: &[u8]) {
        let from = bytes.len();
        bytes.extend(piece);
        if !self.is_legacy {
            let cut = std::str::from_utf8(bytes).err();
            let Some(valid) = cut
                .filter(|it| it.error_len().is_some())
                .map(|it| it.valid_up_to())
            else {
                return;
            };
            self.is_legacy = true;
            let rest = of_old_systems(&bytes[valid..]);
            bytes.truncate(valid);
            bytes.extend(rest.as_bytes());
            return;
        }
        bytes.truncate(from);
        bytes.extend(of_old_systems(piece).as_bytes());
    }

    /// Takes every whole element; returns their length in bytes.
    fn elements(&mut self, text: &str, demand: &Demand<'_>) -> Result<usize, TraceProblem> {
        let mut reader = Reader::from_str(text);
        let config = reader.config_mut();
        config.check_end_names = false;
        config.allow_unmatched_ends = true;
        let mut done = 0;
        loop {
            let event = reader.read_event();
            let at = usize::try_from(reader.buffer_position()).unwrap_or(text.len());
            match event {
                // An element without its end is cut off by the end of a piece, which is not an error.
                Ok(Event::Eof) | Err(quick_xml::Error::Syntax(_)) => return Ok(done),
                Ok(Event::Start(element) | Event::Empty(element)) => {
                    self.element(&element, &text[..done], demand)?;
                }
                Ok(Event::DocType(_)) => {
                    let line = self.line(&text[..done]);
                    return Err(TraceProblem::Entities { line });
                }
                // Text may be cut; nothing is read from it.
                Ok(_) => {}
                Err(error) => return Err(self.damaged(&text[..done], error.to_string())),
            }
            done = at;
        }
    }

    fn line(&self, before: &str) -> u64 {
        let within: u64 = memchr::memchr_iter(b'\n', before.as_bytes())
            .map(|_| 1)
            .sum();
        self.lines + within + 1
    }

    fn damaged(&self, before: &str, reason: String) -> TraceProblem {
        TraceProblem::Xml {
            line: self.line(before),
            reason,
        }
    }

    fn element(
        &mut self,
        element: &BytesStart<'_>,
        before: &str,
        demand: &Demand<'_>,
    ) -> Result<(), TraceProblem> {
        let name = element.local_name();
        match name.as_ref() {
            "rec" => {
                if self.records == demand.most_rows {
                    return Err(TraceProblem::TooLong {
                        most: demand.most_rows,
                    });
                }
                self.records += 1;
                self.records_of_frame += 1;
                self.record(element, before, demand)
            }
            "dataFrame" => {
                self.end_frame(demand)?;
                self.frame = self.columns.len();
                self.places.clear();
                self.grid = Grid::default();
                self.records_of_frame = 0;
                self.head(element);
                Ok(())
            }
            "dataSignal" => {
                let signal = self.signal(element, before)?;
                self.recorded(signal, before)
            }
            name if name.to_ascii_lowercase().ends_with("signal") => {
                let signal = self.signal(element, before)?;
                if self.described.len() < MOST_SIGNALS {
                    self.described.push(signal);
                }
                Ok(())
            }
            _ => {
                self.head(element);
                Ok(())
            }
        }
    }

    /// Takes what an element of the head says about the samples.
    fn head(&mut self, element: &BytesStart<'_>) {
        for attribute in element.attributes().with_checks(false).flatten() {
            let number: Option<f64> = attribute.value.trim().parse().ok();
            let number = number.filter(|it| *it > 0.0 && it.is_finite());
            match (attribute.key.local_name().as_ref(), number) {
                ("interval", Some(seconds)) => self.stated.interval_s = Some(seconds),
                ("datapointCount", Some(count)) => {
                    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
                    let count = count as usize;
                    self.stated.count = Some(count);
                }
                _ => {}
            }
        }
    }

    /// Ends a frame: its signals keep their values up to the stated number of samples.
    fn end_frame(&mut self, demand: &Demand<'_>) -> Result<(), TraceProblem> {
        if self.records_of_frame == 0 {
            return Ok(());
        }
        let rest: Vec<f64> = {
            let left = demand.most_rows.saturating_sub(self.grid.count);
            self.grid.rest(self.stated).take(left + 1).collect()
        };
        for time in rest {
            self.grid.push(time, demand.most_rows)?;
            for column in &mut self.columns[self.frame..] {
                column.held.take(time, None);
            }
        }
        let named: Vec<Channel> = (self.frame..self.columns.len())
            .map(|at| self.channel(at, &self.columns[at].signal))
            .collect();
        let signals = named.iter().zip(&self.columns[self.frame..]);
        let signals = signals.map(|(channel, column)| (channel.name.as_str(), &column.held));
        let said = remarks(signals, (self.records_of_frame, &self.grid), self.stated);
        self.remarks.extend(said);
        Ok(())
    }

    fn recorded(&mut self, signal: Signal, before: &str) -> Result<(), TraceProblem> {
        if self.columns.len() == MOST_SIGNALS {
            let reason = format!("there are more than {MOST_SIGNALS} signals");
            return Err(self.damaged(before, reason));
        }
        let own = self.columns.len() - self.frame;
        let place = signal.place.unwrap_or(own);
        self.places.entry(place).or_insert(self.columns.len());
        self.columns.push(RecordedSignal {
            signal,
            ..RecordedSignal::default()
        });
        Ok(())
    }

    fn signal(&self, element: &BytesStart<'_>, before: &str) -> Result<Signal, TraceProblem> {
        let mut signal = Signal::default();
        for attribute in element.attributes() {
            let attribute = attribute.map_err(|error| self.damaged(before, error.to_string()))?;
            let value = match unescape(&attribute.value) {
                Ok(plain) => plain.trim().to_owned(),
                Err(error) => return Err(self.damaged(before, error.to_string())),
            };
            match attribute.key.local_name().as_ref() {
                "key" => signal.key = value,
                "id" => {
                    signal.place = number_of_value(&value);
                    if signal.key.is_empty() {
                        signal.key = value;
                    }
                }
                "name" => signal.name = value,
                "description" => signal.description = value,
                "unit" | "units" => signal.unit = value,
                // Either the name of a unit, or a number whose meaning is not public.
                "unitsType" if signal.unit.is_empty() && Unit::parse(&value).is_some() => {
                    signal.unit = value;
                }
                _ => {}
            }
        }
        Ok(signal)
    }

    fn record(
        &mut self,
        element: &BytesStart<'_>,
        before: &str,
        demand: &Demand<'_>,
    ) -> Result<(), TraceProblem> {
        let mut time = None;
        let mut found: Vec<(usize, HeldEntry)> = Vec::new();
        for attribute in element.attributes().with_checks(false) {
            let attribute = attribute.map_err(|error| self.damaged(before, error.to_string()))?;
            let key = attribute.key.local_name();
            let index = number_of_value(key.as_ref());
            let is_time = key.as_ref() == "time";
            if !is_time && index.is_none() {
                continue;
            }
            let number = match value(attribute.value.as_bytes()).0 {
                CellValue::Number(number) if number.abs() < NO_VALUE => number,
                CellValue::Number(_) | CellValue::Missing => f64::NAN,
                CellValue::Other => {
                    return Err(TraceProblem::Number {
                        line: self.line(before),
                        column: key.as_ref().to_owned(),
                        text: attribute.value.chars().take(60).collect(),
                    });
                }
            };
            match index {
                Some(index) if number.is_nan() => found.push((index, HeldEntry::Missing)),
                Some(index) => found.push((index, HeldEntry::Value(number))),
                None => time = Some(number),
            }
        }
        let Some(time) = time.filter(|time| time.is_finite()) else {
            return Err(self.damaged(before, "a record has no time".to_owned()));
        };
        let mut written: HashMap<usize, HeldEntry> = HashMap::new();
        for (index, value) in found {
            while !self.places.contains_key(&index) {
                self.recorded(Signal::default(), before)?;
            }
            written.insert(self.places[&index], value);
        }
        let without: Vec<f64> = {
            let left = demand.most_rows.saturating_sub(self.grid.count);
            self.grid.until(time, self.stated).take(left + 1).collect()
        };
        for time in without {
            self.grid.push(time, demand.most_rows)?;
            for column in &mut self.columns[self.frame..] {
                column.held.take(time, None);
            }
        }
        self.grid.push(time, demand.most_rows)?;
        for (at, column) in self.columns.iter_mut().enumerate().skip(self.frame) {
            column.held.take(time, written.get(&at).copied());
        }
        Ok(())
    }

    /// Returns the requested signals.
    pub(super) fn finish(
        mut self,
        demand: &mut Demand<'_>,
    ) -> Result<TraceRecording, TraceProblem> {
        if !self.waiting.trim_ascii().is_empty() {
            let reason = "the file ends within an element".to_owned();
            return Err(self.damaged("", reason));
        }
        if self.records == 0 {
            return Err(TraceProblem::NoRows);
        }
        self.end_frame(demand)?;
        let channels: Vec<Channel> = self
            .columns
            .iter()
            .enumerate()
            .map(|(at, column)| self.channel(at, &column.signal))
            .collect();
        let choice = (demand.choose)(&channels)?;
        let is_wanted = |at: usize| {
            choice
                .values
                .iter()
                .chain(&choice.switches)
                .any(|it| it.0 == at)
        };
        let mut samples = Vec::new();
        let mut clocks: Vec<Vec<f64>> = Vec::new();
        for (at, column) in self.columns.into_iter().enumerate() {
            if !is_wanted(at) {
                samples.push(None);
                continue;
            }
            let HeldSignal {
                times,
                samples: mut found,
                ..
            } = column.held;
            let known = clocks.iter().position(|clock| *clock == times);
            found.clock = Some(known.unwrap_or(clocks.len()));
            if known.is_none() {
                clocks.push(times);
            }
            samples.push(Some(found));
        }
        let mut remarks = self.remarks;
        if choice.time != TimeSource::Layout {
            remarks.push("the times are those of the records".to_owned());
        }
        Ok(TraceRecording {
            layout: LAYOUT,
            channels,
            samples,
            clocks,
            remarks,
        })
    }

    /// Returns a channel by its description in its frame, and by the one of its key elsewhere.
    fn channel(&self, at: usize, signal: &Signal) -> Channel {
        let same = |it: &&Signal| !it.key.is_empty() && it.key == signal.key;
        let elsewhere = self.described.iter().find(same);
        let either = |field: fn(&Signal) -> &String| {
            let own = Some(field(signal)).filter(|text| !text.is_empty());
            own.or_else(|| elsewhere.map(field))
                .cloned()
                .unwrap_or_default()
        };
        let (name, description) = (either(|it| &it.name), either(|it| &it.description));
        let unit = either(|it| &it.unit);
        let shown = [&description, &name, &signal.key]
            .into_iter()
            .find(|it| !it.is_empty());
        Channel {
            name: shown.map_or_else(|| format!("column {}", at + 1), Clone::clone),
            comment: description,
            symbol: name,
            unit: Some(unit).filter(|unit| !unit.is_empty()),
            ..Channel::default()
        }
    }
}
