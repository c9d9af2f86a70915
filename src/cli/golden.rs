//! `frictcomp golden`: each program's timeline against the one that was agreed on.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use similar::TextDiff;

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
    Alone, Axes, Input, Ledger, LoadedMachine, Machines, Naming, find_programs, folder, read_bytes,
    run_alone,
};
use crate::report::{Report, Text, TextOptions};
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

/// A timeline against the one that was agreed on.
enum Verdict {
    AsAgreed,
    /// There is none yet.
    Missing(String),
    Drifted {
        before: String,
        now: String,
    },
}

/// The programs of one call and what they run on.
struct Bench<'a> {
    args: &'a GoldenArgs,
    machines: Machines,
    ledger: Ledger,
    /// The folders that the user named, in which timelines may lie.
    trees: Vec<PathBuf>,
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
                let golden = golden_path(path);
                pairs.push(Pair { input, golden });
            }
            Input::Stdin => failures.push(Failure::new(
                "standard input has no `.timeline` file beside it",
            )),
        }
    }
    let inputs: Vec<Input> = pairs.iter().map(|pair| pair.input.clone()).collect();
    machines.look_ahead(&inputs);
    let tree = |path: &PathBuf| {
        let tree = if path.is_dir() { path } else { folder(path) };
        tree.canonicalize().ok()
    };
    let mut bench = Bench {
        args,
        machines,
        ledger,
        trees: args.paths.iter().filter_map(tree).collect(),
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
            match self.verdict(pair) {
                Ok(Verdict::AsAgreed) => {}
                Ok(Verdict::Missing(_)) => {
                    missing += 1;
                    let _ = writeln!(
                        output,
                        "{}",
                        console.fitted(&format!("{shown} is missing\n"))
                    );
                }
                Ok(Verdict::Drifted { before, now }) => {
                    drifted += 1;
                    append_drift(&mut output, &pair.golden, &before, &now);
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
            let now = match self.verdict(pair) {
                Ok(Verdict::AsAgreed) => continue,
                Ok(Verdict::Missing(now) | Verdict::Drifted { now, .. }) => now,
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

    fn verdict(&mut self, pair: &Pair) -> Result<Verdict, Failure> {
        self.stay_in_tree(&pair.golden)?;
        let loaded = self.machines.for_folder(pair.input.folder())?;
        let now = timeline(&pair.input, &loaded, &self.args.execution)?;
        Ok(match read_golden(&pair.golden)? {
            None => Verdict::Missing(now),
            Some(before) if before == now => Verdict::AsAgreed,
            Some(before) => Verdict::Drifted { before, now },
        })
    }

    /// A link may not lead to a file that the user did not hand over: it would be shown in a
    /// difference, or overwritten.
    fn stay_in_tree(&self, golden: &Path) -> Result<(), Failure> {
        let is_link = std::fs::symlink_metadata(golden).is_ok_and(|it| it.is_symlink());
        let inside = |path: PathBuf| self.trees.iter().any(|tree| path.starts_with(tree));
        if is_link && !golden.canonicalize().is_ok_and(inside) {
            let shown = golden.display();
            return Err(Failure::new(format!(
                "`{shown}` is a link that leads out of the given folders"
            ))
            .with_help("put the timeline itself there, or name its folder"));
        }
        Ok(())
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

/// `a.nc.timeline` beside `a.nc`, so that `a.nc` and `a.spf` do not meet.
fn golden_path(program: &Path) -> PathBuf {
    let mut name = program.as_os_str().to_owned();
    name.push(".timeline");
    name.into()
}

/// The agreed timeline, `None` when there is none. Line ends may be those of any system.
fn read_golden(path: &Path) -> Result<Option<String>, Failure> {
    match read_bytes(path) {
        Ok(bytes) => {
            let text = String::from_utf8_lossy(&bytes);
            Ok(Some(text.replace("\r\n", "\n")))
        }
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(Failure::reading(path, error)),
    }
}

fn append_drift(output: &mut String, golden: &Path, before: &str, now: &str) {
    let shown = shown(golden);
    let diff = TextDiff::from_lines(before, now);
    let agreed = format!("{shown} (agreed)");
    let found = format!("{shown} (now)");
    let mut unified = diff.unified_diff();
    let _ = writeln!(output, "{}", unified.header(&agreed, &found));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drift_is_shown_as_a_diff() {
        let mut output = String::new();
        append_drift(
            &mut output,
            Path::new("a.nc.timeline"),
            "one\ntwo\n",
            "one\n2\n",
        );
        assert_eq!(
            output,
            "--- a.nc.timeline (agreed)\n+++ a.nc.timeline (now)\n@@ -1,2 +1,2 @@\n one\n-two\n+2\n\n"
        );
    }
}
