//! The limits of a dry run on the command line.

use std::num::NonZeroU64;

use clap::Args;

use frictcomp::interpreter::{Limits, Options, StopPolicy};
use frictcomp::session::SessionOptions;
use frictcomp::syntax::SkipLevels;
use frictcomp_host::LoadedMachine;
use frictcomp_report::command_line;

/// What a dry run skips and where it ends.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Execution")]
pub(crate) struct ExecutionArgs {
    /// The skip levels that are on: `none`, `all` or `1,3-5`, where `/` is level 1; all others are
    /// off. Without it and without `skip` in `[machine]` it is unknown whether the control executes
    /// a block that begins with `/`
    #[arg(long, value_name = "LEVELS")]
    skip: Option<SkipLevels>,
    /// The largest number of executed blocks; by default 100 million, and in `check` and `audit` as many
    /// as loops and calls repeat within about two seconds
    #[arg(long, value_name = "N")]
    #[arg(value_parser = clap::value_parser!(u64).range(1..))]
    max_blocks: Option<u64>,
    /// The largest amount of work beyond the text of the blocks, caused by macros, growing strings
    /// and paths under unknown conditions
    #[arg(long, value_name = "N", default_value_t = Limits::default().work)]
    max_work: u64,
    /// The largest number of values that a program may hold
    #[arg(long, value_name = "N", default_value_t = Limits::default().values)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..))]
    max_values: u32,
    /// The deepest nesting of subprogram calls
    #[arg(long, value_name = "N", default_value_t = Limits::default().calls)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..))]
    max_calls: u32,
    /// The deepest nesting of `$` control blocks
    #[arg(long, value_name = "N", default_value_t = Limits::default().nesting)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..))]
    max_nesting: u32,
    /// The deepest nesting of macros, at most 64
    #[arg(long, value_name = "N", default_value_t = Limits::default().macros)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=64))]
    max_macros: u32,
}

impl ExecutionArgs {
    /// Returns the options of programs.
    pub(crate) fn run(&self, stop: StopPolicy) -> Options {
        let limits = Limits::default();
        let limits = Limits {
            blocks: self.max_blocks.unwrap_or(limits.blocks),
            values: self.max_values,
            calls: self.max_calls,
            nesting: self.max_nesting,
            macros: self.max_macros,
            ..limits
        };
        let limits = limits.with_work(self.max_work);
        Options::default()
            .with_stop(stop)
            .with_skip(self.skip)
            .with_limits(limits)
    }

    /// Returns the options where a program runs this many times while a user waits: unless a number of blocks
    /// is given, loops and calls end soon (R9.91).
    pub(crate) fn brief(&self, stop: StopPolicy, times: NonZeroU64) -> Options {
        let mut run = self.run(stop);
        if self.max_blocks.is_none() {
            run.limits.repeats = Limits::brief().repeats / times;
            run.limits.ways /= times;
        }
        run
    }

    /// Returns the options of a session that runs on a machine.
    pub(crate) fn options(&self, loaded: &LoadedMachine, stop: StopPolicy) -> SessionOptions {
        loaded
            .session(self.run(stop))
            .with_wording(Some(command_line))
    }

    /// Returns the options of a program that is checked.
    pub(crate) fn check(&self) -> Options {
        self.brief(StopPolicy::CheckAll, NonZeroU64::MIN)
    }
}
