//! `frictcomp man`: the manual pages.

use std::collections::VecDeque;
use std::path::PathBuf;

use clap::Args;

use super::console::Console;
use super::exit;
use super::failure::Failure;
use super::outputs::{Outputs, write_text};
use frictcomp_host::FileRegistry;

/// Print the manual page, or write one for each command
#[derive(Debug, Args)]
pub(super) struct ManArgs {
    /// Write the pages of the tool and of each command to this folder
    #[arg(long, value_name = "FOLDER")]
    into: Option<PathBuf>,
}

/// Runs the command.
pub(super) fn run(args: &ManArgs, tool: clap::Command, console: Console) -> Result<u8, Failure> {
    let Some(folder) = &args.into else {
        let (_, page) = page(tool)?;
        console.print(&page)?;
        return Ok(exit::CLEAN);
    };
    std::fs::create_dir_all(folder).map_err(|error| Failure::writing(folder, error))?;
    let mut outputs = Outputs::new(&FileRegistry::default(), console);
    for command in commands(tool) {
        let (name, text) = page(command)?;
        let mut file = outputs.file("--into", &folder.join(name))?;
        write_text(&mut file, &text)?;
    }
    outputs.finish()?;
    Ok(exit::CLEAN)
}

/// Returns the tool and its commands, each by its full name, `frictcomp-config-show`.
fn commands(command: clap::Command) -> Vec<clap::Command> {
    let mut found = Vec::new();
    let mut open = VecDeque::from([command.disable_help_subcommand(true)]);
    while let Some(mut command) = open.pop_front() {
        // Propagates global options to the subcommands.
        command.build();
        let name = command.get_display_name().unwrap_or("frictcomp").to_owned();
        open.extend(command.get_subcommands().map(|it| {
            let whole = format!("{name}-{}", it.get_name());
            it.clone().display_name(whole)
        }));
        found.push(command);
    }
    found
}

/// Returns the name of a page and its text.
fn page(command: clap::Command) -> Result<(String, String), Failure> {
    let man = clap_mangen::Man::new(command);
    let name = man.get_filename();
    let mut page = Vec::new();
    man.render(&mut page).map_err(Failure::output)?;
    Ok((name, String::from_utf8_lossy(&page).into_owned()))
}
