//! `frictcomp completions`: command line completion for a shell.

use clap::Args;
use clap_complete::Shell;

use crate::output::{Console, Failure, exit};

/// Print the completions for a shell
#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

/// Runs the command.
pub(crate) fn run(
    args: &CompletionsArgs,
    mut tool: clap::Command,
    console: Console,
) -> Result<u8, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut tool, "frictcomp", &mut script);
    console.print(&String::from_utf8_lossy(&script))?;
    Ok(exit::CLEAN)
}
