//! `frictcomp commission plan`: the measuring programs (R16.1, R16.8).

use std::path::{Path, PathBuf};

use clap::Args;

use crate::args::{ByAxis, MachineArgs, PerAxis, ResultArgs, ResultFormat, quantities, value_list};
use crate::output::{Console, Failure, Outputs, exit, shown, write_text};
use frictcomp::comp::Kind;
use frictcomp::machine::{Axis, Machine};
use frictcomp_host::{FileRegistry, Replaces, read_text, sha256_of};
use frictcomp_physics::motion::AxisLimits;
use frictcomp_recordings::commission::{
    Dynamics, FreeTravel, Installed, MeasuredAxis, Plan, PlanError, PlanFile, PlanRequest, Stage,
    ValueListUsed,
};
use frictcomp_report::commission::{
    PlanReport, render_file, render_json, render_program, render_readme, render_text,
};
use frictcomp_report::{fitted, visible_line};

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
        default_value_t = 0.2,
        value_parser = quantities::speed_of_axis,
        allow_negative_numbers = true
    )]
    slowest: f64,
    /// The feed of all motions that are not measured, in mm/min or °/min
    #[arg(
        long,
        value_name = "MM/MIN",
        default_value_t = 1000.0,
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
    let loaded = args
        .machine
        .machines(&registry)
        .for_folder(Path::new("."))?;
    if loaded.machine.channel.inch {
        let message = "the coordinates of the machine are in inch (P-CHAN-00054 is 1), and what G71 does there is not \
                       documented";
        let help = "the programs are metric; a machine whose programs say G70 themselves is planned as any other, \
                    its travel in mm";
        return Err(Failure::new(message).with_help(help));
    }
    let axes = args
        .axis
        .iter()
        .map(|name| args.measured(name, &loaded.machine));
    let axes = axes.collect::<Result<Vec<_>, _>>()?;
    let machine = match &loaded.origin {
        Some(origin) => shown(origin),
        None => "the command line".to_owned(),
    };
    let lists = args.lists(&registry)?;
    let stage = if lists.is_empty() {
        Stage::Off
    } else {
        Stage::On
    };
    let round = round(args.into.as_deref(), &lists);
    let request = PlanRequest {
        axes,
        feeds: args.feeds.clone(),
        approach: args.approach,
        radius: args.radius,
        slowest: args.slowest,
        round,
    };
    let assumed = loaded
        .machine
        .axes
        .iter()
        .filter(|it| args.axis.contains(&it.name) && AxisLimits::of(it).assumed.jerk);
    let report = PlanReport {
        plan: Plan::new(&request, stage)?,
        lists,
        machine,
        assumed_jerk: assumed.map(|it| it.name.clone()).collect(),
    };
    let mut outputs = Outputs::new(&registry, console);
    let mut target = outputs.result(args.result.output.as_deref())?;
    if let Some(folder) = &args.into {
        write((folder, round), &report, (&mut outputs, console))?;
    }
    outputs.check()?;
    target.text(&match args.result.format {
        ResultFormat::Text => fitted(&render_text(&report), target.look.width),
        ResultFormat::Json => render_json(&report),
    })?;
    outputs.finish()?;
    Ok(exit::CLEAN)
}

/// Writes the files of the folder.
fn write(
    (folder, round): (&Path, u16),
    report: &PlanReport,
    (outputs, console): (&mut Outputs, Console),
) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|error| Failure::writing(folder, error))?;
    let plan = folder.join(plan_name(round));
    let is_other = read_text(&plan).is_ok_and(|there| there != render_file(report));
    if is_other && console.replaces(Replaces::Results) == Replaces::Results {
        let message = format!("`{}` holds another plan", shown(&plan));
        let help = "its recordings would count for the new plan; plan in another folder, or use `--force` if there \
                    are none";
        return Err(Failure::new(message).with_help(help));
    }
    let pages = [
        ("README.txt".to_owned(), render_readme(report)),
        (plan_name(round), render_file(report)),
    ];
    let programs = report.plan.programs.iter();
    let programs = programs.map(|it| (it.file.clone(), render_program(report, it)));
    for (name, text) in programs.chain(pages) {
        let mut file = outputs.file("--into", &folder.join(name))?;
        write_text(&mut file, &text)?;
    }
    Ok(())
}

/// Returns the file name of the plan of a round.
pub(super) fn plan_name(round: u16) -> String {
    format!("plan-{round}.json")
}

/// Reads the plan in a file; `None` if there is none that this version understands.
fn plan_in(path: &Path) -> Option<PlanFile> {
    serde_json::from_str(&read_text(path).ok()?).ok()
}

/// Returns the round of a plan: 1 without lists; with lists the one that already has them, or the next that is not
/// in the folder.
fn round(folder: Option<&Path>, lists: &[ValueListUsed]) -> u16 {
    if lists.is_empty() {
        return 1;
    }
    let sums = |lists: &[ValueListUsed]| {
        let pairs = lists.iter().map(|it| (it.axis.clone(), it.sha256.clone()));
        pairs.collect::<Vec<_>>()
    };
    let is_free = |round: &u16| {
        let path = folder.map(|it| it.join(plan_name(*round)));
        let Some(path) = path.filter(|it| it.exists()) else {
            return true;
        };
        plan_in(&path).is_some_and(|it| sums(&it.lists) == sums(lists))
    };
    (2..u16::MAX).find(is_free).unwrap_or(u16::MAX)
}

impl PlanArgs {
    /// Returns an axis as the machine describes it, with its travel.
    fn measured(&self, name: &str, machine: &Machine) -> Result<MeasuredAxis, Failure> {
        let found = machine.axes.iter().find(|it| it.name == name);
        let axis = found
            .filter(|it| !it.is_spindle())
            .ok_or_else(|| unknown(name, machine))?;
        let limits = AxisLimits::of(axis);
        let lacking = [
            ("max_velocity", limits.assumed.velocity),
            ("max_acceleration", limits.assumed.acceleration),
        ];
        if let Some((key, _)) = lacking.into_iter().find(|(_, is_assumed)| *is_assumed) {
            let message = format!("`{key}` of axis `{}` is not known", visible_line(name));
            let help = "give it in `frictcomp.toml`, or the axis list with `--startup`: the way to accelerate \
                        has to fit into the travel";
            return Err(Failure::new(message).with_help(help));
        }
        let followers = machine.gantry_slaves.iter();
        let followers = followers.filter(|it| it.master.as_deref() == Some(name));
        Ok(MeasuredAxis {
            name: name.to_owned(),
            axis_type: axis.axis_type,
            travel: self.travel_of(name)?,
            dynamics: Dynamics {
                velocity_per_s: limits.velocity_per_s,
                acceleration_per_s2: limits.acceleration_per_s2,
                jerk_per_s3: limits.jerk_per_s3,
            },
            installed: installed(axis),
            pitch: self.pitch_of(name)?,
            followers: followers.map(|it| it.name.clone()).collect(),
        })
    }

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
            let end = |text: &str| text.trim().parse().ok().filter(|it: &f64| it.is_finite());
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

    /// Returns the lists of stage 2, one for each axis, each read as the control reads it.
    fn lists(&self, registry: &FileRegistry) -> Result<Vec<ValueListUsed>, Failure> {
        if self.value_list.is_empty() {
            return Ok(Vec::new());
        }
        let lists = ByAxis {
            option: "--value-list",
            given: &self.value_list,
            axes: &self.names(),
        };
        let of_axis = |axis: &String| {
            let path = lists.required(axis)?;
            value_list(path, registry)?;
            Ok(ValueListUsed {
                axis: axis.clone(),
                file: shown(path),
                sha256: sha256_of(path)?,
            })
        };
        self.axis.iter().map(of_axis).collect()
    }

    /// Returns the distance over which the torque of an axis repeats.
    fn pitch_of(&self, axis: &str) -> Result<Option<f64>, Failure> {
        let pitches = ByAxis {
            option: "--pitch",
            given: &self.pitch,
            axes: &self.names(),
        };
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

/// Returns the state of friction compensation at the start of the control.
fn installed(axis: &Axis) -> Installed {
    if !axis.configured.contains(Kind::Frict) {
        Installed::Unconfigured
    } else if axis.manual.contains(Kind::Frict) {
        Installed::Off
    } else {
        Installed::On
    }
}

fn unknown(name: &str, machine: &Machine) -> Failure {
    let axes = machine.axes.iter().filter(|it| !it.is_spindle());
    let axes: Vec<&str> = axes.map(|it| it.name.as_str()).collect();
    let message = format!(
        "the machine has no linear or rotary axis `{}`",
        visible_line(name)
    );
    Failure::new(message).with_help(format!("its axes are {}", axes.join(", ")))
}

impl From<PlanError> for Failure {
    fn from(error: PlanError) -> Self {
        Self::new(error.to_string()).with_help(error.help())
    }
}
