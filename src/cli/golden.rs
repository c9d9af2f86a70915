//! `frictcomp golden`: each program's timeline against the one that was agreed on.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;

use super::console::{Console, Printed};
use super::execution::ExecutionArgs;
use super::exit;
use super::failure::{Failure, shown};
use super::failures::Failures;
use super::listing::passed_over;
use super::machine::MachineArgs;
use super::outputs::{Outputs, write_text};
use super::painted::difference;
use super::severities::SeverityArgs;
use crate::host::{
    AgreedTimelines, Alone, Axes, Input, Ledger, LoadedMachine, Machines, Naming, TimelineDrift,
    find_programs, folder, run_alone,
};
use crate::report::{Report, Text, TextChange, TextOptions, render_unified};
use crate::session::StopPolicy;

/// The option that writes timelines.
const UPDATE: &str = "golden --update";

/// Compare each program's timeline with the `.timeline` file beside it
#[derive(Debug, Args)]
pub(super) struct GoldenArgs {
    /// Programs and folders of programs
    #[arg(value_name = "PATH", default_value = ".")]
    paths: Vec<PathBuf>,
    /// Write the timelines instead of comparing them
    #[arg(long)]
    update: bool,
    /// Print only the differences
    #[arg(long, short)]
    quiet: bool,
    #[command(flatten)]
    severities: SeverityArgs,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

/// A program with the file that holds its timeline.
struct Pair {
    input: Input,
    golden: PathBuf,
}

/// The programs of one call and what they run on.
struct Bench<'a> {
    args: &'a GoldenArgs,
    machines: Machines,
    ledger: Ledger,
    agreed: AgreedTimelines,
    /// What to say of files that are no programs.
    passed_over: String,
}

/// Runs the command.
pub(super) fn run(args: &GoldenArgs, console: Console) -> Result<u8, Failure> {
    let ledger = Ledger::default();
    let console = if args.quiet { console.quiet() } else { console };
    let mut machines = args.machine.weighed(&args.severities, &ledger)?;
    let found = find_programs(&args.paths, |folder| machines.extensions(folder));
    let mut failures = Failures::from(found.failures);
    let mut pairs = Vec::new();
    for input in found.inputs {
        input.note(&ledger);
        match &input {
            Input::File(path) => {
                let golden = AgreedTimelines::path(path);
                pairs.push(Pair { input, golden });
            }
            Input::Stdin => failures.push(Failure::new(
                "standard input has no `.timeline` file beside it",
            )),
        }
    }
    let inputs: Vec<Input> = pairs.iter().map(|pair| pair.input.clone()).collect();
    machines.look_ahead(&inputs);
    let mut bench = Bench {
        args,
        machines,
        ledger,
        agreed: AgreedTimelines::of(&args.paths),
        passed_over: passed_over(found.passed_over),
    };
    let status = if args.update {
        bench.update(&pairs, console, &mut failures)?
    } else {
        bench.compare(&pairs, console, &mut failures)?
    };
    failures.status(console, status)
}

impl Bench<'_> {
    fn compare(
        &mut self,
        pairs: &[Pair],
        console: Console,
        failures: &mut Failures,
    ) -> Result<u8, Failure> {
        let (mut drifted, mut missing) = (0_u64, 0_u64);
        let mut output = String::new();
        for pair in pairs {
            let shown = shown(&pair.golden);
            match self.drift(pair) {
                Ok(TimelineDrift::AsAgreed) => {}
                Ok(TimelineDrift::Missing { .. }) => {
                    missing += 1;
                    let _ = writeln!(
                        output,
                        "{}",
                        console.fitted(&format!("{shown} is missing\n"))
                    );
                }
                Ok(TimelineDrift::Drifted { before, now }) => {
                    drifted += 1;
                    let (agreed, found) = (format!("{shown} (agreed)"), format!("{shown} (now)"));
                    let change = TextChange {
                        before: (&agreed, &before),
                        after: (&found, &now),
                    };
                    let _ = writeln!(output, "{}", render_unified(change));
                }
                Err(failure) => failures.push(failure),
            }
        }
        if let Printed::Unread = console.print_painted(&output, difference)? {
            return Ok(exit::CLEAN);
        }
        let all = pairs.len();
        if drifted + missing > 0 {
            let counts = [(drifted, "drifted"), (missing, "missing")];
            let parts = counts.iter().filter(|(count, _)| *count > 0);
            let parts: Vec<String> = parts.map(|(n, word)| format!("{n} {word}")).collect();
            Console::talk(&format!(
                "of {} {} (`--update` writes them)",
                timelines(all),
                parts.join(", ")
            ));
            return Ok(exit::FOUND);
        }
        if failures.is_empty() {
            console.remark(&format!("{} as agreed{}", timelines(all), self.passed_over));
        }
        Ok(exit::CLEAN)
    }

    /// Writes the timelines that drifted, all or none of a folder (R9.77).
    fn update(
        &mut self,
        pairs: &[Pair],
        console: Console,
        failures: &mut Failures,
    ) -> Result<u8, Failure> {
        let mut all = Outputs::new(&self.ledger, console);
        for pair in pairs {
            all.claim(UPDATE, &pair.golden);
        }
        all.check()?;
        let mut folders: Vec<(&Path, Vec<&Pair>)> = Vec::new();
        for pair in pairs {
            let folder = folder(&pair.golden);
            match folders.iter_mut().find(|(known, _)| *known == folder) {
                Some((_, pairs)) => pairs.push(pair),
                None => folders.push((folder, vec![pair])),
            }
        }
        let mut written = 0;
        for (folder, pairs) in folders {
            match self.update_folder(&pairs, console) {
                Ok(count) => written += count,
                Err(reasons) => {
                    for reason in reasons {
                        failures.push(reason);
                    }
                    let (shown, count) = (folder.display(), timelines(pairs.len()));
                    Console::talk(&format!(
                        "left out `{shown}`: nothing of its {count} was written"
                    ));
                }
            }
        }
        let all = timelines(pairs.len());
        console.remark(&format!("{written} of {all} written{}", self.passed_over));
        Ok(exit::CLEAN)
    }

    fn update_folder(&mut self, pairs: &[&Pair], console: Console) -> Result<usize, Vec<Failure>> {
        let mut outputs = Outputs::new(&self.ledger, console);
        let (mut written, mut reasons) = (0, Vec::new());
        for pair in pairs {
            let now = match self.drift(pair) {
                Ok(TimelineDrift::AsAgreed) => continue,
                Ok(TimelineDrift::Missing { now } | TimelineDrift::Drifted { now, .. }) => now,
                Err(reason) => {
                    reasons.push(reason);
                    continue;
                }
            };
            let write = |outputs: &mut Outputs| -> Result<(), Failure> {
                let mut file = outputs.file(UPDATE, &pair.golden)?;
                write_text(&mut file, &now)?;
                Ok(file.sync()?)
            };
            match write(&mut outputs) {
                Ok(()) => written += 1,
                Err(reason) => reasons.push(reason),
            }
        }
        if !reasons.is_empty() {
            return Err(reasons);
        }
        outputs.finish().map_err(|reason| vec![reason])?;
        Ok(written)
    }

    fn drift(&mut self, pair: &Pair) -> Result<TimelineDrift, Failure> {
        let loaded = self.machines.for_folder(pair.input.folder())?;
        let now = timeline(&pair.input, &loaded, &self.args.execution)?;
        Ok(self.agreed.compare(&pair.golden, now)?)
    }
}

fn timelines(count: usize) -> String {
    match count {
        1 => "1 timeline".to_owned(),
        _ => format!("{count} timelines"),
    }
}

/// The timeline of one program, the same on every machine and in every folder.
fn timeline(
    input: &Input,
    loaded: &LoadedMachine,
    execution: &ExecutionArgs,
) -> Result<String, Failure> {
    let mut bytes = Vec::new();
    let mut report = Text::new(&mut bytes, TextOptions::default());
    let options = execution.options(loaded, StopPolicy::FirstError);
    run_alone(
        input,
        loaded,
        Alone {
            options,
            naming: Naming::FileName,
            axes: Axes::Ahead,
        },
        &mut report,
    )?;
    report.finish().map_err(Failure::output)?;
    drop(report);
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
