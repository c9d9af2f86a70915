//! `frictcomp identify`: from a recorded trace to a value list.

mod states;

use std::path::{Path, PathBuf};

use clap::Args;

use crate::channels::{AxisChannels, TorqueArgs};
use crate::console::Console;
use crate::cycle::CycleArgs;
use crate::exit;
use crate::failure::Failure;
use crate::outputs::{Outputs, write_text};
use crate::result::Format;
use frictcomp::comp::CncBuild;
use frictcomp::text::shown_path;
use frictcomp_host::{Ledger, OutputFile, read_axis};
use frictcomp_recordings::identify::{
    AxisRecording, IdentifyError, IdentifyOptions, Measured, TraceFinding, Track, Wanted, identify,
    identify_measured_circles,
};
use frictcomp_report::fitted;
use frictcomp_report::html::render_identification;
use frictcomp_report::identify::{IdentifyReport, render_json, render_text};
use frictcomp_report::on_circles::{self, OnCirclesReport};
use frictcomp_report::pictures::friction_curve;
use frictcomp_report::svg::Frame;
use frictcomp_report::value_lists::{IdentifiedFrom, render_identified};

/// Find the friction of an axis in a recorded trace and make a value list of it
///
/// Record torque and commanded velocity while the axis moves back and forth at constant speeds:
/// docs/identification.md says how. Without options the columns `t` (s), `v` (µm/s or 0.001°/s), `x`
/// (0.1 µm or 0.0001°) and `torque` (drive units) are taken; `frictcomp trace` lists the channels of a
/// file.
#[derive(Debug, Args)]
pub(crate) struct IdentifyArgs {
    /// The recorded trace; with `--circles` one or more
    #[arg(required_unless_present = "recording", conflicts_with = "recording")]
    traces: Vec<PathBuf>,
    /// The recording of a state of the axis, cold or warm for instance: `warm=FILE`; give one for each
    #[arg(long, value_name = "STATE=FILE", value_parser = states::parse_state)]
    #[arg(conflicts_with_all = ["circles", "html"])]
    recording: Vec<(String, PathBuf)>,
    /// The state in which the machine works, for which the list is; by default `warm`
    #[arg(
        long,
        value_name = "STATE",
        requires = "recording",
        conflicts_with = "traces"
    )]
    working: Option<String>,
    /// The traces are recorded circles, at two or more feeds, instead of constant speeds
    #[arg(long, conflicts_with_all = ["points", "max_error", "svg", "html"])]
    circles: bool,
    #[command(flatten)]
    channels: AxisChannels,
    #[command(flatten)]
    cycle: CycleArgs,
    /// The largest number of points in the value list; by default 8
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=200))]
    points: Option<u32>,
    /// Use as few points as keep the list within this percentage of the friction
    #[arg(long, value_name = "PCT", allow_negative_numbers = true)]
    max_error: Option<f64>,
    /// The feed in mm/min at which the machine works
    #[arg(
        long,
        value_name = "MM/MIN",
        default_value_t = 1000.0,
        allow_negative_numbers = true
    )]
    feed: f64,
    #[command(flatten)]
    torque: TorqueArgs,
    /// The format of the result
    #[arg(long, default_value = "text")]
    format: Format,
    /// The CNC build that the value list is for, such as `3.1.3132.0`; outputs are whole numbers
    /// unless the build accepts fractions
    #[arg(long, value_name = "BUILD")]
    cnc_build: Option<CncBuild>,
    /// Draw speeds, curve and residuals to this SVG file
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Write an HTML report to this file
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Write the value list to this file
    #[arg(long, short, value_name = "LIST")]
    output: Option<PathBuf>,
}

/// Runs the command.
pub(crate) fn run(args: &IdentifyArgs, console: Console) -> Result<u8, Failure> {
    let options = options(args)?;
    if !args.recording.is_empty() {
        return states::run(args, &options, console);
    }
    let ledger = Ledger::default();
    args.traces
        .iter()
        .for_each(|path| ledger.reads("trace", path));
    let mut outputs = Outputs::new(&ledger, console);
    let list = args.output.as_deref();
    let list = list
        .map(|path| outputs.list("--output", path))
        .transpose()?;
    let svg = outputs.optional("--svg", args.svg.as_deref())?;
    let html = outputs.optional("--html", args.html.as_deref())?;
    outputs.print("the result")?;
    outputs.check()?;
    let read = |path: &PathBuf| {
        let cycle = args.cycle.seconds()?;
        Ok::<_, Failure>(read_axis(path, &args.channels.selection(), cycle)?)
    };
    if args.circles {
        let recordings = args
            .traces
            .iter()
            .map(read)
            .collect::<Result<Vec<_>, _>>()?;
        let report = circles(args, recordings, list)?;
        let mut target = console.stdout();
        target.text(&match args.format {
            Format::Text => fitted(&on_circles::render_text(&report), target.look.width),
            Format::Json => on_circles::render_json(&report),
        })?;
        outputs.finish()?;
        return Ok(exit::CLEAN);
    }
    let [trace] = &args.traces[..] else {
        let message = format!("{} traces were given", args.traces.len());
        return Err(Failure::new(message)
            .with_help("give one trace of constant speeds, or `--circles` for several circles"));
    };
    let report = args.identified(trace, read(trace)?, &options)?;
    if let Some(mut list) = list {
        write_text(&mut list, &args.list_of(&report, &[]))?;
    }
    if let Some(mut svg) = svg {
        write_text(&mut svg, &friction_curve(&report).render(Frame::Alone))?;
    }
    if let Some(mut html) = html {
        render_identification(&report, &mut html).map_err(Failure::output)?;
    }
    let mut target = console.stdout();
    target.text(&match args.format {
        Format::Text => fitted(&render_text(&report), target.look.width),
        Format::Json => render_json(&report),
    })?;
    outputs.finish()?;
    Ok(exit::CLEAN)
}

impl IdentifyArgs {
    /// What a recording tells.
    fn identified(
        &self,
        trace: &Path,
        recording: AxisRecording,
        options: &IdentifyOptions,
    ) -> Result<IdentifyReport, Failure> {
        let options = IdentifyOptions {
            measured: self.torque.measured(recording.measured),
            ..*options
        };
        let identified = identify(&recording.track, &options)
            .map_err(|error| refusal(error, &recording.findings))?;
        Ok(IdentifyReport {
            name: shown_path(trace),
            axis: self.channels.axis.clone(),
            recording,
            identified,
        })
    }

    /// The value list of a report, with further remarks at its head.
    fn list_of(&self, report: &IdentifyReport, remarks: &[String]) -> String {
        let made = IdentifiedFrom {
            axis: report.axis.as_deref(),
            from: &report.name,
            unit: report.unit(),
            faults: &[remarks, &report.faults()].concat(),
        };
        render_identified(&report.identified.list(), made, self.cnc_build)
    }
}

/// Why nothing was identified, with what the channels themselves tell.
pub(crate) fn refusal(error: IdentifyError, findings: &[TraceFinding]) -> Failure {
    findings.iter().fold(error.into(), |failure: Failure, it| {
        failure.with_help(format!("{}: {}", it.code, it.message))
    })
}

/// What recorded circles tell, and their value list.
fn circles(
    args: &IdentifyArgs,
    recordings: Vec<AxisRecording>,
    list: Option<OutputFile>,
) -> Result<OnCirclesReport, Failure> {
    let tracks: Vec<Track> = recordings.iter().map(|it| it.track.clone()).collect();
    let measured = recordings
        .iter()
        .map(|it| args.torque.measured(it.measured));
    // What is known least of any recording.
    let measured = measured.reduce(Measured::common).unwrap_or_default();
    let report = OnCirclesReport {
        names: args.traces.iter().map(|path| shown_path(path)).collect(),
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
        write_text(&mut list, &render_identified(&found, made, args.cnc_build))?;
    }
    Ok(report)
}

/// What is wanted, by the options.
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
        options.wanted = Wanted::Points(points);
    }
    if let Some(percent) = args.max_error {
        if !(percent > 0.0 && percent <= LARGEST) {
            let message = format!("an error of {percent} % cannot be wanted");
            return Err(
                Failure::new(message).with_help("write per cent of the friction, `--max-error 1`")
            );
        }
        options.accuracy = percent / 100.0;
        options.wanted = Wanted::Error {
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
