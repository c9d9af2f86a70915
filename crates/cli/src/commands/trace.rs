//! `frictcomp trace`: the contents of a recorded trace.

use std::path::PathBuf;

use clap::Args;

use crate::args::parse_time_unit;
use crate::output::{Console, Failure, HtmlArgs, Job, ResultArgs, ResultFormat, exit};
use frictcomp::text::shown_path;
use frictcomp_host::{Disk, FileRegistry, read_trace};
use frictcomp_recordings::trace::{ChannelQuantity, ChannelSelection, Choice, Unit};
use frictcomp_report::results::trace::{TraceReport, document, render_json};

/// List the channels of a recording: rates, lengths, ranges, gaps
///
/// Reads exports of TwinCAT Scope (CSV), traces of SINUMERIK (XML) and CSV files with a header. The
/// channels that are taken as a quantity need no option in `identify`, `verify`, `current` and `circle`; any other is
/// named by its name, its comment or its CNC object, after `--velocity`, `--position`, `--torque` and `--time`.
#[derive(Debug, Args)]
pub(crate) struct TraceArgs {
    /// The recording
    #[arg(value_name = "RECORDING")]
    recording: PathBuf,
    /// The channel of the times, where the file has one that is not called `t` or `time`
    #[arg(long, value_name = "CHANNEL")]
    time: Option<String>,
    /// The unit of the times, where the file does not name it: `--unit t=ms`
    #[arg(long, value_name = "CHANNEL=UNIT", value_parser = parse_time_unit)]
    unit: Option<(String, Unit)>,
    #[command(flatten)]
    result: ResultArgs,
    /// Draw the channels over time to this SVG file
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    #[command(flatten)]
    html: HtmlArgs,
}

/// Runs the command.
pub(crate) fn run(args: &TraceArgs, console: Console) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    registry.reads("recording", &args.recording);
    let job = Job::new(&args.result, &registry, console)?;
    let job = job
        .with_picture(args.svg.as_deref())?
        .with_page(&args.html)?;
    job.outputs.check()?;
    let selection = ChannelSelection {
        time: args.time.clone(),
        units: args.unit.iter().cloned().collect(),
        ..ChannelSelection::default()
    };
    let read = read_trace(&args.recording, &Disk::default(), |channels| {
        let time = selection.find(ChannelQuantity::Time, channels)?;
        Ok(Choice::all(channels, time))
    })?;
    let report = TraceReport {
        name: shown_path(&args.recording),
        recording: &read,
    };
    let document = document(&report);
    job.finish_with(std::slice::from_ref(&document), |format| {
        Some(match format {
            // The names of channels stay whole.
            ResultFormat::Text => document.shown(console.detail).to_string(),
            ResultFormat::Json => render_json(&report),
        })
    })?;
    Ok(exit::CLEAN)
}
