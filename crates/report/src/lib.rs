//! Records, messages and results as bytes: formats, pictures, HTML. Nothing here computes results.
//!
//! Every format of the timeline is a [`Sink`](frictcomp::timeline::Sink) over a generic writer. The first error of the
//! writer is kept and ends the dry run; a closed pipe is not an error for the caller.
//!
//! ```
//! use frictcomp::{machine::Machine, text::SourceFile};
//! use frictcomp_report::{Ndjson, View};
//!
//! let program = SourceFile::new("a.nc", "N10 X[COMP OFF FRICT]\nN20 M30\n");
//! let mut records = Vec::new();
//! let mut sink = Ndjson::new(&mut records, View::default());
//! let _ = frictcomp::run(program, Machine::enabled(["X"]), &mut sink);
//! drop(sink);
//! assert!(String::from_utf8(records)?.contains(r#""record":"block""#));
//! # Ok::<(), std::string::FromUtf8Error>(())
//! ```

mod advice;
pub mod assumptions;
pub mod audit;
pub mod circle;
pub mod commission;
pub mod compare;
pub mod configuration;
pub mod contour;
mod csv;
pub mod current;
mod diagnostics;
mod document;
pub mod drives;
mod escape;
mod feed_moves;
mod glitch;
pub mod html;
pub mod identify;
mod json;
pub mod learn;
mod limits;
pub mod lists;
mod messages;
mod ndjson;
mod of_axes;
pub mod on_circles;
mod output;
pub mod pictures;
mod records;
pub mod replay;
pub mod schema;
pub mod states;
pub mod stiction;
mod strings;
pub mod svg;
mod text;
mod timeline_format;
pub mod trace;
pub mod trend;
pub mod tune;
mod unified;
pub mod value_lists;
pub mod verify;
mod view;
mod visible;
mod wording;

pub use csv::{Csv, Positions};
pub use diagnostics::wrap;
pub use diagnostics::{Detail, FALLBACK_WIDTH, Look, Paint, fitted, render};
pub use document::{Document, Headline, ShownDocument, Standing, Table};
pub use feed_moves::feed_moves_text;
pub use json::Json;
pub use limits::assumed_limits;
pub use messages::concise_line;
pub use messages::{Listing, ListingFormat, ProgramResult, Tally};
pub use ndjson::Ndjson;
pub use of_axes::of_axes;
pub use output::Report;
pub use strings::counted;
pub use text::{MessageExtent, Runs, Text, TextOptions, headline};
pub use timeline_format::{TimelineFormat, TimelineOptions};
pub use unified::{TextChange, render_unified};
pub use view::{Blocks, View};
pub use visible::visible_line;
pub use visible::{leading, visible};
pub use wording::command_line;

#[cfg(test)]
mod tests;
