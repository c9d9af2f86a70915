//! `frictcomp ask`: programs that test on the control what its documents leave open, and their answers.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Args, Subcommand};

use crate::args::{
    CncBuildArgs, CycleArgs, MachineArgs, MotionChannels, TorqueChannel, quantities,
};
use crate::output::{Console, Failure, Job, Outputs, ResultArgs, exit, shown};
use frictcomp::text::shown_path;
use frictcomp_host::ask::{AskedAxis, AskedControl, RecordedAnswers, TRAVEL, UnreadAnswer};
use frictcomp_host::{FileRegistry, LoadedMachine};
use frictcomp_recordings::trace::ChannelSelection;
use frictcomp_report::results::ask::{answers_document, document, render_json};
use frictcomp_report::{counted, visible_line};

/// Test on your control what its documents leave open
#[derive(Debug, Subcommand)]
pub(crate) enum AskCommand {
    Write(WriteArgs),
    Read(ReadArgs),
    List(ListArgs),
}

/// Write the NC programs of the tests
///
/// The head of each program says what it tests, what moves, and what to do before and after.
/// Nothing moves farther than `--travel`.
#[derive(Debug, Args)]
pub(crate) struct WriteArgs {
    /// The axis to test; by default the first one with P-AXIS-00522 = 1
    #[arg(long, value_name = "AXIS")]
    axis: Option<String>,
    /// Write the programs to this folder
    #[arg(long, value_name = "FOLDER", default_value = "ask")]
    into: PathBuf,
    /// How far the axis may move, in mm or degrees
    #[arg(long, value_name = "MM", default_value_t = TRAVEL, value_parser = parse_travel)]
    travel: f64,
    #[command(flatten)]
    control: ControlArgs,
}

/// Read the answers of the control, and record them in `frictcomp.toml`
#[derive(Debug, Args)]
pub(crate) struct ReadArgs {
    /// `message.txt` of the control, notes, and recordings in any layout that `frictcomp trace` reads
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// The axis of the recordings; by default the first one with P-AXIS-00522 = 1
    #[arg(long, value_name = "AXIS")]
    axis: Option<String>,
    // The channel of the additive current, by default `frict_comp.output` of the axis.
    #[command(flatten)]
    torque: TorqueChannel,
    #[command(flatten)]
    channels: MotionChannels,
    #[command(flatten)]
    cycle: CycleArgs,
    #[command(flatten)]
    control: ControlArgs,
}

/// List the questions, what is assumed, and what is answered
#[derive(Debug, Args)]
pub(crate) struct ListArgs {
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    control: ControlArgs,
}

/// The control that is asked.
#[derive(Debug, Args)]
struct ControlArgs {
    #[command(flatten)]
    build: CncBuildArgs,
    #[command(flatten)]
    machine: MachineArgs,
}

fn parse_travel(text: &str) -> Result<f64, String> {
    let travel = quantities::mm_or_degrees(text)?;
    let travel = Some(travel).filter(|it| (0.1..=1000.0).contains(it));
    travel.ok_or_else(|| "give a distance from 0.1 to 1000".to_owned())
}

/// Runs the command.
pub(crate) fn run(command: &AskCommand, console: Console) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    match command {
        AskCommand::Write(args) => args.write(&registry, console),
        AskCommand::Read(args) => args.read(&registry, console),
        AskCommand::List(args) => args.list(&registry, console),
    }
}

impl ControlArgs {
    fn loaded(&self, registry: &FileRegistry) -> Result<Arc<LoadedMachine>, Failure> {
        Ok(self.machine.machines(registry).for_folder(Path::new("."))?)
    }

    fn asked<'a>(&self, loaded: &'a LoadedMachine) -> Result<AskedControl<'a>, Failure> {
        Ok(AskedControl::new(loaded, self.build.cnc_build)?)
    }
}

impl WriteArgs {
    fn write(&self, registry: &FileRegistry, console: Console) -> Result<u8, Failure> {
        let mut outputs = Outputs::new(registry, console);
        let loaded = self.control.loaded(registry)?;
        let control = self.control.asked(&loaded)?;
        let axis = AskedAxis {
            travel: self.travel,
            ..control.axis(self.axis.as_deref().unwrap_or(control.usual_axis()))?
        };
        let count = AskedControl::write(&axis, &self.into, outputs.files())?;
        outputs.check()?;
        outputs.finish_quietly()?;
        console.print(&console.fitted(&format!(
            "{} for {} in `{}`: run them on the control as `README.txt` there says, then `frictcomp ask read` what \
             they leave\n",
            counted(count, "program"),
            axis.name,
            shown_path(&self.into)
        )))?;
        if axis.build.is_none() {
            Console::talk(
                "the build of the control is not known, so nothing will be confirmed: give it with `--cnc-build`",
            );
        }
        Ok(exit::CLEAN)
    }
}

impl ListArgs {
    fn list(&self, registry: &FileRegistry, console: Console) -> Result<u8, Failure> {
        let loaded = self.control.loaded(registry)?;
        let build = self.control.asked(&loaded)?.build();
        let (machine, job) = (&loaded.machine, Job::new(&self.result, registry, console)?);
        job.finish(&document(machine, build), || render_json(machine, build))?;
        Ok(exit::CLEAN)
    }
}

impl ReadArgs {
    fn read(&self, registry: &FileRegistry, console: Console) -> Result<u8, Failure> {
        let loaded = self.control.loaded(registry)?;
        let control = self.control.asked(&loaded)?;
        let unread = |path: &Path, UnreadAnswer { line, reason }: &UnreadAnswer| {
            let reason = visible_line(reason);
            Console::talk(&format!("{}:{line}: not an answer: {reason}", shown(path)));
        };
        let read = control.read(&self.files, &self.recorded(&control)?, (registry, unread))?;
        let document = answers_document(&read.answers);
        let mut target = console.stdout();
        target.text(&document.text(console.detail, target.look.width))?;
        if let Some(path) = &read.written {
            console.remark(&format!("wrote `{}`", shown_path(path)));
        }
        if read.lacks_build {
            Console::talk(
                "the build of the control is not known, so nothing is confirmed: give it with `--cnc-build`",
            );
        }
        Ok(exit::CLEAN)
    }

    /// Returns the axis and the channels of recordings.
    fn recorded(&self, control: &AskedControl<'_>) -> Result<RecordedAnswers, Failure> {
        let name = self.axis.as_deref().unwrap_or(control.usual_axis());
        let channels = ChannelSelection {
            torque: self.torque.of_axis(name, &[name])?,
            ..self.channels.of_axis(name, &[name])?
        };
        Ok(RecordedAnswers {
            channels,
            cycle_s: self.cycle.seconds()?,
            axis: name.to_owned(),
        })
    }
}
