//! `frictcomp run`: programs one after the other in one session of the control.

use std::cell::RefCell;
use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::console::{Console, Target};
use super::execution::ExecutionArgs;
use super::fail_on::FailOn;
use super::failure::Failure;
use super::html::HtmlFile;
use super::listing::explain;
use super::machine::{MachineArgs, remark};
use super::outputs::Outputs;
use super::quiet::Quiet;
use super::settings;
use super::severities::SeverityArgs;
use super::start::StartArgs;
use crate::comp::KindSet;
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::host::{
    AxesAhead, Input, Ledger, LoadedMachine, Naming, Played, Programs, StateFile, Surroundings,
    open_session, run_programs, switched_axes,
};
use crate::machine::{AxisSet, Setting};
use crate::report::html::RunDigest;
use crate::report::{
    Blocks, Csv, Json, Ndjson, Report, Runs, Text, TextOptions, View, command_line,
};
use crate::session::{Session, StopPolicy, undescribed};
use crate::timeline::{Record, Sink};

/// Run programs one after the other in one session of the control and print the timeline
///
/// Each program starts with the state that the one before it leaves.
#[derive(Debug, Args)]
// Each is a switch of its own on the command line.
#[allow(clippy::struct_excessive_bools)]
pub(super) struct RunArgs {
    /// The programs, `-` for standard input
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Start with the state saved in this file, and save the state to it at the end
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Treat a failing command as if it were not there, and continue
    #[arg(long)]
    keep_going: bool,
    /// Print only blocks with a change or a message
    #[arg(long, conflicts_with = "full")]
    changes: bool,
    /// Show all blocks; do not fold those without a change
    #[arg(long)]
    full: bool,
    /// Print only the messages that count for the exit status
    #[arg(long, short, conflicts_with_all = ["changes", "full", "format", "columns"])]
    quiet: bool,
    /// The kinds of compensation to show: `FRICT,LEAD` or `all`
    #[arg(long, value_name = "KINDS", default_value = "FRICT", value_parser = settings::parse_kinds)]
    kinds: KindSet,
    /// The format of the timeline
    #[arg(long, default_value = "text")]
    format: Format,
    /// Additional columns for the CSV timeline
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',')]
    columns: Vec<Column>,
    /// Write the timeline to this file
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Also write an HTML report with charts and the annotated source to this file
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// The lowest severity that gives exit status 1
    #[arg(long, value_name = "SEVERITY", default_value = "error")]
    fail_on: FailOn,
    #[command(flatten)]
    severities: SeverityArgs,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    start: StartArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

/// A format of the timeline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum Format {
    /// For people.
    #[default]
    Text,
    /// One JSON object per line.
    Ndjson,
    /// One JSON document.
    Json,
    /// One row per block.
    Csv,
}

/// Columns that a CSV timeline has only where they are asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Column {
    /// The position of each axis after the block.
    Position,
}

impl RunArgs {
    fn report(&self, target: Target) -> Box<dyn Report> {
        let view = View {
            kinds: self.kinds,
            blocks: if self.changes {
                Blocks::Changed
            } else {
                Blocks::All
            },
        };
        if self.quiet {
            return Box::new(Quiet::new(target, self.fail_on));
        }
        let Target { writer, look } = target;
        match self.format {
            Format::Text => {
                let runs = if self.full { Runs::Full } else { Runs::Folded };
                Box::new(Text::new(writer, TextOptions { view, runs, look }))
            }
            Format::Ndjson => Box::new(Ndjson::new(writer, view)),
            Format::Json => Box::new(Json::new(writer, view)),
            Format::Csv if self.columns.contains(&Column::Position) => {
                Box::new(Csv::new(writer, view).with_positions())
            }
            Format::Csv => Box::new(Csv::new(writer, view)),
        }
    }

    /// What the user gave for the run, for the HTML report.
    fn given(&self, loaded: &LoadedMachine) -> Vec<(String, String)> {
        let mut given = Vec::new();
        let mut say = |name: &str, value: String| given.push((name.to_owned(), value));
        match &loaded.origin {
            Some(path) => say("machine", path.display().to_string()),
            None => say("machine", "not configured".to_owned()),
        }
        if !self.machine.enable.is_empty() {
            say("--enable", self.machine.enable.join(", "));
        }
        for (name, setting) in &loaded.settings {
            let value = match setting {
                Setting::Number(number) => number.to_string(),
                Setting::Text(text) => format!("\"{text}\""),
            };
            say("variable", format!("{name} = {value}"));
        }
        match &self.state {
            Some(path) => say("--state", path.display().to_string()),
            None => say(
                "state at start",
                "that of a restart of the control".to_owned(),
            ),
        }
        for (axis, position) in self.start.given() {
            say("--start", format!("{axis} at {position}"));
        }
        let policy = if self.keep_going {
            "the command is passed over (--keep-going)"
        } else {
            "the session stops, as the control does"
        };
        say("at an error", policy.to_owned());
        given
    }

    /// Says which options have no effect with the others (R9.71).
    fn check_options(&self) -> Result<(), Failure> {
        if !self.columns.is_empty() && self.format != Format::Csv {
            return Err(Failure::new("`--columns` belongs to `--format csv`"));
        }
        if self.full && self.format != Format::Text {
            return Err(Failure::new("`--full` has no effect with this `--format`")
                .with_help("only text folds blocks: leave `--full` out"));
        }
        Ok(())
    }

    fn stop_policy(&self) -> StopPolicy {
        if self.keep_going {
            StopPolicy::KeepGoing
        } else {
            StopPolicy::FirstError
        }
    }
}

/// What is set up before the first program runs.
struct Start<'a> {
    programs: Programs<'a>,
    loaded: &'a LoadedMachine,
    session: Session,
}

/// Runs the command.
pub(super) fn run(args: &RunArgs, console: Console) -> Result<u8, Failure> {
    args.check_options()?;
    let console = if args.quiet { console.quiet() } else { console };
    let inputs: Vec<Input> = args.files.iter().map(|path| Input::new(path)).collect();
    for input in &inputs {
        input.probe()?;
    }
    let ledger = Ledger::default();
    for input in &inputs {
        input.note(&ledger);
    }
    let mut outputs = Outputs::new(&ledger, console);
    let target = outputs.result(args.output.as_deref())?;
    let html = outputs.optional("--html", args.html.as_deref())?;
    let mut html = html.map(|file| HtmlFile::new(file, args.kinds));
    let mut machines = args.machine.weighed(&args.severities, &ledger)?;
    machines.look_ahead(&inputs);
    if let Some(path) = args.state.as_deref() {
        // Another run of the same machine may bring the programs that name the others.
        machines.expect_more(StateFile::axes(path));
    }
    let loaded = machines.for_folder(inputs[0].folder())?;
    if let Some(remark) = remark(&loaded) {
        console.remark(&remark);
    }
    if args.format == Format::Csv {
        // A row is a block: the lists have no row.
        for error in loaded.errors() {
            let place = &error.place;
            Console::talk(&format!(
                "{}:{}: error[{}] {}",
                place.file,
                place.start(),
                error.code,
                error.message
            ));
        }
    }
    if let Some(path) = args.state.as_deref() {
        outputs.claim_state(path);
    }
    outputs.check()?;
    let state = args.state.as_deref().map(StateFile::lock).transpose()?;
    let mut options = args.execution.options(&loaded, args.stop_policy());
    options.start = args.start.positions(&loaded.machine)?;
    if !loaded.machine.is_described() {
        options.switched = switched_axes(&inputs);
    }
    if args.format == Format::Csv {
        // A row is a block: the remark has no row.
        if let Some(remark) = undescribed(&loaded.machine, &options.switched) {
            Console::talk(&remark.in_words(Some(command_line)));
        }
    }
    let (mut session, changed) = open_session(&loaded, options, state.as_ref())?;
    if loaded.machine.axis_set == AxisSet::AsTheyOccur {
        session.expect_axes(AxesAhead::of(&inputs, []).names());
    }
    let said: Vec<Diagnostic> = loaded.errors().chain(&changed).cloned().collect();
    let mut start = Start {
        programs: Programs {
            inputs: &inputs,
            said: &said,
        },
        loaded: &loaded,
        session,
    };
    let report = args.report(target);
    let given = args.given(&loaded);
    let (played, hint) = play(&mut start, report, html.as_mut())?;
    let Some(played) = played else {
        // The reader has seen enough; a run that was cut short leaves nothing.
        return Ok(super::exit::CLEAN);
    };
    if let Some(html) = html {
        html.write(&given, &loaded)?;
    }
    if let (true, Some(file)) = (played.flow.is_continue(), &state) {
        outputs.save(file, &start.session.save())?;
    }
    outputs.finish()?;
    args.machine.say_unread(&ledger, console);
    if let (Format::Text, Some(code)) = (args.format, hint) {
        console.remark(&explain(code));
    }
    let status = args.fail_on.status(start.session.counts());
    // Programs that did not run are no all-clear, whatever kept them from it.
    let unrun = (played.unrun > 0).then_some(super::exit::FOUND);
    Ok(status.max(unrun.unwrap_or_default()))
}

/// Runs the programs; `None` where nobody read the timeline to its end, and there is no other output.
fn play(
    start: &mut Start<'_>,
    report: Box<dyn Report>,
    html: Option<&mut HtmlFile>,
) -> Result<(Option<Played>, Option<Code>), Failure> {
    let shared = RefCell::new(report);
    let goes_on_alone = html.is_some();
    let mut sink = Listeners {
        report: &shared,
        html: html.map(HtmlFile::digest),
        most_severe: None,
    };
    // Between two reads of a program no record is on its way.
    let before_waiting = || {
        // A writer that takes no more says so at the next record.
        let _ = shared.borrow_mut().flush();
    };
    let surroundings = Surroundings::new(start.loaded, Naming::AsGiven);
    let surroundings = surroundings.before_waiting(&before_waiting);
    let session = &mut start.session;
    let played = run_programs(session, start.programs, &surroundings, &mut sink);
    let said = sink.most_severe.map(|(_, code)| code);
    let mut report = shared.into_inner();
    report.finish().map_err(Failure::output)?;
    if report.is_closed() && !goes_on_alone {
        return Ok((None, None));
    }
    let played = played?;
    if played.unrun > 0 {
        say_unrun(played.unrun, &start.session);
    }
    Ok((Some(played), said))
}

/// Says why programs did not run.
fn say_unrun(left: usize, session: &Session) {
    let programs = if left == 1 { "program" } else { "programs" };
    let failed = session.counts().contains_key(&Severity::Error);
    Console::talk(&if failed {
        format!(
            "the error stopped the session: {left} more {programs} did not run \
             (`--keep-going` continues after errors)"
        )
    } else {
        format!("the last program did not reach its end: {left} more {programs} did not run")
    });
}

/// The timeline, shared with who flushes it, and the digest for the HTML report.
struct Listeners<'a> {
    report: &'a RefCell<Box<dyn Report>>,
    html: Option<&'a mut RunDigest>,
    /// The first of the most severe diagnostics.
    most_severe: Option<(Severity, Code)>,
}

impl Listeners<'_> {
    fn weigh<'d>(&mut self, said: impl IntoIterator<Item = &'d Diagnostic>) {
        for diagnostic in said {
            if self
                .most_severe
                .is_none_or(|(most, _)| diagnostic.severity > most)
            {
                self.most_severe = Some((diagnostic.severity, diagnostic.code));
            }
        }
    }
}

impl Sink for Listeners<'_> {
    /// A reader of the timeline that has seen enough ends the run, unless there is a report.
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Block(row) => {
                self.weigh(row.diagnostics);
            }
            Record::End(end) => self.weigh(end.notes.iter().map(|note| &note.diagnostic)),
            _ => {}
        }
        let flow = self.report.borrow_mut().record(record);
        match &mut self.html {
            Some(digest) => digest.record(record),
            None => flow,
        }
    }
}
