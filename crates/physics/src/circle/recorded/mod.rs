//! Circles that were recorded on a machine: actual positions of two axes (R5.20, R5.26).
//!
//! A recording holds more than the circle: the paths to it and from it, standstill, several turns,
//! both directions. [`search`] finds the circle that most of the path lies on, whatever else there
//! is; [`cut`] finds the turns on it, and [`ends`] where the machine is not at its feed; [`circle`]
//! evaluates one of the turns, [`turns`] compares it with the others, and [`glitches`] takes all of them.

mod circle;
mod cut;
mod drift;
mod ends;
mod error;
mod fit;
mod glitches;
mod limits;
mod recording;
mod search;
mod trace;
mod turns;

pub use circle::{LeftOut, RecordedCircle};
pub use error::RecordedError;
pub use glitches::{GlitchOrder, MeasuredGlitch};
pub use limits::MIN_POINTS;
pub use recording::{CommandedCircle, Recording};
pub use trace::RecordedTrace;
pub use turns::{WholeTurns, WorseTurn};
