//! The language server: shows messages and states of programs, lists and configurations as the user
//! types (chapter 12).
//!
//! ```text
//! client ── transport ──► server ── checks ──► analysis, on a thread ──► messages ──► client
//!                           │
//!                           └── requests ──► answers, on another thread, from a view of all texts
//! ```

mod actions;
mod analysis;
mod asked;
mod calls;
mod capabilities;
mod checks;
mod client;
mod commands;
mod completion;
mod contour;
mod custom;
mod delivery;
mod documents;
mod encoding;
mod hints;
mod hover;
mod lanes;
mod lens;
mod log;
mod markdown;
mod messages;
mod moving;
mod navigation;
mod outline;
mod pages;
mod parameters;
mod project_calls;
mod refusal;
mod requests;
mod server;
mod settings;
mod states;
mod transport;
mod uri;
mod users;
mod view;
mod wording;
mod worker;

use std::io;

pub use server::Shutdown;
#[cfg(feature = "unstable")]
pub use server::serve;

/// Serves a client over standard input and output.
///
/// # Errors
/// The system cannot start a thread.
pub fn serve_stdio() -> io::Result<Shutdown> {
    let stdio = transport::Stdio::open()?;
    let shutdown = server::serve(&stdio.connection)?;
    stdio.close();
    Ok(shutdown)
}
