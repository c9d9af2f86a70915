//! `frictcomp show`: what is there.

mod calls;
mod files;
mod notes;

use clap::Subcommand;

use crate::output::{Console, Failure};
use frictcomp::interpreter::NoteKind;

/// Show what is there: files, calls, values, words passed over
#[derive(Debug, Subcommand)]
pub(crate) enum ShowCommand {
    Files(files::FilesArgs),
    Calls(calls::CallsArgs),
    /// List the values that programs need from the machine, and where
    Values(notes::NotesArgs),
    /// List what was accepted and passed over, and where
    PassedOver(notes::NotesArgs),
}

/// Runs the command.
pub(crate) fn run(command: &ShowCommand, console: Console) -> Result<u8, Failure> {
    match command {
        ShowCommand::Files(args) => files::run(args, console),
        ShowCommand::Calls(args) => calls::run(args, console),
        ShowCommand::Values(args) => notes::run(args, NoteKind::Unknown, console),
        ShowCommand::PassedOver(args) => notes::run(args, NoteKind::Opaque, console),
    }
}
