//! `frictcomp dap`: the debug adapter.

use std::io::{self, BufReader};

use clap::Args;

use crate::output::{Failure, exit};
use frictcomp_editor::dap::serve;

/// Serve an editor over the Debug Adapter Protocol, on standard input and output
///
/// An editor starts it to step through a program block by block, with breakpoints on lines and on
/// changes of states; `docs/editors.md` has the settings of editors.
#[derive(Debug, Args)]
pub(crate) struct DapArgs {
    /// Accepted because some editors pass it; standard input and output are always used
    #[arg(long)]
    stdio: bool,
}

/// Runs the command.
pub(crate) fn run(_: &DapArgs) -> Result<u8, Failure> {
    serve(BufReader::new(io::stdin()), io::stdout())
        .map_err(|error| Failure::new(format!("the connection to the editor was lost: {error}")))?;
    Ok(exit::CLEAN)
}
