//! From text to blocks.
//!
//! This is the only place that knows pest. Parsing never fails: a block comes back with what was
//! understood and with the faults of the rest. Nothing here knows a machine.

// Without the feature, what only tests see is as good as private.
#![cfg_attr(not(feature = "unstable"), allow(unreachable_pub, dead_code))]

pub(crate) mod allow;
#[cfg(feature = "unstable")]
pub mod ast;
#[cfg(not(feature = "unstable"))]
pub(crate) mod ast;
mod axes;
mod brackets;
mod comp;
mod control_block;
mod dialect;
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
#[cfg(feature = "lsp")]
mod names;
mod parse;
mod pieces;
mod raw;
#[cfg_attr(not(feature = "host"), allow(dead_code, reason = "a host looks ahead"))]
mod scan;
mod skip_levels;
mod texts;
mod unread;
mod upper_case;

pub(crate) use axes::is_axis_name;
pub use axes::{AxisUse, axis_uses};
pub use brackets::MAX_BRACKETS;
pub(crate) use control_block::{ControlBlock, Part, control_part};
pub(crate) use dialect::{Foreign, foreign};
pub use fault::Fault;
pub use flow_scan::FlowScan;
pub use grammar::bound_reading;
pub(crate) use hash_words::hash_name;
pub(crate) use known::{
    Touches, hash_command, is_command, is_letter, is_program_number, is_statement,
};
#[cfg(feature = "unstable")]
pub use lines::BlockReader;
#[cfg(not(feature = "unstable"))]
pub(crate) use lines::BlockReader;
pub use lines::FastPath;
#[cfg(not(feature = "unstable"))]
pub(crate) use parse::parse_block;
#[cfg(feature = "unstable")]
pub use parse::parse_block;
pub use parse::parse_comp;
pub(crate) use parse::{is_lone_m, parse_expression};
pub use raw::{Comments, MAX_LINE, Remark};
#[cfg(not(feature = "unstable"))]
pub(crate) use raw::{LostRemarks, RawBlock, Stretch};
#[cfg(feature = "unstable")]
pub use raw::{LostRemarks, RawBlock, Stretch};

#[cfg(feature = "lsp")]
pub(crate) use mask::code_of;
pub(crate) use mask::goes_on;
#[cfg(feature = "lsp")]
pub(crate) use names::{Named, Role, names_in};
#[cfg(feature = "host")]
pub(crate) use pieces::code_words;
#[cfg(feature = "lsp")]
pub(crate) use pieces::{PieceKind, kind_at};
#[cfg(feature = "host")]
pub(crate) use scan::{NamedAxes, Scan, SwitchedAxes};
pub use skip_levels::{NoSkipLevels, SkipLevels};
pub(crate) use unread::not_known;

#[cfg(test)]
mod reference;
mod remarks;
