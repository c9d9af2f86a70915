//! The debug adapter: a program block by block, as the Debug Adapter Protocol wants it (R12.9).
//!
//! [`stepper`](self) holds the run: the interpreter stands before the block that is shown, and goes
//! back to it by a snapshot when a breakpoint was noticed behind it. The messages are written as JSON
//! values: of the crates that hold the types of the protocol none is kept up.

mod breakpoints;
mod paths;
mod server;
mod stepper;
mod transport;
mod variables;

pub use server::serve;
