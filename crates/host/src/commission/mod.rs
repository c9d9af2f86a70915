//! Commissioning in a folder: the program of each recording, what it shows, and what follows from all (R16.2).

mod closer;
mod error;
mod evaluated;
mod friction;
mod learn;
mod plan;
mod plants;
mod reading;
mod results;
mod trend;

pub use error::CommissionError;
pub use evaluated::{Commissioning, motors_of, read_plans};
pub use learn::{FirstLists, Learning};
pub use plan::{AxisToMeasure, Planning};
pub use reading::{CommissionChannels, CommissionReader, UnusedRecording};
pub use trend::DatedRecordings;
