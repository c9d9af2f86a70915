//! `frictcomp lsp`: the language server.

use clap::Args;

use crate::output::{Failure, exit};
use frictcomp_editor::lsp::{Shutdown, serve_stdio};

/// Serve an editor over the Language Server Protocol, on standard input and output
///
/// An editor starts it. It shows messages, states and fixes while one types; `docs/editors.md` has
/// the settings of editors.
#[derive(Debug, Args)]
pub(crate) struct LspArgs {
    /// Accepted because some editors pass it; standard input and output are always used
    #[arg(long)]
    stdio: bool,
}

/// Runs the command.
pub(crate) fn run(_: &LspArgs) -> Result<u8, Failure> {
    let shutdown =
        serve_stdio().map_err(|error| Failure::new(format!("the server cannot start: {error}")))?;
    Ok(match shutdown {
        Shutdown::Proper => exit::CLEAN,
        // The protocol wants 1 where a client ends the server without having asked for its end.
        Shutdown::Abrupt => exit::FOUND,
    })
}
