//! `frictcomp commission plan`: the measuring programs (R16.1, R16.8).

use std::path::{Path, PathBuf};

use clap::Args;

use crate::args::{ByAxis, MachineArgs, PerAxis, quantities, value_list};
use crate::output::{Console, Failure, Job, ResultArgs, exit};
use frictcomp_host::FileRegistry;
use frictcomp_host::commission::{AxisToMeasure, Planning};
use frictcomp_recordings::commission::FreeTravel;
use frictcomp_report::results::commission::{plan_document, plan_texts, render_json};
use frictcomp_report::visible_line;

/// Write the NC programs that measure friction, and a page for the operator
///
/// Stage 1 runs with friction compensation off: constant speeds of each axis and circles of both, or
/// strokes of one axis alone. With `--value-list` it is stage 2: the circles again and two of the speeds,
/// with these lists on. Every motion stays within the inner 90 % of `--travel`, its acceleration included;
/// velocity and acceleration are those of the machine.
#[derive(Debug, Args)]
pub(crate) struct PlanArgs {
    /// The axes: two linear ones, or one alone
    #[arg(long, value_name = "AXES", value_delimiter = ',', required = true)]
    axis: Vec<String>,
    /// The free travel of each axis, in mm or degrees: `X0..300,Y-50..150`
    #[arg(
        long,
        value_name = "AXIS FROM..TO",
        value_delimiter = ',',
        required = true
    )]
    #[arg(allow_hyphen_values = true)]
    travel: Vec<String>,
    /// The feeds of circles or strokes in mm/min or °/min, at least four over a decade
    #[arg(long, value_name = "MM/MIN", value_delimiter = ',', required = true)]
    #[arg(value_parser = quantities::feed_of_axis, allow_negative_numbers = true)]
    feeds: Vec<f64>,
    /// The radius of the circles in mm; by default 100, or the largest that fits
    #[arg(long, value_name = "MM", value_parser = quantities::mm, allow_negative_numbers = true)]
    radius: Option<f64>,
    /// The distance over which the torque repeats, such as the pitch: `X=10,Y=10`; each run covers it
    #[arg(long, value_name = "AXIS=MM", value_delimiter = ',')]
    pitch: Vec<PerAxis>,
    /// The slowest speed in mm/s or °/s
    #[arg(
        long,
        value_name = "MM/S",
        default_value_t = Planning::SLOWEST,
        value_parser = quantities::speed_of_axis,
        allow_negative_numbers = true
    )]
    slowest: f64,
    /// The feed of all motions that are not measured, in mm/min or °/min
    #[arg(
        long,
        value_name = "MM/MIN",
        default_value_t = Planning::APPROACH,
        value_parser = quantities::feed_of_axis,
        allow_negative_numbers = true
    )]
    approach: f64,
    /// The value list that is on in stage 2, of every axis or `X=comp_x.lis`
    #[arg(long, value_name = "LIST")]
    value_list: Vec<PerAxis>,
    #[command(flatten)]
    result: ResultArgs,
    /// Write the programs, `README.txt` and `plan-1.json` to this folder; stage 2 has `plan-2.json`, and one more for
    /// each further set of lists
    #[arg(long, value_name = "FOLDER")]
    into: Option<PathBuf>,
    #[command(flatten)]
    machine: MachineArgs,
}

/// Runs the command.
pub(crate) fn run(args: &PlanArgs, console: Console) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    let axes = args.axis.iter().map(|name| {
        Ok(AxisToMeasure {
            name: name.clone(),
            travel: args.travel_of(name)?,
            pitch: args.pitch_of(name)?,
        })
    });
    let planning = Planning {
        axes: axes.collect::<Result<_, Failure>>()?,
        feeds: args.feeds.clone(),
        approach: args.approach,
        radius: args.radius,
        slowest: args.slowest,
        lists: args.lists(&registry)?,
        folder: args.into.as_deref(),
        registry: &registry,
    };
    let mut machines = args.machine.machines(&registry);
    let loaded = machines.for_folder(Path::new("."))?;
    let report = planning.plan(&loaded)?;
    let mut job = Job::new(&args.result, &registry, console)?;
    planning.write(&report, plan_texts(&report), job.outputs.files())?;
    job.finish(&plan_document(&report), || render_json(&report))?;
    Ok(exit::CLEAN)
}

impl PlanArgs {
    /// Returns the travel of an axis: `X0..300` or `X=0..300`.
    fn travel_of(&self, name: &str) -> Result<FreeTravel, Failure> {
        let of_axis = |text: &&String| {
            let rest = text.trim().strip_prefix(name);
            rest.is_some_and(|rest| {
                rest.starts_with(['=', '-', '+', '.'])
                    || rest.starts_with(|it: char| it.is_ascii_digit())
            })
        };
        let written =
            || format!("write the travel that is free in mm or degrees, `--travel {name}0..300`");
        let mut given = self.travel.iter().filter(of_axis);
        let (Some(text), None) = (given.next(), given.next()) else {
            let message = format!(
                "`--travel` has to give the travel of `{}` once",
                visible_line(name)
            );
            return Err(Failure::new(message).with_help(written()));
        };
        let ends = text.trim().strip_prefix(name).unwrap_or_default();
        let ends = ends.strip_prefix('=').unwrap_or(ends).split_once("..");
        let ends = ends.and_then(|(low, high)| {
            let end = |text: &str| quantities::mm_or_degrees(text).ok();
            Some(FreeTravel {
                low: end(low)?,
                high: end(high)?,
            })
        });
        ends.ok_or_else(|| {
            let message = format!("`{}` is not a travel range", visible_line(text));
            Failure::new(message).with_help(written())
        })
    }

    /// Returns the lists of stage 2, one for each axis, and reports where one has remarks.
    fn lists(&self, registry: &FileRegistry) -> Result<Vec<PathBuf>, Failure> {
        if self.value_list.is_empty() {
            return Ok(Vec::new());
        }
        let names = self.names();
        let lists = ByAxis::new("--value-list", &self.value_list, &names);
        let of_axis = |axis: &String| {
            let path = lists.required(axis)?;
            value_list(path, registry)?;
            Ok(path.to_owned())
        };
        self.axis.iter().map(of_axis).collect()
    }

    /// Returns the distance over which the torque of an axis repeats.
    fn pitch_of(&self, axis: &str) -> Result<Option<f64>, Failure> {
        let names = self.names();
        let pitches = ByAxis::new("--pitch", &self.pitch, &names);
        let pitch = pitches.channel(axis)?;
        let pitch = pitch.map(|it| quantities::mm_or_degrees(&it)).transpose();
        pitch.map_err(|error| {
            Failure::new(format!("`--pitch` of `{}`: {error}", visible_line(axis)))
        })
    }

    fn names(&self) -> Vec<&str> {
        self.axis.iter().map(String::as_str).collect()
    }
}
