//! Translation of text into blocks.
//!
//! Only this module uses pest. Parsing never fails: a block comes back with what was understood and
//! with the faults of the rest. Nothing here depends on a machine.

// Without the feature, items that only other packages of the same version see are as good as private.
#![cfg_attr(not(feature = "unstable"), allow(unreachable_pub, dead_code))]

pub(crate) mod allow;
#[cfg(feature = "unstable")]
pub mod ast;
#[cfg(not(feature = "unstable"))]
pub(crate) mod ast;
mod comp;
mod content;
mod control_block;
mod expression;
mod fast;
mod grammar;
mod hidden_code;
mod keywords;
mod lines;
mod lower;
mod names;
mod parse;
mod pieces;
mod raw;
mod scan;
mod skip_levels;
mod variable_name;

pub(crate) use content::{Foreign, foreign};
#[cfg(not(feature = "unstable"))]
pub(crate) use control_block::{ControlBlock, Part, control_part};
#[cfg(feature = "unstable")]
pub use control_block::{ControlBlock, Part, control_part};
pub use grammar::bound_reading;
pub(crate) use keywords::hash_name;
pub(crate) use keywords::{is_letter, is_program_number, is_statement, not_known};
#[cfg(feature = "unstable")]
pub use lines::BlockReader;
#[cfg(not(feature = "unstable"))]
pub(crate) use lines::BlockReader;
pub use lines::FastPath;
pub use names::{AxisUse, axis_uses};
pub(crate) use names::{MAX_MACROS, is_axis_name, with_macros};
pub use parse::Fault;
pub use parse::parse_comp;
pub(crate) use parse::repeated_word;
#[cfg(not(feature = "unstable"))]
pub(crate) use parse::{is_lone_end, parse_block, parse_expression};
#[cfg(feature = "unstable")]
pub use parse::{is_lone_end, parse_block, parse_expression};
pub use pieces::MAX_BRACKETS;
pub use raw::{Comments, MAX_LINE, Remark};
#[cfg(not(feature = "unstable"))]
pub(crate) use raw::{LineFault, LostRemarks, RawBlock, Stretch};
#[cfg(feature = "unstable")]
pub use raw::{LineFault, LostRemarks, RawBlock, Stretch};
pub use scan::FlowScan;

#[cfg(not(feature = "unstable"))]
pub(crate) use content::no_program;
#[cfg(feature = "unstable")]
pub use content::reads_as_program;
#[cfg(feature = "unstable")]
pub use content::{HEAD, no_program};
#[cfg(feature = "unstable")]
pub use names::{NameInBlock, NameRole, Named, names_in};
#[cfg(not(feature = "unstable"))]
pub(crate) use pieces::code_of;
#[cfg(feature = "unstable")]
pub use pieces::code_of;
pub(crate) use pieces::goes_on;
#[cfg(feature = "unstable")]
pub use pieces::{PieceKind, code_words, kind_at};
pub(crate) use scan::may_call_file;
#[cfg(feature = "unstable")]
pub use scan::{NamedAxes, Scan, ScanQuestion, SwitchedAxes};
pub use skip_levels::{NoSkipLevels, SkipLevels};
pub(crate) use variable_name::{
    AxisOfVariable, Subscript, Subscripts, VariableFamily, VariableName, compact,
};

#[cfg(test)]
mod reference;
