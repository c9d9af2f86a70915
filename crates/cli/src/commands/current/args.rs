//! The arguments of `frictcomp current`.

use std::path::{Path, PathBuf};

use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches, ValueEnum};

use crate::args::{
    CycleArgs, ExecutionArgs, MachineArgs, MotionChannels, PerAxis, StartArgs, ToolArgs, quantities,
};
use crate::output::{Failure, HtmlArgs};
use frictcomp::text::shown_path;
use frictcomp_host::{Disk, is_recording};
use frictcomp_physics::current::{ChosenOptions, DeadBand, Resampling, TraceOptions};
use frictcomp_physics::motion::PlannerOptions;

/// Compute the additive current of a program or a recording
///
/// A program runs as in `run`, and its path is followed in CNC cycles; the current of each axis
/// depends on its compensation state. A recording, told by its content, is an export of TwinCAT Scope, a
/// SINUMERIK trace or a CSV file with a header: `t` in s, `x` in 0.1 µm or 0.0001°, `v` in µm/s or 0.001°/s,
/// or other channels; one row per CNC cycle. Either `x` or `v` may be missing. A
/// column `comp` with `on` and `off` switches compensation as COMP would.
#[derive(Debug, Args)]
pub(crate) struct CurrentArgs {
    /// The program, `-` for standard input, or the recorded motion of axes
    #[arg(
        value_name = "PROGRAM|RECORDING",
        required_unless_present = "recording",
        conflicts_with = "recording"
    )]
    file: Option<PathBuf>,
    /// The axes to compute the current for; by default all of a recording, or those of a program that have a value list
    #[arg(long = "axis", value_name = "AXES", value_delimiter = ',')]
    pub(super) axes: Vec<String>,
    /// The recorded motion of axes, where its content does not tell it from a program
    #[arg(long, value_name = "RECORDING")]
    recording: Option<PathBuf>,
    /// The compensation value list of every axis, or `X=LIST`; for a program, replaces the one in the configuration
    #[arg(long, value_name = "LIST")]
    pub(super) value_list: Vec<PerAxis>,
    #[command(flatten)]
    pub(super) channels: MotionChannels,
    #[command(flatten)]
    pub(super) cycle: CycleArgs,
    /// Turn the rows of a recording into CNC cycles; without this option, times that do not increase by
    /// one cycle are refused
    #[arg(long)]
    pub(super) resample: bool,
    /// Treat velocities of a recording up to V, in µm/s or 0.001°/s, as standstill; by default only those
    /// that toggle around zero
    #[arg(long, value_name = "V", value_parser = parse_dead_band)]
    #[arg(allow_negative_numbers = true)]
    pub(super) dead_band: Option<DeadBand>,
    /// How to read what the documents leave open: `standstill=zero`, `below=origin`,
    /// `delay=reversal`, `start=every`, with commas between them
    #[arg(
        long,
        value_name = "READING",
        default_value = "",
        hide_default_value = true
    )]
    pub(super) reading: ChosenOptions,
    /// The format of the result
    #[arg(long, default_value = "csv")]
    pub(super) format: CurrentFormat,
    /// Additional columns for a program
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',')]
    pub(super) columns: Vec<CurrentColumn>,
    /// End the trace of a program after N CNC cycles
    #[arg(long, value_name = "N", default_value_t = PlannerOptions::default().max_cycles)]
    #[arg(value_parser = clap::value_parser!(u64).range(1..))]
    pub(super) max_cycles: u64,
    /// Draw currents, velocities, weights and compensation states over time to this SVG file
    #[arg(long, value_name = "FILE")]
    pub(super) svg: Option<PathBuf>,
    #[command(flatten)]
    pub(super) html: HtmlArgs,
    /// Write the result to this file
    #[arg(long, short, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    #[command(flatten)]
    pub(super) machine: MachineArgs,
    #[command(flatten)]
    pub(super) start: StartArgs,
    #[command(flatten)]
    pub(super) tool: ToolArgs,
    #[command(flatten)]
    pub(super) execution: ExecutionArgs,
}

/// The file that the current is computed over.
pub(crate) enum CurrentSource<'a> {
    /// A program.
    Program(&'a Path),
    /// The recorded motion of an axis.
    Recording(&'a Path),
}

/// The arguments as they are declared, without options that have no effect on the file (R9.71).
#[derive(Debug)]
pub(crate) struct CurrentCall(pub(super) CurrentArgs);

impl Args for CurrentCall {
    fn augment_args(command: Command) -> Command {
        CurrentArgs::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        CurrentArgs::augment_args_for_update(command)
    }
}

impl FromArgMatches for CurrentCall {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let args = CurrentArgs::from_arg_matches(matches)?;
        let (path, what, others) = match args.source() {
            CurrentSource::Program(path) => (path, "a program", &OF_RECORDINGS[..]),
            CurrentSource::Recording(path) => (path, "a recording", &OF_PROGRAMS[..]),
        };
        let command = Self::augment_args(Command::new("current"));
        let is_given = |option: &&Arg| {
            let id = option.get_id().as_str();
            others.contains(&id) && matches.value_source(id) == Some(ValueSource::CommandLine)
        };
        match command.get_arguments().find(is_given) {
            Some(option) => {
                let option = option.get_long().unwrap_or_default();
                let path = shown_path(path);
                let message = format!("`--{option}` has no effect on `{path}`, which is {what}\n");
                Err(clap::Error::raw(ErrorKind::ArgumentConflict, message))
            }
            None => Ok(Self(args)),
        }
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        self.0.update_from_arg_matches(matches)
    }
}

/// Options that have no effect on a program.
const OF_RECORDINGS: [&str; 7] = [
    "time",
    "position",
    "velocity",
    "unit",
    "lead",
    "resample",
    "dead_band",
];

/// Options that have no effect on a recording.
const OF_PROGRAMS: [&str; 17] = [
    "columns",
    "max_cycles",
    "radii",
    "start",
    "config",
    "isolated",
    "startup",
    "enable",
    "settings",
    "allow_outside",
    "skip",
    "max_blocks",
    "max_calls",
    "max_nesting",
    "max_macros",
    "max_work",
    "max_values",
];

impl CurrentArgs {
    /// Returns the file, told by its content to be a program or a recording.
    pub(super) fn source(&self) -> CurrentSource<'_> {
        match (&self.recording, &self.file) {
            (Some(path), _) => CurrentSource::Recording(path),
            (None, Some(path)) if is_recording(path, &Disk::default()) => {
                CurrentSource::Recording(path)
            }
            (None, path) => CurrentSource::Program(path.as_deref().unwrap_or(Path::new("-"))),
        }
    }

    /// Returns the options for converting rows of a recording to cycles.
    pub(super) fn trace_options(&self) -> Result<TraceOptions, Failure> {
        let resampling = if self.resample {
            Resampling::Done
        } else {
            Resampling::Refused
        };
        Ok(TraceOptions::default()
            .with_cycle_s(self.cycle.seconds()?)
            .with_resampling(resampling)
            .with_dead_band(self.dead_band.unwrap_or_default()))
    }
}

/// Parses a velocity, 0 or above.
fn parse_dead_band(text: &str) -> Result<DeadBand, String> {
    let limit = Some(quantities::um_per_s(text)?).filter(|limit| *limit >= 0.0);
    limit
        .map(DeadBand::Below)
        .ok_or_else(|| "a dead band is a velocity from 0 on, in µm/s or 0.001°/s".to_owned())
}

/// A format of the currents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(super) enum CurrentFormat {
    /// One row per cycle.
    #[default]
    Csv,
}

/// Columns for the currents of a program, written only on request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum CurrentColumn {
    /// The compensation state.
    Comp,
    /// The line of the block being executed.
    Line,
    /// What the control does beyond the trace, such as `G261` (FC907).
    Simplified,
}
