//! `frictcomp identify`: from a recording to a value list.

mod args;
mod states;

use std::path::Path;

use args::identified;
pub(crate) use args::{IdentifyArgs, refusal};

use crate::args::{named, refuse_alike};
use crate::output::{Console, Failure, Job, Outputs, exit, write_text};
use frictcomp::text::shown_path;
use frictcomp_host::{Disk, FileRegistry, OutputFile, read_axis, refuse_copies};
use frictcomp_recordings::identify::{
    AxisRecording, IdentifyError, IdentifyOptions, ListRequest, ListRequestError, identify_circles,
};
use frictcomp_recordings::value_lists::{IdentifiedFrom, render_identified};
use frictcomp_report::results::identify::on_circles::{self, OnCirclesReport};
use frictcomp_report::results::identify::{IdentifyReport, document, render_json};
use frictcomp_report::visible_line;

/// Runs the command.
pub(crate) fn run(args: &mut IdentifyArgs, console: Console) -> Result<u8, Failure> {
    let options = options(args)?;
    if args.states {
        return states::run(args, &options, console);
    }
    if let Some(first) = args.recordings.first() {
        args.channels.find_axes(first, &[])?;
    }
    let args = &*args;
    let registry = FileRegistry::default();
    args.recordings
        .iter()
        .for_each(|path| registry.reads("recording", path));
    let mut job = Job::new(&args.result, &registry, console)?;
    let lists = lists(args, &mut job.outputs)?;
    let job = job
        .with_picture(args.svg.as_deref())?
        .with_page(&args.html)?;
    job.outputs.check()?;
    if args.circles {
        let report = circles(args, lists, &registry)?;
        let document = on_circles::document(&report);
        job.finish(&document, || on_circles::render_json(&report))?;
        return Ok(exit::CLEAN);
    }
    let reports = at_speeds(args, &options, &registry)?;
    for (mut list, report) in lists.into_iter().zip(&reports) {
        write_text(&mut list, &args.list_of(report, &[]))?;
    }
    let documents: Vec<_> = reports.iter().map(document).collect();
    job.finish_all(&documents, || render_json(&reports))?;
    Ok(exit::CLEAN)
}

/// Returns the files of the value lists: one, or one of each axis.
fn lists(args: &IdentifyArgs, outputs: &mut Outputs) -> Result<Vec<OutputFile>, Failure> {
    let sole = [
        (
            "`--write-list` writes the list of",
            args.write_list.is_some(),
        ),
        ("`--svg` draws", args.svg.is_some()),
        ("`--html` shows", args.html.is_given()),
    ];
    for (what, _) in sole.into_iter().filter(|it| it.1) {
        args.channels.sole_axis(what)?;
    }
    if let Some(path) = &args.write_list {
        return Ok(vec![outputs.list("--write-list", path)?]);
    }
    let Some(folder) = &args.into else {
        return Ok(Vec::new());
    };
    let axes = args.channels.axes();
    if axes == [""] {
        let message = "`--into` names each list after its axis, and no axis is known";
        return Err(Failure::new(message).with_help("name the axes, `--axis X,Y`"));
    }
    if let Some(axis) = axes
        .iter()
        .find(|it| it.contains(['/', '\\', ':']) || it.starts_with('.'))
    {
        let message = format!("`{}` is no name of a list", visible_line(axis));
        return Err(Failure::new(message).with_help("name the axis as its channels do"));
    }
    let axes = axes.into_iter();
    axes.map(|axis| outputs.list_in_folder("--into", &folder.join(format!("{axis}.lis"))))
        .collect()
}

/// Returns the friction of each axis in a recording of constant speeds.
fn at_speeds(
    args: &IdentifyArgs,
    options: &IdentifyOptions,
    registry: &FileRegistry,
) -> Result<Vec<IdentifyReport>, Failure> {
    let [path] = &args.recordings[..] else {
        let message = format!("{} recordings were given", args.recordings.len());
        return Err(Failure::new(message).with_help(
            "give one recording of constant speeds, or `--circles` for several circles",
        ));
    };
    let axes = args.channels.axes();
    let read = |axis: &&str| read(args, (axis, path), registry);
    let recordings = axes.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    refuse_alike(
        axes.iter()
            .copied()
            .zip(recordings.iter().map(|it| &it.track)),
    )?;
    let reports = axes.into_iter().zip(recordings);
    reports
        .map(|(axis, recording)| identified((axis, path), recording, options))
        .collect()
}

/// Reads the channels of an axis.
pub(super) fn read(
    args: &IdentifyArgs,
    (axis, path): (&str, &Path),
    registry: &FileRegistry,
) -> Result<AxisRecording, Failure> {
    let selection = args.channels.selection(axis, path, registry)?;
    let cycle = args.cycle.seconds()?;
    let recording = read_axis(path, &selection, cycle, &Disk::default())?;
    Ok(args.torque.about(recording))
}

/// Returns the values identified on recorded circles, and writes their value list.
fn circles(
    args: &IdentifyArgs,
    lists: Vec<OutputFile>,
    registry: &FileRegistry,
) -> Result<OnCirclesReport, Failure> {
    refuse_copies(&args.recordings)?;
    let axis = args.channels.sole_axis("the circles are those of")?;
    let paths = args.recordings.iter();
    let recordings = paths.map(|path| read(args, (axis, path), registry));
    let recordings = recordings.collect::<Result<Vec<_>, _>>()?;
    let report = OnCirclesReport {
        names: args
            .recordings
            .iter()
            .map(|path| shown_path(path))
            .collect(),
        axis: named(axis),
        found: identify_circles(&recordings)?,
        recordings,
    };
    for mut list in lists {
        let made = IdentifiedFrom {
            axis: report.axis.as_deref(),
            from: &report.names.join(", "),
            unit: report.unit(),
            faults: &report.faults(),
        };
        let found = report.found.list();
        write_text(
            &mut list,
            &render_identified(&found, made, args.build.cnc_build),
        )?;
    }
    Ok(report)
}

/// Returns the options of an identification.
fn options(args: &IdentifyArgs) -> Result<IdentifyOptions, Failure> {
    let request = ListRequest {
        points: args.points.and_then(|points| usize::try_from(points).ok()),
        max_error_percent: args.max_error,
        feed_mm_per_min: args.feed,
    };
    request.options().map_err(|error| {
        let failure = Failure::new(error.to_string());
        match error {
            ListRequestError::MaxError(_) => {
                failure.with_help("write per cent of the friction, `--max-error 1`")
            }
            _ => failure,
        }
    })
}

impl From<IdentifyError> for Failure {
    fn from(error: IdentifyError) -> Self {
        Self::new(error.to_string()).with_help(error.help())
    }
}
