//! What the targets share: an input as files, a session with small budgets, and what must hold of
//! every place.

mod bench;
mod files;

pub use bench::{Bench, POLICIES, machine};
pub use files::{Files, MAIN};
