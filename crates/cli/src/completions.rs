//! `frictcomp completions`: command line completion for a shell.

use clap::Args;
use clap_complete::Shell;

use super::console::Console;
use super::exit;
use super::failure::Failure;

/// Print the completions for a shell
#[derive(Debug, Args)]
pub(super) struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

/// Runs the command.
pub(super) fn run(
    args: &CompletionsArgs,
    mut tool: clap::Command,
    console: Console,
) -> Result<u8, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut tool, "frictcomp", &mut script);
    console.print(&String::from_utf8_lossy(&script))?;
    Ok(exit::CLEAN)
}
