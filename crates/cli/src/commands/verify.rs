//! `frictcomp verify`: compares a recorded torque with a value list.

use std::path::PathBuf;

use clap::Args;

use crate::args::{
    AxisChannelArgs, ByAxis, CurrentReadingArgs, CycleArgs, FollowedChannels, PerAxis, TorqueArgs,
    named, refuse_alike, value_list,
};
use crate::output::{Console, Failure, HtmlArgs, Job, ResultArgs, exit};
use frictcomp::text::shown_path;
use frictcomp_host::{Disk, FileRegistry, read_axis};
use frictcomp_recordings::identify::{Predictor, verify_recording};
use frictcomp_report::results::verify::{VerifyReport, document, render_json};

/// Compare a recorded torque with what a value list predicts
///
/// The prediction is the additive current that the control computes from the list. Says at which
/// speeds the list is too low or too high, whether its sign is inverted, and, where the following error
/// was recorded, whether the list acted and whether it is early or late at reversals. The channels are
/// named as for `identify`, which looks at the recording in the same way. The exit status is 1 where the list does not
/// fit, or the recording is doubtful. Record without compensation, or record the torque that the drive measures.
#[derive(Debug, Args)]
pub(crate) struct VerifyArgs {
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
    torque: TorqueArgs,
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
pub(crate) fn run(args: &mut VerifyArgs, console: Console) -> Result<u8, Failure> {
    args.channels.find_axes(&args.recording, &args.value_list)?;
    let args = &*args;
    let registry = FileRegistry::default();
    registry.reads("recording", &args.recording);
    let job = Job::new(&args.result, &registry, console)?.with_page(&args.html)?;
    if args.html.is_given() {
        args.channels.sole_axis("`--html` shows")?;
    }
    let axes = args.channels.axes();
    let of_lists = ByAxis::new("--value-list", &args.value_list, &axes);
    let lists = axes.iter().map(|axis| {
        let path = of_lists.required(axis)?;
        Ok((path, value_list(path, &registry)?))
    });
    let lists = lists.collect::<Result<Vec<_>, Failure>>()?;
    job.outputs.check()?;
    let cycle_s = args.cycle.seconds()?;
    let reports = axes.iter().zip(&lists).map(|(axis, (path, list))| {
        let recorded = &args.recording;
        let selection = args.channels.selection(axis, recorded, &registry)?;
        let selection = args.followed.added_to(selection, (axis, &axes))?;
        let recording = read_axis(recorded, &selection, cycle_s, &Disk::default())?;
        let mut recording = args.torque.about(recording);
        let predictor = Predictor {
            list,
            reading: args.reading.reading,
            cycle_s,
        };
        let verified = verify_recording(&mut recording, &predictor)?;
        Ok(VerifyReport {
            axis: named(axis),
            trace: shown_path(recorded),
            list: shown_path(path),
            recording,
            verified,
        })
    });
    let reports = reports.collect::<Result<Vec<_>, Failure>>()?;
    let tracks = reports.iter().map(|it| &it.recording.track);
    refuse_alike(axes.iter().copied().zip(tracks))?;
    let status = if reports.iter().all(|it| it.verified.fits()) {
        exit::CLEAN
    } else {
        exit::FOUND
    };
    let documents: Vec<_> = reports.iter().map(document).collect();
    job.finish_all(&documents, || render_json(&reports))?;
    Ok(status)
}
