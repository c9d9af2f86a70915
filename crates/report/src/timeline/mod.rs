//! The records of a session, one file a format.

mod csv;
mod format;
pub(crate) mod json;
mod ndjson;
mod output;
mod records;
mod text;
mod view;

pub use csv::{Csv, Positions};
pub use format::{TimelineFormat, TimelineOptions};
pub use json::Json;
pub use ndjson::Ndjson;
pub(crate) use output::Output;
pub use output::Report;
pub use text::{MessageExtent, Runs, Text, TextOptions, headline};
pub use view::{Blocks, View};
