//! `frictcomp ask`: programs that test on the control what its documents leave open, and their answers.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Args, Subcommand};
use serde_json::{Value, json};

use crate::args::{
    CncBuildArgs, CycleArgs, MachineArgs, MotionChannels, ResultArgs, ResultFormat, TorqueChannel,
    quantities,
};
use crate::output::{Console, Failure, Outputs, exit, shown, write_text};
use frictcomp::comp::CncBuild;
use frictcomp::diagnostic::Severity;
use frictcomp::machine::Machine;
use frictcomp::readings::{Basis, Question};
use frictcomp::text::shown_path;
use frictcomp_host::ask::{
    Answer, AnswerVerdict, AnsweredReading, AskedAxis, RecordedQuestions, UnreadAnswer, ask,
    date_of, read_answers, read_recorded_answers, readme, with_findings,
};
use frictcomp_host::{
    CONFIG_NAME, FileRegistry, HostError, LoadedMachine, MendedFile, read_text, write_mended,
    write_new,
};
use frictcomp_recordings::trace::ChannelSelection;
use frictcomp_report::{Headline, Standing, counted, fitted, visible_line};

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
    // That of the additive current, by default `frict_comp.output` of the axis.
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

/// The usual distance that an axis may move, in mm or degrees.
const TRAVEL: f64 = 10.0;

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
        AskCommand::List(args) => args.list(Outputs::new(&registry, console), &registry),
    }
}

impl ControlArgs {
    /// Returns the machine; an error in its description is a failure.
    fn loaded(&self, registry: &FileRegistry) -> Result<Arc<LoadedMachine>, Failure> {
        let mut machines = self.machine.machines(registry);
        let loaded = machines.for_folder(Path::new("."))?;
        let mut said = loaded.diagnostics.iter();
        if said.any(|it| it.severity == Severity::Error) {
            let mut failure = Failure::new("the description of the machine has errors");
            failure.diagnostics.clone_from(&loaded.diagnostics);
            return Err(failure);
        }
        Ok(loaded)
    }

    fn build(&self, machine: &Machine) -> Option<CncBuild> {
        self.build.cnc_build.or(machine.build)
    }

    fn asked(&self, name: &str, machine: &Machine) -> AskedAxis {
        let found = machine.find(name);
        AskedAxis {
            name: name.to_owned(),
            number: found.and_then(|axis| machine.axis(axis).number),
            index: found.map_or(0, frictcomp::comp::AxisIndex::get),
            build: self.build(machine),
            travel: TRAVEL,
        }
    }

    fn axis(&self, given: Option<&str>, machine: &Machine) -> Result<AskedAxis, Failure> {
        let frict = frictcomp::comp::Kind::Frict;
        let mut axes = machine.axes.iter();
        let configured = axes.find(|axis| axis.configured.contains(frict));
        let name = given.or_else(|| configured.map(|axis| axis.name.as_str()));
        let name = name.unwrap_or("X");
        if machine.find(name).is_none() {
            let names: Vec<&str> = machine.axes.iter().map(|it| it.name.as_str()).collect();
            return Err(Failure::new(format!("the machine has no axis `{name}`"))
                .with_help(format!("its axes are {}", names.join(", "))));
        }
        Ok(self.asked(name, machine))
    }
}

impl WriteArgs {
    fn write(&self, registry: &FileRegistry, console: Console) -> Result<u8, Failure> {
        let mut outputs = Outputs::new(registry, console);
        let loaded = self.control.loaded(registry)?;
        let axis = AskedAxis {
            travel: self.travel,
            ..self.control.axis(self.axis.as_deref(), &loaded.machine)?
        };
        let folder = &self.into;
        fs::create_dir_all(folder).map_err(|error| Failure::writing(folder, error))?;
        let files = Question::ALL.into_iter();
        let files: Vec<_> = files.flat_map(|question| ask(question, &axis)).collect();
        for file in &files {
            let mut target = outputs.file("--into", &folder.join(&file.name))?;
            write_text(&mut target, &file.text)?;
        }
        let mut target = outputs.file("--into", &folder.join("README.txt"))?;
        write_text(&mut target, &readme(&axis))?;
        outputs.check()?;
        outputs.finish_quietly()?;
        console.print(&console.fitted(&format!(
            "{} for {} in `{}`: run them on the control as `README.txt` there says, then `frictcomp ask read` what \
             they leave\n",
            counted(files.len(), "program"),
            axis.name,
            shown_path(folder)
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
    fn list(&self, mut outputs: Outputs, registry: &FileRegistry) -> Result<u8, Failure> {
        let loaded = self.control.loaded(registry)?;
        let machine = &loaded.machine;
        let build = self.control.build(machine);
        let mut target = outputs.result(self.result.output.as_deref())?;
        outputs.check()?;
        let width = target.look.width;
        target.text(&match self.result.format {
            ResultFormat::Text => fitted(&listed(machine, build), width),
            ResultFormat::Json => {
                let questions = Question::ALL.into_iter();
                let questions: Vec<Value> = questions.map(|it| record(it, machine)).collect();
                let headline = headline(machine, build);
                let list = json!({ "schema": 1, "headline": headline, "questions": questions });
                format!("{list:#}\n")
            }
        })?;
        outputs.finish()?;
        Ok(exit::CLEAN)
    }
}

impl ReadArgs {
    /// Returns the answers in a file: lines of a text, or what a recording shows.
    fn answers_in(&self, path: &Path, machine: &Machine) -> Result<Vec<Answer>, Failure> {
        const LINES: &str = "answers are lines that begin with `frictcomp-ask`, as in `message.txt`, or a recording";
        let (answers, unread) =
            read_answers(&read_text(path)?, |name| self.control.asked(name, machine));
        for UnreadAnswer { line, reason } in &unread {
            let reason = visible_line(reason);
            Console::talk(&format!("{}:{line}: not an answer: {reason}", shown(path)));
        }
        if !answers.is_empty() {
            return Ok(answers);
        }
        if !unread.is_empty() {
            return Err(Failure::new(format!("`{}` holds no answer", shown(path))).with_help(LINES));
        }
        let of_machine = machine.cycle_time_ms.map(|ms| ms / 1000.0);
        let axis = self.control.axis(self.axis.as_deref(), machine)?;
        let name = axis.name.as_str();
        let selection = self.channels.of_axis(name, &[name])?;
        let lead_mm = machine.axes.iter().find(|it| it.name == axis.name);
        let asked = RecordedQuestions {
            axis: &axis,
            machine,
            selection: &ChannelSelection {
                torque: self.torque.of_axis(name, &[name])?,
                lead_mm: selection
                    .lead_mm
                    .or(lead_mm.and_then(|it| it.motor_lead_mm)),
                ..selection
            },
            cycle_s: self.cycle.seconds()?.or(of_machine),
        };
        read_recorded_answers(path, asked).map_err(|error| Failure::from(error).with_help(LINES))
    }

    fn read(&self, registry: &FileRegistry, console: Console) -> Result<u8, Failure> {
        let loaded = self.control.loaded(registry)?;
        let mut answers = Vec::new();
        let mut findings = Vec::new();
        for path in &self.files {
            registry.reads("answers", path);
            let changed = fs::metadata(path).and_then(|it| it.modified());
            let date = date_of(changed.map_err(|error| HostError::read(path, error))?);
            for answer in self.answers_in(path, &loaded.machine)? {
                if let AnswerVerdict::Reading(reading) = answer.verdict {
                    findings.push(AnsweredReading {
                        question: answer.question,
                        reading,
                        build: self
                            .control
                            .build
                            .cnc_build
                            .or(answer.build)
                            .or(loaded.machine.build),
                        date: date.clone(),
                    });
                }
                answers.push(answer);
            }
        }
        let contradictions = contradictions(&answers);
        if let Some(question) = contradictions.first() {
            let rule = question.facts().rule;
            return Err(
                Failure::new(format!("the answers to {rule} contradict each other")).with_help(
                    "give the files of one control, and one at a time to see which it is",
                ),
            );
        }
        drop_what_is_answered(&mut answers);
        console.print(&console.fitted(&told(&answers)))?;
        let path = configuration(&loaded);
        remember(&path, &findings)?;
        if !findings.is_empty() {
            console.remark(&format!("wrote `{}`", shown_path(&path)));
        }
        if findings.iter().any(|finding| finding.build.is_none()) {
            Console::talk(
                "the build of the control is not known, so nothing is confirmed: give it with `--cnc-build`",
            );
        }
        Ok(exit::CLEAN)
    }
}

/// Drops what one file does not decide but another one does.
fn drop_what_is_answered(answers: &mut Vec<Answer>) {
    let decided: Vec<Question> = answers
        .iter()
        .filter(|answer| answer.verdict != AnswerVerdict::Undecidable)
        .map(|answer| answer.question)
        .collect();
    answers.retain(|answer| {
        answer.verdict != AnswerVerdict::Undecidable || !decided.contains(&answer.question)
    });
    answers.sort_by_key(|answer| answer.question);
}

/// Returns the configuration that the answers go into.
fn configuration(loaded: &LoadedMachine) -> PathBuf {
    let origin = loaded.origin.as_deref();
    let own = origin.filter(|path| path.extension().is_some_and(|it| it == "toml"));
    own.map_or_else(|| PathBuf::from(CONFIG_NAME), Path::to_owned)
}

fn remember(path: &Path, findings: &[AnsweredReading]) -> Result<(), Failure> {
    if findings.is_empty() {
        return Ok(());
    }
    let is_new = !path.exists();
    let before = if is_new {
        String::new()
    } else {
        read_text(path)?
    };
    let after = with_findings(&before, findings)
        .map_err(|error| Failure::new(format!("{}: {error}", shown_path(path))))?;
    if is_new {
        return Ok(write_new(path, &after)?);
    }
    Ok(write_mended([&MendedFile {
        path: path.to_owned(),
        bytes: after.clone().into_bytes(),
        before,
        after,
        changes: findings.len(),
    }])?)
}

/// Returns the questions with contradictory answers.
fn contradictions(answers: &[Answer]) -> Vec<Question> {
    let decided = |answer: &&Answer| answer.verdict != AnswerVerdict::Undecidable;
    let mut found = Vec::new();
    for answer in answers.iter().filter(decided) {
        let mut others = answers.iter().filter(decided);
        if others.any(|it| it.question == answer.question && it.verdict != answer.verdict) {
            found.push(answer.question);
        }
    }
    found
}

/// Returns the answers in words; a reason for several undecidable ones is reported once.
fn told(answers: &[Answer]) -> String {
    let undecided = |it: &&Answer| it.verdict == AnswerVerdict::Undecidable;
    let undecided = answers.iter().filter(undecided).count();
    let answered = match answers.len() - undecided {
        0 => "no question answered".to_owned(),
        answered => format!("{} answered", counted(answered, "question")),
    };
    let left = match undecided {
        0 => String::new(),
        left => format!(", {left} left open"),
    };
    let mut text = format!("{answered}{left}\n\n");
    let is_alike = |one: &Answer, other: &Answer| {
        one.verdict == AnswerVerdict::Undecidable
            && one.verdict == other.verdict
            && (&one.axis, one.build, &one.evidence) == (&other.axis, other.build, &other.evidence)
    };
    for alike in answers.chunk_by(is_alike) {
        let answer = &alike[0];
        let question = answer.question;
        let rules: Vec<_> = alike.iter().map(|it| it.question.facts().rule).collect();
        let reading = match answer.verdict {
            AnswerVerdict::Reading(reading) => format!(": {}", question.name_of(reading)),
            AnswerVerdict::Undecidable => String::new(),
        };
        let build = answer.build.map_or(String::new(), |it| format!(" on {it}"));
        let _ = writeln!(text, "{} {}{reading}", rules.join(", "), answer.word());
        let _ = writeln!(text, "  axis {}{build}: {}", answer.axis, answer.evidence);
    }
    text
}

/// Returns the basis of the reading in force, in words.
fn basis(question: Question, machine: &Machine, build: Option<CncBuild>) -> String {
    let readings = &machine.readings;
    let name = readings.name(question);
    match readings.basis(question, build) {
        Basis::Confirmed(it) => format!("{name}, confirmed on {} ({})", it.build, it.date),
        Basis::Selected => format!("{name}, selected, not confirmed on this build"),
        Basis::Assumed if readings.of(question).is_none() => "open, taken as unknown".to_owned(),
        Basis::Assumed => format!("{name}, assumed"),
    }
}

/// Returns the verdict: how many questions the control has answered.
fn headline(machine: &Machine, build: Option<CncBuild>) -> Headline {
    let bases = Question::ALL.map(|it| machine.readings.basis(it, build));
    let confirmed = bases.iter().filter(|it| matches!(it, Basis::Confirmed(_)));
    let selected = bases.iter().filter(|it| matches!(it, Basis::Selected));
    let (confirmed, selected) = (confirmed.count(), selected.count());
    let assumed = bases.len() - confirmed - selected;
    let cure = if confirmed < bases.len() {
        "; `frictcomp ask write` writes the programs that ask the control"
    } else {
        ""
    };
    let text = format!(
        "{}: {confirmed} confirmed, {selected} selected, {assumed} assumed{cure}",
        counted(bases.len(), "question")
    );
    Headline::new(Standing::Plain, text)
}

fn listed(machine: &Machine, build: Option<CncBuild>) -> String {
    let mut text = format!("{}\n\n", headline(machine, build));
    for question in Question::ALL {
        let facts = question.facts();
        let _ = writeln!(text, "{} {}", facts.rule, facts.question);
        let _ = writeln!(text, "  reading: {}", basis(question, machine, build));
        let _ = writeln!(text, "  depends on it: {}", facts.depends);
        let _ = writeln!(text, "  asked by {}: {}", facts.way.as_str(), facts.how);
    }
    text
}

fn record(question: Question, machine: &Machine) -> Value {
    let facts = question.facts();
    let confirmation = machine.readings.confirmation(question);
    json!({
        "rule": facts.rule,
        "question": facts.question,
        "readings": facts.readings,
        "assumed": facts.assumed_name(),
        "reading": machine.readings.name(question),
        "confirmed": confirmation.map(|it| json!({ "build": it.build.to_string(), "date": it.date })),
        "way": facts.way.as_str(),
        "depends": facts.depends,
        "how": facts.how,
    })
}
