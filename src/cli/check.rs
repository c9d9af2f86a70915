//! `frictcomp check`: every diagnostic of every program.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;

use super::console::{Console, Printed, Target};
use super::discovery::{LoadedMachine, MachineArgs, Machines};
use super::dry_run::{Alone, Axes, ExecutionArgs, run_alone};
use super::failure::{Failure, Failures};
use super::files::{Input, Naming};
use super::ledger::Ledger;
use super::listing::{Lister, ListingArgs, total};
use super::notes::{self, Note};
use super::outputs::Outputs;
use super::unread::say_unread;
use super::{switched, walk, workers};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::report::wrap;
use crate::session::{NoteKind, Notes, StopPolicy};
use crate::text::Position;
use crate::timeline::{Record, Repeat, Sink};

/// Print all messages of all programs; each program runs from the start of the control
#[derive(Debug, Args)]
pub(super) struct CheckArgs {
    /// Programs and folders of programs; `-` is standard input
    #[arg(value_name = "PATH", default_value = ".")]
    paths: Vec<PathBuf>,
    /// Instead of messages, list the values that the programs need from the machine, and where
    #[arg(long, conflicts_with_all = ["opaque", "fail_on", "jobs", "quiet", "statistics", "ignore", "select", "severity"])]
    unknowns: bool,
    /// Instead of messages, list what was accepted and passed over, and where
    #[arg(long, conflicts_with_all = ["fail_on", "jobs", "quiet", "statistics", "ignore", "select", "severity"])]
    opaque: bool,
    /// The number of programs to check at once; by default the number of processors
    #[arg(long, short, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    #[command(flatten)]
    listing: ListingArgs,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

/// Runs the command.
pub(super) fn run(args: &CheckArgs, console: Console) -> Result<u8, Failure> {
    let ledger = Ledger::default();
    let console = args.listing.console(console);
    let mut machines = Machines::new(&args.machine, &ledger);
    machines.weigh(&args.listing.severities)?;
    let found = walk::programs(&args.paths, |folder| machines.extensions(folder));
    let mut failures = Failures::from(found.failures);
    let inputs = found.inputs;
    for input in &inputs {
        input.note(&ledger);
    }
    machines.look_ahead(&inputs);
    let mut outputs = Outputs::new(&ledger, console);
    let mut target = outputs.result(args.listing.output.as_deref())?;
    // Every list is known before anything runs.
    let loaded = inputs.iter().map(|it| machines.for_folder(it.folder()));
    let jobs: Vec<Job> = inputs.iter().zip(loaded.collect::<Vec<_>>()).collect();
    outputs.check()?;
    if let Some(kind) = args.notes() {
        let format = args.listing.format.of_records("this list")?;
        notes::list(kind, (format, target), |lines| {
            for (input, loaded) in jobs {
                if let Err(failure) = args.take_notes(kind, (input, loaded), lines) {
                    failures.push(failure);
                }
            }
        })?;
        outputs.finish()?;
        return failures.status(console, super::exit::CLEAN);
    }
    say_undescribed(args, &jobs, (&mut target, console));
    let mut listing = args.listing.lister(target)?;
    args.check_all(jobs, &mut listing, &mut failures);
    let printed = listing.finish()?;
    if printed == Printed::Unread && failures.is_empty() {
        return Ok(super::exit::CLEAN);
    }
    outputs.finish()?;
    for remark in machines.loaded().filter_map(LoadedMachine::remark) {
        console.remark(&remark);
    }
    say_unread(&args.machine, &ledger, console);
    if args.listing.format.is_text() && listing.tally().files > 0 {
        let passed_over = walk::passed_over(found.passed_over);
        console.remark(&(total(listing.tally()) + &passed_over));
        listing.hint().iter().for_each(|hint| console.remark(hint));
    }
    failures.status(console, listing.status())
}

/// Says above everything else that no machine is described (R1.37).
fn say_undescribed(args: &CheckArgs, jobs: &[Job<'_>], (target, console): (&mut Target, Console)) {
    let undescribed = jobs.iter().filter_map(|(input, loaded)| {
        let described = loaded.as_ref().map_or(true, |it| it.machine.is_described());
        (!described).then_some(*input)
    });
    let Some(remark) = switched::remark(undescribed) else {
        return;
    };
    if args.listing.format.is_text() && !args.listing.quiet && !args.listing.statistics {
        // A writer that takes no more says so at the next line.
        let _ = writeln!(target.writer, "{}\n", wrap(&remark, target.look.width, 0));
    } else {
        console.remark(&remark);
    }
}

/// A program and the machine that it runs on.
type Job<'a> = (&'a Input, Result<Arc<LoadedMachine>, Failure>);

impl CheckArgs {
    fn notes(&self) -> Option<NoteKind> {
        match (self.unknowns, self.opaque) {
            (true, _) => Some(NoteKind::Unknown),
            (_, true) => Some(NoteKind::Opaque),
            _ => None,
        }
    }

    /// Runs a program and keeps what there is to note.
    fn take_notes(
        &self,
        kind: NoteKind,
        (input, loaded): Job<'_>,
        lines: &mut BTreeSet<Note>,
    ) -> Result<(), Failure> {
        let loaded = loaded?;
        let mut options = self.execution.options(&loaded, StopPolicy::CheckAll);
        options.notes = Notes::Taken;
        let alone = Alone {
            options,
            naming: Naming::AsGiven,
            axes: Axes::AsTheyOccur,
        };
        let session = run_alone(input, &loaded, alone, &mut Found::default())?;
        for (name, place) in session.notes(kind) {
            lines.insert(Note {
                name: name.to_owned(),
                file: place.file.to_string(),
                start: place.start(),
            });
        }
        let more = session.notes_left_out();
        if more > 0 {
            let (name, listed) = (input.name(Naming::AsGiven), session.notes(kind).count());
            Console::talk(&format!(
                "{name}: {listed} places are listed; further ones occurred {more} times"
            ));
        }
        Ok(())
    }

    /// Checks the programs, many at once, and lists what was found in their order.
    fn check_all(&self, jobs: Vec<Job<'_>>, listing: &mut Lister<'_>, failures: &mut Failures) {
        let mut listed: Vec<Option<PathBuf>> = Vec::new();
        let workers = self.jobs.unwrap_or_else(workers::processors);
        let workers = workers.min(NonZeroUsize::new(jobs.len()).unwrap_or(NonZeroUsize::MIN));
        let check = |(input, loaded): Job<'_>| {
            let loaded = loaded?;
            let found = check_file(input, &loaded, &self.execution)?;
            Ok((loaded, found))
        };
        workers::in_order(jobs.into_iter(), workers, check, |checked| {
            let (loaded, found) = match checked {
                Ok(checked) => checked,
                Err(failure) => {
                    failures.push(failure);
                    return ControlFlow::Continue(());
                }
            };
            let mut flow = ControlFlow::Continue(());
            if !listed.contains(&loaded.origin) {
                listed.push(loaded.origin.clone());
                for diagnostic in loaded.errors() {
                    flow = listing.diagnostic(diagnostic);
                }
            }
            listing.file();
            for diagnostic in found.diagnostics.values() {
                flow = listing.diagnostic(diagnostic);
            }
            for (severity, more) in &found.unsaid {
                listing.count(*severity, *more);
            }
            flow
        });
    }
}

/// Every diagnostic of one program, in the order of the places, each once.
fn check_file(
    input: &Input,
    loaded: &LoadedMachine,
    execution: &ExecutionArgs,
) -> Result<Found, Failure> {
    let options = execution.options(loaded, StopPolicy::CheckAll);
    let mut found = Found::default();
    let session = run_alone(
        input,
        loaded,
        Alone {
            options,
            naming: Naming::AsGiven,
            axes: Axes::AsTheyOccur,
        },
        &mut found,
    )?;
    found.unsaid = session.counts().clone();
    for (severity, said) in &found.said {
        let counted = found.unsaid.entry(*severity).or_default();
        *counted = counted.saturating_sub(*said);
    }
    Ok(found)
}

/// What makes two diagnostics the same.
type Key = (Arc<str>, Position, Position, Code, String);

/// Keeps each diagnostic once, however often a loop brings it up.
#[derive(Default)]
struct Found {
    diagnostics: BTreeMap<Key, Diagnostic>,
    /// How many came, by severity.
    said: BTreeMap<Severity, u64>,
    /// How many more the session counted: a file says so many and no more (R2.85).
    unsaid: BTreeMap<Severity, u64>,
}

impl Found {
    fn add(&mut self, diagnostic: &Diagnostic) {
        *self.said.entry(diagnostic.severity).or_default() += 1;
        let place = &diagnostic.place;
        let key = (
            place.file.clone(),
            place.start(),
            place.end(),
            diagnostic.code,
            diagnostic.message.clone(),
        );
        self.diagnostics
            .entry(key)
            .or_insert_with(|| diagnostic.clone());
    }

    /// Says how often a message came true that is said once.
    fn count(&mut self, repeat: &Repeat) {
        let from = (
            Arc::from(repeat.file.as_str()),
            repeat.start,
            repeat.start,
            Code::ALL[0],
            String::new(),
        );
        let here = self.diagnostics.range_mut(from..);
        let here = here
            .take_while(|((file, start, ..), _)| **file == *repeat.file && *start == repeat.start);
        for ((_, _, _, code, message), said) in here {
            if *code == repeat.code && *message == repeat.message {
                said.message = format!("{message} ({} times)", repeat.times);
            }
        }
    }
}

impl Sink for Found {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Block(row) => row.diagnostics.iter().for_each(|said| self.add(said)),
            Record::End(end) => {
                end.notes.iter().for_each(|note| self.add(&note.diagnostic));
                end.repeated.iter().for_each(|repeat| self.count(repeat));
            }
            // What the lists say is listed once a machine, not once a program.
            Record::Machine(said) => *self.said.entry(said.severity).or_default() += 1,
            Record::Session { .. } | Record::Program { .. } | Record::Summary(_) => {}
        }
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::{SourceFile, Span};

    #[test]
    fn a_diagnostic_is_kept_once_and_in_the_order_of_the_text() {
        let file = SourceFile::new("a.nc", "N1 X\nN2 Y");
        let at = |start| Diagnostic::new(Code::Fc402, file.place(Span::new(start, start + 1)), "x");
        let mut found = Found::default();
        for start in [5, 3, 5, 0, 3] {
            found.add(&at(start));
        }
        let starts: Vec<String> = found
            .diagnostics
            .values()
            .map(|diagnostic| diagnostic.place.start().to_string())
            .collect();
        assert_eq!(starts, ["1:1", "1:4", "2:1"]);
    }
}
