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

pub mod assumptions;
mod document;
pub mod html;
mod messages;
pub mod pictures;
pub mod results;
pub mod svg;
mod timeline;
mod wording;

pub use document::{Document, Headline, Length, ShownDocument, Standing, Table};
pub use messages::{Listing, ListingFormat, ProgramResult, Tally, concise_line};
pub use timeline::{
    Blocks, Csv, Json, MessageExtent, Ndjson, Positions, Report, Runs, Text, TextOptions,
    TimelineFormat, TimelineOptions, View, headline,
};
pub use wording::{
    Detail, FALLBACK_WIDTH, Look, Paint, TextChange, assumed_limits, command_line, counted,
    feed_moves_text, fitted, leading, render, render_unified, rounded, to_json, visible,
    visible_line, wrap,
};

#[cfg(test)]
mod tests;
