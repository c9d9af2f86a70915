//! `frictcomp init`: a configuration to begin with (R9.73).

use std::path::PathBuf;

use clap::Args;

use crate::args::FolderArgs;
use crate::output::{Console, Failure, exit};
use frictcomp::machine::Outline;
use frictcomp::text::shown_path;
use frictcomp_host::{CONFIG_NAME, HostError, outline_of, write_new};
use frictcomp_report::results::configuration::render_configuration;

/// Write a commented `frictcomp.toml` to start from
///
/// Describes the machine from the control's start-up list or a TwinCAT project if one is given or found in the folder,
/// otherwise from the axes that the programs in the folder use: `enable = true` then assumes that each is compensated.
/// An existing file is not changed.
#[derive(Debug, Args)]
pub(crate) struct InitArgs {
    /// The folder with the programs
    #[arg(value_name = "FOLDER", default_value = ".")]
    folder: PathBuf,
    /// The start-up list of the machine, such as `hochlauf.lis`
    #[arg(long, value_name = "LIST")]
    startup: Option<PathBuf>,
    /// The TwinCAT project of the machine, such as `Machine.tsproj`
    #[arg(long, value_name = "FILE", conflicts_with = "startup")]
    project: Option<PathBuf>,
    #[command(flatten)]
    folders: FolderArgs,
}

/// Runs the command.
pub(crate) fn run(args: &InitArgs) -> Result<u8, Failure> {
    let target = args.folder.join(CONFIG_NAME);
    if target.symlink_metadata().is_ok() {
        return Err(HostError::AlreadyThere(target).into());
    }
    let outline = outline_of(
        &args.folder,
        args.startup.as_deref().or(args.project.as_deref()),
        &args.folders.options(),
    )?;
    write_new(&target, &render_configuration(&outline))?;
    Console::talk(&format!(
        "wrote `{}`: {}",
        shown_path(&target),
        told(&outline)
    ));
    let names = names(&outline).join(", ");
    if !names.is_empty() {
        Console::talk(&format!(
            "`enable = true` assumes that these axes are compensated, which nobody knows yet: {names}; write \
             `frict_comp = true` or `frict_comp = false` for each"
        ));
    }
    Console::talk("next: `frictcomp config show` shows the machine that it describes");
    Ok(exit::CLEAN)
}

/// Returns the names of the axes that programs use.
fn names(outline: &Outline) -> Vec<&str> {
    outline.axes().iter().map(|(name, _)| *name).collect()
}

/// Returns what was found out about a machine, in a few words.
fn told(outline: &Outline) -> String {
    if let Outline::Startup(path) | Outline::Project(path) = outline {
        return format!("the machine of `{path}`");
    }
    let names = names(outline);
    if names.is_empty() {
        return "there is no start-up list, no project and no program; fill in the axes".to_owned();
    }
    let names = names.join(", ");
    format!("no start-up list and no project was found; the programs use {names}")
}
