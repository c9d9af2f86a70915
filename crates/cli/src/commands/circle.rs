//! `frictcomp circle`: the circular test, simulated or recorded.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::args::{
    ByAxis, CircleChannelArgs, CurrentReadingArgs, CycleArgs, ModelArgs, PerAxis, PlantArgs,
    quantities, value_list,
};
use crate::output::{Console, Failure, HtmlArgs, Job, ResultArgs, exit, progress};
use frictcomp::lists::FrictionList;
use frictcomp::text::shown_path;
use frictcomp_host::{FileRegistry, compare, find_plant, memory_for_simulation, read_circles};
use frictcomp_physics::circle::{Circle, CircularTest, CommandedCircle, Method, PathCentre};
use frictcomp_report::results::circle::{
    CircleReport, ListOrigin, document, render_csv, render_json,
};

/// Make a circular test, simulated or recorded
///
/// Drives a circle with two simulated axes, with friction compensation off and on. Prints the
/// figures of ISO 230-4, the glitch at each quadrant, and what they suggest. A recording is evaluated
/// instead where one is named: an export of TwinCAT Scope, a SINUMERIK trace or a CSV file,
/// with the columns `x` and `y` in mm (or `x_um` and `y_um` in µm), the actual positions of X and Y, or the
/// channels that `--position` names. Name two files for both directions.
#[derive(Debug, Args)]
pub(crate) struct CircleArgs {
    /// A recorded circle instead of a simulated one; name two for both directions
    #[arg(value_name = "RECORDING", conflicts_with_all = OF_SIMULATIONS)]
    files: Vec<PathBuf>,
    /// Radius in mm; for recorded circles the commanded radius
    #[arg(long, value_name = "MM", value_parser = quantities::mm, allow_negative_numbers = true)]
    radius: Option<f64>,
    /// Feed in mm/min, by default 1000; for recorded circles the commanded feed, by default that of
    /// the column `t` in s
    #[arg(long, value_name = "MM/MIN", value_parser = quantities::mm_per_min)]
    #[arg(allow_negative_numbers = true)]
    feed: Option<f64>,
    #[command(flatten)]
    plant: PlantArgs,
    #[command(flatten)]
    model: ModelArgs,
    /// The compensation value list of both axes, or `X=LIST` and `Y=LIST`; by default the stiction
    /// compensation of the plant if it has one, or else its friction curve
    #[arg(long, value_name = "LIST")]
    value_list: Vec<PerAxis>,
    #[command(flatten)]
    cycle: CycleArgs,
    #[command(flatten)]
    reading: CurrentReadingArgs,
    /// A recorded circle, as it is named without the option
    #[arg(long, value_name = "FILE", conflicts_with_all = OF_SIMULATIONS)]
    recording: Vec<PathBuf>,
    /// The centre about which G(b) and H compare both directions: `common`, the mean of both
    /// least-squares centres, or `own`
    #[arg(long, value_name = "CENTRE", default_value_t)]
    centre: PathCentre,
    #[command(flatten)]
    channels: CircleChannelArgs,
    #[command(flatten)]
    result: ResultArgs<CircleFormat>,
    /// Draw the circle with magnified deviation, compensation off and on, to this SVG file
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    #[command(flatten)]
    html: HtmlArgs,
}

/// Options that have no effect on a recording.
const OF_SIMULATIONS: [&str; 5] = ["plant", "model", "value_list", "cycle_time", "reading"];

/// A format of the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum CircleFormat {
    /// Tables for people.
    #[default]
    Text,
    /// One JSON document.
    Json,
    /// The radial deviation every 0.1°.
    Csv,
}

/// Runs the command.
pub(crate) fn run(args: &CircleArgs, console: Console) -> Result<u8, Failure> {
    memory_for_simulation()?;
    let registry = FileRegistry::default();
    let job = Job::new(&args.result, &registry, console)?;
    let job = job
        .with_picture(args.svg.as_deref())?
        .with_page(&args.html)?;
    let recordings = [&args.files[..], &args.recording].concat();
    let report = if recordings.is_empty() {
        args.channels.refuse_without_recording()?;
        let (test, origin) = simulation(args, &registry)?;
        job.outputs.check()?;
        let comparison = compare(&test, &progress::watch())?.about(args.centre);
        CircleReport::simulated(test, comparison, origin)
    } else {
        for path in &recordings {
            registry.reads("recording", path);
        }
        job.outputs.check()?;
        let commanded = CommandedCircle {
            radius_mm: args.radius,
            feed_mm_per_min: args.feed,
        };
        let recording = read_circles(
            &recordings,
            &args.channels.selections()?,
            commanded,
            args.centre,
        )?;
        CircleReport::recorded(recording)
    };
    let document = document(&report);
    job.finish_with(&[document], |format| match format {
        CircleFormat::Text => None,
        CircleFormat::Json => Some(render_json(&report)),
        CircleFormat::Csv => Some(render_csv(&report)),
    })?;
    Ok(exit::CLEAN)
}

/// Returns the simulation, and the origin of the value lists.
fn simulation(
    args: &CircleArgs,
    registry: &FileRegistry,
) -> Result<(CircularTest, ListOrigin), Failure> {
    let plant = find_plant(args.plant.name(), registry)?;
    let (compensation, origin) = match &args.value_list[..] {
        [] => (Method::of_plant(&plant), ListOrigin::Plant),
        given => {
            let (lists, origin) = given_lists(given, registry)?;
            (lists.map(|list| Some(list.into())), origin)
        }
    };
    let test = CircularTest {
        circle: Circle {
            radius_mm: args.radius.unwrap_or(Circle::default().radius_mm),
            feed_mm_per_min: args.feed.unwrap_or(Circle::default().feed_mm_per_min),
            cycle_time_s: args
                .cycle
                .seconds()?
                .unwrap_or(Circle::default().cycle_time_s),
        },
        plant,
        model: args.model.model(),
        compensation,
        reading: args.reading.reading,
    };
    Ok((test, origin))
}

/// Returns the lists given for both axes, or for each.
fn given_lists(
    given: &[PerAxis],
    registry: &FileRegistry,
) -> Result<([FrictionList; 2], ListOrigin), Failure> {
    let lists = ByAxis::new("--value-list", given, &["X", "Y"]);
    let [x, y] = [lists.required("X")?, lists.required("Y")?];
    let origin = if x == y {
        ListOrigin::File(shown_path(x))
    } else {
        ListOrigin::EachAxis([x, y].map(shown_path))
    };
    Ok(([value_list(x, registry)?, value_list(y, registry)?], origin))
}
