//! FC409: friction compensation is switched while the axis moves on (R1.57).

use super::linter::Linter;
use super::memory::{Jump, place};
use crate::comp::{AxisIndex, Kind, State};
use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::{AxisWord, BlockEnd, Executed, Group, PositionFrame};

impl Linter<'_> {
    /// Notes changes of an axis that moves, and says which of them are followed by a move in the same
    /// direction.
    pub(super) fn jump(&mut self, executed: &Executed<'_>, said: &mut Vec<Diagnostic>) {
        if executed.rests && executed.moved.is_empty() {
            self.jumps.clear();
            return;
        }
        if !executed.outcomes.is_empty() && !executed.rests {
            self.note_jumps(executed);
        }
        if executed.moved.is_empty() || self.jumps.is_empty() {
            return;
        }
        let moves = executed.moved.iter();
        let moves = moves.filter(|_| is_line(executed));
        let moves: Vec<_> = moves
            .filter_map(|word| Some((word.axis, rises(word, executed)?)))
            .collect();
        for jump in std::mem::take(&mut self.jumps) {
            let goes_on = moves.contains(&(jump.axis, jump.rises));
            let now = executed.compensation.state(jump.axis, Kind::Frict);
            if goes_on && now != jump.before {
                said.push(self.say_jump(jump, now));
            }
        }
    }

    fn note_jumps(&mut self, executed: &Executed<'_>) {
        if !is_line(executed) || executed.modal.functions.block_end == BlockEnd::ExactStop {
            return;
        }
        let commands = executed.outcomes.iter();
        let commands =
            commands.filter_map(|outcome| Some((outcome.result.as_ref().ok()?, outcome)));
        for (&axis, outcome) in commands {
            let mut changes = executed.changes.iter();
            let change = changes.find(|it| it.axis == axis && it.kind == Kind::Frict);
            let Some(change) = change.filter(|it| matters(it.from, it.to)) else {
                continue;
            };
            let mut moved = executed.aside.last_moved.iter();
            let word = moved.find(|word| word.axis == axis);
            // In a block with motion words the position is the one after them.
            let to = executed.moved.iter().find(|word| word.axis == axis);
            let to = to.map_or_else(|| position(axis, executed), |word| word.from);
            let rises = word.and_then(|word| direction(word.from, to));
            let known = self.jumps.iter().any(|jump| jump.axis == axis);
            if let Some(rises) = rises.filter(|_| !known) {
                self.jumps.push(Jump {
                    axis,
                    rises,
                    before: change.from,
                    place: place(executed, outcome.command.span),
                });
            }
        }
    }

    fn say_jump(&self, jump: Jump, now: State) -> Diagnostic {
        let name = self.name(jump.axis);
        let way = if now == State::Active { "on" } else { "off" };
        let message = format!(
            "friction compensation of axis `{name}` is switched {way} while the axis moves on in the same \
             direction, where its current would jump"
        );
        Diagnostic::new(Code::Fc409, jump.place, message)
            .with_axis(name)
            .with_help("switch it where the axis stands still or reverses")
            .with_help("it is assumed that the command itself does not stop the path; if it does, there is no jump")
    }
}

/// Whether the current of an axis differs between two states.
fn matters(from: State, to: State) -> bool {
    from != to
        && (from == State::Active || to == State::Active)
        && from != State::Unknown
        && to != State::Unknown
}

/// Whether straight moves at feed are in force, in the coordinates of the machine.
fn is_line(executed: &Executed<'_>) -> bool {
    let modal = executed.modal;
    modal.is_known(Group::Motion) && modal.functions.motion == 1
}

fn position(axis: AxisIndex, executed: &Executed<'_>) -> Option<f64> {
    let position = executed.modal.position(axis);
    let is_of_machine = position.frame == PositionFrame::Machine;
    position.value.filter(|_| is_of_machine)
}

fn rises(word: &AxisWord, executed: &Executed<'_>) -> Option<bool> {
    direction(word.from, position(word.axis, executed))
}

/// Whether an axis moves to larger coordinates; `None` where it rests, or that is not known.
fn direction(from: Option<f64>, to: Option<f64>) -> Option<bool> {
    let way = to? - from?;
    (way.abs() > 1e-9).then_some(way > 0.0)
}
