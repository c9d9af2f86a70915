//! `frictcomp run`: programs one after the other in one session of the control.

mod listeners;

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::args::{
    ExecutionArgs, FailOn, FailOnArgs, MachineArgs, SeverityArgs, StartArgs, explain, remark,
    settings, values,
};
use crate::output::{Console, DataTarget, Failure, FileWatch, HtmlFile, Outputs};
use frictcomp::comp::KindSet;
use frictcomp::diagnostic::{Code, Diagnostic, Severity};
use frictcomp::interpreter::{SearchedBlock, StopPolicy};
use frictcomp::session::{Session, undescribed};
use frictcomp_host::{
    ChangedPrograms, FileRegistry, Input, LoadedMachine, Naming, Programs, RunContext, RunSummary,
    StateFile, expect_axes, is_source, open_session, processors, run_programs, switched_axes,
};
use frictcomp_report::html::GivenForRun;
use frictcomp_report::{
    Blocks, Positions, Report, Runs, TextOptions, TimelineFormat, TimelineOptions, View,
    command_line, concise_line,
};
use listeners::{Listeners, Quiet, SharedReport};

/// Show what is active, block by block, and what is left at the end
///
/// Runs programs one after the other in one session of the control. Each program starts with the state that the one before it leaves.
#[derive(Debug, Args)]
#[command(mut_arg("fail_on", |it| it.default_value("error")))]
// Each is a separate switch on the command line.
#[allow(clippy::struct_excessive_bools)]
pub(crate) struct RunArgs {
    /// The programs, `-` for standard input
    #[arg(required = true, value_name = "PROGRAM")]
    files: Vec<PathBuf>,
    /// Start with the state saved in this file, and save the state to it at the end
    #[arg(long, value_name = "FILE")]
    state: Option<PathBuf>,
    /// Start the program at a block, by its number (`N100`) or its line (`12`), after a block search:
    /// nothing moves before it, and whether the COMP commands before it act is not documented, so both
    /// readings are shown
    #[arg(long, value_name = "BLOCK")]
    from: Option<SearchedBlock>,
    /// Treat a failing command as if it were not there, and continue
    #[arg(long)]
    keep_going: bool,
    /// Print only blocks with a change or a message
    #[arg(long, visible_alias = "changes-only", conflicts_with = "full")]
    changes: bool,
    /// Show all blocks; do not fold those without a change
    #[arg(long)]
    full: bool,
    /// Print only the messages that count for the exit status, then the verdict
    #[arg(long, short, conflicts_with_all = ["changes", "full", "format", "columns"])]
    quiet: bool,
    /// The kinds of compensation to show: `FRICT,LEAD` or `all`
    #[arg(long, value_name = "KINDS", default_value = "FRICT", value_parser = settings::parse_kinds)]
    kinds: KindSet,
    /// The format of the timeline
    #[arg(long, default_value = "text", value_parser = values::timeline_format())]
    format: TimelineFormat,
    /// Additional columns for the CSV timeline
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',')]
    columns: Vec<TimelineColumn>,
    /// Write the timeline to this file
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Also write an HTML report with charts and the annotated source to this file
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Run again after each save of a program, a list or the configuration that the run reads
    #[arg(long, conflicts_with_all = ["state", "output", "html"])]
    watch: bool,
    #[command(flatten)]
    fail_on: FailOnArgs,
    #[command(flatten)]
    severities: SeverityArgs,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    start: StartArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

/// Columns of the CSV timeline that are written only on request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum TimelineColumn {
    /// The position of each axis after the block.
    Position,
}

impl RunArgs {
    fn report(&self, target: DataTarget) -> Box<dyn Report> {
        if self.quiet {
            return Box::new(Quiet::new(target, self.fail_on()));
        }
        let blocks = if self.changes {
            Blocks::Changed
        } else {
            Blocks::All
        };
        let runs = if self.full { Runs::Full } else { Runs::Folded };
        let positions = if self.columns.contains(&TimelineColumn::Position) {
            Positions::Shown
        } else {
            Positions::Hidden
        };
        let view = View {
            kinds: self.kinds,
            blocks,
        };
        let look = target.look;
        let options = TimelineOptions {
            text: TextOptions::default()
                .with_view(view)
                .with_runs(runs)
                .with_look(look),
            positions,
        };
        self.format.report(target.writer, options)
    }

    /// Returns the user's options of the run, for the HTML report.
    fn given<'a>(&'a self, loaded: &'a LoadedMachine) -> GivenForRun<'a> {
        GivenForRun {
            machine: loaded.origin.as_deref(),
            enabled: &self.machine.enable,
            variables: &loaded.settings,
            state: self.state.as_deref(),
            start: self.start.given(),
            stop: self.stop_policy(),
        }
    }

    /// Reports which options have no effect in this combination (R9.71).
    fn check_options(&self) -> Result<(), Failure> {
        if !self.columns.is_empty() && self.format != TimelineFormat::Csv {
            return Err(Failure::new("`--columns` belongs to `--format csv`"));
        }
        if self.full && self.format != TimelineFormat::Text {
            return Err(Failure::new("`--full` has no effect with this `--format`")
                .with_help("only text folds blocks: leave `--full` out"));
        }
        if self.from.is_some() && self.files.len() > 1 {
            return Err(
                Failure::new("`--from` starts one program, and several are named")
                    .with_help("run the others without it; `--state` hands on what they leave"),
            );
        }
        Ok(())
    }

    /// Returns what gives exit status 1: `run` shows what a program does, and fails where the control stops.
    fn fail_on(&self) -> FailOn {
        self.fail_on.or(Severity::Error)
    }

    fn stop_policy(&self) -> StopPolicy {
        if self.keep_going {
            StopPolicy::KeepGoing
        } else {
            StopPolicy::FirstError
        }
    }
}

/// Setup of the first program.
struct FirstProgram<'a> {
    programs: Programs<'a>,
    loaded: &'a LoadedMachine,
    session: Session,
}

/// Runs the command.
pub(crate) fn run(args: &RunArgs, console: Console) -> Result<u8, Failure> {
    args.check_options()?;
    let console = if args.quiet {
        console.quiet()?
    } else {
        console
    };
    if args.watch {
        watch(args, console)
    } else {
        run_once(args, console)
    }
}

/// Runs the programs, and again after each save that affects one of them. Ends when watching is no longer
/// possible.
fn watch(args: &RunArgs, console: Console) -> Result<u8, Failure> {
    if args.files.iter().any(|path| path.as_os_str() == "-") {
        let failure = Failure::new("standard input is not saved, so it cannot be watched");
        return Err(failure.with_help("name programs"));
    }
    let inputs: Vec<Input> = args.files.iter().map(|path| Input::new(path)).collect();
    let mut files = FileWatch::new()?;
    files.watch(args.files.iter().map(PathBuf::as_path))?;
    loop {
        if let Err(failure) = run_once(args, console) {
            console.explain(&failure);
        }
        loop {
            let mut machines = args.machine.machines(&FileRegistry::default());
            for input in &inputs {
                // A machine that cannot be used was reported by the run.
                let _ = machines.for_folder(input.folder());
            }
            files.watch(machines.folders())?;
            files.say();
            let saved = files.next(|path| is_source(path, None))?;
            let (changed, _) = ChangedPrograms::of(saved, &inputs, &mut machines, processors());
            if !changed.inputs.is_empty() {
                break;
            }
        }
    }
}

/// Runs the programs one after the other.
fn run_once(args: &RunArgs, console: Console) -> Result<u8, Failure> {
    let inputs: Vec<Input> = args.files.iter().map(|path| Input::new(path)).collect();
    for input in &inputs {
        input.probe()?;
    }
    let registry = FileRegistry::default();
    for input in &inputs {
        input.note(&registry);
    }
    let mut outputs = Outputs::new(&registry, console);
    let target = outputs.result(args.output.as_deref())?;
    let html = outputs.optional("--html", args.html.as_deref())?;
    let mut html = html.map(|file| HtmlFile::new(file, args.kinds));
    let mut machines = args.machine.weighed(&args.severities, &registry)?;
    machines.look_ahead(&inputs);
    if let Some(path) = args.state.as_deref() {
        // Another run of the same machine may bring the programs that name the other axes.
        machines.expect_more(StateFile::axes(path));
    }
    let loaded = machines.for_folder(inputs[0].folder())?;
    if let Some(remark) = remark(&loaded) {
        console.remark(&remark);
    }
    if args.format == TimelineFormat::Csv {
        // A row is a block: the lists have no row.
        for error in loaded.errors() {
            Console::talk(&concise_line(error));
        }
    }
    if let Some(path) = args.state.as_deref() {
        outputs.claim_state(path);
    }
    outputs.check()?;
    let state = args.state.as_deref().map(StateFile::lock).transpose()?;
    let mut options = args.execution.options(&loaded, args.stop_policy());
    options.run = options.run.with_search(args.from);
    options.start = args.start.positions(&loaded.machine)?;
    if !loaded.machine.is_described() {
        options.switched = switched_axes(&inputs);
    }
    if args.format == TimelineFormat::Csv {
        // A row is a block: the remark has no row.
        if let Some(remark) = undescribed(&loaded.machine, &options.switched) {
            Console::talk(&remark.in_words(Some(command_line)));
        }
    }
    let (mut session, changed) = open_session(&loaded, options, state.as_ref())?;
    expect_axes(&mut session, &loaded, &inputs);
    let said: Vec<Diagnostic> = loaded.errors().chain(&changed).cloned().collect();
    let mut start = FirstProgram {
        programs: Programs {
            inputs: &inputs,
            said: &said,
        },
        loaded: &loaded,
        session,
    };
    let report = args.report(target);
    let Some(played) = play(&mut start, report, html.as_mut())? else {
        // The reader has seen enough; a run that was cut short saves nothing.
        return Ok(crate::output::CLEAN);
    };
    if let Some(html) = html {
        html.write(args.given(&loaded), &loaded)?;
    }
    if let (true, Some(file)) = (played.summary.flow.is_continue(), &state) {
        outputs.save(file, &start.session.save())?;
    }
    outputs.finish()?;
    args.machine.say_unread(&machines, &registry, console);
    if let (TimelineFormat::Text, Some(code)) = (args.format, played.most_severe) {
        console.remark(&explain(code));
    }
    let fail_on = args.fail_on();
    let unknown = fail_on.judge(start.session.unknown(), console);
    let status = fail_on.status(start.session.counts()).max(unknown);
    // Neither a program that stopped nor one that did not run is an all-clear, whatever the reason.
    let has_stopped = played.has_stopped && fail_on.counts(Severity::Error);
    let is_cut_short = has_stopped || played.summary.unrun > 0;
    Ok(if is_cut_short {
        crate::output::FOUND
    } else {
        status
    })
}

/// Result of the programs of a call.
struct Played {
    summary: RunSummary,
    most_severe: Option<Code>,
    /// Whether an error ended one of the programs.
    has_stopped: bool,
}

/// Runs the programs; `None` if the timeline was not read to its end and there is no other output.
fn play(
    start: &mut FirstProgram<'_>,
    report: Box<dyn Report>,
    html: Option<&mut HtmlFile>,
) -> Result<Option<Played>, Failure> {
    let timeline = SharedReport::new(report);
    let goes_on_alone = html.is_some();
    let mut listeners = Listeners::new(&timeline, html.map(HtmlFile::digest));
    // Between two reads of a program no record is being written.
    let before_waiting = || timeline.flush();
    let context = RunContext::new(start.loaded, Naming::AsGiven);
    let context = context.before_waiting(&before_waiting);
    let session = &mut start.session;
    let played = run_programs(session, start.programs, &context, &mut listeners);
    let (most_severe, has_stopped) = (listeners.most_severe(), listeners.has_stopped());
    let mut report = timeline.into_report();
    report.finish().map_err(Failure::output)?;
    if report.is_closed() && !goes_on_alone {
        return Ok(None);
    }
    let summary = played?;
    if summary.unrun > 0 {
        say_unrun(summary.unrun, &start.session);
    }
    Ok(Some(Played {
        summary,
        most_severe,
        has_stopped,
    }))
}

/// Reports why programs did not run.
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
