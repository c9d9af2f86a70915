//! The states of each axis over the executed blocks, as stretches of a bar.

use frictcomp::comp::State;

use crate::rows::ExecutedRows;

/// Stretches shorter than the bar divided by this are not distinguished.
const COLUMNS: usize = 512;

/// The state of a stretch in which several states are too close together.
const CHANGING: &str = "changing";

/// A stretch of blocks, from 1, both included, and its state.
pub(crate) type BarSpan = (usize, usize, &'static str);

/// Returns the bar of an axis.
pub(crate) fn bar(rows: &ExecutedRows, axis: usize) -> Vec<BarSpan> {
    let total = rows.kept.len();
    let columns = total.min(COLUMNS);
    let mut stretches: Vec<BarSpan> = Vec::new();
    for column in 0..columns {
        let (from, to) = (column * total / columns, (column + 1) * total / columns);
        let state = of_rows(rows, axis, from..to);
        match stretches.last_mut() {
            Some(last) if last.2 == state => last.1 = to,
            _ => stretches.push((from + 1, to, state)),
        }
    }
    stretches
}

fn of_rows(rows: &ExecutedRows, axis: usize, mut range: std::ops::Range<usize>) -> &'static str {
    let state = |row| rows.states(Some(row)).get(axis).copied();
    let first = range.next().and_then(state);
    let first = first.unwrap_or(State::Unconfigured);
    if range.all(|row| state(row) == Some(first)) {
        first.as_str()
    } else {
        CHANGING
    }
}
