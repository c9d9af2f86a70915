//! `frictcomp show calls`: which programs call which.

use std::collections::VecDeque;
use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use crate::args::{FolderArgs, MachineArgs, say_left_out};
use crate::output::{Console, Failure, Failures, Outputs, Printed, ResultArgs, exit, parts};
use frictcomp::interpreter::NoProgram;
use frictcomp_host::{
    CallGraph, FileRegistry, GraphProgram, MissingCall, find_programs, processors,
};
use frictcomp_report::{Headline, Standing, counted, to_json, visible_line};

/// The deepest call that is indented; deeper ones begin a separate tree.
const MAX_DEPTH: usize = 24;

/// Show which programs call which, those that no program calls, and calls of missing programs
///
/// Nothing is executed: a call counts whether it is reached or not. A call whose program depends on the
/// value of a variable is marked as such.
#[derive(Debug, Args)]
pub(crate) struct CallsArgs {
    /// Programs and folders of programs
    #[arg(value_name = "PATH", default_value = ".")]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    result: ResultArgs<CallsFormat>,
    #[command(flatten)]
    folders: FolderArgs,
    #[command(flatten)]
    machine: MachineArgs,
}

/// A format of the calls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum CallsFormat {
    /// A tree for people.
    #[default]
    Text,
    /// Graphviz.
    Dot,
    /// One JSON document.
    Json,
}

/// Runs the command.
pub(super) fn run(args: &CallsArgs, console: Console) -> Result<u8, Failure> {
    Failures::of(console, |failures| graph(args, console, failures))
}

fn graph(args: &CallsArgs, console: Console, failures: &mut Failures) -> Result<u8, Failure> {
    if args.paths.iter().any(|path| path.as_os_str() == "-") {
        let failure = Failure::new("standard input has no folder in which it could be called");
        return Err(failure.with_help("name programs or folders"));
    }
    let registry = FileRegistry::default();
    let machines = args.machine.machines(&registry);
    let mut machines = machines.selecting(args.folders.options());
    let mut found = find_programs(&args.paths, |folder| machines.selection(folder));
    failures.extend(Failures::from(found.failures));
    for input in &found.inputs {
        input.note(&registry);
    }
    let mut outputs = Outputs::new(&registry, console);
    let mut target = outputs.result(args.result.output.as_deref())?;
    outputs.check()?;
    let mut calls = failures.keep(CallGraph::of(&found.inputs, &mut machines, processors()));
    for program in calls.programs() {
        program.input.note(&registry);
    }
    outputs.check()?;
    let mains = calls.mains(processors());
    let shown = CallsOutput { calls, mains };
    let printed = match args.result.format {
        CallsFormat::Text => target.painted(&shown.text(), parts)?,
        CallsFormat::Dot => target.text(&shown.dot())?,
        CallsFormat::Json => target.text(&to_json(&shown.json()))?,
    };
    if printed == Printed::Read {
        outputs.finish()?;
    }
    say_left_out(&mut found.left_out, &registry, console);
    Ok(exit::CLEAN)
}

/// A graph that is being written.
struct CallsOutput {
    calls: CallGraph,
    /// Whether each program is a main program.
    mains: Vec<bool>,
}

impl CallsOutput {
    fn programs(&self) -> &[GraphProgram] {
        self.calls.programs()
    }

    fn name(&self, at: usize) -> String {
        visible_line(&self.programs()[at].name).into_owned()
    }

    fn names(&self, all: &[usize]) -> String {
        let names: Vec<String> = all.iter().map(|at| self.name(*at)).collect();
        names.join(", ")
    }

    fn text(&self) -> String {
        let mut out = format!("{}\n\n", self.headline());
        let mut is_shown = vec![false; self.mains.len()];
        let roots = (0..self.mains.len()).filter(|at| self.mains[*at]);
        let mut roots: VecDeque<usize> = roots.collect();
        while let Some(root) = roots.pop_front() {
            if !is_shown[root] {
                let _ = writeln!(out, "{}", self.name(root));
                self.tree(root, (&mut is_shown, &mut roots), &mut out);
            }
        }
        self.append_circles(&mut out);
        for same in self.calls.of_one_name() {
            let _ = writeln!(out, "one name in several folders: {}", self.names(&same));
        }
        out
    }

    /// Appends the calls of a program, and those of what it calls unless they are already shown.
    fn tree(
        &self,
        root: usize,
        (is_shown, roots): (&mut [bool], &mut VecDeque<usize>),
        out: &mut String,
    ) {
        is_shown[root] = true;
        self.append_other_calls(root, 1, out);
        let mut open = vec![(root, 0)];
        while let Some((at, next)) = open.last_mut() {
            let Some(call) = self.programs()[*at].calls.get(*next) else {
                open.pop();
                continue;
            };
            *next += 1;
            let depth = open.len();
            let again = if is_shown[call.program] && !self.programs()[call.program].is_leaf() {
                ", see above"
            } else {
                ""
            };
            let (indent, name) = ("  ".repeat(depth), self.name(call.program));
            let _ = writeln!(out, "{indent}{name} (line {}){again}", call.line);
            if is_shown[call.program] {
                continue;
            }
            if depth == MAX_DEPTH {
                roots.push_front(call.program);
                continue;
            }
            is_shown[call.program] = true;
            self.append_other_calls(call.program, depth + 1, out);
            open.push((call.program, 0));
        }
    }

    /// Appends the calls of a program that lead nowhere.
    fn append_other_calls(&self, at: usize, depth: usize, out: &mut String) {
        let (indent, program) = ("  ".repeat(depth), &self.programs()[at]);
        for missing in &program.missing {
            let (name, line) = (visible_line(&missing.name), missing.line);
            let _ = writeln!(out, "{indent}{name} (line {line}): {}", why(missing));
        }
        for line in &program.open {
            let _ = writeln!(
                out,
                "{indent}a program known only at run time (line {line})"
            );
        }
    }

    fn append_circles(&self, out: &mut String) {
        for circle in self.calls.circles() {
            let _ = match circle.as_slice() {
                [one] => writeln!(out, "calls itself: {}", self.name(*one)),
                several => writeln!(out, "call each other in a cycle: {}", self.names(several)),
            };
        }
    }

    fn dot(&self) -> String {
        let quoted = |name: &str| {
            let name = visible_line(name);
            format!("\"{}\"", name.replace('\\', "\\\\").replace('"', "\\\""))
        };
        let mut out = String::from("digraph calls {\n  rankdir=LR\n  node [shape=box]\n");
        for (program, is_main) in self.programs().iter().zip(&self.mains) {
            let (name, style) = (
                quoted(&program.name),
                if *is_main { " [penwidth=2]" } else { "" },
            );
            let _ = writeln!(out, "  {name}{style}");
            for call in &program.calls {
                let called = quoted(&self.programs()[call.program].name);
                let _ = writeln!(out, "  {name} -> {called} [label=\"{}\"]", call.line);
            }
            for missing in &program.missing {
                let called = quoted(&format!("{} (missing)", missing.name));
                let _ = writeln!(out, "  {called} [style=dashed]");
                let _ = writeln!(
                    out,
                    "  {name} -> {called} [label=\"{}\", style=dashed]",
                    missing.line
                );
            }
        }
        out + "}\n"
    }

    fn json(&self) -> Value {
        let programs = self.programs();
        let name = |at: &usize| Value::from(programs[*at].name.as_str());
        let named = |all: Vec<Vec<usize>>| -> Vec<Vec<Value>> {
            let all = all.iter().map(|circle| circle.iter());
            all.map(|circle| circle.map(name).collect()).collect()
        };
        let shown = programs.iter().zip(&self.mains).map(|(program, is_main)| {
            let calls = program.calls.iter();
            let calls = calls.map(|it| json!({ "file": name(&it.program), "line": it.line }));
            let called_by: Vec<Value> = program.called_by.iter().map(name).collect();
            json!({
                "file": program.name,
                "main": is_main,
                "calls": calls.collect::<Vec<_>>(),
                "called_by": called_by,
                "open": program.open,
            })
        });
        let missing = programs.iter().flat_map(|program| {
            let missing = program.missing.iter();
            missing.map(|it| json!({ "file": program.name, "line": it.line, "name": it.name }))
        });
        json!({
            "schema": 1,
            "headline": self.headline(),
            "programs": shown.collect::<Vec<_>>(),
            "missing": missing.collect::<Vec<_>>(),
            "circles": named(self.calls.circles()),
            "same_name": named(self.calls.of_one_name()),
        })
    }

    fn headline(&self) -> Headline {
        let programs = self.programs();
        let uncalled = programs.iter().filter(|it| it.called_by.is_empty());
        let missing = programs.iter().map(|it| it.missing.len()).sum::<usize>();
        let text = format!(
            "{}, {}, {} that no program calls; {} of missing programs",
            counted(programs.len(), "program"),
            counted(self.mains.iter().filter(|it| **it).count(), "main program"),
            uncalled.count(),
            counted(missing, "call"),
        );
        let standing = if missing > 0 {
            Standing::Bad
        } else {
            Standing::Plain
        };
        Headline::new(standing, text)
    }
}

fn why(missing: &MissingCall) -> String {
    match &missing.why {
        NoProgram::Near(name) => format!("missing, there is `{}`", visible_line(name)),
        NoProgram::Outside => {
            "lies outside the folders of the programs (`--allow-outside`)".to_owned()
        }
        NoProgram::Unusable(reason) => reason.clone(),
        _ => "missing".to_owned(),
    }
}
