//! `frictcomp tune`: finds the parameters of a value list that leave the smallest glitch.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::args::{
    CncBuildArgs, CurrentReadingArgs, CycleArgs, MachineArgs, ModelArgs, quantities,
};
use crate::output::{
    Console, Failure, HtmlArgs, Job, Outputs, ResultArgs, exit, progress, write_text,
};
use frictcomp::diagnostic::{Code, Diagnostic};
use frictcomp::lists::{AxisType, ListHead, Points};
use frictcomp::machine::Axis;
use frictcomp::text::{Place, Span};
use frictcomp_host::{FileRegistry, OutputFile, find_plant, memory_for_simulation, tune};
use frictcomp_physics::circle::RemainingGlitch;
use frictcomp_physics::circle::TuningAim;
use frictcomp_physics::circle::{
    Circle, FeedResult, FreeParameter, PlaneAxis, Ranges, Shaping, Task,
};
use frictcomp_physics::simulation::Plant;
use frictcomp_recordings::value_lists::render_tuned;
use frictcomp_report::results::tune::{TuneReport, document, render_json};
use frictcomp_report::{rounded, visible_line};

/// Largest number of circles tuned at once.
const MAX_CIRCLES: usize = 32;

/// Largest number of plants.
const MAX_PLANTS: usize = 16;

/// Find the value lists with the smallest glitch on simulated drives
///
/// Searches `position_delay`, `reversal_lookahead`, `delay_cycles` and `scaling_factor` within
/// their documented ranges for the smallest worst glitch over all circles, then shapes the points
/// of the friction curve below 1 mm/s where that is worth it. On a plant with `[stiction]` it
/// searches MP1511 and MP1512.
#[derive(Debug, Args)]
pub(crate) struct TuneArgs {
    /// The drives: `stiff`, `mid`, `soft`, or a TOML file; several are tuned one after the other
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
        value_parser = quantities::mm_per_min,
        default_value = "500,1000,2000,5000",
        allow_negative_numbers = true
    )]
    feeds: Vec<f64>,
    /// The accelerations v²/R in mm/s², instead of feeds; each feed follows from the radius
    #[arg(
        long,
        value_name = "MM/S2",
        value_delimiter = ',',
        value_parser = quantities::mm_per_s2,
        conflicts_with = "feeds",
        allow_negative_numbers = true
    )]
    accelerations: Vec<f64>,
    /// Search this parameter beyond its documented range
    #[arg(long, value_name = "PARAMETER", value_delimiter = ',')]
    free: Vec<Free>,
    /// The radii in mm, each with every feed
    #[arg(
        long,
        value_name = "MM",
        value_delimiter = ',',
        value_parser = quantities::mm,
        default_value = "100",
        allow_negative_numbers = true
    )]
    radii: Vec<f64>,
    /// Keep the friction curve as it is; do not shape it below 1 mm/s
    #[arg(long)]
    no_shaping: bool,
    /// Find a list that is also good where the contact is half or twice as stiff, or friction differs by
    /// 10 % between the directions
    #[arg(long)]
    robust: bool,
    #[command(flatten)]
    model: ModelArgs,
    #[command(flatten)]
    cycle: CycleArgs,
    #[command(flatten)]
    reading: CurrentReadingArgs,
    #[command(flatten)]
    result: ResultArgs,
    /// Draw the glitch over the feed, before and after tuning, to this SVG file
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    #[command(flatten)]
    html: HtmlArgs,
    #[command(flatten)]
    build: CncBuildArgs,
    /// Write the value list of the first plant to this file; if X and Y have different lists, that of X
    #[arg(long, value_name = "FILE")]
    write_list: Option<PathBuf>,
    /// Write a value list for each axis of the first plant to this folder, named after the axes of
    /// the machine: `X.lis`, `Y.lis`
    #[arg(long, value_name = "FOLDER")]
    into: Option<PathBuf>,
    #[command(flatten)]
    machine: MachineArgs,
}

/// A parameter that may leave its documented range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Free {
    /// Range up to 200 µm.
    #[value(name = "position_delay", alias = "position-delay")]
    PositionDelay,
    /// Range up to 50 cycles.
    #[value(name = "reversal_lookahead", alias = "reversal-lookahead")]
    ReversalLookahead,
    /// Range from 0 to 100 000 µs.
    #[value(name = "mp1511")]
    Mp1511,
    /// Range up to 1000 counting steps.
    #[value(name = "mp1512")]
    Mp1512,
}

/// Runs the command.
pub(crate) fn run(args: &TuneArgs, console: Console) -> Result<u8, Failure> {
    memory_for_simulation()?;
    let circles = circles(args)?;
    if args.plant.len() > MAX_PLANTS {
        let message = format!("{} plants were given", args.plant.len());
        return Err(Failure::new(message).with_help(format!("give at most {MAX_PLANTS}")));
    }
    let registry = FileRegistry::default();
    let plants: Vec<Plant> = args
        .plant
        .iter()
        .map(|name| find_plant(name, &registry))
        .collect::<Result<_, _>>()?;
    if let Some(first) = plants.first()
        && (args.write_list.is_some() || args.into.is_some())
    {
        check_list(first)?;
    }
    let mut job = Job::new(&args.result, &registry, console)?;
    let list = args.write_list.as_deref();
    let list = list
        .map(|path| job.outputs.list("--write-list", path))
        .transpose()?;
    let axis_lists = match &args.into {
        Some(folder) => axis_lists(folder, args, &mut job.outputs, &registry)?,
        None => Vec::new(),
    };
    let job = job
        .with_picture(args.svg.as_deref())?
        .with_page(&args.html)?;
    job.outputs.check()?;
    let mut reports = Vec::new();
    for plant in plants {
        let task = Task {
            plant,
            model: args.model.model(),
            circles: circles.clone(),
            ranges: ranges(&args.free),
            reading: args.reading.reading,
            points: Points::of_build(args.build.cnc_build),
            shaping: if args.no_shaping {
                Shaping::None
            } else {
                Shaping::Allowed
            },
            aim: if args.robust {
                TuningAim::Robust
            } else {
                TuningAim::Plant
            },
        };
        let tuned = tune(&task, &progress::watch())?;
        reports.push(TuneReport::new(&task, tuned));
    }
    if let Some(first) = reports.first() {
        let [x, y] = &first.tuned.axes;
        if let Some(mut file) = list {
            write_text(
                &mut file,
                &render_tuned(first.list_of(x), args.build.cnc_build, &ListHead::default()),
            )?;
            if x != y {
                console.remark("Y has its own list: `--into` writes both");
            }
        }
        for (mut of_axis, axis) in axis_lists.into_iter().zip([x, y]) {
            let text = render_tuned(first.list_of(axis), args.build.cnc_build, &of_axis.head());
            write_text(&mut of_axis.file, &text)?;
        }
    }
    for report in &reports {
        console.show(&worse_than_off(report));
    }
    let document = document(&reports);
    job.finish(&document, || render_json(&reports))?;
    Ok(exit::CLEAN)
}

/// Refuses a plant with stiction compensation, which has no value list to write.
fn check_list(plant: &Plant) -> Result<(), Failure> {
    if [&plant.x, &plant.y].iter().all(|it| it.stiction.is_none()) {
        return Ok(());
    }
    let message = format!(
        "the plant `{}` compensates stiction, which has no value list",
        visible_line(&plant.name)
    );
    let help =
        "enter MP1511 and MP1512 of the report in the control and in `[stiction]` of the plant";
    Err(Failure::new(message).with_help(help))
}

/// The file of an axis's list, and its owner.
struct AxisFile {
    file: OutputFile,
    name: String,
    number: Option<u32>,
}

impl AxisFile {
    fn head(&self) -> ListHead<'_> {
        ListHead {
            number: self.number,
            name: Some(&self.name),
            ..ListHead::default()
        }
    }
}

/// Returns the files of the lists of X and Y, named after the first two linear axes of the machine, if they
/// have no better names: `X.lis`.
fn axis_lists(
    folder: &Path,
    args: &TuneArgs,
    outputs: &mut Outputs,
    registry: &FileRegistry,
) -> Result<Vec<AxisFile>, Failure> {
    let loaded = args.machine.machines(registry).for_folder(Path::new("."))?;
    let linear: Vec<&Axis> = loaded
        .machine
        .axes
        .iter()
        .filter(|axis| axis.axis_type == AxisType::Linear)
        .collect();
    let of = |(at, axis): (usize, PlaneAxis)| {
        let same = linear
            .iter()
            .find(|it| it.name.eq_ignore_ascii_case(axis.as_str()));
        let found = same.or(linear.get(at));
        let name = found.map_or(axis.as_str(), |axis| &axis.name);
        Ok(AxisFile {
            file: outputs.list_in_folder("--into", &folder.join(format!("{name}.lis")))?,
            name: name.to_owned(),
            number: found.and_then(|axis| axis.number),
        })
    };
    PlaneAxis::ALL.into_iter().enumerate().map(of).collect()
}

/// Returns FC506 where compensation is worse than none (R5.25).
fn worse_than_off(report: &TuneReport) -> Vec<Diagnostic> {
    let worse = report.tuned.feeds.iter().filter(|it| it.is_worse());
    let on_a_circle = |it: &FeedResult| {
        format!(
            "at {} mm/min on a radius of {} mm compensation leaves {:.1} µm, more than the {:.1} µm \
             without it",
            rounded(it.feed_mm_per_min),
            rounded(it.radius_mm),
            it.glitch_on_um,
            it.glitch_off_um
        )
    };
    let mut messages: Vec<String> = worse.map(on_a_circle).collect();
    // Between the circles it is reported once, where it is worst (R5.29).
    let between = report.tuned.check.iter().filter(|it| it.is_worse());
    let loss = |it: &RemainingGlitch| it.glitch_on_um - it.glitch_off_um;
    let worst_of_all = between.max_by(|one, other| loss(one).total_cmp(&loss(other)));
    if let Some(it) = worst_of_all.filter(|_| messages.is_empty()) {
        messages.push(format!(
            "at {:.2} mm/s² compensation leaves {:.1} µm, more than the {:.1} µm without it",
            it.acceleration_mm_per_s2, it.glitch_on_um, it.glitch_off_um
        ));
    }
    let tell = |message: String| {
        let place = Place {
            file: report.plant.as_str().into(),
            text: "".into(),
            first_line: 1,
            span: Span::new(0, 0),
        };
        Diagnostic::new(Code::Fc506, place, message)
            .with_help("tune for fewer feeds, or search further with `--free position_delay`")
    };
    messages.into_iter().map(tell).collect()
}

fn circles(args: &TuneArgs) -> Result<Vec<Circle>, Failure> {
    let cycle = args.cycle.seconds()?;
    let cycle_time_s = cycle.unwrap_or(Circle::default().cycle_time_s);
    let of_radius = |&radius_mm: &f64| {
        let circle = move |feed_mm_per_min| Circle {
            radius_mm,
            feed_mm_per_min,
            cycle_time_s,
        };
        let feeds: Vec<f64> = match &args.accelerations[..] {
            [] => args.feeds.clone(),
            given => given
                .iter()
                .map(|it| 60.0 * (it * radius_mm).sqrt())
                .collect(),
        };
        feeds.into_iter().map(circle)
    };
    let possible = f64::MIN_POSITIVE..f64::INFINITY;
    let mut accelerations = args.accelerations.iter();
    if let Some(acceleration) = accelerations.find(|it| !possible.contains(*it)) {
        let message = format!("an acceleration of {acceleration} mm/s² is not possible");
        return Err(Failure::new(message).with_help("give v²/R in mm/s², such as 2.8"));
    }
    let circles: Vec<Circle> = args.radii.iter().flat_map(of_radius).collect();
    if circles.len() > MAX_CIRCLES {
        let message = format!("{} circles were given", circles.len());
        let help = format!("give at most {MAX_CIRCLES} pairs of feed and radius");
        return Err(Failure::new(message).with_help(help));
    }
    Ok(circles)
}

fn ranges(free: &[Free]) -> Ranges {
    free.iter().fold(Ranges::default(), |ranges, free| {
        ranges.free(match free {
            Free::PositionDelay => FreeParameter::PositionDelay,
            Free::ReversalLookahead => FreeParameter::ReversalLookahead,
            Free::Mp1511 => FreeParameter::Mp1511,
            Free::Mp1512 => FreeParameter::Mp1512,
        })
    })
}
