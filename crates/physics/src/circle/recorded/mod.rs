//! Circles that were recorded on a machine: actual positions of two axes (R5.20, R5.26).
//!
//! A recording holds more than the circle: the paths to it and from it, standstill, several turns,
//! both directions. [`search`] finds the circle that most of the path lies on, whatever else there
//! is; [`cut`] finds the turns on it, and [`circle`] evaluates one of them; [`turns`] compares it
//! with the others.

mod circle;
mod cut;
mod drift;
mod error;
mod fit;
mod limits;
mod recording;
mod search;
mod trace;
mod turns;

pub use circle::{LeftOut, RecordedCircle};
pub use error::RecordedError;
pub use limits::MIN_POINTS;
pub use recording::{CommandedCircle, Recording};
pub use trace::RecordedTrace;
pub use turns::{WholeTurns, WorseTurn};
