//! The CNC cycle.

use thiserror::Error;

use frictcomp::diagnostic::ReadableNumber;

/// The shortest and the longest CNC cycle in ms.
const SHORTEST_MS: f64 = 0.001;
const LONGEST_MS: f64 = 1000.0;

/// A CNC cycle that no control has.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "a CNC cycle of {} ms is not possible; it must be between {SHORTEST_MS} and {LONGEST_MS} ms",
    ReadableNumber(*.milliseconds)
)]
#[non_exhaustive]
pub struct CycleError {
    /// The cycle that was given.
    pub milliseconds: f64,
}

/// Checks a CNC cycle in seconds.
///
/// # Errors
/// It is too short or too long, or not a number.
pub fn check_cycle(seconds: f64) -> Result<f64, CycleError> {
    let milliseconds = seconds * 1000.0;
    if (SHORTEST_MS..=LONGEST_MS).contains(&milliseconds) {
        Ok(seconds)
    } else {
        Err(CycleError { milliseconds })
    }
}
