//! `frictcomp check`: every diagnostic of every program.

mod baseline;

use std::collections::BTreeSet;
use std::io::Write;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::args::{
    ExecutionArgs, FixArgs, FolderArgs, Lister, ListingArgs, MachineArgs, MendRun, Uncompensated,
    of_axis, passed_over, remark, say_left_out, total, undescribed_remark,
};
use crate::commands::diff::unseen_remark;
use crate::output::{Console, DataTarget, Failure, Failures, FileWatch, Outputs, Printed};
use baseline::BaselineArgs;
use frictcomp::diagnostic::{Code, Diagnostic};
use frictcomp_host::{
    Baseline, CalledPrograms, ChangedFile, ChangedPrograms, CheckOptions, CheckedPrograms, Disk,
    FileRegistry, HostError, Machines, Naming, ProgramsOnMachines, Revision, find_programs,
    is_source, processors,
};
use frictcomp_report::assumptions::rests_on_text;
use frictcomp_report::{ListingFormat, ProgramResult, command_line, counted, visible_line, wrap};

/// Print all messages of all programs, and mend what is safe
///
/// Each program runs from the start of the control. A program that another one calls is checked in its callers: it is not checked by itself if it holds
/// neither M02 nor M30 and a main program of this call executes it to its end.
#[derive(Debug, Args)]
// Each is a separate switch on the command line.
#[allow(clippy::struct_excessive_bools)]
pub(crate) struct CheckArgs {
    /// Programs and folders of programs; `-` is standard input
    #[arg(value_name = "PATH", default_value = ".")]
    paths: Vec<PathBuf>,
    /// The number of programs to check at once; by default the number of processors
    #[arg(long, short, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Check only the programs that differ from this revision of their git repository, by default
    /// `HEAD`, and those that reach them by their calls
    #[arg(long, value_name = "REV", num_args = 0..=1, default_missing_value = "HEAD")]
    changed: Option<String>,
    /// Check called programs by themselves, too
    #[arg(long)]
    all: bool,
    /// Check again after each save, only what the change reaches
    #[arg(long, conflicts_with_all = ["changed", "fix", "diff", "write_baseline", "output"])]
    watch: bool,
    #[command(flatten)]
    baseline: BaselineArgs,
    #[command(flatten)]
    fixes: FixArgs,
    #[command(flatten)]
    listing: ListingArgs,
    #[command(flatten)]
    folders: FolderArgs,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

/// Runs the command.
pub(crate) fn run(args: &CheckArgs, console: Console) -> Result<u8, Failure> {
    let console = args.listing.console(console)?;
    if args.watch {
        return watch(args, console);
    }
    Failures::of(console, |failures| check(args, console, (None, failures)))
}

/// Checks all programs, and after each save what it affects. Ends when watching is no longer possible.
fn watch(args: &CheckArgs, console: Console) -> Result<u8, Failure> {
    if args.paths.iter().any(|path| path.as_os_str() == "-") {
        let failure = Failure::new("standard input is not saved, so it cannot be watched");
        return Err(failure.with_help("name programs or folders"));
    }
    let mut files = FileWatch::new()?;
    files.watch(args.paths.iter().map(PathBuf::as_path))?;
    let mut saved: Option<Vec<ChangedFile>> = None;
    loop {
        let mut machines = args.machines(&FileRegistry::default())?;
        let found = find_programs(&args.paths, |folder| machines.selection(folder));
        for input in &found.inputs {
            // A machine that cannot be used is reported by the check.
            let _ = machines.for_folder(input.folder());
        }
        files.watch(machines.folders())?;
        let done = Failures::of(console, |failures| {
            check(args, console, (saved.take(), failures))
        });
        if let Err(failure) = done {
            console.explain(&failure);
        }
        files.say();
        let selection = machines.selection(args.paths.first().map_or(Path::new(""), |it| it));
        saved = Some(files.next(|path| is_source(path, selection.extensions.as_deref()))?);
    }
}

fn check(
    args: &CheckArgs,
    console: Console,
    (saved, failures): (Option<Vec<ChangedFile>>, &mut Failures),
) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    let mut machines = args.machines(&registry)?;
    let Since { paths, revision } = args.since()?;
    let mut found = find_programs(&paths, |folder| machines.selection(folder));
    failures.extend(Failures::from(found.failures));
    let mut inputs = found.inputs;
    if let Some((name, revision)) = &revision {
        let changed = ChangedPrograms::since(revision, &inputs, &mut machines, processors());
        let changed = failures.keep(changed?);
        console.remark(&changed_remark(changed.inputs.len(), inputs.len(), name));
        if let Some(remark) = unseen_remark(&changed) {
            console.remark(&remark);
        }
        inputs = changed.inputs;
    }
    if let Some(saved) = saved {
        let changed = ChangedPrograms::of(saved, &inputs, &mut machines, processors());
        inputs = failures.keep(changed).inputs;
    }
    for input in &inputs {
        input.note(&registry);
    }
    machines.look_ahead(&inputs);
    let mut outputs = Outputs::new(&registry, console);
    let mut target = outputs.result(args.listing.output.as_deref())?;
    let options = args.options();
    let mut bench = MendRun {
        inputs: &inputs,
        machines: &mut machines,
        options: &options,
    };
    if args.fixes.diff {
        outputs.check()?;
        let status = bench.diff(&mut target, (console, failures))?;
        outputs.finish()?;
        return Ok(status);
    }
    if args.fixes.fix {
        outputs.check()?;
        bench.fix(console, failures)?;
    }
    let programs = ProgramsOnMachines::new(&inputs, &mut machines);
    outputs.check()?;
    let undescribed = programs.undescribed().count();
    say_undescribed(args, &programs, &mut target, console);
    let mut listing = args.listing.lister(target)?;
    let (mut baseline, written) = args.baseline.open(&registry, &mut outputs)?;
    outputs.check()?;
    let checked = failures.keep(programs.check(&options));
    let in_callers = checked.in_callers;
    let silenced = checked.programs.iter().flat_map(|it| &it.silenced);
    let hushed = silenced.clone().map(|it| it.code).collect();
    let silenced: BTreeSet<String> = silenced.map(ToString::to_string).collect();
    list_all(checked, &mut listing, &mut baseline);
    found.left_out.forget_read(&registry);
    let missed = found.left_out.diagnostics(&mut machines);
    list_missed(missed, &mut listing, &mut baseline);
    let known = baseline::finish((baseline, written), console, &registry)?;
    if let Some(record) = &known {
        listing.record(record);
    }
    let name = inputs.first().map(|it| it.name(Naming::AsGiven));
    if let (Some(name), false) = (name, args.baseline.is_written()) {
        let mut headline = listing.tally().on_programs(&name);
        if known.is_some() {
            headline.text.push_str(" beyond the baseline");
        }
        let is_any_clean = listing.tally().programs.contains_key(&ProgramResult::Clean);
        let assumed = machines.loaded().filter_map(|it| it.machine.assumption());
        let without =
            is_any_clean.then(|| withheld(&machines, &hushed, [undescribed, inputs.len()]));
        let basis = assumed.chain(without.into_iter().flatten());
        listing.headline(headline.assuming(basis));
    }
    let printed = listing.finish()?;
    if printed == Printed::Unread && failures.is_empty() {
        return Ok(crate::output::CLEAN);
    }
    outputs.finish()?;
    for remark in machines.loaded().filter_map(remark) {
        console.remark(&remark);
    }
    args.machine.say_unread(&machines, &registry, console);
    if args.listing.format == ListingFormat::Text && !args.baseline.is_written() {
        listing.hint().iter().for_each(|hint| console.remark(hint));
        let beside = in_callers_remark(in_callers) + &passed_over(found.left_out.others());
        for silenced in &silenced {
            console.detail(&visible_line(silenced));
        }
        console.detail(&(total(listing.tally()) + &beside));
        if let Some(said) = rests_on_text(&listing.tally().rests_on) {
            console.detail(&said);
        }
    }
    say_left_out(&mut found.left_out, &registry, console);
    if let Some(remark) = listing.unknown_remark() {
        console.remark(&remark);
    }
    Ok(listing.status())
}

/// Returns what a clean program is clean without: messages that are not seen, and a machine of the programs, of which
/// so many of all have none that is described.
fn withheld(
    machines: &Machines,
    silenced: &BTreeSet<Code>,
    [undescribed, all]: [usize; 2],
) -> impl Iterator<Item = String> {
    let unreported = machines.loaded().flat_map(|it| it.levels.unreported());
    let unreported = in_words(&unreported.collect(), "not reported");
    let undescribed = match undescribed {
        0 => None,
        some if some == all => Some("no machine is described".to_owned()),
        some => Some(format!(
            "no machine is described for {}",
            counted(some, "program")
        )),
    };
    let silenced = in_words(silenced, "silenced");
    silenced.into_iter().chain(unreported).chain(undescribed)
}

/// Returns codes in words: "FC401 and FC403 are silenced".
fn in_words(codes: &BTreeSet<Code>, how: &str) -> Option<String> {
    const MOST: usize = 4;
    let names: Vec<&str> = codes.iter().map(|code| code.as_str()).collect();
    match &names[..] {
        [] => None,
        [one] => Some(format!("{one} is {how}")),
        names if names.len() > MOST => Some(format!("{} codes are {how}", names.len())),
        [names @ .., last] => Some(format!("{} and {last} are {how}", names.join(", "))),
    }
}

/// Lists the programs that were not looked at and switch compensation (R18.5).
fn list_missed(
    missed: impl IntoIterator<Item = Diagnostic>,
    listing: &mut Lister<'_>,
    baseline: &mut Baseline,
) {
    for mut said in missed {
        said.reword(Some(command_line));
        list((listing, baseline), &said);
    }
}

/// Reports before everything else that no machine is described (R1.37).
fn say_undescribed(
    args: &CheckArgs,
    programs: &ProgramsOnMachines<'_>,
    target: &mut DataTarget,
    console: Console,
) {
    let Some(remark) = undescribed_remark(programs.undescribed()) else {
        return;
    };
    if args.listing.format == ListingFormat::Text && !args.listing.quiet && !args.listing.statistics
    {
        // A writer that accepts no more fails at the next line.
        let _ = writeln!(target.writer, "{}\n", wrap(&remark, target.look.width, 0));
    } else {
        console.remark(&remark);
    }
}

/// Returns the number of programs checked since a revision, in words.
fn changed_remark(changed: usize, all: usize, revision: &str) -> String {
    match changed {
        0 => format!("none of {all} programs differs from `{revision}` or reaches one that does"),
        _ => format!("{changed} of {all} programs differ from `{revision}` or reach one that does"),
    }
}

/// Subject of the check: paths, and the revision with its name where only changed programs count.
struct Since {
    paths: Vec<PathBuf>,
    revision: Option<(String, Revision)>,
}

impl CheckArgs {
    fn machines(&self, registry: &FileRegistry) -> Result<Machines, Failure> {
        let machines = self.machine.weighed(&self.listing.severities, registry)?;
        Ok(machines.selecting(self.folders.options()))
    }

    /// Returns the paths, and the revision with its name where only changed programs are checked. A word after
    /// `--changed` that is not a revision may be the first path.
    fn since(&self) -> Result<Since, Failure> {
        let Some(name) = &self.changed else {
            return Ok(Since {
                paths: self.paths.clone(),
                revision: None,
            });
        };
        let folder = self.paths.first().map(PathBuf::as_path);
        let folder = folder
            .filter(|path| path.is_dir())
            .or(folder.and_then(Path::parent));
        let folder = folder.unwrap_or(Path::new(""));
        match Revision::new(folder, name) {
            Ok(revision) => Ok(Since {
                paths: self.paths.clone(),
                revision: Some((name.clone(), revision)),
            }),
            Err(HostError::NoRevision(_)) if Path::new(name).exists() => {
                let mut paths = vec![PathBuf::from(name)];
                // Without a path the current folder is meant, and the word takes its place.
                paths.extend(
                    self.paths
                        .iter()
                        .filter(|path| **path != Path::new("."))
                        .cloned(),
                );
                let head = "HEAD".to_owned();
                let revision = Revision::new(folder, &head)?;
                Ok(Since {
                    paths,
                    revision: Some((head, revision)),
                })
            }
            Err(error) => Err(error.into()),
        }
    }

    /// Returns the options of the checks.
    fn options(&self) -> CheckOptions {
        CheckOptions {
            run: self.execution.check(),
            wording: Some(command_line),
            called: if self.all {
                CalledPrograms::Alone
            } else {
                CalledPrograms::InCallers
            },
            workers: self.jobs.unwrap_or_else(processors),
            disk: Disk::default(),
        }
    }
}

/// Lists the messages of programs, in their order.
fn list_all(checked: CheckedPrograms, listing: &mut Lister<'_>, baseline: &mut Baseline) {
    for program in &checked.programs {
        for (axis, axis_type, moves) in &program.uncompensated {
            let moves = Uncompensated::of_program(*axis_type, *moves);
            listing.feed_moves(axis.clone(), &moves);
        }
        let unknown = program.unknown.iter();
        listing.unknown(unknown.map(|(axis, kind)| of_axis(axis, *kind)).collect());
        for (severity, more) in &program.unsaid {
            listing.count(*severity, baseline.unlisted(*severity, *more));
        }
    }
    // Only now is it known which programs reach a message.
    let said = checked.causes.diagnostics();
    let listed: Vec<bool> = said
        .iter()
        .map(|said| list((listing, baseline), said))
        .collect();
    for program in checked.programs {
        listing.rests_on(program.rests_on);
        let certain = if program.unknown.is_empty() {
            ProgramResult::Clean
        } else {
            ProgramResult::Depends
        };
        let listed = || {
            let places = program.said.iter().filter(|at| listed[**at]);
            places.map(|at| &said[*at])
        };
        let results = listed().map(|said| ProgramResult::of(said, &program.left));
        let result = results.chain([certain]).min().unwrap_or(certain);
        let axes = listed().filter_map(|said| {
            let result = ProgramResult::of(said, &program.left);
            let axis = said.axis.as_deref().filter(|_| result.is_of_axis());
            Some((result, axis?))
        });
        listing.program(&program.name, result, axes);
    }
}

/// Lists a message unless it is in the baseline. Returns whether it is not.
fn list((listing, baseline): (&mut Lister<'_>, &mut Baseline), said: &Diagnostic) -> bool {
    let is_new = baseline.lists(said);
    if is_new {
        // A writer that accepts no more is found at the end.
        let _ = listing.diagnostic(said);
    }
    is_new
}

/// Returns the remark on programs that were checked only in their callers.
fn in_callers_remark(programs: usize) -> String {
    match programs {
        0 => String::new(),
        1 => "; 1 called program was checked in its callers (`--all` checks it alone)".to_owned(),
        several => {
            format!(
                "; {several} called programs were checked in their callers (`--all` checks them alone)"
            )
        }
    }
}
