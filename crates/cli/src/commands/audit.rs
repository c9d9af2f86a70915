//! `frictcomp audit`: what the order of programs does.

use std::collections::BTreeMap;
use std::num::{NonZeroU64, NonZeroUsize};
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::args::{
    ExecutionArgs, FailOn, FailOnWord, FolderArgs, MachineArgs, SeverityArgs, differences, of_axis,
    say_left_out, settings, undescribed_remark,
};
use crate::output::{
    Console, Failure, Failures, Files, Outputs, Printed, RecordsFormat, difference, exit, shown,
};
use frictcomp::audit::{Archive, CuredMotions, MendedEnd, Selected, WhyMissed};
use frictcomp::comp::{Kind, KindSet};
use frictcomp::diagnostic::{Diagnostic, Severity};
use frictcomp::interpreter::StopPolicy;
use frictcomp::session::Causes;
use frictcomp_host::{
    ArchiveAuditor, AuditOptions, FileRegistry, Input, Machines, MendedProgram, find_programs,
    read_text, write_mended,
};
use frictcomp_report::html::render_audit;
use frictcomp_report::results::audit::{
    AuditReport, Length, records, render_csv, render_text, sequence_records, sequence_text,
};
use frictcomp_report::{counted, fitted};

/// Show what the order of programs does, and end its hazards
///
/// Shows which programs leave an axis away from its start-up state, and which move it in the state that they find.
/// Each program runs twice, once with every configured axis in its start-up state and once with every one away
/// from it. This shows what it does after any other program.
#[derive(Debug, Args)]
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
    #[arg(long, short, conflicts_with_all = ["sequence", "all", "format", "diff"])]
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
    /// What gives exit status 1, where hazards are warnings; a list such as `error,unknown`
    #[arg(
        long,
        value_name = "SEVERITY",
        value_delimiter = ',',
        default_value = "warning"
    )]
    fail_on: Vec<FailOnWord>,
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

/// How many of the programs that one block mends are named.
const MOST_NAMES: usize = 20;

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
        let auditor = self.auditor(found.inputs, (&mut machines, &registry), failures);
        if auditor.programs().is_empty() {
            return Ok(exit::CLEAN);
        }
        outputs.check()?;
        say_undescribed(&auditor, console);
        let mut archives = failures.keep(auditor.audit());
        if let Some(fix) = self.fix.or(self.diff) {
            let motions = if self.changing_motions {
                CuredMotions::Changed
            } else {
                CuredMotions::Kept
            };
            let changes = failures.keep(auditor.mend(&archives, fix.end(), motions));
            say_missed(&archives, &changes);
            say_changed(&changes);
            say_roots(&changes);
            if self.diff.is_some() {
                let files = changes.iter().filter_map(|change| change.file.as_ref());
                target.painted(&differences(files), difference)?;
                Console::talk(&to_write(&changes));
                outputs.finish()?;
                let report = AuditReport::new(auditor.described(), archives, None);
                return Ok(self.status(report.has_warnings(), false));
            }
            write(&changes, console)?;
            archives = failures.keep(auditor.audit());
        }
        found.left_out.forget_read(&registry);
        let report = AuditReport::new(auditor.described(), archives, found.left_out.in_words());
        let width = target.look.width;
        let printed = target.text(&match self.format {
            AuditFormat::Text if self.quiet => fitted(&format!("{}\n", report.headline()), width),
            AuditFormat::Text if self.all => {
                fitted(&render_text(&report, Length::Whole, console.detail), width)
            }
            AuditFormat::Text => {
                fitted(&render_text(&report, Length::Folded, console.detail), width)
            }
            AuditFormat::Csv => render_csv(&report),
            AuditFormat::Json => RecordsFormat::Json.records("", &records(&report)),
            AuditFormat::Ndjson => RecordsFormat::Ndjson.records("", &records(&report)),
        })?;
        if let Some(html) = &mut html {
            render_audit(&report, &mut Files, html).map_err(Failure::output)?;
        } else if printed == Printed::Unread && failures.is_empty() {
            return Ok(exit::CLEAN);
        }
        outputs.finish()?;
        self.machine.say_unread(&machines, &registry, console);
        let errors = say_lists(&auditor, console);
        let unknown = self.unknown_status(report.unknown(), console);
        let mut unseen = about_files(&auditor, &report);
        say_left_out(&mut found.left_out, &registry, console);
        unseen.extend(found.left_out.diagnostics(&mut machines));
        console.show(&unseen);
        let mut counts = counts(report.has_warnings(), errors);
        for said in &unseen {
            *counts.entry(said.severity).or_default() += 1;
        }
        let status = FailOn::judging(&self.fail_on).status(&counts);
        Ok(status.max(unknown))
    }

    /// Returns the auditor of the programs that can run on their machines.
    fn auditor(
        &self,
        inputs: Vec<Input>,
        (machines, registry): (&mut Machines, &FileRegistry),
        failures: &mut Failures,
    ) -> ArchiveAuditor {
        for input in &inputs {
            input.note(registry);
        }
        machines.look_ahead(&inputs);
        let run = self.execution.brief(StopPolicy::FirstError, RUNS);
        let mut options = AuditOptions::new(run).with_kinds(self.kinds);
        if let Some(jobs) = self.jobs {
            options = options.with_workers(jobs);
        }
        failures.keep(ArchiveAuditor::new(inputs, machines, options))
    }

    /// Returns the exit status for unknown states, which are reported where they count (R2.98).
    fn unknown_status<'a>(
        &self,
        unknown: impl Iterator<Item = (&'a str, Kind)>,
        console: Console,
    ) -> u8 {
        let unknown = unknown.map(|(axis, kind)| of_axis(axis, kind)).collect();
        let fail_on = FailOn::judging(&self.fail_on);
        if let Some(remark) = fail_on.unknown_remark(&unknown) {
            console.remark(&remark);
        }
        fail_on.unknown_status(&unknown)
    }

    fn status(&self, warnings: bool, errors: bool) -> u8 {
        FailOn::judging(&self.fail_on).status(&counts(warnings, errors))
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
        let inputs = programs_of(order)?;
        let mut machines = self.machine.weighed(&self.severities, &registry)?;
        let auditor = self.auditor(inputs, (&mut machines, &registry), failures);
        outputs.check()?;
        say_undescribed(&auditor, console);
        let steps = failures.keep(auditor.follow());
        let width = target.look.width;
        target.text(&match self.format {
            AuditFormat::Json => RecordsFormat::Json.records("", &sequence_records(&steps)),
            AuditFormat::Ndjson => RecordsFormat::Ndjson.records("", &sequence_records(&steps)),
            AuditFormat::Text | AuditFormat::Csv => {
                fitted(&sequence_text(&steps, console.detail), width)
            }
        })?;
        outputs.finish()?;
        self.machine.say_unread(&machines, &registry, console);
        for loaded in auditor.machines() {
            if let Some(assumption) = loaded.machine.assumption() {
                console.remark(&assumption);
            }
        }
        let is_cut = steps.iter().any(|step| step.stopped.is_some());
        let errors = say_lists(&auditor, console) || is_cut;
        let mut axes = steps.iter().flat_map(|step| &step.axes);
        let inherits = axes.any(|axis| axis.left_by.is_some());
        let axes = steps.iter().flat_map(|step| &step.axes);
        let unknown = axes.filter(|axis| axis.end == Selected::Unknown);
        let unknown = unknown.map(|axis| (axis.axis.as_str(), axis.kind));
        let unknown = self.unknown_status(unknown, console);
        Ok(self.status(inherits, errors).max(unknown))
    }
}

/// Returns whether there are warnings and errors as numbers.
fn counts(warnings: bool, errors: bool) -> BTreeMap<Severity, u64> {
    let counts = [(Severity::Warning, warnings), (Severity::Error, errors)];
    counts
        .map(|(severity, any)| (severity, u64::from(any)))
        .into()
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

/// Returns the messages about programs without a block, and files that are no programs (R18.6).
fn about_files(auditor: &ArchiveAuditor, report: &AuditReport) -> Vec<Diagnostic> {
    let mut causes = Causes::default();
    for (loaded, machine) in auditor.machines().iter().zip(&report.machines) {
        let programs = machine.archive.programs().iter();
        for said in programs.flat_map(|program| &program.about_file) {
            if let Some(severity) = loaded.levels.severity(said.code) {
                let mut said = said.clone();
                said.severity = severity;
                causes.say(said);
            }
        }
    }
    causes.diagnostics().to_vec()
}

/// Reports before everything else that no machine is described (R1.37).
fn say_undescribed(auditor: &ArchiveAuditor, console: Console) {
    if let Some(remark) = undescribed_remark(auditor.undescribed()) {
        console.remark(&remark);
    }
}

/// Reports why the control does not accept its lists, and returns whether it has such faults.
fn say_lists(auditor: &ArchiveAuditor, console: Console) -> bool {
    let machines = auditor.machines().iter();
    let errors: Vec<_> = machines.flat_map(|it| it.errors().cloned()).collect();
    console.show(&errors);
    !errors.is_empty()
}

/// Reports which programs are left to the user, and why (R10.8).
fn say_missed(archives: &[Archive], changes: &[MendedProgram]) {
    for change in changes {
        let programs = archives[change.machine].programs();
        let Some(program) = change.program.map(|at| &programs[at]) else {
            continue;
        };
        for missed in &change.missed {
            let way_home = program.axes[missed.mending.at].way_home();
            let why = match &missed.why {
                WhyMissed::ChangesMotion(of) if **of == *program.file => {
                    "a block that mends this would change the state in which axes move".to_owned()
                }
                WhyMissed::ChangesMotion(of) => format!(
                    "a block that mends this would change the state in which axes move in `{of}`, which calls it"
                ),
                _ => "no single block mends this".to_owned(),
            };
            let takes_it = match &missed.why {
                WhyMissed::ChangesMotion(_) => ", or take the block with `--unsafe`",
                _ => "",
            };
            Console::talk(&format!(
                "{}: {why}; write `{way_home}` wherever it is needed by hand{takes_it}",
                program.file,
            ));
        }
    }
}

/// Reports which blocks change the state in which axes move (R10.8).
fn say_changed(changes: &[MendedProgram]) {
    for change in changes {
        let Some(file) = change.file.as_ref().filter(|_| !change.changed.is_empty()) else {
            continue;
        };
        Console::talk(&format!(
            "{}: a block changes the state in which axes move in {}",
            shown(&file.path),
            change.changed.join(", "),
        ));
    }
}

/// Reports which blocks mend the programs that call their file, too (R10.8).
fn say_roots(changes: &[MendedProgram]) {
    for change in changes {
        let Some(file) = change.file.as_ref().filter(|_| !change.also.is_empty()) else {
            continue;
        };
        let count = change.also.len();
        let programs = counted(count, "program");
        let names: Vec<&str> = change
            .also
            .iter()
            .take(MOST_NAMES)
            .map(String::as_str)
            .collect();
        let more = match count.saturating_sub(MOST_NAMES) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let verb = if count == 1 { "calls" } else { "call" };
        let unnamed = match change.program {
            Some(_) => "",
            None => "; programs that were not audited may call it, too",
        };
        Console::talk(&format!(
            "{}: this mends {programs} that {verb} it: {}{more}{unnamed}",
            shown(&file.path),
            names.join(", "),
        ));
    }
}

/// Returns the effect of `--fix` in words.
fn to_write(changes: &[MendedProgram]) -> String {
    let files = changes.iter().filter_map(|change| change.file.as_ref());
    let blocks: usize = files.clone().map(|file| file.changes).sum();
    match (blocks, files.count()) {
        (0, _) => "nothing to write".to_owned(),
        (blocks, programs) => format!(
            "{} in {} (`--fix` writes {})",
            counted(blocks, "block"),
            counted(programs, "program"),
            if blocks == 1 { "it" } else { "them" },
        ),
    }
}

fn write(changes: &[MendedProgram], console: Console) -> Result<(), Failure> {
    let files = changes.iter().filter_map(|change| change.file.as_ref());
    write_mended(files.clone())?;
    for file in files {
        let blocks = counted(file.changes, "block");
        console.remark(&format!("wrote `{}`: {blocks}", shown(&file.path)));
    }
    Ok(())
}

/// Reads one program per line, relative to the folder of the list; empty lines and lines that begin with `#`
/// or `;` are ignored.
fn programs_of(order: &Path) -> Result<Vec<Input>, Failure> {
    let text = read_text(order)?;
    let folder = order.parent().unwrap_or(Path::new(""));
    let names = text.lines().map(str::trim);
    let names = names.filter(|name| !name.is_empty() && !name.starts_with(['#', ';']));
    let inputs: Vec<Input> = names.map(|name| Input::File(folder.join(name))).collect();
    if inputs.is_empty() {
        return Err(
            Failure::new(format!("`{}` names no program", shown(order))).with_help(
                "write the path of one program on each line, from the folder of this file",
            ),
        );
    }
    for input in &inputs {
        input.probe()?;
    }
    Ok(inputs)
}
