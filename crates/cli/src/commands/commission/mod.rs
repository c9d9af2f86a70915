//! `frictcomp commission`: from measuring programs to a proven list.

mod channels;
mod learn;
mod plan;
mod run;
mod trend;

use clap::Subcommand;

use crate::output::{Console, Failure};

/// Commission the compensation of one or two axes, step by step in a folder
#[derive(Debug, Subcommand)]
pub(crate) enum CommissionCommand {
    Plan(plan::PlanArgs),
    Run(run::CommissionRunArgs),
    Learn(learn::LearnArgs),
    Trend(trend::TrendArgs),
}

/// Runs the command.
pub(crate) fn run(command: &CommissionCommand, console: Console) -> Result<u8, Failure> {
    match command {
        CommissionCommand::Plan(args) => plan::run(args, console),
        CommissionCommand::Run(args) => run::run(args, console),
        CommissionCommand::Learn(args) => learn::run(args, console),
        CommissionCommand::Trend(args) => trend::run(args, console),
    }
}
