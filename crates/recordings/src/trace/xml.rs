//! The XML that the trace of a SINUMERIK control writes.
//!
//! Signals are described by elements with a `key`, a `name` and a `description`; a `dataFrame` names
//! the signals of its records in their order, and each `rec` has a `time` in s and the values `f1`,
//! `f2` and so on. The bytes come piece by piece: an unfinished element waits for the next piece.

use quick_xml::Reader;
use quick_xml::escape::unescape;
use quick_xml::events::{BytesStart, Event};

use super::cell::{CellValue, of_old_systems, value};
use super::channel::Channel;
use super::choice::{Demand, TimeSource};
use super::error::TraceProblem;
use super::recording::{ChannelSamples, Layout, RowForm, TraceRecording};

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
    records: usize,
    /// The bytes are letters of an old code page.
    is_legacy: bool,
}

/// A signal by its attributes.
#[derive(Debug, Clone, Default)]
struct Signal {
    key: String,
    name: String,
    description: String,
    unit: String,
}

/// A recorded signal.
#[derive(Debug, Default)]
struct RecordedSignal {
    signal: Signal,
    times: Vec<f64>,
    samples: ChannelSamples,
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
                self.record(element, before)
            }
            "dataFrame" => {
                self.frame = self.columns.len();
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
            _ => Ok(()),
        }
    }

    fn recorded(&mut self, signal: Signal, before: &str) -> Result<(), TraceProblem> {
        if self.columns.len() == MOST_SIGNALS {
            let reason = format!("there are more than {MOST_SIGNALS} signals");
            return Err(self.damaged(before, reason));
        }
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
            let field = match attribute.key.local_name().as_ref() {
                "key" | "id" => &mut signal.key,
                "name" => &mut signal.name,
                "description" => &mut signal.description,
                "unit" | "units" => &mut signal.unit,
                _ => continue,
            };
            *field = match unescape(&attribute.value) {
                Ok(plain) => plain.trim().to_owned(),
                Err(error) => return Err(self.damaged(before, error.to_string())),
            };
        }
        Ok(signal)
    }

    fn record(&mut self, element: &BytesStart<'_>, before: &str) -> Result<(), TraceProblem> {
        let mut time = None;
        let mut found: Vec<(usize, f64)> = Vec::new();
        for attribute in element.attributes().with_checks(false) {
            let attribute = attribute.map_err(|error| self.damaged(before, error.to_string()))?;
            let key = attribute.key.local_name();
            let index = key
                .as_ref()
                .strip_prefix("f")
                .and_then(|digits| digits.parse::<usize>().ok()?.checked_sub(1));
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
                Some(index) => found.push((index, number)),
                None => time = Some(number),
            }
        }
        let Some(time) = time.filter(|time| time.is_finite()) else {
            return Err(self.damaged(before, "a record has no time".to_owned()));
        };
        for (index, number) in found {
            while self.columns.len() <= self.frame + index.min(MOST_SIGNALS) {
                self.recorded(Signal::default(), before)?;
            }
            let column = &mut self.columns[self.frame + index];
            if number.is_nan() {
                column.samples.missing.count += 1;
                continue;
            }
            column.times.push(time);
            column.samples.values.push(number);
        }
        Ok(())
    }

    /// The requested signals.
    pub(super) fn finish(self, demand: &mut Demand<'_>) -> Result<TraceRecording, TraceProblem> {
        if !self.waiting.trim_ascii().is_empty() {
            let reason = "the file ends within an element".to_owned();
            return Err(self.damaged("", reason));
        }
        if self.records == 0 {
            return Err(TraceProblem::NoRows);
        }
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
            let mut found = column.samples;
            let known = clocks.iter().position(|clock| *clock == column.times);
            found.clock = Some(known.unwrap_or(clocks.len()));
            if known.is_none() {
                clocks.push(column.times);
            }
            samples.push(Some(found));
        }
        let mut remarks = Vec::new();
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

    /// A channel by its description in its frame, and by the one of its key elsewhere.
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
