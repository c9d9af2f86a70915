//! The command line of frictcomp.

use std::process::ExitCode;

fn main() -> ExitCode {
    frictcomp::cli::run(std::env::args_os())
}
