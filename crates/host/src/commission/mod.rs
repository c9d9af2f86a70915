//! The recordings of a commissioning: the program of each, and what it shows (R16.2).

mod channels;
mod closer;
mod friction;
mod reading;
mod recorded;
mod results;
mod unused;

pub use channels::CommissionChannels;
pub use reading::CommissionReader;
pub use unused::UnusedRecording;
