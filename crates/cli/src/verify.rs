//! `frictcomp verify`: compares a recorded torque with a value list.

use std::path::PathBuf;

use clap::Args;

use super::channels::{AxisChannelArgs, FollowedChannels};
use super::console::Console;
use super::cycle::CycleArgs;
use super::exit;
use super::failure::Failure;
use super::html::{HtmlArgs, write_page};
use super::machine::value_list;
use super::outputs::Outputs;
use super::per_axis::{ByAxis, PerAxis};
use super::readings::CurrentReadingArgs;
use super::result::{ResultArgs, ResultFormat};
use frictcomp::text::shown_path;
use frictcomp_host::{Disk, FileRegistry, read_axis};
use frictcomp_recordings::identify::{Predictor, verify_followed};
use frictcomp_report::verify::{VerifyReport, document, render_json};

/// Compare a recorded torque with what a value list predicts
///
/// The prediction is the additive current that the control computes from the list. Says at which
/// speeds the list is too low or too high, whether its sign is inverted, and, where the following error
/// was recorded, whether the list acted and whether it is early or late at reversals. The channels are
/// named as for `identify`. The exit status is 1 where the list does not fit. Record without
/// compensation, or record the torque that the drive measures.
#[derive(Debug, Args)]
pub(super) struct VerifyArgs {
    /// The recording
    #[arg(value_name = "RECORDING")]
    recording: PathBuf,
    /// The compensation value list
    #[arg(long, value_name = "LIST", required = true)]
    value_list: Vec<PerAxis>,
    #[command(flatten)]
    channels: AxisChannelArgs,
    #[command(flatten)]
    followed: FollowedChannels,
    #[command(flatten)]
    cycle: CycleArgs,
    #[command(flatten)]
    reading: CurrentReadingArgs,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    html: HtmlArgs,
}

/// Runs the command.
pub(super) fn run(args: &VerifyArgs, console: Console) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    registry.reads("recording", &args.recording);
    let mut outputs = Outputs::new(&registry, console);
    let mut result = outputs.result(args.result.output.as_deref())?;
    let html = args.html.page(&mut outputs)?;
    let axis = args.channels.axis();
    let lists = ByAxis {
        option: "--value-list",
        given: &args.value_list,
        axes: &[axis],
    };
    let path = lists.required(axis)?;
    let list = value_list(path, &registry)?;
    outputs.check()?;
    let cycle_s = args.cycle.seconds()?;
    let selection = args.channels.selection(&args.recording, &registry)?;
    let selection = args.followed.added_to(selection, (axis, &[axis]))?;
    let recording = read_axis(&args.recording, &selection, cycle_s, &Disk::default())?;
    let predictor = Predictor {
        list: &list,
        reading: args.reading.reading,
        cycle_s,
    };
    let verified = verify_followed(&recording.track, &recording.following_errors, &predictor)?;
    let report = VerifyReport {
        trace: shown_path(&args.recording),
        list: shown_path(path),
        recording,
        verified,
    };
    let status = if report.verified.fits() {
        exit::CLEAN
    } else {
        exit::FOUND
    };
    let document = document(&report);
    write_page(html, &document)?;
    result.text(&match args.result.format {
        ResultFormat::Text => document.text(console.detail, result.look.width),
        ResultFormat::Json => render_json(&report),
    })?;
    outputs.finish()?;
    Ok(status)
}
