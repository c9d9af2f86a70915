//! Lints on the use of COMP (chapter 1.4): one function a lint, one list of them.
//!
//! FC404 and FC406 are statements about a block's text and come from `syntax`.

use std::sync::Arc;

use crate::codes::Code;
use crate::compensation::{Compensation, State};
use crate::diagnostic::{Diagnostic, Place};
use crate::interpreter::{EndedBy, Executed};
use crate::machine::{AxisIndex, Machine};
use crate::source::Span;
use crate::syntax::{CompCommand, Kind, Selection};

/// A diagnostic at the end of a program, with the executed block that it is about.
#[derive(Debug, Clone)]
pub struct EndNote {
    /// The executed block that it is about.
    pub seq: u64,
    /// What there is to say.
    pub diagnostic: Diagnostic,
}

/// The lints on an executed block.
const ON_BLOCK: [fn(&Linter<'_>, &Executed<'_>, &mut Vec<Diagnostic>); 2] =
    [changes_nothing, shares_block_with_motion];

/// The lints on a program that ended.
const ON_END: [fn(&Linter<'_>, &Compensation, &mut Vec<EndNote>); 2] =
    [left_changed, depends_on_earlier_program];

/// A block that a lint may have to name later.
#[derive(Debug, Clone)]
struct Site {
    seq: u64,
    place: Place,
}

/// What the lints remember of one axis during a program.
#[derive(Debug, Clone)]
struct AxisMemory {
    /// The state of each kind when the program began.
    start: [State; Kind::ALL.len()],
    /// The block that last changed each kind.
    changed: [Option<Site>; Kind::ALL.len()],
    /// The first block that moved the axis.
    moved: Option<Site>,
    /// Whether the program switched friction compensation of the axis itself.
    sets_friction: bool,
    /// Whether an earlier program of the session left it changed.
    changed_before: bool,
}

/// What the lints remember.
pub(crate) struct Linter<'m> {
    machine: &'m Machine,
    axes: Vec<AxisMemory>,
    /// Whether an earlier program left any axis changed.
    any_changed_before: bool,
}

impl<'m> Linter<'m> {
    /// A program begins with a state; `session_start` is the one that the session began with.
    pub(crate) fn new(
        machine: &'m Machine,
        start: &Compensation,
        session_start: &Compensation,
    ) -> Self {
        let axes = (0..start.len()).map(AxisIndex::new).map(|axis| AxisMemory {
            start: Kind::ALL.map(|kind| start.state(axis, kind)),
            changed: Default::default(),
            moved: None,
            sets_friction: false,
            changed_before: start.state(axis, Kind::Frict)
                != session_start.state(axis, Kind::Frict),
        });
        let axes: Vec<_> = axes.collect();
        Self {
            machine,
            any_changed_before: axes.iter().any(|axis| axis.changed_before),
            axes,
        }
    }

    /// Looks at an executed block and appends what there is to say.
    pub(crate) fn block(&mut self, executed: &Executed<'_>, said: &mut Vec<Diagnostic>) {
        if !executed.outcomes.is_empty() {
            for lint in ON_BLOCK {
                lint(self, executed, said);
            }
            for outcome in executed.outcomes {
                if let Ok(axis) = outcome.result {
                    let named = outcome.command.selection.kinds().contains(Kind::Frict);
                    self.axes[axis.get()].sets_friction |= named;
                }
            }
        }
        for (position, change) in executed.changes.iter().enumerate() {
            let command = command_of(executed, position);
            let span = command.map_or(whole(executed), |command| command.span);
            self.axes[change.axis.get()].changed[change.kind as usize] = Some(site(executed, span));
        }
        if !self.any_changed_before {
            return;
        }
        for word in executed.moved {
            let memory = &mut self.axes[word.axis.get()];
            if memory.changed_before && memory.moved.is_none() {
                memory.moved = Some(site(executed, word.span));
            }
        }
    }

    /// Looks at the state that an ended program leaves. A program that an error or a budget
    /// stopped is not blamed for what it did not come to.
    pub(crate) fn end(&self, by: EndedBy, left: &Compensation, notes: &mut Vec<EndNote>) {
        if matches!(by, EndedBy::Error | EndedBy::Budget) {
            return;
        }
        for lint in ON_END {
            lint(self, left, notes);
        }
    }

    fn name(&self, axis: usize) -> &str {
        &self.machine.axes[axis].name
    }
}

fn site(executed: &Executed<'_>, span: Span) -> Site {
    Site {
        seq: executed.seq,
        place: place(executed, span),
    }
}

fn place(executed: &Executed<'_>, span: Span) -> Place {
    Place {
        file: Arc::clone(executed.file),
        text: executed.text.into(),
        first_line: executed.line,
        span,
    }
}

fn whole(executed: &Executed<'_>) -> Span {
    Span::new(0, executed.text.len())
}

/// The command that made the change at a position; `None` for what an unknown condition changed.
fn command_of<'a>(executed: &'a Executed<'_>, position: usize) -> Option<&'a CompCommand> {
    let mut made = 0;
    executed
        .outcomes
        .iter()
        .find(|outcome| {
            made += outcome.changes;
            position < made
        })
        .map(|outcome| &outcome.command)
}

/// FC402: a command that changes nothing.
fn changes_nothing(_: &Linter<'_>, executed: &Executed<'_>, said: &mut Vec<Diagnostic>) {
    for outcome in executed.outcomes {
        let Ok(axis) = outcome.result else {
            continue;
        };
        if outcome.changes > 0 {
            continue;
        }
        let command = &outcome.command;
        let configured = command
            .selection
            .kinds()
            .iter()
            .any(|kind| executed.compensation.is_configured(axis, kind));
        let name = &command.axis;
        let why = match (configured, command.selection) {
            (false, _) => "is not configured",
            (true, Selection::On(_)) => "is already on",
            (true, Selection::Off(_) | Selection::OffAll) => "is already off",
        };
        let what = match command.selection {
            Selection::OffAll => "every compensation".to_owned(),
            Selection::On(kinds) | Selection::Off(kinds) => {
                let words: Vec<&str> = kinds.iter().map(Kind::keyword).collect();
                format!("`{}`", words.join(" "))
            }
        };
        said.push(
            Diagnostic::new(
                Code::Fc402,
                place(executed, command.span),
                format!("this command changes nothing: {what} of axis `{name}` {why}"),
            )
            .with_axis(name.clone()),
        );
    }
}

/// FC405: the command takes effect before the motion of its block (R1.9).
fn shares_block_with_motion(_: &Linter<'_>, executed: &Executed<'_>, said: &mut Vec<Diagnostic>) {
    let first = executed
        .outcomes
        .iter()
        .find(|outcome| outcome.result.is_ok());
    if let (Some(outcome), false) = (first, executed.moved.is_empty()) {
        said.push(
            Diagnostic::new(
                Code::Fc405,
                place(executed, outcome.command.span),
                "COMP and motion share a block; the command takes effect before the motion",
            )
            .with_axis(outcome.command.axis.clone())
            .with_help("write the command in a block of its own"),
        );
    }
}

/// FC401: the program leaves a kind other than it found it.
fn left_changed(linter: &Linter<'_>, left: &Compensation, notes: &mut Vec<EndNote>) {
    for (position, memory) in linter.axes.iter().enumerate() {
        for (kind, site) in Kind::ALL.into_iter().zip(&memory.changed) {
            let start = memory.start[kind as usize];
            let end = left.state(AxisIndex::new(position), kind);
            let known = start != State::Unknown && end != State::Unknown;
            let Some(site) = site.as_ref().filter(|_| known && start != end) else {
                continue;
            };
            let name = linter.name(position);
            let keyword = kind.keyword();
            let back = if matches!(end, State::Inactive) {
                "ON"
            } else {
                "OFF"
            };
            let diagnostic = Diagnostic::new(
                Code::Fc401,
                site.place.clone(),
                format!(
                    "`{keyword}` of axis `{name}` is left {} past program end; it was {} at program start",
                    end.word(),
                    start.word()
                ),
            )
            .with_axis(name)
            .with_help(format!("write `{name}[COMP {back} {keyword}]` before M30, or switch it in the next program"));
            notes.push(EndNote {
                seq: site.seq,
                diagnostic,
            });
        }
    }
}

/// FC403: what the program does depends on what ran before.
fn depends_on_earlier_program(linter: &Linter<'_>, _: &Compensation, notes: &mut Vec<EndNote>) {
    for (position, memory) in linter.axes.iter().enumerate() {
        let Some(site) = memory.moved.as_ref().filter(|_| !memory.sets_friction) else {
            continue;
        };
        let name = linter.name(position);
        let start = memory.start[Kind::Frict as usize].word();
        let diagnostic = Diagnostic::new(
            Code::Fc403,
            site.place.clone(),
            format!("axis `{name}` moves with friction compensation {start} because an earlier program left it so"),
        )
        .with_axis(name)
        .with_help(format!("set it at program start, `{name}[COMP ON FRICT]` or `{name}[COMP OFF FRICT]`"));
        notes.push(EndNote {
            seq: site.seq,
            diagnostic,
        });
    }
}
