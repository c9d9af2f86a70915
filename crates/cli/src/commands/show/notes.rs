//! `frictcomp show values` and `frictcomp show passed-over`: what programs need from the machine, and what was passed
//! over.

use std::collections::BTreeSet;
use std::path::PathBuf;

use clap::Args;
use serde_json::{Value, json};

use crate::args::{ExecutionArgs, FolderArgs, MachineArgs};
use crate::output::{Console, Failure, Failures, Outputs, RecordsFormat, ResultArgs, exit};
use frictcomp::interpreter::{NoteKind, Notes};
use frictcomp::session::Findings;
use frictcomp::text::{Position, shown_json};
use frictcomp_host::{
    Axes, FileRegistry, Input, LoadedMachine, Naming, SingleRun, find_programs, run_alone,
};
use frictcomp_report::{Headline, Standing, command_line, counted, leading};

/// Programs whose notes are shown.
#[derive(Debug, Args)]
pub(crate) struct NotesArgs {
    /// Programs and folders of programs; `-` is standard input
    #[arg(value_name = "PATH", default_value = ".")]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    result: ResultArgs<RecordsFormat>,
    #[command(flatten)]
    folders: FolderArgs,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

/// A name and its place.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct NotedName {
    name: String,
    file: String,
    start: Position,
}

impl NotedName {
    /// Returns `V.E.PART mill.nc:12:5`.
    fn text(&self) -> String {
        let line = format!("{} {}:{}", self.name, self.file, self.start);
        leading(&line).into_owned() + "\n"
    }

    fn record(&self, kind: NoteKind) -> Value {
        json!({
            "record": match kind {
                NoteKind::Unknown => "unknown",
                NoteKind::Opaque => "opaque",
            },
            "name": self.name,
            "file": self.file,
            "line": self.start.line,
            "column": self.start.column,
        })
    }
}

/// Lists the notes of this kind in the order of their names.
pub(super) fn run(args: &NotesArgs, kind: NoteKind, console: Console) -> Result<u8, Failure> {
    Failures::of(console, |failures| list(args, kind, (console, failures)))
}

fn list(
    args: &NotesArgs,
    kind: NoteKind,
    (console, failures): (Console, &mut Failures),
) -> Result<u8, Failure> {
    let registry = FileRegistry::default();
    let machines = args.machine.machines(&registry);
    let mut machines = machines.selecting(args.folders.options());
    let found = find_programs(&args.paths, |folder| machines.selection(folder));
    failures.extend(Failures::from(found.failures));
    for input in &found.inputs {
        input.note(&registry);
    }
    machines.look_ahead(&found.inputs);
    let mut outputs = Outputs::new(&registry, console);
    let mut target = outputs.result(args.result.output.as_deref())?;
    // Every list is known before anything runs.
    let inputs = found.inputs.iter();
    let jobs = inputs.map(|it| (it, machines.for_folder(it.folder())));
    let jobs: Vec<_> = jobs.collect();
    outputs.check()?;
    let mut notes = BTreeSet::new();
    for (input, loaded) in jobs {
        let taken = loaded.map_err(Failure::from);
        let taken = taken.and_then(|it| args.take(kind, (input, &it), &mut notes));
        taken.unwrap_or_else(|failure| failures.push(failure));
    }
    let headline = headline(kind, &notes);
    let text: String = notes.iter().map(NotedName::text).collect();
    let text = match &*text {
        "" => format!("{headline}\n"),
        lines => format!("{headline}\n\n{lines}"),
    };
    let mut values: Vec<Value> = notes.iter().map(|note| note.record(kind)).collect();
    values.push(json!({ "record": "summary", "headline": headline }));
    target.text(&shown_json(&args.result.format.records(&text, &values)))?;
    outputs.finish()?;
    Ok(exit::CLEAN)
}

/// Returns the verdict: how many names there are, and at how many places.
fn headline(kind: NoteKind, notes: &BTreeSet<NotedName>) -> Headline {
    let names: BTreeSet<&str> = notes.iter().map(|it| it.name.as_str()).collect();
    let (names, places) = (names.len(), counted(notes.len(), "place"));
    Headline::new(
        Standing::Plain,
        match (kind, names) {
            (NoteKind::Unknown, 0) => "no program needs a value of the machine".to_owned(),
            (NoteKind::Unknown, _) => {
                format!(
                    "{} of the machine, read at {places}",
                    counted(names, "value")
                )
            }
            (NoteKind::Opaque, 0) => "no word is passed over".to_owned(),
            (NoteKind::Opaque, _) => {
                format!("{} passed over, at {places}", counted(names, "word"))
            }
        },
    )
}

impl NotesArgs {
    /// Runs a program and collects its notes.
    fn take(
        &self,
        kind: NoteKind,
        (input, loaded): (&Input, &LoadedMachine),
        notes: &mut BTreeSet<NotedName>,
    ) -> Result<(), Failure> {
        let mut run = self.execution.check();
        run.notes = Notes::Taken;
        let alone = SingleRun {
            options: loaded.session(run).with_wording(Some(command_line)),
            naming: Naming::AsGiven,
            axes: Axes::AsTheyOccur,
        };
        let session = run_alone(input, loaded, alone, &mut Findings::default())?;
        notes.extend(session.notes(kind).map(|(name, place)| NotedName {
            name: name.to_owned(),
            file: place.file.to_string(),
            start: place.start(),
        }));
        let more = session.notes_left_out();
        if more > 0 {
            let (name, listed) = (input.name(Naming::AsGiven), session.notes(kind).count());
            Console::talk(&format!(
                "{name}: {listed} places are listed; it occurred {more} more times"
            ));
        }
        Ok(())
    }
}
