//! The command line of frictcomp.

use std::process::ExitCode;

fn main() -> ExitCode {
    frictcomp_cli::run(std::env::args_os())
}
