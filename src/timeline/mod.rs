//! Rows and records: what a dry run reports, in that order.
//!
//! The records of a session come in a fixed order (chapter 9.2 of the rules): the session, then for each program its
//! beginning, its blocks, its end, and finally the summary. A [`Sink`] takes them one after another; nothing is kept,
//! so a program of any length streams through.
//!
//! Records are [`Serialize`](serde::Serialize): the objects are the lines of the NDJSON timeline. There, a message
//! about a block or an end is a separate record, see [`Record::diagnostics`].

mod in_force;
mod record;
mod serial;

pub use crate::lint::EndNote;
pub use in_force::{ReadingInForce, ReadingsInForce};
pub use record::{
    AxisSummary, ChangedBy, DiagnosticRecord, End, FeedMoves, Join, Record, Repeat, Row, SCHEMA,
    SilencedMessage, Sink, StateView, Summary, TOOL,
};
pub use serial::{Possible, States};
