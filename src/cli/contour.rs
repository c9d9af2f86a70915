//! `frictcomp contour`: where on the part compensation is missing.

use std::path::PathBuf;
use std::sync::Arc;

use clap::{Args, ValueEnum};

use super::console::{Console, Target};
use super::cycle::CycleArgs;
use super::execution::ExecutionArgs;
use super::exit;
use super::failure::Failure;
use super::machine::{MachineArgs, remark, value_list};
use super::outputs::{Outputs, write_text};
use super::result::ResultArgs;
use super::start::StartArgs;
use crate::contour::{
    ContourAxis, ContourOptions, MovingAxes, NoContour, ProgramContour, parameterise,
};
use crate::diagnostic::{Diagnostic, Severity};
use crate::host::{
    Alone, Axes, Done, Input, Ledger, LoadedMachine, Naming, OutputFile, find_plant, run_alone,
};
use crate::motion::{PlannerOptions, check_cycle};
use crate::report::contour::{
    ContourRecorder, ContourSubject, document, render_text, summary_record,
};
use crate::report::html::render_contour;
use crate::report::pictures::ContourPicture;
use crate::report::svg::Frame;
use crate::session::{Motions, SessionOptions, StopPolicy};
use crate::simulation::FrictionModel;

/// Show where on the part compensation is missing: drive the path of a program with simulated axes
///
/// The path is driven three times: with friction compensation as the program switches it, with all
/// of it on, and with all of it off. Each reversal of an axis is listed with its glitch.
#[derive(Debug, Args)]
pub(super) struct ContourArgs {
    /// The program
    #[arg(value_name = "PROGRAM")]
    program: PathBuf,
    /// The axes of the plane, `XY` or `X1,Y1`; by default `XY`
    #[arg(long, value_name = "AXES", default_value = "XY")]
    plane: String,
    /// The machine: `stiff`, `mid`, `soft`, or a TOML file
    #[arg(long, value_name = "PLANT", default_value = "stiff")]
    plant: String,
    /// The friction model
    #[arg(long, default_value = "lugre")]
    model: FrictionModel,
    /// The compensation value list of an axis, in place of the machine's
    #[arg(long, value_name = "AXIS=FILE", value_parser = parse_list)]
    value_list: Vec<(String, PathBuf)>,
    #[command(flatten)]
    start: StartArgs,
    #[command(flatten)]
    cycle: CycleArgs,
    /// The largest number of CNC cycles
    #[arg(long, value_name = "N", default_value_t = PlannerOptions::default().max_cycles)]
    #[arg(value_parser = clap::value_parser!(u64).range(1..))]
    max_cycles: u64,
    #[command(flatten)]
    result: ResultArgs<Format>,
    /// Draw the path with its magnified deviation, and the deviation over time, to this SVG file
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Write an HTML report with the picture, the figures and the reversals to this file
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Exit with status 1 if a cutting move deviates by more, in µm
    #[arg(long, value_name = "UM")]
    fail_above: Option<f64>,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

/// A format of the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum Format {
    /// Figures and sentences for people.
    #[default]
    Text,
    /// One JSON document with every reversal and block.
    Json,
    /// One line a reversal, then the figures.
    Ndjson,
    /// One row a reversal.
    Csv,
}

fn parse_list(text: &str) -> Result<(String, PathBuf), String> {
    match text.split_once('=') {
        Some((axis, path)) if !axis.is_empty() && !path.is_empty() => {
            Ok((axis.trim().to_owned(), path.into()))
        }
        _ => Err("write the axis and the file, `X=comp_x.lis`".to_owned()),
    }
}

/// Runs the command.
pub(super) fn run(args: &ContourArgs, console: Console) -> Result<u8, Failure> {
    let input = args.input()?;
    let ledger = Ledger::default();
    input.note(&ledger);
    let mut outputs = Outputs::new(&ledger, console);
    let mut result = outputs.result(args.result.output.as_deref())?;
    let mut pictures = Pictures {
        svg: outputs.optional("--svg", args.svg.as_deref())?,
        html: outputs.optional("--html", args.html.as_deref())?,
    };
    let mut machines = args.machine.machines(&ledger);
    machines.look_ahead(std::slice::from_ref(&input));
    let mut loaded = machines.for_folder(input.folder())?.as_ref().clone();
    if let Some(remark) = remark(&loaded) {
        Console::talk(&remark);
    }
    let session = args.session(&loaded)?;
    let axes = args.axes((&input, &session), &loaded, &ledger)?;
    parameterise(&mut loaded.machine, &axes);
    outputs.check()?;
    let planner = args.planner(&loaded)?;
    let options = ContourOptions::new(axes)
        .with_planner(planner)
        .with_model(args.model);
    let watch = Arc::clone(&loaded.watch);
    let watching = move |time_s: f64| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // shown only
        watch.show(|| Done::Cycles((time_s / planner.cycle_s) as u64));
    };
    let recorder = args.recorder(&options, (&mut result, &pictures), &watching);
    let mut contour = ProgramContour::new(&loaded.machine, options, recorder);
    run_alone(&input, &loaded, alone(session), &mut contour)?;
    contour.finish();
    check(&mut contour)?;
    let subject = ContourSubject {
        program: input.name(Naming::AsGiven),
        plant: args.plant.clone(),
    };
    pictures.draw(&mut contour, &subject)?;
    let text = match args.result.format {
        Format::Text => render_text(&mut contour, &subject),
        Format::Json => document(&mut contour),
        Format::Ndjson => {
            let mut record = summary_record(&contour);
            record["record"] = "summary".into();
            format!("{record}\n")
        }
        Format::Csv => String::new(),
    };
    let worst = contour.deviations().programmed.max_um();
    let said = said(&contour, &loaded);
    let has_moved = contour.machine_time_s() > 0.0;
    drop(contour);
    result.text(&text)?;
    outputs.finish()?;
    console.show(&said);
    if !has_moved {
        Console::talk(
            "no motion was driven: program absolute positions and F first, or say with `--start \
             X0,Y0` where the axes stand",
        );
    }
    args.machine.say_unread(&ledger, console);
    let failed = said.iter().any(|said| said.severity == Severity::Error);
    let deviates = args
        .fail_above
        .is_some_and(|limit| worst > limit || !has_moved);
    Ok(if failed || deviates {
        exit::FOUND
    } else {
        exit::CLEAN
    })
}

/// What ends a contour before the program ends.
fn check(contour: &mut ProgramContour<ContourRecorder<'_>>) -> Result<(), Failure> {
    if let Some(error) = contour.sink().take_error()
        && error.kind() != std::io::ErrorKind::BrokenPipe
    {
        return Err(Failure::output(error));
    }
    if contour.is_unstable() {
        return Err(Failure::new(format!(
            "the simulated drives are unstable after {:.3} s of the program",
            contour.machine_time_s()
        ))
        .with_help("check gains and masses of the plant"));
    }
    Ok(())
}

/// The pictures that are asked for.
struct Pictures {
    svg: Option<OutputFile>,
    html: Option<OutputFile>,
}

impl Pictures {
    fn draw(
        &mut self,
        contour: &mut ProgramContour<ContourRecorder<'_>>,
        subject: &ContourSubject,
    ) -> Result<(), Failure> {
        let Some(picture) = contour.sink().take_picture() else {
            return Ok(());
        };
        let chart = picture.chart(&subject.program);
        if let Some(svg) = &mut self.svg {
            write_text(svg, &chart.render(Frame::Alone))?;
        }
        if let Some(html) = &mut self.html {
            render_contour((contour, subject), &chart, html).map_err(Failure::output)?;
        }
        Ok(())
    }
}

impl ContourArgs {
    fn input(&self) -> Result<Input, Failure> {
        if self
            .fail_above
            .is_some_and(|limit| limit < 0.0 || limit.is_nan())
        {
            return Err(Failure::new(
                "`--fail-above` is a deviation in µm, 0 or more",
            ));
        }
        let input = Input::new(&self.program);
        if input == Input::Stdin {
            return Err(Failure::new(
                "standard input can be read only once, and a contour needs the program twice",
            )
            .with_help("name a file"));
        }
        input.probe()?;
        Ok(input)
    }

    /// What is kept or written while the contour is made.
    fn recorder<'a>(
        &self,
        options: &ContourOptions,
        (result, pictures): (&'a mut Target, &Pictures),
        watch: &'a (dyn Fn(f64) + Sync),
    ) -> ContourRecorder<'a> {
        let names: Vec<String> = options.axes.iter().map(|axis| axis.name.clone()).collect();
        let plane = [names[0].clone(), names[1].clone()];
        let mut recorder = ContourRecorder::new(names, watch);
        recorder = match self.result.format {
            Format::Text if pictures.html.is_none() => recorder,
            Format::Text | Format::Json => recorder.keeping_all(),
            Format::Ndjson => recorder.writing_ndjson(&mut result.writer),
            Format::Csv => recorder.writing_csv(&mut result.writer),
        };
        if pictures.svg.is_some() || pictures.html.is_some() {
            recorder = recorder.drawing(ContourPicture::new(plane));
        }
        recorder
    }

    fn session(&self, loaded: &LoadedMachine) -> Result<SessionOptions, Failure> {
        let mut session = self.execution.options(loaded, StopPolicy::FirstError);
        session.run.motions = Motions::Taken;
        session.start = self.start.positions(&loaded.machine)?;
        Ok(session)
    }

    /// The cycle of the command line, else that of the machine.
    fn planner(&self, loaded: &LoadedMachine) -> Result<PlannerOptions, Failure> {
        let of_machine = loaded.machine.cycle_time_ms.map(|ms| ms / 1000.0);
        let cycle = self.cycle.seconds()?.or(of_machine);
        Ok(PlannerOptions {
            cycle_s: check_cycle(cycle.unwrap_or(PlannerOptions::default().cycle_s))?,
            max_cycles: self.max_cycles,
        })
    }

    /// The axes to drive: a first run finds those that move.
    fn axes(
        &self,
        (input, session): (&Input, &SessionOptions),
        loaded: &LoadedMachine,
        ledger: &Ledger,
    ) -> Result<Vec<ContourAxis>, Failure> {
        let mut moving = MovingAxes::default();
        run_alone(input, loaded, alone(session.clone()), &mut moving)?;
        let plant = find_plant(&self.plant, ledger)?;
        let given = self.value_list.iter().map(|(axis, path)| {
            let list = value_list(path, ledger)?;
            Ok((axis.clone(), path.display().to_string(), list))
        });
        let given: Vec<_> = given.collect::<Result<_, Failure>>()?;
        let axes = moving
            .driven(&loaded.machine, plane(&self.plane)?, &plant, &given)
            .map_err(|error| no_contour(&error))?;
        if let Some((axis, ..)) = given
            .iter()
            .find(|(axis, ..)| axes.iter().all(|it| it.name != *axis))
        {
            return Err(Failure::new(format!(
                "`--value-list {axis}=…`: the contour drives no axis `{axis}`"
            )));
        }
        Ok(axes)
    }
}

/// `XY`, or `X1,Y1` for names of several letters.
fn plane(text: &str) -> Result<[&str; 2], Failure> {
    let pair = match text.split_once(',') {
        Some((first, second)) => Some([first.trim(), second.trim()]),
        None if text.chars().count() == 2 => {
            let second = text.char_indices().nth(1).map_or(0, |(at, _)| at);
            Some([&text[..second], &text[second..]])
        }
        None => None,
    };
    pair.ok_or_else(|| {
        Failure::new(format!("`--plane {text}` does not name two axes"))
            .with_help("write `--plane XY`, or `--plane X1,Y1`")
    })
}

fn no_contour(error: &NoContour) -> Failure {
    let help = match error {
        NoContour::NoAxis(unknown) => unknown.help("its axes are"),
        _ => None,
    };
    let failure = Failure::new(error.to_string());
    match help {
        Some(help) => failure.with_help(help),
        None => failure,
    }
}

fn alone(options: SessionOptions) -> Alone {
    Alone {
        options,
        naming: Naming::AsGiven,
        axes: Axes::AsTheyOccur,
    }
}

/// What there is to say: errors of the program, remarks on the trace.
fn said(contour: &ProgramContour<ContourRecorder<'_>>, loaded: &LoadedMachine) -> Vec<Diagnostic> {
    let (errors, remarks) = contour.diagnostics();
    let mut said = errors.to_vec();
    for remark in remarks {
        if let Some(severity) = loaded.levels.severity(remark.code) {
            let mut remark = remark.clone();
            remark.severity = severity;
            said.push(remark);
        }
    }
    said
}
