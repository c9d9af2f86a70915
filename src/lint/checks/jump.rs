//! FC409: friction compensation is switched while the axis keeps moving (R1.57).

use crate::comp::{AxisIndex, Kind, State};
use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::{AxisWord, BlockEnd, Executed, PathForm, PositionFrame, Travel};
use crate::lint::linter::Linter;
use crate::lint::memory::{SwitchAfterMove, place};
use crate::readings::Question;

impl Linter<'_> {
    /// Records changes on a moving axis, and reports those that are followed by a move in the same direction.
    pub(super) fn jump(&mut self, executed: &Executed<'_>, said: &mut Vec<Diagnostic>) {
        // R1.57: if the command itself stops the path, there is no jump.
        if self.machine.readings.takes_second(Question::LookAhead) {
            return;
        }
        if executed.moves.rests() && executed.moved.is_empty() {
            self.jumps.clear();
            return;
        }
        if !executed.outcomes.is_empty() && !executed.moves.rests() {
            self.note_jumps(executed);
        }
        if executed.moved.is_empty() || self.jumps.is_empty() {
            return;
        }
        let moves = executed.moved.iter();
        let moves = moves.filter(|_| is_feed(executed));
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
        if !is_feed(executed) || executed.modal.functions.block_end == BlockEnd::ExactStop {
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
            let mut moved = executed.moves.last_words().iter();
            let word = moved.find(|word| word.axis == axis);
            // In a block with motion words, the current position is the one after them.
            let to = executed.moved.iter().find(|word| word.axis == axis);
            let to = to.map_or_else(|| position(axis, executed), |word| word.from);
            let rises = word.and_then(|word| match executed.moves.arcs()[1] {
                Some(arc) if to.is_some() && is_around(arc, axis) => {
                    tangent(arc, axis, ArcEnd::Last)
                }
                _ => direction(word.from, to),
            });
            let known = self.jumps.iter().any(|jump| jump.axis == axis);
            if let Some(rises) = rises.filter(|_| !known) {
                self.jumps.push(SwitchAfterMove {
                    axis,
                    rises,
                    before: change.from,
                    place: place(executed, outcome.command.span),
                });
            }
        }
    }

    fn say_jump(&self, jump: SwitchAfterMove, now: State) -> Diagnostic {
        let name = self.name(jump.axis);
        let way = if now == State::Active { "on" } else { "off" };
        let message = format!(
            "friction compensation of axis `{name}` is switched {way} while the axis keeps moving in the same \
             direction, where its current would jump"
        );
        Diagnostic::new(Code::Fc409, jump.place, message)
            .with_axis(name)
            .with_help("switch it where the axis is at standstill or reverses")
            .with_help("it is assumed that the command itself does not stop the path; if it does, there is no jump")
    }
}

/// Returns whether the current of an axis differs between two states.
fn matters(from: State, to: State) -> bool {
    from != to
        && (from == State::Active || to == State::Active)
        && from != State::Unknown
        && to != State::Unknown
}

/// Returns whether feed moves are modal.
fn is_feed(executed: &Executed<'_>) -> bool {
    executed.modal.functions.is_feed_move()
}

/// An end of an arc.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ArcEnd {
    First,
    Last,
}

/// Returns whether an axis belongs to the plane of an arc.
fn is_around(travel: &Travel, axis: AxisIndex) -> bool {
    matches!(travel.form, PathForm::Arc(arc) if arc.axes.contains(&axis))
}

/// Returns whether an axis of the plane moves to larger coordinates at an end of an arc; `None` if it reverses there,
/// or the direction is unknown.
fn tangent(travel: &Travel, axis: AxisIndex, end: ArcEnd) -> Option<bool> {
    let PathForm::Arc(arc) = travel.form else {
        return None;
    };
    let ends = |places: &[Option<f64>]| -> Option<[f64; 2]> {
        let [one, two] = arc
            .axes
            .map(|axis| places.get(axis.get()).copied().flatten());
        Some([one?, two?])
    };
    let shape = arc.between([ends(&travel.from)?, ends(&travel.to)?]).ok()?;
    let angle = match end {
        ArcEnd::First => shape.start,
        ArcEnd::Last => shape.start + shape.sweep,
    };
    let way = if axis == arc.axes[0] {
        -angle.sin()
    } else {
        angle.cos()
    };
    (way.abs() > 1e-6).then_some(way * shape.sweep > 0.0)
}

fn position(axis: AxisIndex, executed: &Executed<'_>) -> Option<f64> {
    let position = executed.modal.position(axis);
    let is_of_machine = position.frame == PositionFrame::Machine;
    position.value.filter(|_| is_of_machine)
}

fn rises(word: &AxisWord, executed: &Executed<'_>) -> Option<bool> {
    if let Some(arc) = executed.moves.arcs()[0]
        && is_around(arc, word.axis)
    {
        position(word.axis, executed)?;
        return tangent(arc, word.axis, ArcEnd::First);
    }
    direction(word.from, position(word.axis, executed))
}

/// Returns whether an axis moves to larger coordinates; `None` if it is at rest, or the direction is unknown.
fn direction(from: Option<f64>, to: Option<f64>) -> Option<bool> {
    let way = to? - from?;
    (way.abs() > 1e-9).then_some(way > 0.0)
}
