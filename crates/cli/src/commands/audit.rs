//! `frictcomp audit`: what the order of programs does.

use std::num::{NonZeroU64, NonZeroUsize};
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::args::{
    ExecutionArgs, FailOnArgs, FolderArgs, MachineArgs, SeverityArgs, differences, say_left_out,
    settings, undescribed_remark,
};
use crate::output::{
    Console, Failure, Failures, Files, Outputs, Printed, RecordsFormat, difference, exit, shown,
};
use frictcomp::audit::{Archive, CuredMotions, MendedEnd};
use frictcomp::comp::KindSet;
use frictcomp::diagnostic::Severity;
use frictcomp::interpreter::StopPolicy;
use frictcomp::text::shown_path;
use frictcomp_host::{
    ArchiveAuditor, AuditOptions, FileRegistry, Input, Machines, MendedFile, MendedProgram,
    find_programs, programs_in_order, write_mended,
};
use frictcomp_report::html::render_with_lines;
use frictcomp_report::results::audit::{
    AuditReport, SequenceReport, also_mended_text, changed_text, document, missed_text, records,
    render_csv, sequence_records, sequence_text, to_write_text,
};
use frictcomp_report::{Length, counted, fitted};

/// Show what the order of programs does, and end its hazards
///
/// Shows which programs leave an axis away from its start-up state, and which move it in the state that they find.
/// Each program runs twice, once with every configured axis in its start-up state and once with every one away
/// from it. This shows what it does after any other program.
#[derive(Debug, Args)]
#[command(mut_arg("fail_on", |it| it.help(
    "What gives exit status 1, where hazards are warnings; a list such as `error,unknown`"
)))]
// Each is a separate switch on the command line.
#[allow(clippy::struct_excessive_bools)]
pub(crate) struct AuditArgs {
    /// Programs and folders of programs
    #[arg(value_name = "PATH", default_value = ".")]
    paths: Vec<PathBuf>,
    /// The kinds of compensation to audit: `FRICT,LEAD`; without a value all
    #[arg(long, value_name = "KINDS", num_args = 0..=1, default_value = "FRICT")]
    #[arg(default_missing_value = "all", value_parser = settings::parse_kinds)]
    kinds: KindSet,
    /// Write the blocks that end the hazards: into the programs that leave an axis away from its start-up
    /// state, into those that inherit it, or for each axis into the smaller number of programs
    #[arg(long, value_name = "PROGRAMS", num_args = 0..=1, require_equals = true)]
    #[arg(
        default_missing_value = "smaller",
        conflicts_with = "sequence",
        group = "mending"
    )]
    fix: Option<FixScope>,
    /// Show the blocks that `--fix` would write, as a unified diff
    #[arg(long, value_name = "PROGRAMS", num_args = 0..=1, require_equals = true)]
    #[arg(default_missing_value = "smaller", conflicts_with_all = ["sequence", "fix", "format", "all"])]
    #[arg(group = "mending")]
    diff: Option<FixScope>,
    /// Where no other block helps, take one that changes the state in which an axis moves
    #[arg(long = "unsafe", requires = "mending")]
    changing_motions: bool,
    /// Follow the programs in the order of this file, one on each line
    #[arg(long, value_name = "FILE", conflicts_with_all = ["paths", "html", "jobs"])]
    sequence: Option<PathBuf>,
    /// Show long tables and lists in full
    #[arg(long)]
    all: bool,
    /// Print only the verdict
    #[arg(long, short, conflicts_with_all = ["all", "format", "diff"])]
    quiet: bool,
    /// The number of programs to run at once; by default the number of processors
    #[arg(long, short, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// The format of the result
    #[arg(long, default_value = "text")]
    format: AuditFormat,
    /// Write the result to this file
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Write a report with the matrix of programs and axes to this HTML file
    #[arg(long, value_name = "FILE", conflicts_with_all = ["fix", "diff"])]
    html: Option<PathBuf>,
    #[command(flatten)]
    fail_on: FailOnArgs,
    #[command(flatten)]
    severities: SeverityArgs,
    #[command(flatten)]
    folders: FolderArgs,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

/// Number of runs of each program.
const RUNS: NonZeroU64 = NonZeroU64::new(2).expect("a program runs twice");

/// Programs to change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum FixScope {
    /// Those that leave an axis away from its start-up state: a command before the end
    Leavers,
    /// Those that inherit it: a command before the first motion
    Inheritors,
    /// The smaller number of programs for each axis
    Smaller,
}

/// The format of the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum AuditFormat {
    /// A table and sentences
    Text,
    /// One document
    Json,
    /// One record per line
    Ndjson,
    /// One row per program, axis and kind
    Csv,
}

/// Runs the command.
pub(crate) fn run(args: &AuditArgs, console: Console) -> Result<u8, Failure> {
    let console = if args.quiet {
        console.quiet()?
    } else {
        console
    };
    Failures::of(console, |failures| match &args.sequence {
        Some(order) => args.follow(order, console, failures),
        None => args.audit(console, failures),
    })
}

impl AuditArgs {
    fn audit(&self, console: Console, failures: &mut Failures) -> Result<u8, Failure> {
        let registry = FileRegistry::default();
        let mut outputs = Outputs::new(&registry, console);
        let mut target = outputs.result(self.output.as_deref())?;
        let mut html = outputs.optional("--html", self.html.as_deref())?;
        let machines = self.machine.weighed(&self.severities, &registry)?;
        let mut machines = machines.selecting(self.folders.options());
        let mut found = find_programs(&self.paths, |folder| machines.selection(folder));
        if found.inputs.contains(&Input::Stdin) {
            return Err(Failure::new(
                "standard input can be read only once, and an audit runs each program twice",
            )
            .with_help("name a file"));
        }
        failures.extend(Failures::from(found.failures));
        let auditor = self.auditor(found.inputs, &mut machines, failures);
        if auditor.programs().is_empty() {
            return Ok(exit::CLEAN);
        }
        outputs.check()?;
        say_undescribed(&auditor, console);
        let mut archives = failures.keep(auditor.audit());
        if let Some(fix) = self.fix.or(self.diff) {
            let changes = failures.keep(auditor.mend(&archives, fix.end(), self.motions()));
            say_mended(&archives, &changes);
            let files = changes.iter().filter_map(|change| change.file.as_ref());
            if self.diff.is_some() {
                target.painted(&differences(files.clone()), difference)?;
                let blocks = files.clone().map(|file| file.changes).sum();
                Console::talk(&to_write_text(blocks, files.count()));
                outputs.finish()?;
                let report = AuditReport::new(auditor.described(), archives, None);
                return Ok(self.status(report.has_warnings().then_some(Severity::Warning)));
            }
            write(files, console)?;
            archives = failures.keep(auditor.audit());
        }
        found.left_out.forget_read(&registry);
        let report = AuditReport::new(auditor.described(), archives, found.left_out.in_words());
        let length = if self.all {
            Length::Whole
        } else {
            Length::Folded
        };
        let document = document(&report);
        let width = target.look.width;
        let printed = target.text(&match self.format {
            AuditFormat::Text if self.quiet => fitted(&format!("{}\n", report.headline()), width),
            AuditFormat::Text => {
                let shown = document.shown(console.detail).with_length(length);
                fitted(&shown.to_string(), width)
            }
            AuditFormat::Csv => render_csv(&report),
            AuditFormat::Json => RecordsFormat::Json.records("", &records(&report)),
            AuditFormat::Ndjson => RecordsFormat::Ndjson.records("", &records(&report)),
        })?;
        if let Some(html) = &mut html {
            render_with_lines(&document, &mut Files, html).map_err(Failure::output)?;
        } else if printed == Printed::Unread && failures.is_empty() {
            return Ok(exit::CLEAN);
        }
        outputs.finish()?;
        self.machine.say_unread(&machines, &registry, console);
        let errors = say_list_errors(&auditor, console);
        let unknown = self.fail_on.judging().judge(report.unknown(), console);
        let archives = report.machines.iter().map(|machine| &machine.archive);
        let mut unseen = auditor.about_files(archives).diagnostics().to_vec();
        say_left_out(&mut found.left_out, &registry, console);
        unseen.extend(found.left_out.diagnostics(&mut machines));
        console.show(&unseen);
        let hazards = report.has_warnings().then_some(Severity::Warning);
        let unseen = unseen.iter().map(|said| said.severity);
        Ok(self
            .status(hazards.into_iter().chain(errors).chain(unseen))
            .max(unknown))
    }

    /// Returns the auditor of the programs that can run on their machines.
    fn auditor(
        &self,
        inputs: Vec<Input>,
        machines: &mut Machines,
        failures: &mut Failures,
    ) -> ArchiveAuditor {
        let run = self.execution.brief(StopPolicy::FirstError, RUNS);
        let mut options = AuditOptions::new(run).with_kinds(self.kinds);
        if let Some(jobs) = self.jobs {
            options = options.with_workers(jobs);
        }
        failures.keep(ArchiveAuditor::new(inputs, machines, options))
    }

    fn motions(&self) -> CuredMotions {
        if self.changing_motions {
            CuredMotions::Changed
        } else {
            CuredMotions::Kept
        }
    }

    /// Returns the exit status for what is said, by its severities.
    fn status(&self, said: impl IntoIterator<Item = Severity>) -> u8 {
        let counts = said.into_iter().map(|severity| (severity, 1));
        self.fail_on.judging().status(&counts.collect())
    }

    /// Follows the programs in a given order.
    fn follow(
        &self,
        order: &Path,
        console: Console,
        failures: &mut Failures,
    ) -> Result<u8, Failure> {
        if self.format == AuditFormat::Csv {
            return Err(Failure::new("`--sequence` has no `--format csv`")
                .with_help("write `--format text`, `json` or `ndjson`"));
        }
        let registry = FileRegistry::default();
        let mut outputs = Outputs::new(&registry, console);
        let mut target = outputs.result(self.output.as_deref())?;
        registry.reads("sequence", order);
        let inputs = programs_in_order(order)?;
        let mut machines = self.machine.weighed(&self.severities, &registry)?;
        let auditor = self.auditor(inputs, &mut machines, failures);
        outputs.check()?;
        say_undescribed(&auditor, console);
        let steps = failures.keep(auditor.follow());
        let described = auditor.described().map(|(_, machine)| machine);
        let report = SequenceReport::new(steps, described);
        let width = target.look.width;
        target.text(&match self.format {
            AuditFormat::Json => RecordsFormat::Json.records("", &sequence_records(&report)),
            AuditFormat::Ndjson => RecordsFormat::Ndjson.records("", &sequence_records(&report)),
            AuditFormat::Text | AuditFormat::Csv if self.quiet => {
                fitted(&format!("{}\n", report.headline()), width)
            }
            AuditFormat::Text | AuditFormat::Csv => {
                fitted(&sequence_text(&report, console.detail), width)
            }
        })?;
        outputs.finish()?;
        self.machine.say_unread(&machines, &registry, console);
        let errors = say_list_errors(&auditor, console);
        let unknown = self.fail_on.judging().judge(report.unknown(), console);
        let inherits = report.has_warnings().then_some(Severity::Warning);
        let cut = report.is_cut().then_some(Severity::Error);
        Ok(self
            .status(inherits.into_iter().chain(cut).chain(errors))
            .max(unknown))
    }
}

impl FixScope {
    fn end(self) -> MendedEnd {
        match self {
            Self::Leavers => MendedEnd::Leavers,
            Self::Inheritors => MendedEnd::Inheritors,
            Self::Smaller => MendedEnd::Smaller,
        }
    }
}

/// Reports before everything else that no machine is described (R1.37).
fn say_undescribed(auditor: &ArchiveAuditor, console: Console) {
    if let Some(remark) = undescribed_remark(auditor.undescribed()) {
        console.remark(&remark);
    }
}

/// Reports why the control does not accept its lists, and returns the severity of such faults.
fn say_list_errors(auditor: &ArchiveAuditor, console: Console) -> Option<Severity> {
    let errors: Vec<_> = auditor.list_errors().cloned().collect();
    console.show(&errors);
    errors.first().map(|error| error.severity)
}

/// Reports what is left to the user, and what the blocks do besides.
fn say_mended(archives: &[Archive], changes: &[MendedProgram]) {
    let audited = |change: &MendedProgram| {
        let programs = archives[change.machine].programs();
        change.program.map(|at| &programs[at])
    };
    for change in changes {
        if let Some(program) = audited(change) {
            let missed = change.missed.iter();
            missed.for_each(|missed| Console::talk(&missed_text(program, missed)));
        }
    }
    let files = changes
        .iter()
        .filter_map(|change| Some((change, change.file.as_ref()?)));
    let files = files.map(|(change, file)| (change, shown_path(&file.path)));
    for (change, file) in files
        .clone()
        .filter(|(change, _)| !change.changed.is_empty())
    {
        Console::talk(&changed_text(&file, &change.changed));
    }
    for (change, file) in files.filter(|(change, _)| !change.also.is_empty()) {
        Console::talk(&also_mended_text(&file, audited(change), &change.also));
    }
}

fn write<'a>(
    files: impl Iterator<Item = &'a MendedFile> + Clone,
    console: Console,
) -> Result<(), Failure> {
    write_mended(files.clone())?;
    for file in files {
        let blocks = counted(file.changes, "block");
        console.remark(&format!("wrote `{}`: {blocks}", shown(&file.path)));
    }
    Ok(())
}
