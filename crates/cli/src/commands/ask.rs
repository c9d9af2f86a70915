//! `frictcomp ask`: programs that test on the control what its documents leave open, and their answers.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Args, Subcommand};

use crate::args::{
    CncBuildArgs, CycleArgs, MachineArgs, MotionChannels, TorqueChannel, quantities,
};
use crate::output::{Console, Failure, Job, Outputs, ResultArgs, exit};
use frictcomp::text::shown_path;
use frictcomp_host::ask::{AskedControl, RecordedAnswers, TRAVEL};
use frictcomp_host::{FileRegistry, LoadedMachine};
use frictcomp_recordings::evidence::UnreadAnswer;
use frictcomp_recordings::trace::ChannelSelection;
use frictcomp_report::results::ask::{AnswersReport, WrittenPrograms, document, render_json};
use frictcomp_report::visible_line;

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
    #[arg(long, value_name = "MM", default_value_t = TRAVEL, value_parser = quantities::mm_or_degrees)]
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
    result: ResultArgs,
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
        let axis = control.axis(control.axis_name(self.axis.as_deref()))?;
        let axis = axis.within(self.travel)?;
        let programs = AskedControl::write(&axis, &self.into, outputs.files())?;
        outputs.check()?;
        outputs.finish_quietly()?;
        let written = WrittenPrograms {
            axis: &axis.name,
            travel: axis.travel,
            build: axis.build,
            folder: shown_path(&self.into),
            programs,
        };
        let mut target = console.stdout();
        target.text(&written.document().text(console.detail, target.look.width))?;
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
        let mut unread = Vec::new();
        let say = |line: &UnreadAnswer| {
            let (file, reason) = (visible_line(&line.file), visible_line(&line.reason));
            Console::talk(&format!("{file}:{}: not an answer: {reason}", line.line));
            unread.push(line.clone());
        };
        let read = control.read(&self.files, &self.recorded(&control)?, (registry, say))?;
        let job = Job::new(&self.result, registry, console)?;
        job.outputs.check()?;
        let configuration = control.configuration();
        let is_kept = read.keep(&configuration)?;
        let configuration = shown_path(&configuration);
        let report = AnswersReport {
            answers: &read.answers,
            unread,
            recorded_in: is_kept.then(|| configuration.clone()),
            lacks_build: read.lacks_build(),
        };
        job.finish(&report.document(), || report.render_json())?;
        if is_kept {
            console.remark(&format!("wrote `{configuration}`"));
        }
        if report.lacks_build {
            Console::talk(
                "the build of the control is not known, so nothing is confirmed: give it with `--cnc-build`",
            );
        }
        Ok(exit::CLEAN)
    }

    /// Returns the axis and the channels of recordings.
    fn recorded(&self, control: &AskedControl<'_>) -> Result<RecordedAnswers, Failure> {
        let name = control.axis_name(self.axis.as_deref());
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
