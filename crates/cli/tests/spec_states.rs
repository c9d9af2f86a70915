//! States across programs: the lints on use, the state file, the messages if no machine is
//! described.

mod folder;
mod states;
#[path = "../../../tests/support/mod.rs"]
mod support;
mod workspace;
