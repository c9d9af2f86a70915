//! Lints on the use of COMP (chapter 1.4): one file a lint, one memory of what the program did,
//! one of what programs left.
//!
//! FC404 and FC406 are statements about a block's text and come from `syntax`.

mod checks;
mod history;
mod jump;
mod left_away;
mod linter;
mod memory;
mod moved_before;
mod repeated;
mod shared_block;
mod undescribed;

pub use history::Maker;
pub(crate) use history::{History, Told};
pub use linter::EndNote;
pub(crate) use linter::Linter;
