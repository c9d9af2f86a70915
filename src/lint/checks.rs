//! The lints, and their assignment to commands, motions and ends.

mod command;
mod jump;
mod left_away;
mod moved_before;

use super::linter::{LeftAway, Linter, Taken};
use super::memory;
use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::{Ended, EndedBy, Executed, FoundStates};
use crate::readings::Question;
use crate::text::Span;

/// The lints on a command, before it is recorded; the first one with a message wins, so that a command is not reported
/// twice.
const ON_COMMAND: [fn(&Linter<'_>, &Taken<'_>) -> Option<Diagnostic>; 2] =
    [command::repeated, command::undescribed];

impl Linter<'_> {
    /// Checks an executed block and appends the messages.
    pub(crate) fn block(&mut self, executed: &Executed<'_>, said: &mut Vec<Diagnostic>) {
        if executed.seq == 1 && **executed.file == *self.file {
            self.begin = Some(memory::place(executed, Span::default()));
        }
        if executed.branch != self.branch.as_deref() {
            // Earlier motions were on another way.
            self.jumps.clear();
            self.branch = executed.branch.map(<[_]>::to_vec);
        }
        if !executed.outcomes.is_empty() {
            self.commands(executed, said);
        }
        if !(executed.outcomes.is_empty() && self.jumps.is_empty()) {
            self.jump(executed, said);
        }
        for refused in executed.diagnostics {
            if refused.code == Code::PErr70435
                && let Some(axis) = refused.axis.as_deref().and_then(|it| self.machine.find(it))
            {
                let required = self.machine.axis(axis).monitored();
                self.memory.refused(axis, required, executed);
            }
        }
        // The commands of a block act before its motion (R1.9). What a block search passes does not move (R2.96).
        for motion in executed.motions().filter(|_| !executed.passed) {
            let is_first = self.memory.moved(&motion, executed);
            said.extend(moved_before::lint(self, (&motion, is_first), executed));
        }
    }

    fn commands(&mut self, executed: &Executed<'_>, said: &mut Vec<Diagnostic>) {
        for outcome in executed.outcomes {
            let Ok(axis) = outcome.result else {
                continue;
            };
            let taken = Taken {
                axis,
                outcome,
                executed,
            };
            said.extend(ON_COMMAND.iter().find_map(|lint| lint(self, &taken)));
            self.memory.command(axis, outcome);
        }
        said.extend(command::shared_block(executed));
    }

    /// Checks the state that an ended program leaves, and records what made it. A program stopped by a budget is not
    /// judged by what it did not reach. A program in an endless loop, or one that an error stops, is ended by a reset,
    /// which keeps the state unless another reading is selected (R1.28). Where the run went on after errors, the state
    /// at them is judged, too.
    pub(crate) fn end(&mut self, ended: &Ended<'_>) -> Vec<LeftAway> {
        self.states.program_ended(&self.program, ended);
        let is_kept = !self.machine.readings.takes_second(Question::Reset);
        // The blocks that a block search passes are not judged.
        let is_missed = ended
            .diagnostics
            .iter()
            .any(|said| said.code == Code::Fc413);
        let mut left = match ended.by {
            EndedBy::Error if is_missed => return Vec::new(),
            EndedBy::Budget if !(ended.endless && is_kept) => Vec::new(),
            _ => left_away::lint(self, ended),
        };
        if let Some(stopped) = ended.stopped {
            let at_errors = Ended {
                by: EndedBy::Error,
                at: None,
                ends: &stopped.ends,
                compensation: &stopped.compensation,
                possible: &stopped.possible,
                found: FoundStates {
                    history: &stopped.history,
                    ..ended.found
                },
                ..*ended
            };
            let mut found = left_away::lint(self, &at_errors);
            let start_up = &self.states.start_up;
            found.retain(|it| {
                let is_known = left
                    .iter()
                    .any(|known| (known.axis, known.kind) == (it.axis, it.kind));
                !is_known && memory::command_to(&at_errors, (it.axis, it.kind), start_up).is_some()
            });
            left.append(&mut found);
        }
        left
    }
}
