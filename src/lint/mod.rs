//! Lints on the use of COMP (chapter 1.4): the checks, a memory of the running program's effects, and a memory of the
//! states that programs left.
//!
//! FC404 and FC406 are statements about a block's text and come from `syntax`.

mod checks;
mod linter;
mod memory;

pub use linter::EndNote;
pub(crate) use linter::Linter;
pub use memory::Maker;
pub(crate) use memory::{LeftAwayNotice, SessionStates};
