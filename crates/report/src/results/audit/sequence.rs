//! The effect of a given order, program by program (R10.6).

use std::collections::BTreeSet;
use std::fmt::Write as _;

use serde_json::{Map, Value, json};

use super::subject::axis_name;
use crate::assumptions::rests_on_text;
use crate::document::{Headline, Standing};
use crate::wording::{Detail, listed, visible_line};
use frictcomp::audit::{Selected, Step, StepAxis};
use frictcomp::comp::Kind;
use frictcomp::machine::Machine;
use frictcomp::timeline::SCHEMA;

/// Programs in a given order, each with what it does to the axes.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct SequenceReport {
    /// The programs.
    pub steps: Vec<Step>,
    /// The assumptions about axes on which it rests, in words (R18.2).
    pub assumptions: Vec<String>,
}

impl SequenceReport {
    /// Creates the report on programs that were followed on some machines.
    pub fn new<'a>(steps: Vec<Step>, machines: impl Iterator<Item = &'a Machine>) -> Self {
        Self {
            steps,
            assumptions: machines.filter_map(Machine::assumption).collect(),
        }
    }

    /// Returns the verdict: which program first moves an axis that an earlier one left away from its start-up state, and
    /// what is left at the end (R18.20).
    pub fn headline(&self) -> Headline {
        let inherits = self.steps.iter().filter_map(|step| {
            let axis = step.axes.iter().find(|axis| axis.left_by.is_some())?;
            Some((step, axis, axis.left_by.as_deref()?))
        });
        let inherits: Vec<_> = inherits.collect();
        let stopped = self.steps.iter().find(|step| step.stopped.is_some());
        let at_end = |is_meant: fn(&StepAxis) -> bool| {
            let axes = self.steps.last().into_iter().flat_map(|step| &step.axes);
            let names = axes.filter(|axis| is_meant(axis));
            let names: Vec<String> = names.map(|axis| axis_name(&axis.axis, axis.kind)).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            listed(&names)
        };
        let is_away = |axis: &StepAxis| axis.end != axis.start_up && axis.end != Selected::Unknown;
        let (standing, text) = if let Some((step, axis, by)) = inherits.first() {
            let name = axis_name(&axis.axis, axis.kind);
            let moves = if axis.moves_certainly() {
                "moves"
            } else {
                "may move"
            };
            let others = inherits.iter().map(|(step, ..)| step.file.as_str());
            let others: BTreeSet<&str> = others.filter(|file| *file != step.file).collect();
            let more = match others.len() {
                0 => String::new(),
                1 => "; another program does, too, or may".to_owned(),
                more => format!("; {more} other programs do, too, or may"),
            };
            let stops = stopped.map_or(String::new(), |step| {
                format!("; {} stops before its end", step.file)
            });
            let text = format!(
                "{} {moves} {name} outside its start-up state, left so by {by}{more}{stops}",
                step.file
            );
            (Standing::Bad, text)
        } else if let Some(step) = stopped {
            (Standing::Bad, format!("{} stops before its end", step.file))
        } else if let Some(names) = at_end(is_away) {
            (
                Standing::Bad,
                format!(
                    "no program moves what another left away; the order leaves {names} away from the start-up state"
                ),
            )
        } else if let Some(names) = at_end(|axis| axis.end == Selected::Unknown) {
            (
                Standing::Open,
                format!(
                    "it is not known whether the order leaves {names} away from the start-up state"
                ),
            )
        } else if self.steps.is_empty() {
            (Standing::Open, "no program was followed".to_owned())
        } else {
            (Standing::Good, "no program moves what another left away, and the order leaves every axis in its start-up state".to_owned())
        };
        Headline::new(standing, text).assuming(self.assumptions.iter().cloned())
    }

    /// Returns whether a program moves an axis that an earlier one left away from its start-up state.
    pub fn has_warnings(&self) -> bool {
        self.axes().any(|axis| axis.left_by.is_some())
    }

    /// Returns whether a program does not reach its end.
    pub fn is_cut(&self) -> bool {
        self.steps.iter().any(|step| step.stopped.is_some())
    }

    /// Returns the axes and kinds whose state after a program is not known.
    pub fn unknown(&self) -> impl Iterator<Item = (&str, Kind)> {
        let unknown = self.axes().filter(|axis| axis.end == Selected::Unknown);
        unknown.map(|axis| (axis.axis.as_str(), axis.kind))
    }

    fn axes(&self) -> impl Iterator<Item = &StepAxis> {
        self.steps.iter().flat_map(|step| &step.axes)
    }
}

/// Returns the programs of the order, one line each, the readings on which their states rest, and the verdict.
pub fn sequence_text(report: &SequenceReport, detail: Detail) -> String {
    let lines = report.steps.iter().map(step_line);
    let last = detail.full(report.steps.last()).flatten();
    let rests_on = last.and_then(|last| rests_on_text(&last.rests_on));
    let verdict = report.headline().to_string();
    let lines = lines.chain(rests_on).chain([verdict]);
    let lines = lines.map(|line| line + "\n");
    lines.collect()
}

fn step_line(step: &Step) -> String {
    let mut line = format!("{}:", visible_line(&step.file));
    let mut parts = Vec::new();
    for axis in &step.axes {
        let mut part = String::new();
        let name = axis_name(&axis.axis, axis.kind);
        let name = visible_line(&name);
        if axis.start != axis.end {
            let (start, end) = (axis.start.as_str(), axis.end.as_str());
            let _ = write!(part, "{name} {start} → {end}");
            if let Some(by) = &axis.by {
                let _ = write!(part, " at {}", place(step, &by.file, by.line));
            }
        } else if axis.end != axis.start_up {
            let _ = write!(part, "{name} stays {}", axis.end.as_str());
        }
        if let Some(possible) = &axis.possible {
            let words = possible.in_words(&step.file);
            let _ = write!(part, " ({})", visible_line(&words));
        }
        if let Some(away) = moves_away(step, axis) {
            if part.is_empty() {
                let _ = write!(part, "{name}");
            } else {
                part.push(',');
            }
            part.push_str(&away);
        }
        if !part.is_empty() {
            parts.push(part);
        }
    }
    if parts.is_empty() {
        parts.push("every axis in its start-up state".to_owned());
    }
    let _ = write!(line, " {}", parts.join("; "));
    if let Some(reason) = &step.stopped {
        let code = reason
            .code
            .map_or(String::new(), |code| format!("{code}: "));
        let _ = write!(line, "; stops, {code}{}", visible_line(&reason.message));
    }
    line
}

fn moves_away(step: &Step, axis: &StepAxis) -> Option<String> {
    let away = axis.away.as_ref()?;
    let place = place(step, &away.site.file, away.site.line);
    let moves = if axis.moves_certainly() {
        "moves"
    } else {
        "may move"
    };
    let mut text = format!(
        " {moves} outside its start-up state at {place} ({})",
        away.motion.as_str()
    );
    if let Some(program) = &axis.left_by {
        let _ = write!(text, ", left so by {}", visible_line(program));
    }
    Some(text)
}

fn place(step: &Step, file: &str, line: u32) -> String {
    if file == step.file {
        format!("line {line}")
    } else {
        format!("{}:{line}", visible_line(file))
    }
}

/// Returns the steps and a summary as records; the first one has `schema`.
pub fn sequence_records(report: &SequenceReport) -> Vec<Value> {
    let records = report.steps.iter().enumerate().map(|(at, step)| {
        let mut record = json!(step);
        record["record"] = "step".into();
        record["position"] = (at + 1).into();
        let axes = step
            .axes
            .iter()
            .map(|axis| (axis_name(&axis.axis, axis.kind), json!(axis)));
        record["axes"] = Value::Object(axes.collect::<Map<String, Value>>());
        if at == 0 {
            record["schema"] = SCHEMA.into();
        }
        record
    });
    let summary = json!({ "record": "summary", "headline": report.headline() });
    records.chain([summary]).collect()
}
