//! `frictcomp identify`: from a recording to a value list.

mod args;
mod states;

use std::path::PathBuf;

pub(crate) use args::{IdentifyArgs, refusal};

use crate::console::Console;
use crate::exit;
use crate::failure::Failure;
use crate::html::write_page;
use crate::outputs::{Outputs, write_picture, write_text};
use crate::recorded_files::refuse_copies;
use crate::result::ResultFormat;
use frictcomp::text::shown_path;
use frictcomp_host::{Disk, FileRegistry, OutputFile, read_axis};
use frictcomp_recordings::identify::{
    AxisRecording, IdentifyError, IdentifyOptions, Measured, RequestedPoints, Track,
    identify_measured_circles,
};
use frictcomp_report::identify::{document, render_json};
use frictcomp_report::on_circles::{self, OnCirclesReport};
use frictcomp_report::value_lists::{IdentifiedFrom, render_identified};

/// Runs the command.
pub(crate) fn run(args: &IdentifyArgs, console: Console) -> Result<u8, Failure> {
    let options = options(args)?;
    if args.states {
        return states::run(args, &options, console);
    }
    let registry = FileRegistry::default();
    args.recordings
        .iter()
        .for_each(|path| registry.reads("recording", path));
    let mut outputs = Outputs::new(&registry, console);
    let mut target = outputs.result(args.result.output.as_deref())?;
    let list = args.write_list.as_deref();
    let list = list
        .map(|path| outputs.list("--write-list", path))
        .transpose()?;
    let svg = outputs.optional("--svg", args.svg.as_deref())?;
    let html = args.html.page(&mut outputs)?;
    outputs.check()?;
    let read = |path: &PathBuf| {
        let cycle = args.cycle.seconds()?;
        Ok::<_, Failure>(read_axis(
            path,
            &args.channels.selection(path, &registry)?,
            cycle,
            &Disk::default(),
        )?)
    };
    if args.circles {
        refuse_copies(&args.recordings)?;
        let recordings = args
            .recordings
            .iter()
            .map(read)
            .collect::<Result<Vec<_>, _>>()?;
        let report = circles(args, recordings, list)?;
        let document = on_circles::document(&report);
        write_page(html, &document)?;
        target.text(&match args.result.format {
            ResultFormat::Text => document.text(console.detail, target.look.width),
            ResultFormat::Json => on_circles::render_json(&report),
        })?;
        outputs.finish()?;
        return Ok(exit::CLEAN);
    }
    let [recording] = &args.recordings[..] else {
        let message = format!("{} recordings were given", args.recordings.len());
        return Err(Failure::new(message).with_help(
            "give one recording of constant speeds, or `--circles` for several circles",
        ));
    };
    let report = args.identified(recording, read(recording)?, &options)?;
    if let Some(mut list) = list {
        write_text(&mut list, &args.list_of(&report, &[]))?;
    }
    let document = document(&report);
    write_picture(svg, &document)?;
    write_page(html, &document)?;
    target.text(&match args.result.format {
        ResultFormat::Text => document.text(console.detail, target.look.width),
        ResultFormat::Json => render_json(&report),
    })?;
    outputs.finish()?;
    Ok(exit::CLEAN)
}

/// Returns the values identified on recorded circles, and their value list.
fn circles(
    args: &IdentifyArgs,
    recordings: Vec<AxisRecording>,
    list: Option<OutputFile>,
) -> Result<OnCirclesReport, Failure> {
    let tracks: Vec<Track> = recordings.iter().map(|it| it.track.clone()).collect();
    let measured = recordings
        .iter()
        .map(|it| args.torque.measured(it.measured));
    // The least that is known of any recording.
    let measured = measured.reduce(Measured::common).unwrap_or_default();
    let report = OnCirclesReport {
        names: args
            .recordings
            .iter()
            .map(|path| shown_path(path))
            .collect(),
        axis: args.channels.axis.clone(),
        found: identify_measured_circles(&tracks, &measured)?,
        recordings,
    };
    if let Some(mut list) = list {
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
    const MOST: usize = 20;
    const LARGEST: f64 = 50.0;
    let mut options = IdentifyOptions::default();
    if !(args.feed > 0.0 && args.feed.is_finite()) {
        return Err(Failure::new(format!(
            "a feed of {} mm/min cannot be used",
            args.feed
        )));
    }
    options.working_speed = args.feed / 60.0;
    let points = args
        .points
        .map(|points| usize::try_from(points).unwrap_or(MOST));
    if let Some(points) = points {
        options.wanted = RequestedPoints::Points(points);
    }
    if let Some(percent) = args.max_error {
        if !(percent > 0.0 && percent <= LARGEST) {
            let message = format!("an error of {percent} % is not possible");
            return Err(
                Failure::new(message).with_help("write per cent of the friction, `--max-error 1`")
            );
        }
        options.accuracy = percent / 100.0;
        options.wanted = RequestedPoints::Error {
            part: options.accuracy,
            most: points.unwrap_or(MOST),
        };
    }
    Ok(options)
}

impl From<IdentifyError> for Failure {
    fn from(error: IdentifyError) -> Self {
        Self::new(error.to_string()).with_help(error.help())
    }
}
