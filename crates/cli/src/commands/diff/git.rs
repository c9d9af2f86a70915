//! `frictcomp diff --git`: which programs switch differently since a revision (R17.4).

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::{DiffArgs, contours, version_of};
use crate::args::{say_left_out, undescribed_remark};
use crate::output::{
    Console, Failure, Failures, Outputs, Printed, ResultFormat, difference, exit, shown,
};
use frictcomp::text::shown_path;
use frictcomp_host::{
    ChangedPrograms, Disk, FileRegistry, Input, LoadedMachine, MachineOfVersions, MachineOwner,
    Machines, OpenText, Revision, find_programs, processors,
};
use frictcomp_physics::compare::{Agreement, ContourAgreement, Version, VersionComparison};
use frictcomp_report::fitted;
use frictcomp_report::results::compare::{VersionsReport, document, render_json_since};

/// A program in both versions; it may be missing from one of them.
struct ProgramVersions {
    name: String,
    old: Option<Input>,
    new: Option<Input>,
}

/// Runs the command with a revision.
pub(crate) fn run(args: &DiffArgs, revision: &str, console: Console) -> Result<u8, Failure> {
    Failures::of(console, |failures| {
        compare(args, revision, (console, failures))
    })
}

/// Compares the programs that differ from a revision, or reach a file that differs.
fn compare(
    args: &DiffArgs,
    revision: &str,
    (console, failures): (Console, &mut Failures),
) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    let machines = args.machine.machines(&registry);
    let mut machines = machines.selecting(args.folders.options());
    let here = PathBuf::from(".");
    let paths = if args.paths.is_empty() {
        std::slice::from_ref(&here)
    } else {
        &args.paths
    };
    let mut found = find_programs(paths, |folder| machines.selection(folder));
    let revised = Revision::new(folder_of(&paths[0]), revision)?;
    let changed = ChangedPrograms::since(&revised, &found.inputs, &mut machines, processors());
    let changed = failures.keep(changed?);
    // A folder whose programs were all deleted contains none.
    if changed.files.is_empty() || !found.inputs.is_empty() {
        failures.extend(Failures::from(found.failures));
    }
    for input in &changed.inputs {
        input.note(&registry);
    }
    let mut outputs = Outputs::new(&registry, console);
    let mut result = outputs.result(args.result.output.as_deref())?;
    outputs.check()?;
    let disk = changed.disk(&revised)?;
    machines.look_ahead(&changed.inputs);
    if changed.is_machine_changed {
        console.remark(&format!(
            "the configuration or a list differs from `{revision}`; both versions run on the current \
             machine"
        ));
    }
    if let Some(remark) = unseen_remark(&changed) {
        console.remark(&remark);
    }
    let pairs = pairs(&changed, (&disk, paths));
    let comparer = Comparer {
        args,
        revision,
        disk,
        registry: &registry,
    };
    let mut reports = Vec::new();
    for pair in &pairs {
        match comparer.report(pair, &mut machines) {
            Ok(report) => reports.push(report),
            Err(failure) => failures.push(failure),
        }
    }
    let is_same = |report: &&VersionsReport| {
        let contours = report.contours.as_ref().map(|it| it.comparison.agreement());
        report.comparison.agreement() == Agreement::Same
            && matches!(contours, None | Some(ContourAgreement::NoMore))
    };
    let same = reports.iter().filter(is_same).count();
    let printed = match args.result.format {
        ResultFormat::Text => {
            let different = reports.iter().filter(|report| !is_same(report));
            let texts = different.map(|report| {
                let shown = document(report);
                format!("{}{}", named(report), shown.shown(console.detail))
            });
            let text = texts.collect::<Vec<_>>().join("\n");
            result.painted(&fitted(&text, result.look.width), difference)?
        }
        ResultFormat::Json => result.text(&render_json_since(&reports, revision))?,
    };
    outputs.finish()?;
    let count = reports.len();
    console.remark(&match count {
        0 => format!("no program differs from `{revision}` or reaches one that does"),
        1 => format!("1 program compared with `{revision}`: {same} switches the same"),
        _ => format!("{count} programs compared with `{revision}`: {same} switch the same"),
    });
    args.machine.say_unread(&machines, &registry, console);
    say_left_out(&mut found.left_out, &registry, console);
    Ok(if same == count || printed == Printed::Unread {
        exit::CLEAN
    } else {
        exit::FOUND
    })
}

/// Returns a remark on files that git does not track, whose changes are not seen.
pub(crate) fn unseen_remark(changed: &ChangedPrograms) -> Option<String> {
    const MOST_NAMED: usize = 5;
    let names = changed.unseen.iter().take(MOST_NAMED);
    let names = names.map(|place| format!("`{}`", shown(&Disk::named(place))));
    let names: Vec<String> = names.collect();
    let more = if changed.unseen.len() > MOST_NAMED {
        ", \u{2026}"
    } else {
        ""
    };
    (!names.is_empty()).then(|| {
        format!(
            "git does not track {}{more}: changes there are not seen",
            names.join(", ")
        )
    })
}

/// Returns the name of the program of a report without differences.
fn named(report: &VersionsReport) -> String {
    match report.comparison.differences().next() {
        Some(_) => String::new(),
        None => format!("{}:\n", shown(Path::new(&report.new))),
    }
}

fn folder_of(path: &Path) -> &Path {
    if path.is_dir() {
        return path;
    }
    path.parent().unwrap_or(Path::new(""))
}

/// Returns the programs to compare: those of the work tree, then those that only the revision has.
fn pairs(changed: &ChangedPrograms, (disk, paths): (&Disk, &[PathBuf])) -> Vec<ProgramVersions> {
    let mut renamed: BTreeMap<PathBuf, &Path> = BTreeMap::new();
    let mut added: Vec<PathBuf> = Vec::new();
    for file in &changed.files {
        match (&file.new, &file.old) {
            (Some(new), Some(old)) => _ = renamed.insert(Disk::place(new), &old.path),
            (Some(new), None) => added.push(Disk::place(new)),
            (None, _) => {}
        }
    }
    let open = |path: &Path| {
        let text = disk.text(path)?.clone();
        let path = Disk::named(path);
        Some(Input::Open(OpenText { path, text }))
    };
    let inputs = changed.inputs.iter().filter_map(|input| {
        let Input::File(path) = input else {
            return None;
        };
        let place = Disk::place(path);
        let old = match renamed.get(&place) {
            Some(old) => open(old),
            None if added.contains(&place) => None,
            // It is the same in both, and reaches a file that differs.
            None => Some(input.clone()),
        };
        Some(ProgramVersions {
            name: shown_path(path),
            old,
            new: Some(input.clone()),
        })
    });
    let mut pairs: Vec<ProgramVersions> = inputs.collect();
    let roots: Vec<PathBuf> = paths.iter().map(|path| Disk::place(path)).collect();
    let gone = changed.files.iter().filter(|file| file.new.is_none());
    for old in gone.filter_map(|file| file.old.as_ref()) {
        let is_meant = roots.iter().any(|root| old.path.starts_with(root));
        if is_meant && changed.is_program(&old.path) {
            pairs.push(ProgramVersions {
                name: shown_path(&Disk::named(&old.path)),
                old: open(&old.path),
                new: None,
            });
        }
    }
    pairs
}

/// Inputs of comparisons.
struct Comparer<'a> {
    args: &'a DiffArgs,
    revision: &'a str,
    /// The disk of the revision.
    disk: Disk,
    registry: &'a FileRegistry,
}

impl Comparer<'_> {
    fn report(
        &self,
        pair: &ProgramVersions,
        machines: &mut Machines,
    ) -> Result<VersionsReport, Failure> {
        let input = pair.new.as_ref().or(pair.old.as_ref());
        let folder = input.map_or(Path::new(""), Input::folder);
        let new = machines.for_folder(folder)?;
        let old = LoadedMachine {
            disk: self.disk.clone(),
            ..(*new).clone()
        };
        let version = |input: &Option<Input>, loaded: &LoadedMachine| match input {
            Some(input) => version_of(self.args, input, loaded),
            None => Ok(Version::new(self.args.kinds)),
        };
        let (before, after) = (version(&pair.old, &old)?, version(&pair.new, &new)?);
        let comparison = VersionComparison::new(before, after);
        let is_described = new.machine.is_described();
        let contours = match (&pair.old, &pair.new) {
            (Some(one), Some(other)) if self.args.contour => {
                let machine = MachineOfVersions {
                    old,
                    new: (*new).clone(),
                    owner: MachineOwner::Both,
                };
                let inputs = [one.clone(), other.clone()];
                Some(contours(self.args, &inputs, (&machine, self.registry))?)
            }
            _ => None,
        };
        let old_name = pair.old.as_ref().map(|input| {
            let name = input.name(frictcomp_host::Naming::AsGiven);
            format!("{}:{name}", self.revision)
        });
        Ok(VersionsReport {
            old: old_name.unwrap_or_else(|| "/dev/null".to_owned()),
            new: if pair.new.is_some() {
                pair.name.clone()
            } else {
                "/dev/null".to_owned()
            },
            remark: (!is_described).then(|| undescribed_remark(input)).flatten(),
            comparison,
            contours,
        })
    }
}
