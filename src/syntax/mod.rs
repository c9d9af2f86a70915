//! From text to blocks.
//!
//! This is the only place that knows pest. Parsing never fails: a block comes back with what was
//! understood and with the faults of the rest. Nothing here knows a machine.

pub(crate) mod allow;
pub mod ast;
mod axes;
mod brackets;
mod comp;
mod expression;
mod fast;
mod fault;
mod flow_scan;
mod grammar;
mod hash_words;
mod known;
mod lines;
mod lower;
mod mask;
mod parse;
mod raw;
mod unread;

pub use axes::{AxisUse, axis_uses};
pub use brackets::MAX_BRACKETS;
pub use fault::Fault;
pub use flow_scan::FlowScan;
pub(crate) use hash_words::hash_name;
pub(crate) use known::{is_command, is_letter, is_statement};
pub use lines::{BlockReader, FastPath};
pub(crate) use parse::parse_expression;
pub use parse::{parse_block, parse_comp};
pub use raw::{Comments, LostRemarks, MAX_LINE, RawBlock, Remark, Stretch};
pub(crate) use unread::not_known;

#[cfg(test)]
mod reference;
mod remarks;
