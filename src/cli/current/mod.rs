//! `frictcomp current`: the additive current over the commanded trace of a program, or over a
//! recorded one.

mod program;
mod recorded;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Args, ValueEnum};

use super::console::Console;
use super::cycle::CycleArgs;
use super::discovery::MachineArgs;
use super::dry_run::ExecutionArgs;
use super::failure::Failure;
use super::files::read_text;
use super::ledger::Ledger;
use super::outputs::{OutputFile, Outputs};
use crate::current::Reading;
use crate::diagnostic::Severity;
use crate::lists::{Conditions, Entries, FrictionDraft, FrictionList, Verdict};
use crate::motion::PlannerOptions;
use crate::report::pictures::{AxisPlot, CurrentPlot};
use crate::report::svg::Frame;
use crate::text::SourceFile;

/// Compute the additive current of a program or a recorded trace, cycle by cycle
///
/// A program runs as in `run`, and its path is followed in CNC cycles; the current of each axis
/// depends on its compensation state. A trace is a CSV file with a header: `t` in s, `x` in 0.1 µm
/// or 0.0001°, `v` in µm/s or 0.001°/s, one row per CNC cycle. Either `x` or `v` may be missing. A
/// column `comp` with `on` and `off` switches compensation as COMP would.
#[derive(Debug, Args)]
pub(super) struct CurrentArgs {
    /// The program, `-` for standard input
    #[arg(
        required_unless_present = "trace",
        conflicts_with = "trace",
        requires = "axes"
    )]
    program: Option<PathBuf>,
    /// The axes of the program to compute the current for
    #[arg(
        long = "axis",
        value_name = "AXIS",
        value_delimiter = ',',
        conflicts_with = "trace"
    )]
    axes: Vec<String>,
    /// A recorded commanded trace instead of a program
    #[arg(long, value_name = "FILE", requires = "value_list")]
    #[arg(conflicts_with_all = OF_PROGRAMS)]
    trace: Option<PathBuf>,
    /// The compensation value list; for a program, replaces the one in the configuration
    #[arg(long, value_name = "LIST")]
    value_list: Option<PathBuf>,
    #[command(flatten)]
    cycle: CycleArgs,
    /// Where the documents leave something open: `standstill=zero,below=origin,delay=reversal`
    #[arg(long, value_name = "READING", default_value = "")]
    reading: Reading,
    /// The format of the result
    #[arg(long, default_value = "csv")]
    format: Format,
    /// Additional columns for a program
    #[arg(
        long,
        value_name = "COLUMNS",
        value_delimiter = ',',
        conflicts_with = "trace"
    )]
    columns: Vec<Column>,
    /// End the trace of a program after N CNC cycles
    #[arg(long, value_name = "N", default_value_t = PlannerOptions::default().max_cycles)]
    #[arg(value_parser = clap::value_parser!(u64).range(1..))]
    max_cycles: u64,
    /// Draw currents, velocities, weights and compensation states over time to this SVG file
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Write the result to this file
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

/// Options that have no effect on a trace (R9.71).
const OF_PROGRAMS: [&str; 14] = [
    "max_cycles",
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

/// A format of the currents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum Format {
    /// One row per cycle.
    #[default]
    Csv,
}

/// Columns that the currents of a program have only where they are asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Column {
    /// The compensation state.
    Comp,
    /// The line of the block being executed.
    Line,
}

/// Runs the command.
pub(super) fn run(args: &CurrentArgs, console: Console) -> Result<u8, Failure> {
    let Format::Csv = args.format;
    match (&args.program, &args.trace, &args.value_list) {
        (Some(program), ..) => program::run(program, args, console),
        (None, Some(trace), Some(list)) => recorded::run((trace, list), args, console),
        // The arguments are declared so that one of them is there.
        _ => Err(Failure::new("there is neither a program nor a trace")),
    }
}

/// A picture that is drawn while the cycles come in, and the file that it goes into.
struct Plot {
    file: OutputFile,
    traces: CurrentPlot,
}

impl Plot {
    /// The picture that the user asked for.
    fn create(
        args: &CurrentArgs,
        outputs: &mut Outputs,
        axes: Vec<AxisPlot>,
    ) -> Result<Option<Self>, Failure> {
        let Some(path) = &args.plot else {
            return Ok(None);
        };
        Ok(Some(Self {
            file: outputs.file("--plot", path)?,
            traces: CurrentPlot::new(axes),
        }))
    }

    /// Writes the picture.
    fn finish(mut self) -> Result<(), Failure> {
        self.file.text(&self.traces.chart().render(Frame::Alone))
    }
}

/// Says which outputs were cut to 16 bit.
fn say_saturated(axis: &str, cycles: u64) {
    if cycles > 0 {
        Console::talk(&format!(
            "FC137: the current of {cycles} cycles{axis} is beyond 16 bit and was cut"
        ));
    }
}

/// The values that a list would give the control.
pub(super) fn value_list(path: &Path, ledger: &Ledger) -> Result<FrictionList, Failure> {
    ledger.reads("value list", path);
    let source = Arc::new(SourceFile::new(
        path.display().to_string(),
        read_text(path)?,
    ));
    let entries = Entries::parse(&source);
    let mut diagnostics = entries.diagnostics.clone();
    let draft = FrictionDraft::from_entries(&entries, &mut diagnostics);
    let reading = draft.check(&Conditions::default());
    diagnostics.extend(reading.diagnostics);
    let reason = match reading.verdict {
        Verdict::Accepted(list) => {
            let count = diagnostics.len();
            if count > 0 {
                let name = source.name();
                Console::talk(&format!(
                    "lists: {count} remarks (`frictcomp lists {name}` shows them)"
                ));
            }
            return Ok(list);
        }
        Verdict::Absent => "it holds no friction parameters",
        Verdict::Off => "its mode is 0, off",
        Verdict::Rejected(_) => "the control would reject it",
    };
    diagnostics.retain(|diagnostic| diagnostic.severity == Severity::Error);
    Err(Failure {
        message: format!(
            "the value list `{}` cannot be used: {reason}",
            source.name()
        ),
        help: Vec::new(),
        diagnostics,
    })
}
