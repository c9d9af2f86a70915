//! `frictcomp golden`: compares each program's timeline, or contour, with the agreed one.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;

use crate::args::{
    ExecutionArgs, FolderArgs, MachineArgs, SeverityArgs, SimulationArgs, Tolerance, passed_over,
    say_left_out,
};
use crate::output::{Console, Failure, Failures, Printed, difference, exit, shown};
use frictcomp::interpreter::StopPolicy;
use frictcomp::text::shown_path;
use frictcomp_host::{
    Axes, FileRegistry, GoldenDrift, GoldenFile, GoldenKind, GoldenResults, HostError, Input,
    LeftOutFiles, LoadedMachine, Machines, Naming, SingleRun, drive_contour, find_programs,
    run_alone,
};
use frictcomp_physics::contour::BlockDeviations;
use frictcomp_report::results::contour::{AgreedContour, GoldenContour, agreed_contour};
use frictcomp_report::{
    MessageExtent, Report, Text, TextChange, TextOptions, counted, render_unified,
};

const TIMELINE: GoldenKind = GoldenKind {
    extension: "timeline",
    writer: "golden --update",
};

/// Compare programs with their agreed timelines or contours
///
/// The agreed timeline is the `.timeline` file next to the program. With `--contour`, compares the contour with the `.contour` file next to the program: the
/// deviation of each block and the glitches of its reversals. A figure that changes by no more than the
/// tolerance is as agreed.
#[derive(Debug, Args)]
pub(crate) struct GoldenArgs {
    /// Programs and folders of programs
    #[arg(value_name = "PATH", default_value = ".")]
    paths: Vec<PathBuf>,
    /// Write the timelines, or contours, instead of comparing them
    #[arg(long)]
    update: bool,
    /// Compare contours in place of timelines
    #[arg(long)]
    contour: bool,
    /// How much a figure of a contour may change, in µm; by default 0.5
    #[arg(long, value_name = "UM")]
    tolerance: Option<Tolerance>,
    #[command(flatten)]
    simulation: SimulationArgs,
    /// Print only the differences
    #[arg(long, short)]
    quiet: bool,
    #[command(flatten)]
    severities: SeverityArgs,
    #[command(flatten)]
    folders: FolderArgs,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

/// The programs of one call, their machines, and the agreed results.
struct GoldenRun<'a> {
    args: &'a GoldenArgs,
    machines: Machines,
    registry: FileRegistry,
    agreed: GoldenResults,
    files: Vec<GoldenFile>,
    /// The files that are not taken as programs.
    left_out: LeftOutFiles,
}

/// Runs the command.
pub(crate) fn run(args: &GoldenArgs, console: Console) -> Result<u8, Failure> {
    let console = if args.quiet {
        console.quiet()?
    } else {
        console
    };
    Failures::of(console, |failures| golden(args, console, failures))
}

fn golden(args: &GoldenArgs, console: Console, failures: &mut Failures) -> Result<u8, Failure> {
    if !args.contour {
        Tolerance::refuse_without_contour(args.tolerance)?;
        args.simulation.refuse_without_contour()?;
    }
    let registry = FileRegistry::default();
    let machines = args.machine.weighed(&args.severities, &registry)?;
    let mut machines = machines.selecting(args.folders.options());
    let found = find_programs(&args.paths, |folder| machines.selection(folder));
    failures.extend(Failures::from(found.failures));
    let agreed = GoldenResults::of(args.kind(), &args.paths);
    let mut files = Vec::new();
    for input in &found.inputs {
        input.note(&registry);
        match agreed.beside(input) {
            Ok(file) => files.push(file),
            Err(error) => failures.push(error.into()),
        }
    }
    let programs: Vec<Input> = files.iter().map(|it| it.program.clone()).collect();
    machines.look_ahead(&programs);
    let bench = GoldenRun {
        args,
        machines,
        registry,
        agreed,
        files,
        left_out: found.left_out,
    };
    if args.update {
        bench.update(console, failures)
    } else {
        bench.compare(console, failures)
    }
}

impl GoldenRun<'_> {
    /// Reports the programs that were not looked at, and options that name nothing.
    fn say_beside(&mut self, console: Console) {
        say_left_out(&mut self.left_out, &self.registry, console);
        console.show(&self.left_out.diagnostics(&mut self.machines));
        let machine = &self.args.machine;
        machine.say_unread(&self.machines, &self.registry, console);
    }

    fn compare(mut self, console: Console, failures: &mut Failures) -> Result<u8, Failure> {
        let (mut drifted, mut missing) = (0_u64, 0_u64);
        let mut output = String::new();
        for file in &self.files {
            let (bench, registry) = ((self.args, &mut self.machines), &self.registry);
            let now = |agreed: Option<&str>| result((&file.program, agreed), bench, registry);
            let name = shown(&file.path);
            match self.agreed.compare(file, now) {
                Ok(GoldenDrift::AsAgreed) => {}
                Ok(GoldenDrift::Missing { .. }) => {
                    missing += 1;
                    output += &console.fitted(&format!("{name} is missing\n"));
                }
                Ok(GoldenDrift::Drifted { before, now }) => {
                    drifted += 1;
                    let (agreed, found) = (format!("{name} (agreed)"), format!("{name} (now)"));
                    let change = TextChange {
                        before: (&agreed, &before),
                        after: (&found, &now),
                    };
                    let _ = writeln!(output, "{}", render_unified(change));
                }
                Err(failure) => failures.push(failure),
            }
        }
        let differs = drifted + missing > 0;
        if differs || failures.is_empty() {
            let verdict = self.verdict(drifted, missing);
            let between = if output.is_empty() { "" } else { "\n" };
            output = format!("{}{between}{output}", console.fitted(&verdict));
        }
        if let Printed::Unread = console.print_painted(&output, difference)? {
            return Ok(exit::CLEAN);
        }
        self.say_beside(console);
        Ok(if differs { exit::FOUND } else { exit::CLEAN })
    }

    fn verdict(&self, drifted: u64, missing: u64) -> String {
        let all = self.args.counted(self.files.len());
        let counts = [
            (drifted, ["differs", "differ"]),
            (missing, ["is missing", "are missing"]),
        ];
        let parts = counts.iter().filter(|(count, _)| *count > 0);
        let parts = parts.map(|(count, [one, more])| {
            format!("{count} {}", if *count == 1 { one } else { more })
        });
        match &*parts.collect::<Vec<_>>().join(", ") {
            "" => format!("{all} as agreed{}\n", passed_over(self.left_out.others())),
            parts => format!("{all}: {parts} (`--update` agrees to what is there now)\n"),
        }
    }

    fn update(mut self, console: Console, failures: &mut Failures) -> Result<u8, Failure> {
        let mut written = 0;
        let (args, registry) = (self.args, &self.registry);
        let now = |program: &Input, agreed: Option<&str>| {
            result((program, agreed), (args, &mut self.machines), registry)
        };
        for updated in self.agreed.update::<Failure>(&self.files, registry, now)? {
            for path in &updated.written {
                console.remark(&format!("wrote `{}`", shown_path(path)));
            }
            if updated.failures.is_empty() {
                written += updated.written.len();
                continue;
            }
            let (folder, count) = (shown_path(updated.folder), args.counted(updated.files));
            for failure in updated.failures {
                failures.push(failure);
            }
            Console::talk(&match updated.written.len() {
                0 => format!("left out `{folder}`: none of its {count} was written"),
                some => format!("`{folder}`: {some} of its {count} written"),
            });
            written += updated.written.len();
        }
        self.say_beside(console);
        let (all, beside) = (
            self.args.counted(self.files.len()),
            passed_over(self.left_out.others()),
        );
        console.remark(&format!("{written} of {all} written{beside}"));
        Ok(exit::CLEAN)
    }
}

impl GoldenArgs {
    fn kind(&self) -> GoldenKind {
        if !self.contour {
            return TIMELINE;
        }
        GoldenKind {
            extension: "contour",
            writer: "golden --contour --update",
        }
    }

    fn counted(&self, count: usize) -> String {
        counted(count, self.kind().extension)
    }
}

/// Returns the result of one program, keeping the agreed figures where the tolerance allows it.
fn result(
    (program, agreed): (&Input, Option<&str>),
    (args, machines): (&GoldenArgs, &mut Machines),
    registry: &FileRegistry,
) -> Result<String, Failure> {
    let loaded = machines.for_folder(program.folder())?;
    if args.contour {
        let contour = contour(program, (args, &loaded), registry)?;
        let tolerance_um = args.tolerance.unwrap_or_default().um();
        Ok(agreed.map_or_else(
            || contour.to_string(),
            |agreed| contour.keeping(agreed, tolerance_um),
        ))
    } else {
        Ok(timeline(program, &loaded, &args.execution)?)
    }
}

/// Returns the contour of one program, the same in every folder.
fn contour(
    program: &Input,
    (args, loaded): (&GoldenArgs, &LoadedMachine),
    registry: &FileRegistry,
) -> Result<AgreedContour, Failure> {
    let simulation = &args.simulation;
    let of = (loaded, Naming::FileName);
    let setup = simulation.setup(of, &args.execution, registry)?;
    let contour = drive_contour(program, loaded, &setup, |_| BlockDeviations::default())?;
    let subject = GoldenContour {
        program: program.name(Naming::FileName),
        plant: simulation.plant().to_owned(),
        start: simulation.start.given().to_vec(),
    };
    Ok(agreed_contour(contour, &subject))
}

/// Returns the timeline of one program, the same on every machine and in every folder.
fn timeline(
    program: &Input,
    loaded: &LoadedMachine,
    execution: &ExecutionArgs,
) -> Result<String, HostError> {
    let mut bytes = Vec::new();
    let options = TextOptions::default().with_messages(MessageExtent::Code);
    let mut report = Text::new(&mut bytes, options);
    let alone = SingleRun {
        options: execution.options(loaded, StopPolicy::FirstError),
        naming: Naming::FileName,
        axes: Axes::Ahead,
    };
    run_alone(program, loaded, alone, &mut report)?;
    report.finish().map_err(HostError::Output)?;
    drop(report);
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
