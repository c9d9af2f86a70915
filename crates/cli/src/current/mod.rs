//! `frictcomp current`: the additive current over the commanded trace of a program, or over a
//! recorded one.

mod args;
mod plot;
mod program;
mod recorded;
mod table;

pub(super) use args::CurrentArgs;

use super::console::Console;
use super::failure::Failure;
use args::CurrentFormat;

/// Runs the command.
pub(super) fn run(args: &CurrentArgs, console: Console) -> Result<u8, Failure> {
    let CurrentFormat::Csv = args.format;
    match (&args.program, &args.recording) {
        (Some(program), _) => program::run(program, args, console),
        (None, Some(recording)) => recorded::run(recording, args, console),
        // The argument declaration ensures that one of them is given.
        (None, None) => Err(Failure::new("give a program or a recording")),
    }
}
