//! `frictcomp tune`: the parameters of a value list that leave the smallest glitch.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::console::Console;
use super::cycle::CycleArgs;
use super::exit;
use super::failure::Failure;
use super::outputs::{Outputs, write_text};
use super::progress;
use crate::circle::{Circle, Ranges, Task};
use crate::comp::CncBuild;
use crate::current::Reading;
use crate::host::{Ledger, find_plant, memory_for_simulation, tune};
use crate::lists::{Field, Points, write_value_list};
use crate::report::pictures::tuning;
use crate::report::svg::Frame;
use crate::report::tune::{TuneReport, render_json, render_text};
use crate::report::visible_line;
use crate::simulation::{FrictionModel, Plant};

/// Feeds that are tuned at once, at most.
const MAX_FEEDS: usize = 16;

/// Plants at most.
const MAX_PLANTS: usize = 16;

/// Find the value list parameters with the smallest glitch on a simulated machine
///
/// Searches `position_delay`, `reversal_lookahead`, `delay_cycles` and `scaling_factor` within
/// their documented ranges for the smallest worst glitch over all feeds. The table is the friction
/// curve of the plant.
#[derive(Debug, Args)]
pub(super) struct TuneArgs {
    /// The machine: `stiff`, `mid`, `soft`, or a TOML file; several are tuned one after the other
    #[arg(
        long,
        value_name = "PLANT",
        value_delimiter = ',',
        default_value = "stiff"
    )]
    plant: Vec<String>,
    /// The feeds in mm/min
    #[arg(
        long,
        value_name = "MM/MIN",
        value_delimiter = ',',
        default_value = "500,1000,2000,5000",
        allow_negative_numbers = true
    )]
    feeds: Vec<f64>,
    /// Search this parameter beyond its documented range
    #[arg(long, value_name = "PARAMETER", value_delimiter = ',')]
    free: Vec<Free>,
    /// Radius in mm
    #[arg(
        long,
        value_name = "MM",
        default_value_t = 100.0,
        allow_negative_numbers = true
    )]
    radius: f64,
    /// The friction model
    #[arg(long, default_value = "lugre")]
    model: FrictionModel,
    #[command(flatten)]
    cycle: CycleArgs,
    /// Where the documents leave something open: `standstill=zero,below=origin,delay=reversal`
    #[arg(long, value_name = "READING", default_value = "")]
    reading: Reading,
    /// The format of the result
    #[arg(long, default_value = "text")]
    format: Format,
    /// Draw the glitch over the feed, before and after tuning, to this SVG file
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// The CNC build that the value list is for, such as `3.1.3132.0`; outputs are whole numbers
    /// unless the build accepts fractions
    #[arg(long, value_name = "BUILD")]
    cnc_build: Option<CncBuild>,
    /// Write the value list of the first plant to this file
    #[arg(long, short, value_name = "LIST")]
    output: Option<PathBuf>,
}

/// A parameter that may leave its documented range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Free {
    /// Up to 200 µm.
    #[value(name = "position_delay", alias = "position-delay")]
    PositionDelay,
    /// Up to 50 cycles.
    #[value(name = "reversal_lookahead", alias = "reversal-lookahead")]
    ReversalLookahead,
}

/// A format of the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum Format {
    /// A table for people.
    #[default]
    Text,
    /// One JSON document.
    Json,
}

/// Runs the command.
pub(super) fn run(args: &TuneArgs, console: Console) -> Result<u8, Failure> {
    memory_for_simulation()?;
    let circles = circles(args)?;
    if args.plant.len() > MAX_PLANTS {
        let message = format!("{} plants were given", args.plant.len());
        return Err(Failure::new(message).with_help(format!("give at most {MAX_PLANTS}")));
    }
    let ledger = Ledger::default();
    let mut outputs = Outputs::new(&ledger, console);
    outputs.print("the result")?;
    let list = outputs.optional("--output", args.output.as_deref())?;
    let svg = outputs.optional("--svg", args.svg.as_deref())?;
    let plants: Vec<Plant> = args
        .plant
        .iter()
        .map(|name| find_plant(name, &ledger))
        .collect::<Result<_, _>>()?;
    outputs.check()?;
    let model = args.model;
    let watch = progress::watch();
    let mut reports = Vec::new();
    for plant in plants {
        let name = plant.name.clone();
        let task = Task {
            plant,
            model,
            circles: circles.clone(),
            ranges: ranges(&args.free),
            reading: args.reading,
        };
        reports.push(TuneReport {
            plant: name,
            model: model.as_str(),
            diameter_mm: 2.0 * args.radius,
            reading: args.reading.to_string(),
            tuned: tune(&task, &watch)?,
        });
    }
    if let (Some(mut list), Some(first)) = (list, reports.first()) {
        write_text(&mut list, &value_list(first, args.cnc_build))?;
    }
    if let Some(mut svg) = svg {
        write_text(&mut svg, &tuning(&reports).render(Frame::Alone))?;
    }
    console.print(&match args.format {
        Format::Text => console.fitted(&render_text(&reports)),
        Format::Json => render_json(&reports),
    })?;
    outputs.finish()?;
    Ok(exit::CLEAN)
}

/// The tuned value list of a plant, written for a build.
fn value_list(report: &TuneReport, build: Option<CncBuild>) -> String {
    let points = Points::of_build(build);
    let made = format!(
        "Friction compensation for the plant {}, tuned with the model {}",
        visible_line(&report.plant),
        report.model
    );
    let mut remarks = vec![
        made.as_str(),
        "The table is the friction curve of its X axis",
    ];
    if points == Points::Real {
        remarks.push("Outputs with decimals need the build V3.1.3132.0 or V4.29.0");
    }
    write_value_list(&report.tuned.list, points, &remarks)
}

fn circles(args: &TuneArgs) -> Result<Vec<Circle>, Failure> {
    if args.feeds.len() > MAX_FEEDS {
        let message = format!("{} feeds were given", args.feeds.len());
        return Err(Failure::new(message).with_help(format!("give at most {MAX_FEEDS}")));
    }
    let cycle = args.cycle.seconds()?;
    let circle = |&feed: &f64| {
        let circle = Circle {
            radius_mm: args.radius,
            feed_mm_per_min: feed,
            cycle_time_s: cycle.unwrap_or(Circle::default().cycle_time_s),
        };
        circle.check().map(|()| circle).map_err(Failure::from)
    };
    args.feeds.iter().map(circle).collect()
}

fn ranges(free: &[Free]) -> Ranges {
    free.iter().fold(Ranges::default(), |ranges, free| {
        ranges.free(match free {
            Free::PositionDelay => Field::PositionDelay,
            Free::ReversalLookahead => Field::ReversalLookahead,
        })
    })
}
