//! The debug adapter: a program block by block, by the Debug Adapter Protocol (R12.9).
//!
//! The interpreter of `stepper` stands before the block that is shown, and returns there by a snapshot
//! when the block itself shows that the run should have stopped before it. What the adapter sends is
//! written as JSON values: of the crates with the types of the protocol none is maintained.

mod arguments;
mod breakpoints;
mod conditions;
mod paths;
mod server;
mod stepper;
mod transport;
mod variables;
mod wording;

pub use server::serve;
