//! `frictcomp current`: the additive current over the commanded trace of a program, or over a
//! recorded one.

mod args;
mod plot;
mod program;
mod recorded;
mod table;

pub(crate) use args::CurrentCall;

use crate::output::{Console, Failure};
use args::{CurrentFormat, CurrentSource};

/// Runs the command.
pub(crate) fn run(CurrentCall(args): &CurrentCall, console: Console) -> Result<u8, Failure> {
    let CurrentFormat::Csv = args.format;
    match args.source() {
        CurrentSource::Program(program) => program::run(program, args, console),
        CurrentSource::Recording(recording) => recorded::run(recording, args, console),
    }
}
