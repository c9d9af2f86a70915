//! The debug adapter: runs a program block by block, by the Debug Adapter Protocol (R12.9).
//!
//! The interpreter of `stepper` has not yet executed the block that is shown. If executing the block shows
//! that the run should have stopped before it, the stepper goes back to a snapshot. What the adapter sends
//! is written as JSON values: no crate with the types of the protocol is maintained.

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
