//! Changes by `check --fix`, shown by `check --diff` (R9.82).

use std::fmt::Write as _;

use clap::Args;

use crate::output::{Console, DataTarget, Failure, Failures, Printed, difference, exit, shown};
use frictcomp::text::shown_path;
use frictcomp_host::{CheckOptions, Input, Machines, MendedFile, ProgramsOnMachines, write_mended};
use frictcomp_report::{TextChange, render_unified};

/// Largest number of rounds of changes, since changes may call for others.
const MOST_PASSES: usize = 10;

/// Options for applying or showing changes of the programs.
#[derive(Debug, Clone, Args)]
pub(crate) struct FixArgs {
    /// Apply the changes that do not affect what the machine does, then print the remaining messages
    #[arg(long)]
    pub(crate) fix: bool,
    /// Instead of messages, show the changes that `--fix` would apply, as a unified diff
    #[arg(long, conflicts_with_all = ["fix", "format", "statistics", "fail_on"])]
    pub(crate) diff: bool,
}

/// Programs and the setup of their runs.
pub(crate) struct MendRun<'a> {
    pub(crate) inputs: &'a [Input],
    pub(crate) machines: &'a mut Machines,
    pub(crate) options: &'a CheckOptions,
}

impl MendRun<'_> {
    /// Makes the safe changes of the programs, each file as a whole.
    pub(crate) fn fix(&mut self, console: Console, failures: &mut Failures) -> Result<(), Failure> {
        self.only_files("--fix")?;
        for _ in 0..MOST_PASSES {
            let mut failed = Failures::default();
            let mended = self.mended(&mut failed);
            let is_done = mended.is_empty();
            for file in mended {
                let (path, count) = (shown(&file.path), changes(file.changes));
                match write_mended([&file]) {
                    Ok(()) => console.remark(&format!("fixed `{path}`: {count}")),
                    Err(error) => failed.push(error.into()),
                }
            }
            let is_done = is_done || !failed.is_empty();
            failures.extend(failed);
            if is_done {
                return Ok(());
            }
        }
        Ok(())
    }

    /// Shows the safe changes of the programs.
    pub(crate) fn diff(
        &mut self,
        target: &mut DataTarget,
        (console, failures): (Console, &mut Failures),
    ) -> Result<u8, Failure> {
        self.only_files("--diff")?;
        let mended = self.mended(failures);
        if target.painted(&differences(&mended), difference)? == Printed::Unread {
            return Ok(exit::CLEAN);
        }
        if mended.is_empty() {
            console.remark("nothing to change");
            return Ok(exit::CLEAN);
        }
        let count: usize = mended.iter().map(|file| file.changes).sum();
        let files = match mended.len() {
            1 => "1 file".to_owned(),
            count => format!("{count} files"),
        };
        console.remark(&format!(
            "{} in {files} (`--fix` applies {})",
            changes(count),
            if count == 1 { "it" } else { "them" },
        ));
        Ok(exit::FOUND)
    }

    /// Refuses inputs that can be read only once and not replaced: standard input, pipes, devices.
    fn only_files(&self, option: &str) -> Result<(), Failure> {
        let name = |input: &Input| match input {
            Input::Stdin => Some("standard input".to_owned()),
            Input::File(path) if path.exists() && !path.is_file() => {
                Some(format!("`{}`", shown_path(path)))
            }
            Input::File(_) | Input::Open(_) => None,
        };
        match self.inputs.iter().find_map(name) {
            Some(name) => Err(Failure::new(format!("`{option}` cannot change {name}"))
                .with_help("name a regular file")),
            None => Ok(()),
        }
    }

    /// Returns the files with their safe changes.
    fn mended(&mut self, failures: &mut Failures) -> Vec<MendedFile> {
        let programs = ProgramsOnMachines::new(self.inputs, self.machines);
        failures.keep(programs.mended(self.options))
    }
}

fn changes(count: usize) -> String {
    match count {
        1 => "1 change".to_owned(),
        _ => format!("{count} changes"),
    }
}

/// Returns the changes of files as a unified diff.
pub(crate) fn differences<'a>(files: impl IntoIterator<Item = &'a MendedFile>) -> String {
    let mut output = String::new();
    for file in files {
        let name = shown(&file.path);
        let [before, after] = [&file.before, &file.after].map(|text| with_line_feeds(text));
        let change = TextChange {
            before: (&name, &before),
            after: (&name, &after),
        };
        let _ = write!(output, "{}", render_unified(change));
    }
    output
}

/// Returns a text whose lines end like those of a difference.
fn with_line_feeds(text: &str) -> String {
    text.replace("\r\n", "\n").replace('\r', "\n")
}
