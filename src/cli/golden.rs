//! `frictcomp golden`: each program's timeline against the one that was agreed on.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use similar::TextDiff;

use super::console::Console;
use super::discovery::{LoadedMachine, MachineArgs, Machines};
use super::dry_run::{Alone, ExecutionArgs, run_alone};
use super::failure::Failure;
use super::files::{Input, Naming};
use super::replace::replace;
use super::{exit, walk};
use crate::report::{Report, Text, TextOptions};
use crate::session::StopPolicy;

/// Compares each program's timeline with the `.timeline` file beside it
#[derive(Debug, Args)]
pub(super) struct GoldenArgs {
    /// Programs and folders of programs
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// Write the timelines instead of comparing them
    #[arg(long)]
    update: bool,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

/// Runs the command.
pub(super) fn run(args: &GoldenArgs, console: Console) -> Result<u8, Failure> {
    let inputs = walk::programs(&args.paths)?;
    let mut machines = Machines::new(&args.machine);
    let mut drifted = 0_u64;
    let mut output = String::new();
    for input in &inputs {
        let Input::File(path) = input else {
            return Err(Failure::new(
                "standard input has no `.timeline` file beside it",
            ));
        };
        let loaded = machines.for_folder(input.folder())?;
        let now = timeline(input, &loaded, &args.execution)?;
        let golden = golden_path(path);
        let before = read_golden(&golden)?;
        if before.as_deref() == Some(now.as_str()) {
            continue;
        }
        drifted += 1;
        if args.update {
            replace(&golden, now.as_bytes())?;
            let _ = writeln!(output, "wrote {}", golden.display());
        } else {
            append_drift(&mut output, &golden, before.as_deref(), &now);
        }
    }
    console.print(&output)?;
    let all = inputs.len();
    if args.update {
        Console::talk(&format!("{drifted} of {all} timelines written"));
        return Ok(exit::CLEAN);
    }
    if drifted == 0 {
        Console::talk(&format!("{all} timelines are as agreed"));
        return Ok(exit::CLEAN);
    }
    Console::talk(&format!(
        "{drifted} of {all} timelines drifted (`--update` writes them)"
    ));
    Ok(exit::FOUND)
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
        },
        &mut report,
    )?;
    report.finish().map_err(|error| Failure::output(&error))?;
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
    match std::fs::read(path) {
        Ok(bytes) => {
            let text = String::from_utf8_lossy(&bytes);
            Ok(Some(text.replace("\r\n", "\n")))
        }
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(Failure::reading(path, &error)),
    }
}

fn append_drift(output: &mut String, golden: &Path, before: Option<&str>, now: &str) {
    let shown = golden.display();
    let Some(before) = before else {
        let _ = writeln!(output, "{shown} is missing\n");
        return;
    };
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
            Some("one\ntwo\n"),
            "one\n2\n",
        );
        assert_eq!(
            output,
            "--- a.nc.timeline (agreed)\n+++ a.nc.timeline (now)\n@@ -1,2 +1,2 @@\n one\n-two\n+2\n\n"
        );
        output.clear();
        append_drift(&mut output, Path::new("a.nc.timeline"), None, "x");
        assert_eq!(output, "a.nc.timeline is missing\n\n");
    }
}
