//! Signals whose records leave out what did not change (R6.24): each keeps its last value on the grid of
//! the trace.

use super::error::TraceProblem;
use super::recording::ChannelSamples;

/// The part of an interval by which a record may lie off the grid.
const OFF_GRID: f64 = 0.01;

/// Factor for rounding times: decimals of a second with at most nine digits.
const DECIMALS: f64 = 1e9;

/// Statements in the head of a trace about its samples.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct StatedSamples {
    /// The time between two samples in s.
    pub(super) interval_s: Option<f64>,
    /// Number of the samples of a signal.
    pub(super) count: Option<usize>,
}

/// The samples of a signal.
#[derive(Debug, Default)]
pub(super) struct HeldSignal {
    pub(super) times: Vec<f64>,
    pub(super) samples: ChannelSamples,
    /// The last value; `None` before the first one, and where it is missing.
    last: Option<f64>,
    /// Number of the records that have a value.
    pub(super) written: usize,
}

/// The value of a signal in a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum HeldEntry {
    /// A number.
    Value(f64),
    /// The record has the attribute, but its text is not a number.
    Missing,
}

/// The grid of the samples of a frame.
#[derive(Debug, Default)]
pub(super) struct Grid {
    first: Option<f64>,
    last: Option<f64>,
    /// Number of samples so far.
    pub(super) count: usize,
}

impl HeldSignal {
    fn hold(&mut self, time: f64) {
        if let Some(value) = self.last {
            self.times.push(time);
            self.samples.values.push(value);
        }
    }

    /// Takes the value of the record at a time, or keeps the last one.
    pub(super) fn take(&mut self, time: f64, written: Option<HeldEntry>) {
        match written {
            Some(HeldEntry::Value(value)) => {
                self.written += 1;
                self.last = Some(value);
            }
            Some(HeldEntry::Missing) => {
                self.written += 1;
                self.samples.missing.count += 1;
                self.last = None;
            }
            None => {}
        }
        self.hold(time);
    }
}

impl Grid {
    /// Returns the times without a record before the one at `time`.
    pub(super) fn until(&self, time: f64, stated: StatedSamples) -> impl Iterator<Item = f64> {
        let steps = self.last.zip(stated.interval_s).map(|(last, interval)| {
            let steps = (time - last) / interval;
            let is_on_grid = (steps - steps.round()).abs() <= OFF_GRID;
            let whole = if is_on_grid { steps.round() } else { 0.0 };
            (last, interval, whole)
        });
        let (last, interval, whole) = steps.unwrap_or_default();
        std::iter::successors(Some(1.0), |step| Some(step + 1.0))
            .take_while(move |step| *step < whole)
            .map(move |step| decimal(last + step * interval))
    }

    /// Returns the times after the last record, up to the stated number of samples.
    pub(super) fn rest(&self, stated: StatedSamples) -> impl Iterator<Item = f64> {
        let left = stated.count.unwrap_or_default().saturating_sub(self.count);
        let from = self.last.zip(stated.interval_s);
        let left = if from.is_some() { left } else { 0 };
        let (last, interval) = from.unwrap_or_default();
        #[allow(clippy::cast_precision_loss)] // at most the rows of a trace
        (1..=left).map(move |step| decimal(last + step as f64 * interval))
    }

    /// Takes a sample.
    pub(super) fn push(&mut self, time: f64, most_rows: usize) -> Result<(), TraceProblem> {
        if self.count == most_rows {
            return Err(TraceProblem::TooLong { most: most_rows });
        }
        self.first.get_or_insert(time);
        self.last = Some(time);
        self.count += 1;
        Ok(())
    }
}

/// Returns a time as a file writes it.
fn decimal(time: f64) -> f64 {
    (time * DECIMALS).round() / DECIMALS
}

/// Returns the remarks on signals that do not stand in every record.
pub(super) fn remarks<'a>(
    signals: impl Iterator<Item = (&'a str, &'a HeldSignal)>,
    (records, grid): (usize, &Grid),
    stated: StatedSamples,
) -> Vec<String> {
    let sparse = signals.filter(|(_, signal)| signal.written < records.max(grid.count));
    let sparse: Vec<String> = sparse
        .map(|(name, signal)| format!("`{name}` {} times", signal.written))
        .collect();
    let mut said = Vec::new();
    if !sparse.is_empty() {
        said.push(format!(
            "records leave out what did not change: of {} samples, the file writes {}; the last value is kept",
            grid.count,
            sparse.join(", ")
        ));
    }
    if let Some(count) = stated.count.filter(|count| *count != grid.count) {
        let named = match sparse.len() {
            0 => String::new(),
            _ => format!("; {} may be sparse", sparse.join(", ")),
        };
        said.push(format!(
            "the head states {count} samples, but there are {}{named}",
            grid.count
        ));
    }
    said
}
