//! `frictcomp contour`: where on the part compensation is missing.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::args::{ExecutionArgs, MachineArgs, SimulationArgs, quantities, remark};
use crate::output::{Console, DataTarget, Failure, Files, Outputs, ResultArgs, exit, write_text};
use frictcomp::diagnostic::{Diagnostic, Severity};
use frictcomp_host::{
    FileRegistry, Input, LoadedMachine, Naming, NoDrivenContour, OutputFile, drive_contour,
};
use frictcomp_physics::contour::{ContourLimits, ContourOptions, ProgramContour};
use frictcomp_report::html::render_contour;
use frictcomp_report::pictures::ContourPicture;
use frictcomp_report::results::contour::{
    ContourRecorder, ContourSubject, contour_remarks, document, limit_remarks, render_json,
    render_summary, why_not_judged,
};
use frictcomp_report::svg::Frame;

/// Show where on the part compensation is missing
///
/// The path of the program is driven with simulated axes, three times: with friction compensation as the program switches it, with all
/// of it on, and with all of it off. Each reversal of an axis is listed with its glitch.
#[derive(Debug, Args)]
pub(crate) struct ContourArgs {
    /// The program
    #[arg(value_name = "PROGRAM")]
    program: PathBuf,
    #[command(flatten)]
    simulation: SimulationArgs,
    #[command(flatten)]
    result: ResultArgs<ContourFormat>,
    /// Draw the path with its magnified deviation, and the deviation over time, to this SVG file
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Write an HTML report with the picture, the figures and the reversals to this file
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Exit with status 1 if a cutting move deviates by more, in µm, or if the contour is not judged
    #[arg(long, value_name = "UM", value_parser = quantities::um)]
    fail_above: Option<f64>,
    /// Exit with status 1 if missing compensation costs more, in µm, or if the contour is not judged:
    /// the deviation as programmed less the one with all of it on
    #[arg(long, value_name = "UM", value_parser = quantities::um)]
    fail_above_due: Option<f64>,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

/// A format of the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum ContourFormat {
    /// Figures and sentences for people.
    #[default]
    Text,
    /// One JSON document with every reversal and block.
    Json,
    /// One line per reversal, then the figures.
    Ndjson,
    /// One row per reversal.
    Csv,
}

/// Runs the command.
pub(crate) fn run(args: &ContourArgs, console: Console) -> Result<u8, Failure> {
    let input = args.input()?;
    let limits = args.limits()?;
    let registry = FileRegistry::default();
    input.note(&registry);
    let mut outputs = Outputs::new(&registry, console);
    let mut result = outputs.result(args.result.output.as_deref())?;
    let mut pictures = Pictures {
        svg: outputs.optional("--svg", args.svg.as_deref())?,
        html: outputs.optional("--html", args.html.as_deref())?,
    };
    let mut machines = args.machine.machines(&registry);
    machines.look_ahead(std::slice::from_ref(&input));
    let loaded = machines.for_folder(input.folder())?;
    if let Some(remark) = remark(&loaded) {
        Console::talk(&remark);
    }
    let simulation = &args.simulation;
    let setup = simulation.setup((&loaded, Naming::AsGiven), &args.execution, &registry)?;
    outputs.check()?;
    let width = result.look.width;
    let target = &mut result;
    let mut contour = drive_contour(&input, &loaded, &setup, |options| {
        args.recorder(options, (target, &pictures))
    })?;
    check(&mut contour)?;
    let subject = ContourSubject {
        program: input.name(Naming::AsGiven),
        plant: simulation.plant().to_owned(),
    };
    pictures.draw(&mut contour, &subject)?;
    let text = match args.result.format {
        ContourFormat::Text => document(&mut contour, &subject).text(console.detail, width),
        ContourFormat::Json => render_json(&mut contour, &limits),
        ContourFormat::Ndjson => render_summary(&contour, &limits),
        ContourFormat::Csv => String::new(),
    };
    let said = said(&contour, &loaded);
    let has_moved = contour.machine_time_s() > 0.0;
    // A row has no place for remarks on the whole program.
    let remarks = match args.result.format {
        ContourFormat::Csv if limits.any() => contour_remarks(&contour, console.detail),
        ContourFormat::Csv => [
            why_not_judged(&contour),
            contour_remarks(&contour, console.detail),
        ]
        .concat(),
        _ => Vec::new(),
    };
    let exceeded = limit_remarks(&contour, &limits);
    drop(contour);
    result.text(&text)?;
    outputs.finish()?;
    console.show(&said);
    if !has_moved {
        Console::talk(
            "no motion was driven: program absolute positions and F first, or give the axis \
             positions with `--start X0,Y0`",
        );
    }
    remarks
        .iter()
        .chain(&exceeded)
        .for_each(|line| Console::talk(line));
    args.machine.say_unread(&machines, &registry, console);
    let failed = said.iter().any(|said| said.severity == Severity::Error);
    Ok(if failed || !exceeded.is_empty() {
        exit::FOUND
    } else {
        exit::CLEAN
    })
}

/// Checks for a reason to stop a contour before the program ends.
fn check(contour: &mut ProgramContour<ContourRecorder<'_>>) -> Result<(), Failure> {
    match contour.sink().take_error() {
        Some(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::output(error))
        }
        _ => Ok(()),
    }
}

/// The requested pictures.
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
        if let Some(svg) = &mut self.svg {
            let chart = picture.clone().chart(&subject.heading(contour));
            write_text(svg, &chart.render(Frame::Alone))?;
        }
        if let Some(html) = &mut self.html {
            render_contour((contour, subject), &picture, &mut Files, html)
                .map_err(Failure::output)?;
        }
        Ok(())
    }
}

impl ContourArgs {
    fn input(&self) -> Result<Input, Failure> {
        let input = Input::new(&self.program);
        if input == Input::Stdin {
            return Err(NoDrivenContour::OnlyOnce.into());
        }
        input.probe()?;
        Ok(input)
    }

    fn limits(&self) -> Result<ContourLimits, Failure> {
        let options = [
            ("--fail-above", self.fail_above),
            ("--fail-above-due", self.fail_above_due),
        ];
        for (option, limit) in options {
            if limit.is_some_and(|limit| limit < 0.0 || limit.is_nan()) {
                return Err(Failure::new(format!(
                    "`{option}` is a limit in µm, 0 or more"
                )));
            }
        }
        Ok(ContourLimits {
            deviation_um: self.fail_above,
            due_um: self.fail_above_due,
        })
    }

    /// Returns the recorder of the parts kept or written while the contour is made.
    fn recorder<'a>(
        &self,
        options: &ContourOptions,
        (result, pictures): (&'a mut DataTarget, &Pictures),
    ) -> ContourRecorder<'a> {
        let names: Vec<String> = options.axes.iter().map(|axis| axis.name.clone()).collect();
        let plane = [names[0].clone(), names[1].clone()];
        let mut recorder = ContourRecorder::new(names);
        recorder = match self.result.format {
            ContourFormat::Text if pictures.html.is_none() => recorder,
            ContourFormat::Text | ContourFormat::Json => recorder.keeping_all(),
            ContourFormat::Ndjson => recorder.writing_ndjson(&mut result.writer),
            ContourFormat::Csv => recorder.writing_csv(&mut result.writer),
        };
        if pictures.svg.is_some() || pictures.html.is_some() {
            recorder = recorder.drawing(ContourPicture::new(plane));
        }
        recorder
    }
}

/// Returns the messages: errors of the program, remarks on the trace.
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
