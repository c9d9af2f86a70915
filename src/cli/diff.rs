//! `frictcomp diff`: which blocks change the compensation state between two versions.

use std::fmt::Write as _;
use std::hash::{Hash, Hasher};
use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::Args;
use similar::{Algorithm, ChangeTag, capture_diff_slices};

use super::console::{Console, Printed};
use super::execution::ExecutionArgs;
use super::exit;
use super::failure::{Failure, shown};
use super::machine::{MachineArgs, undescribed_remark};
use super::painted::difference;
use super::settings;
use crate::comp::{KindSet, State};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::host::{Alone, Axes, Input, Ledger, Naming, run_alone};
use crate::report::visible_line;
use crate::session::StopPolicy;
use crate::timeline::{EndedBy, Record, Row, Sink};

/// Show which compensation changes differ between two versions of a program
#[derive(Debug, Args)]
pub(super) struct DiffArgs {
    /// The old version
    #[arg(value_name = "OLD")]
    old: PathBuf,
    /// The new version
    #[arg(value_name = "NEW")]
    new: PathBuf,
    /// The kinds of compensation to compare: `FRICT,LEAD` or `all`
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
    /// An error or a bound of which the end will tell whether it stopped the program.
    candidate: Option<String>,
    /// Why the version cannot be compared as a whole.
    obstacle: Option<String>,
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
                    change.kind.as_str(),
                    change.from.as_str(),
                    change.to.as_str(),
                ),
                line: row.line,
                text: text.to_owned(),
            });
        }
    }
}

impl Switches {
    /// Looks at a message for what keeps the version from being compared.
    fn judge(&mut self, said: &Diagnostic) {
        let place = &said.place;
        let (file, line) = (&place.file, place.start().line);
        let code = said.code;
        if code.severity() == Severity::Error || code.is_budget() {
            self.candidate.get_or_insert_with(|| {
                format!("{file}:{line} stops with {code}: {}", said.message)
            });
        }
        if code == Code::Fc408 {
            self.obstacle.get_or_insert_with(|| {
                format!("what {file}:{line} does depends on a machine that is not described")
            });
        }
    }
}

impl Sink for Switches {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        match record {
            Record::Block(row) => {
                self.add(row);
                row.diagnostics.iter().for_each(|said| self.judge(said));
                let lost = row
                    .changes
                    .iter()
                    .find(|change| change.to == State::Unknown && self.kinds.contains(change.kind));
                if let Some(change) = lost {
                    let (file, line) = (row.file, row.line);
                    let (name, kind) = (row.state.name(change.axis), change.kind.as_str());
                    self.obstacle.get_or_insert_with(|| {
                        format!("from {file}:{line} on {kind} of {name} is not known offline")
                    });
                }
            }
            Record::End(end) => {
                end.notes
                    .iter()
                    .for_each(|note| self.judge(&note.diagnostic));
                if matches!(end.by, EndedBy::Error | EndedBy::Budget) {
                    self.obstacle = self.candidate.take().or(self.obstacle.take());
                }
            }
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

/// Runs the command.
pub(super) fn run(args: &DiffArgs, console: Console) -> Result<u8, Failure> {
    let (old, above) = switches(args, &Input::new(&args.old))?;
    let (new, above_new) = switches(args, &Input::new(&args.new))?;
    let mut output = String::new();
    let same = append_difference(&mut output, &old.list, &new.list);
    if !same {
        let names = format!("--- {}\n+++ {}\n", shown(&args.old), shown(&args.new));
        output.insert_str(0, &names);
    }
    let obstacles: Vec<&String> = [&old, &new]
        .into_iter()
        .filter_map(|version| version.obstacle.as_ref())
        .collect();
    for obstacle in &obstacles {
        let _ = writeln!(output, "not comparable: {}", visible_line(obstacle));
    }
    if same && obstacles.is_empty() {
        let count = new.list.len();
        let plural = if count == 1 { "" } else { "s" };
        let _ = writeln!(
            output,
            "no difference: {count} change{plural} of state in both"
        );
    }
    if let Some(remark) = above.or(above_new) {
        output.insert_str(0, &format!("{remark}\n\n"));
    }
    if let Printed::Unread = console.print_painted(&console.fitted(&output), difference)? {
        return Ok(exit::CLEAN);
    }
    Ok(if same && obstacles.is_empty() {
        exit::CLEAN
    } else {
        exit::FOUND
    })
}

/// The changes of one version, and what stands above the result where its machine is not described.
fn switches(args: &DiffArgs, input: &Input) -> Result<(Switches, Option<String>), Failure> {
    input.probe()?;
    let mut machines = args.machine.machines(&Ledger::default());
    machines.look_ahead(std::slice::from_ref(input));
    let loaded = machines.for_folder(input.folder())?;
    let options = args.execution.options(&loaded, StopPolicy::FirstError);
    let mut switches = Switches {
        kinds: args.kinds,
        list: Vec::new(),
        candidate: None,
        obstacle: None,
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
    let remark = if loaded.machine.is_described() {
        None
    } else {
        undescribed_remark([&Input::new(&args.old), &Input::new(&args.new)])
    };
    Ok((switches, remark))
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
