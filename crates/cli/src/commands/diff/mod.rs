//! `frictcomp diff`: which blocks change the compensation state between two versions.

mod git;

pub(crate) use git::unseen_remark;

use std::path::PathBuf;

use clap::Args;

use crate::args::{
    ExecutionArgs, FolderArgs, MachineArgs, SimulationArgs, Tolerance, settings, undescribed_remark,
};
use crate::output::{
    Console, Failure, HtmlArgs, Outputs, Printed, ResultArgs, ResultFormat, difference, exit,
    write_page,
};
use frictcomp::comp::KindSet;
use frictcomp::interpreter::StopPolicy;
use frictcomp::text::shown_path;
use frictcomp_host::{
    Axes, FileRegistry, Input, LoadedMachine, MachineOfVersions, MachineOwner, Naming, SingleRun,
    drive_contour, run_alone,
};
use frictcomp_physics::compare::{
    Agreement, ContourAgreement, ContourComparison, Version, VersionComparison, VersionContour,
};
use frictcomp_physics::contour::BlockDeviations;
use frictcomp_report::results::compare::{ContoursReport, VersionsReport, document, render_json};

/// Show what a change changes in the states, and in the contour
///
/// Compares two versions of a program. The exit status is 0 if both versions change the states in the same way, and 1 if a block changes
/// a state in only one of them, or if a version is not known as a whole: an error stops it, a state
/// depends on what only the machine knows, or no machine is described. With `--contour` it is 1, too,
/// if a block of the new version deviates more, or if a motion could not be driven.
///
/// With `--git` the programs of the work tree that differ from a revision, and those that reach them by
/// their calls, are compared with what they were.
#[derive(Debug, Args)]
#[command(override_usage = "frictcomp diff [OPTIONS] <OLD> <NEW>\n       \
    frictcomp diff [OPTIONS] --git <REV> [PATH]...")]
pub(crate) struct DiffArgs {
    /// The old version and the new one; with `--git` programs and folders of programs
    #[arg(value_name = "OLD NEW")]
    pub(crate) paths: Vec<PathBuf>,
    /// Compare the work tree with this revision of its git repository
    #[arg(long, value_name = "REV", conflicts_with = "html")]
    git: Option<String>,
    /// The kinds of compensation to compare: `FRICT,LEAD` or `all`
    #[arg(long, value_name = "KINDS", default_value = "FRICT", value_parser = settings::parse_kinds)]
    pub(crate) kinds: KindSet,
    /// Also compare the contours: where the simulated axes deviate more in the new version
    #[arg(long)]
    pub(crate) contour: bool,
    /// How much more a block may deviate in the new version, in µm; by default 0.5
    #[arg(long, value_name = "UM")]
    tolerance: Option<Tolerance>,
    #[command(flatten)]
    simulation: SimulationArgs,
    #[command(flatten)]
    pub(crate) result: ResultArgs,
    #[command(flatten)]
    html: HtmlArgs,
    #[command(flatten)]
    pub(crate) folders: FolderArgs,
    #[command(flatten)]
    pub(crate) machine: MachineArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

impl DiffArgs {
    /// Reports which options have no effect in this combination (R9.71).
    pub(crate) fn check_options(&self) -> Result<(), Failure> {
        if !self.contour {
            Tolerance::refuse_without_contour(self.tolerance)?;
            self.simulation.refuse_without_contour()?;
        }
        Ok(())
    }
}

/// Runs the command.
pub(crate) fn run(args: &DiffArgs, console: Console) -> Result<u8, Failure> {
    args.check_options()?;
    match &args.git {
        Some(revision) => git::run(args, revision, console),
        None => compare(args, console),
    }
}

fn compare(args: &DiffArgs, console: Console) -> Result<u8, Failure> {
    let [old_path, new_path] = args.paths.as_slice() else {
        let failure = Failure::new("two versions are compared, an old one and a new one");
        return Err(failure.with_help(
            "write `frictcomp diff OLD NEW`, or compare with a revision: `frictcomp diff --git HEAD`",
        ));
    };
    let registry = FileRegistry::default();
    let inputs = [old_path, new_path].map(|path| Input::new(path));
    for input in &inputs {
        input.probe()?;
        input.note(&registry);
    }
    let mut outputs = Outputs::new(&registry, console);
    let mut result = outputs.result(args.result.output.as_deref())?;
    let html = args.html.page(&mut outputs)?;
    let mut machines = args.machine.machines(&registry);
    let machine = machines.for_versions(&inputs)?;
    outputs.check()?;
    if let Some(remark) = remark(&machine) {
        console.remark(&remark);
    }
    let [old, new] = &inputs;
    let comparison = VersionComparison::new(
        version_of(args, old, &machine.old)?,
        version_of(args, new, &machine.new)?,
    );
    let comparison = if machine.runs_alike(&inputs) {
        comparison.of_same_texts()
    } else {
        comparison
    };
    let contours = if args.contour {
        Some(contours(args, &inputs, (&machine, &registry))?)
    } else {
        None
    };
    let is_described = machine.new.machine.is_described();
    let report = VersionsReport {
        old: shown_path(old_path),
        new: shown_path(new_path),
        remark: (!is_described)
            .then(|| undescribed_remark(&inputs))
            .flatten(),
        comparison,
        contours,
    };
    let document = document(&report);
    let printed = match args.result.format {
        ResultFormat::Text => {
            let text = document.text(console.detail, result.look.width);
            result.painted(&text, difference)?
        }
        ResultFormat::Json => result.text(&render_json(&report))?,
    };
    let written = html.is_some();
    write_page(html, &document)?;
    outputs.finish()?;
    args.machine.say_unread(&machines, &registry, console);
    let contours = report.contours.as_ref().map(|it| it.comparison.agreement());
    Ok(match (report.comparison.agreement(), contours) {
        _ if printed == Printed::Unread && !written => exit::CLEAN,
        (Agreement::Same, None | Some(ContourAgreement::NoMore)) => exit::CLEAN,
        _ => exit::FOUND,
    })
}

/// Returns the remark on the owner of the machine of both versions, where it is not obvious
/// (R17.4).
fn remark(machine: &MachineOfVersions) -> Option<String> {
    let taken = shown_path(machine.new.origin.as_ref()?);
    match &machine.owner {
        MachineOwner::NewNotOld(path) => {
            let passed_over = shown_path(path);
            Some(format!(
                "both versions run on the machine of `{taken}`, not on that of `{passed_over}`"
            ))
        }
        MachineOwner::CurrentFolder => Some(format!(
            "both versions run on the machine of `{taken}`, that of the current folder"
        )),
        _ => None,
    }
}

/// Returns the contours of both versions.
fn contours(
    args: &DiffArgs,
    inputs: &[Input; 2],
    (machine, registry): (&MachineOfVersions, &FileRegistry),
) -> Result<ContoursReport, Failure> {
    let mut plane = Default::default();
    let mut contour = |input, loaded| -> Result<VersionContour, Failure> {
        let of = (loaded, Naming::AsGiven);
        let setup = args.simulation.setup(of, &args.execution, registry)?;
        let contour = drive_contour(input, loaded, &setup, |_| BlockDeviations::default())?;
        plane = setup.plane;
        Ok(contour.into())
    };
    let [old, new] = inputs;
    let (old, new) = (contour(old, &machine.old)?, contour(new, &machine.new)?);
    Ok(ContoursReport {
        comparison: ContourComparison::new(old, new, args.tolerance.unwrap_or_default().um()),
        plane,
        plant: args.simulation.plant().to_owned(),
    })
}

/// Returns the compensation switches of a version.
fn version_of(args: &DiffArgs, input: &Input, loaded: &LoadedMachine) -> Result<Version, Failure> {
    let alone = SingleRun {
        options: args.execution.options(loaded, StopPolicy::FirstError),
        naming: Naming::AsGiven,
        axes: Axes::AsTheyOccur,
    };
    let mut version = Version::new(args.kinds);
    run_alone(input, loaded, alone, &mut version)?;
    Ok(version)
}
