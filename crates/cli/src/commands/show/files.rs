//! `frictcomp show files`: which files are taken as programs.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};

use crate::args::{FolderArgs, MachineArgs, passed_over};
use crate::output::{
    Console, Failure, Failures, Outputs, Printed, ResultArgs, ResultFormat, exit, shown,
};
use frictcomp::text::shown_path;
use frictcomp::timeline::SCHEMA;
use frictcomp_host::{FileRegistry, FoundPrograms, Input, LeftOutFile, Naming, find_programs};
use frictcomp_report::{Headline, Standing, counted, to_json};

/// Show which files are taken as programs, which are not, and why
///
/// Nothing is executed. A program that is not taken by itself may still be called by one that is.
#[derive(Debug, Args)]
pub(crate) struct FilesArgs {
    /// Programs and folders of programs
    #[arg(value_name = "PATH", default_value = ".")]
    paths: Vec<PathBuf>,
    /// List the files that are no programs, too
    #[arg(long)]
    all: bool,
    #[command(flatten)]
    result: ResultArgs,
    #[command(flatten)]
    folders: FolderArgs,
    #[command(flatten)]
    machine: MachineArgs,
}

/// Runs the command.
pub(super) fn run(args: &FilesArgs, console: Console) -> Result<u8, Failure> {
    Failures::of(console, |failures| files(args, console, failures))
}

fn files(args: &FilesArgs, console: Console, failures: &mut Failures) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    let machines = args.machine.machines(&registry);
    let mut machines = machines.selecting(args.folders.options());
    let mut found = find_programs(&args.paths, |folder| machines.selection(folder));
    failures.extend(Failures::from(std::mem::take(&mut found.failures)));
    for input in &found.inputs {
        input.note(&registry);
    }
    let mut outputs = Outputs::new(&registry, console);
    let mut target = outputs.result(args.result.output.as_deref())?;
    outputs.check()?;
    let printed = match args.result.format {
        ResultFormat::Text => target.text(&args.text(&found))?,
        ResultFormat::Json => target.text(&to_json(&args.json(&found)))?,
    };
    if printed == Printed::Read {
        outputs.finish()?;
    }
    Ok(exit::CLEAN)
}

impl FilesArgs {
    fn left_out<'a>(&self, found: &'a FoundPrograms) -> impl Iterator<Item = &'a LeftOutFile> {
        let all = self.all;
        let files = found.left_out.files.iter();
        files.filter(move |file| all || file.is_listed())
    }

    fn text(&self, found: &FoundPrograms) -> String {
        let mut out = format!("{}\n\n", headline(found));
        for input in &found.inputs {
            let _ = writeln!(out, "{}", taken_name(input));
        }
        for file in self.left_out(found) {
            let _ = writeln!(out, "{}: not taken, {}", shown(&file.path), file.reason());
        }
        out
    }

    fn json(&self, found: &FoundPrograms) -> Value {
        let taken = found.inputs.iter();
        let taken =
            taken.map(|input| json!({ "file": input.name(Naming::AsGiven), "taken": true }));
        let left_out = self.left_out(found).map(|file| {
            json!({
                "file": shown_path(&file.path),
                "taken": false,
                "why": file.why.as_str(),
                "switches": file.switch.as_ref().map(|place| place.first_line),
            })
        });
        json!({
            "schema": SCHEMA,
            "headline": headline(found),
            "files": taken.chain(left_out).collect::<Vec<_>>(),
            "others": found.left_out.others(),
        })
    }
}

/// Returns the verdict: how many programs are taken, and what is not.
fn headline(found: &FoundPrograms) -> Headline {
    let taken = counted(found.inputs.len(), "program");
    let beside = passed_over(found.left_out.others());
    let text = match found.left_out.in_words() {
        Some(kinds) => format!("{taken}; not taken: {kinds}{beside}"),
        None => format!("{taken}{beside}"),
    };
    Headline::new(Standing::Plain, text)
}

fn taken_name(input: &Input) -> String {
    match input {
        Input::File(path) => shown(path),
        _ => input.name(Naming::AsGiven),
    }
}
