//! `frictcomp commission trend`: the friction of an axis over the dates of its recordings (R16.6).

use std::path::PathBuf;

use clap::Args;

use crate::args::{AxisChannelArgs, CycleArgs, TorqueArgs, named};
use crate::output::{Console, Failure, HtmlArgs, Job, ResultArgs, exit};
use frictcomp_host::commission::DatedRecordings;
use frictcomp_host::{FileRegistry, recordings_in};
use frictcomp_report::results::trend::{document, render_json};

/// Follow the friction of an axis over the dates of its recordings
///
/// Takes every recording of constant speeds in a folder whose name holds a date, `x-2026-03-01.csv`, and
/// lists where Fc, Fs, the viscous part or the offset changed by more than 3 combined errors and 5 %. Give
/// recordings of the same state, for example warm, of one axis.
#[derive(Debug, Args)]
pub(crate) struct TrendArgs {
    /// The folder with the recordings
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    #[command(flatten)]
    channels: AxisChannelArgs,
    #[command(flatten)]
    cycle: CycleArgs,
    #[command(flatten)]
    torque: TorqueArgs,
    #[command(flatten)]
    result: ResultArgs,
    /// Draw the parameters over the dates to this SVG file
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    #[command(flatten)]
    html: HtmlArgs,
}

/// Runs the command.
pub(crate) fn run(args: &TrendArgs, console: Console) -> Result<u8, Failure> {
    let recordings = &recordings_in(&args.folder)?;
    let axis = args.channels.sole_axis("a trend is that of")?;
    let registry = FileRegistry::default();
    for path in recordings {
        registry.reads("recording", path);
    }
    let job = Job::new(&args.result, &registry, console)?;
    let job = job
        .with_picture(args.svg.as_deref())?
        .with_page(&args.html)?;
    job.outputs.check()?;
    let of_folder = args.folder.join("recording");
    let dated = DatedRecordings {
        folder: &args.folder,
        recordings,
        axis: named(axis),
        channels: args.channels.selection(axis, &of_folder, &registry)?,
        cycle_s: args.cycle.seconds()?,
        torque_kind: args.torque.kind.torque_kind,
        compensation: args.torque.switched(),
    };
    let report = dated.trend()?;
    let document = document(&report);
    job.finish(&document, || render_json(&report))?;
    Ok(exit::CLEAN)
}
