//! Rows of a recorded trace as CNC cycles: they are checked, or converted to cycles.

use thiserror::Error;

use super::additive::Switched;
use super::columns::TraceColumns;
use crate::motion::{CycleError, check_cycle};
use frictcomp::diagnostic::ReadableNumber;

/// The cycle of a trace without times.
const DEFAULT_CYCLE_S: f64 = 0.001;

/// The part of the cycle by which a step may differ from it.
const TOLERANCE: f64 = 0.01;

/// Number of cycles from which a step is a gap.
const GAP: f64 = 1.5;

/// Maximum number of cycles: eleven hours of 1 ms.
const MAX_CYCLES: f64 = 40_000_000.0;

/// Treatment of times that are not those of CNC cycles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Resampling {
    /// Such rows are refused.
    #[default]
    Refused,
    /// Cycles are made from the rows, with straight lines between them.
    Done,
}

/// Reason why the rows of a trace are not CNC cycles.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum CyclesError {
    /// A cycle that no control has.
    #[error(transparent)]
    Cycle(#[from] CycleError),
    /// A row before the one above it.
    #[error(
        "the time jumps back at row {row}, from {} to {} s",
        ReadableNumber(*.before_s),
        ReadableNumber(*.time_s)
    )]
    Backwards {
        /// The row, counted from 1 below the header.
        row: usize,
        /// The time of the row above.
        before_s: f64,
        /// Time.
        time_s: f64,
    },
    /// A row at the time of the one above it.
    #[error("row {row} has the time of the row above, {} s", ReadableNumber(*.time_s))]
    Repeated {
        /// The row, counted from 1 below the header.
        row: usize,
        /// Time.
        time_s: f64,
    },
    /// Cycles that were not recorded.
    #[error(
        "a gap of {} ms before row {row}, at {} s; a CNC cycle has {} ms",
        milliseconds(*.step_s),
        ReadableNumber(*.time_s),
        milliseconds(*.cycle_s)
    )]
    Gap {
        /// The row, counted from 1 below the header.
        row: usize,
        /// Time.
        time_s: f64,
        /// The time since the row above.
        step_s: f64,
        /// The cycle.
        cycle_s: f64,
    },
    /// A step that is not the cycle.
    #[error(
        "row {row}, at {} s, comes {} ms after the row above; a CNC cycle has {} ms",
        ReadableNumber(*.time_s),
        milliseconds(*.step_s),
        milliseconds(*.cycle_s)
    )]
    Step {
        /// The row, counted from 1 below the header.
        row: usize,
        /// Time.
        time_s: f64,
        /// The time since the row above.
        step_s: f64,
        /// The cycle.
        cycle_s: f64,
    },
    /// A time that is not a number.
    #[error("the time of row {row} is not a number")]
    NoTime {
        /// The row, counted from 1 below the header.
        row: usize,
    },
    /// Rows that are too far apart for the cycles between them.
    #[error("the times of the recording are {} s apart, too far for cycles of {} ms", ReadableNumber(*.length_s), milliseconds(*.cycle_s))]
    TooLong {
        /// Time from the first row to the last.
        length_s: f64,
        /// The cycle.
        cycle_s: f64,
    },
}

/// Returns a time in ms without the rounding error of its difference.
fn milliseconds(seconds: f64) -> ReadableNumber {
    ReadableNumber((seconds * 1e9).round() / 1e6)
}

/// Returns the cycle of a trace: the given one, otherwise the usual step of its times.
///
/// # Errors
/// A cycle that no control has.
pub(super) fn cycle_of(times_s: Option<&[f64]>, given: Option<f64>) -> Result<f64, CycleError> {
    let usual = || usual_step(times_s?);
    check_cycle(given.or_else(usual).unwrap_or(DEFAULT_CYCLE_S))
}

/// Returns the median of the steps forward.
fn usual_step(times_s: &[f64]) -> Option<f64> {
    let steps = times_s.windows(2).map(|pair| pair[1] - pair[0]);
    let mut steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() {
        return None;
    }
    let (_, median, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
    // Times are written in decimals, which steps are not.
    let nanoseconds = (*median * 1e9).round();
    Some(if nanoseconds > 0.0 {
        nanoseconds / 1e9
    } else {
        *median
    })
}

/// Checks that each row is a cycle after the one above it, within 1 %.
///
/// # Errors
/// The first row that is not.
pub(super) fn check(times_s: &[f64], cycle_s: f64) -> Result<(), CyclesError> {
    let no_time = times_s.iter().position(|time| !time.is_finite());
    if let Some(place) = no_time {
        return Err(CyclesError::NoTime { row: place + 1 });
    }
    for (place, pair) in times_s.windows(2).enumerate() {
        let (above, time) = (pair[0], pair[1]);
        let (step_s, row) = (time - above, place + 2);
        if (step_s - cycle_s).abs() <= cycle_s * TOLERANCE + time.abs() * 1e-12 {
            continue;
        }
        return Err(if step_s < 0.0 {
            CyclesError::Backwards {
                row,
                before_s: above,
                time_s: time,
            }
        } else if step_s == 0.0 {
            CyclesError::Repeated { row, time_s: time }
        } else if step_s > cycle_s * GAP {
            CyclesError::Gap {
                row,
                time_s: time,
                step_s,
                cycle_s,
            }
        } else {
            CyclesError::Step {
                row,
                time_s: time,
                step_s,
                cycle_s,
            }
        });
    }
    Ok(())
}

/// Makes cycles from rows. Between rows positions and velocities change linearly, and compensation
/// switches with its row. Also returns the steps taken, in sentences.
///
/// # Errors
/// There would be too many cycles, or a time is not a number.
pub(super) fn resample(
    columns: TraceColumns,
    cycle_s: f64,
) -> Result<(TraceColumns, Vec<String>), CyclesError> {
    let Some(times_s) = columns.times_s.as_deref() else {
        return Ok((columns, Vec::new()));
    };
    let no_time = times_s.iter().position(|time| !time.is_finite());
    if let Some(place) = no_time {
        return Err(CyclesError::NoTime { row: place + 1 });
    }
    let kept = rising(times_s);
    let (Some(&first), Some(&last)) = (kept.first(), kept.last()) else {
        return Ok((columns, Vec::new()));
    };
    let (first_s, length_s) = (times_s[first], times_s[last] - times_s[first]);
    let last_count = (length_s / cycle_s + 1e-6).floor();
    if last_count >= MAX_CYCLES {
        return Err(CyclesError::TooLong { length_s, cycle_s });
    }
    let rate = (1.0 / cycle_s).round();
    let is_whole = (rate * cycle_s - 1.0).abs() < 1e-12;
    let mut resampled = Resampled::default();
    let mut after = 0;
    let mut count = 0.0;
    while count <= last_count {
        let offset = if is_whole {
            count / rate
        } else {
            count * cycle_s
        };
        let time = first_s + offset;
        // Within a thousandth of a cycle it is the row itself.
        while after + 1 < kept.len() && times_s[kept[after]] < time - cycle_s * 1e-3 {
            after += 1;
        }
        let around = [kept[after.saturating_sub(1)], kept[after]];
        resampled.take(&columns, around, time);
        count += 1.0;
    }
    let said = resampled.told(times_s, &kept, cycle_s);
    let columns = TraceColumns {
        times_s: Some(resampled.times_s),
        positions: columns.positions.map(|_| resampled.positions),
        velocities: columns.velocities.map(|_| resampled.velocities),
        switched: resampled.switched,
    };
    Ok((columns, said))
}

/// Returns the rows whose time is after that of every row above.
fn rising(times_s: &[f64]) -> Vec<usize> {
    let mut latest = f64::NEG_INFINITY;
    let rows = times_s.iter().enumerate();
    rows.filter(|(_, time)| {
        let rises = **time > latest;
        latest = latest.max(**time);
        rises
    })
    .map(|(row, _)| row)
    .collect()
}

/// Cycles made of rows.
#[derive(Default)]
struct Resampled {
    times_s: Vec<f64>,
    positions: Vec<f64>,
    velocities: Vec<f64>,
    switched: Vec<Switched>,
}

impl Resampled {
    /// Takes one more cycle, after the first of two rows and not after the second.
    fn take(&mut self, columns: &TraceColumns, [before, row]: [usize; 2], time: f64) {
        let times_s = columns.times_s.as_deref().unwrap_or_default();
        let span = times_s[row] - times_s[before];
        let share = if span > 0.0 {
            ((time - times_s[before]) / span).clamp(0.0, 1.0)
        } else {
            1.0
        };
        // A cycle that meets a row but for the rounding of its time is that row.
        let share = if share > 1.0 - 1e-6 { 1.0 } else { share };
        let between = |values: &[f64]| {
            if share >= 1.0 {
                values[row]
            } else {
                values[before] + share * (values[row] - values[before])
            }
        };
        self.times_s.push(time);
        if let Some(positions) = &columns.positions {
            self.positions.push(between(positions));
        }
        if let Some(velocities) = &columns.velocities {
            self.velocities.push(between(velocities));
        }
        let switched = if share >= 1.0 { row } else { before };
        self.switched.push(columns.switched[switched]);
    }

    /// Returns the treatment in words.
    fn told(&self, times_s: &[f64], kept: &[usize], cycle_s: f64) -> Vec<String> {
        let mut said = vec![format!(
            "{} rows are resampled to {} cycles of {} ms",
            times_s.len(),
            self.times_s.len(),
            milliseconds(cycle_s)
        )];
        let left_out = times_s.len() - kept.len();
        if left_out > 0 {
            said.push(format!(
                "{left_out} rows whose time is not after every time above are left out"
            ));
        }
        let steps = kept
            .windows(2)
            .map(|pair| (times_s[pair[1]] - times_s[pair[0]], pair[1] + 1));
        let usual = usual_step(times_s).unwrap_or(cycle_s).max(cycle_s);
        let gaps: Vec<(f64, usize)> = steps.filter(|(step, _)| *step > usual * GAP).collect();
        if let Some((longest, row)) = gaps.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0)) {
            let longest = milliseconds(longest);
            said.push(match gaps.len() {
                1 => format!("a gap of {longest} ms before row {row} is bridged by a straight line"),
                more => format!(
                    "{more} gaps are bridged by straight lines, the longest of {longest} ms before row {row}"
                ),
            });
        }
        said
    }
}
