//! `frictcomp diff`: which blocks change the compensation state between two versions.

use std::fmt::Write as _;
use std::hash::{Hash, Hasher};
use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::Args;
use similar::{Algorithm, ChangeTag, capture_diff_slices};

use super::console::{Console, Printed};
use super::discovery::{MachineArgs, Machines};
use super::dry_run::{Alone, Axes, ExecutionArgs, run_alone};
use super::exit;
use super::failure::{Failure, shown};
use super::files::{Input, Naming};
use super::ledger::Ledger;
use super::painted::difference;
use super::settings;
use crate::diagnostic::Severity;
use crate::report::visible_line;
use crate::session::StopPolicy;
use crate::syntax::KindSet;
use crate::timeline::{Record, Row, Sink};

/// Shows which blocks change the compensation state between two versions of a program
#[derive(Debug, Args)]
pub(super) struct DiffArgs {
    /// The version before
    #[arg(value_name = "OLD")]
    old: PathBuf,
    /// The version now
    #[arg(value_name = "NEW")]
    new: PathBuf,
    /// The kinds of compensation that are compared: `FRICT,LEAD` or `all`
    #[arg(long, value_name = "KINDS", default_value = "FRICT", value_parser = settings::parse_kinds)]
    kinds: KindSet,
    #[command(flatten)]
    machine: MachineArgs,
    #[command(flatten)]
    execution: ExecutionArgs,
}

/// One change of a state; the line is shown, but lines that moved make no difference.
#[derive(Debug, Clone)]
struct Switch {
    /// The block number, or the text of a block without one.
    block: String,
    /// Axis, kind and states.
    change: String,
    line: u32,
    text: String,
}

impl PartialEq for Switch {
    fn eq(&self, other: &Self) -> bool {
        self.block == other.block && self.change == other.change
    }
}

impl Eq for Switch {}

impl Hash for Switch {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.block.hash(state);
        self.change.hash(state);
    }
}

/// Keeps the changes of one version.
struct Switches {
    kinds: KindSet,
    list: Vec<Switch>,
    /// The first error, which ends the run.
    error: Option<String>,
}

impl Switches {
    fn add(&mut self, row: &Row<'_>) {
        let changes = row
            .changes
            .iter()
            .filter(|change| self.kinds.contains(change.kind));
        for change in changes {
            let text = row.text.lines().next().unwrap_or_default().trim_end();
            self.list.push(Switch {
                block: match row.number {
                    Some(number) => format!("N{number}"),
                    None => row.text.to_owned(),
                },
                change: format!(
                    "{} {}: {} → {}",
                    row.state.name(change.axis),
                    change.kind.keyword(),
                    change.from.word(),
                    change.to.word(),
                ),
                line: row.line,
                text: text.to_owned(),
            });
        }
    }
}

impl Sink for Switches {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        if let Record::Block(row) = record {
            self.add(row);
            let error = row
                .diagnostics
                .iter()
                .find(|diagnostic| diagnostic.severity == Severity::Error);
            if let (None, Some(error)) = (&self.error, error) {
                self.error = Some(format!(
                    "{}:{} stops with {}: {}",
                    row.file, row.line, error.code, error.message
                ));
            }
        }
        ControlFlow::Continue(())
    }
}

/// Runs the command.
pub(super) fn run(args: &DiffArgs, console: Console) -> Result<u8, Failure> {
    let old = switches(args, &Input::new(&args.old))?;
    let new = switches(args, &Input::new(&args.new))?;
    let mut output = String::new();
    let same = append_difference(&mut output, &old, &new);
    if same {
        let count = new.len();
        let plural = if count == 1 { "" } else { "s" };
        let _ = writeln!(
            output,
            "no difference: {count} change{plural} of state in both"
        );
    } else {
        let names = format!("--- {}\n+++ {}\n", shown(&args.old), shown(&args.new));
        output.insert_str(0, &names);
    }
    if let Printed::Unread = console.print_painted(&output, difference)? {
        return Ok(exit::CLEAN);
    }
    Ok(if same { exit::CLEAN } else { exit::FOUND })
}

fn switches(args: &DiffArgs, input: &Input) -> Result<Vec<Switch>, Failure> {
    input.probe()?;
    let mut machines = Machines::new(&args.machine, &Ledger::default());
    machines.look_ahead(std::slice::from_ref(input));
    let loaded = machines.for_folder(input.folder())?;
    let options = args.execution.options(&loaded, StopPolicy::FirstError);
    let mut switches = Switches {
        kinds: args.kinds,
        list: Vec::new(),
        error: None,
    };
    run_alone(
        input,
        &loaded,
        Alone {
            options,
            naming: Naming::AsGiven,
            axes: Axes::AsTheyOccur,
        },
        &mut switches,
    )?;
    if let Some(error) = &switches.error {
        Console::talk(error);
    }
    Ok(switches.list)
}

/// Appends what differs; says whether nothing does.
fn append_difference(output: &mut String, old: &[Switch], new: &[Switch]) -> bool {
    let operations = capture_diff_slices(Algorithm::Myers, old, new);
    let mut same = true;
    for operation in &operations {
        for change in operation.iter_changes(old, new) {
            let sign = match change.tag() {
                ChangeTag::Equal => continue,
                ChangeTag::Delete => '-',
                ChangeTag::Insert => '+',
            };
            same = false;
            let switch = change.value();
            let _ = writeln!(
                output,
                "{sign} {:>6}  {:<28}  {}",
                switch.line,
                switch.change,
                visible_line(&switch.text)
            );
        }
    }
    same
}

#[cfg(test)]
mod tests {
    use super::*;

    fn switch(line: u32, block: &str, change: &str) -> Switch {
        Switch {
            block: block.to_owned(),
            change: change.to_owned(),
            line,
            text: format!("{block} …"),
        }
    }

    #[test]
    fn moved_lines_make_no_difference() {
        let mut output = String::new();
        let old = [switch(4, "N25", "Y FRICT: active → inactive")];
        let new = [switch(9, "N25", "Y FRICT: active → inactive")];
        assert!(append_difference(&mut output, &old, &new));
        assert_eq!(output, "");
        assert!(!append_difference(&mut output, &old, &[]));
        assert_eq!(output, "-      4  Y FRICT: active → inactive    N25 …\n");
    }
}
