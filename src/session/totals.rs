//! Totals of a session, and the feed moves that axes make without friction compensation (R13.12).

use std::collections::{BTreeMap, BTreeSet};

use crate::comp::{AxisIndex, Compensation, Kind, State};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::interpreter::{BlockMotion, BlockMove, Certainty, Executed, PathForm, PositionFrame};
use crate::lists::Origin;
use crate::machine::Machine;
use crate::readings::{Question, QuestionSet};
use crate::text::Place;
use crate::timeline::{ChangedBy, FeedMoves, SilencedMessage};

/// Totals of a session for the summary record.
pub(super) struct SessionTotals {
    pub(super) blocks: u64,
    pub(super) counts: BTreeMap<Severity, u64>,
    pub(super) changed_by: Vec<Vec<ChangedBy>>,
    pub(super) changes: Vec<u64>,
    /// The last block that changed each axis: its program and its number in the run.
    pub(super) last_changed: Vec<Option<(u32, u64)>>,
    /// The codes of the messages that states are assumed.
    pub(super) assumed: BTreeSet<Code>,
    /// The messages that comments silence.
    pub(super) silenced: BTreeSet<SilencedMessage>,
    /// The open questions whose readings messages depend on (R15.3).
    pub(super) rests_on: QuestionSet,
    pub(super) feed_moves: FeedMoveCounter,
    /// The configured kinds that were unknown at a program's end or where their axis moved, and those that a program
    /// switches on an axis that nothing describes.
    pub(super) unknown: BTreeSet<(AxisIndex, Kind)>,
    /// Whether the machine has axes that nothing describes.
    pub(super) has_undescribed: bool,
    /// Undescribed axes that programs move or switch, with the program and place of the first message on each (R18.2).
    pub(super) undescribed: BTreeMap<AxisIndex, Option<(u32, Place)>>,
}

impl SessionTotals {
    /// Returns the totals before the first program on a machine.
    pub(super) fn of(machine: &Machine) -> Self {
        let axes = machine.axes.len();
        Self {
            blocks: 0,
            counts: BTreeMap::new(),
            changed_by: vec![Vec::new(); axes],
            changes: vec![0; axes],
            last_changed: vec![None; axes],
            assumed: BTreeSet::new(),
            silenced: BTreeSet::new(),
            rests_on: QuestionSet::default(),
            feed_moves: FeedMoveCounter::new(axes),
            unknown: BTreeSet::new(),
            has_undescribed: machine.axes.iter().any(|axis| !axis.is_described()),
            undescribed: BTreeMap::new(),
        }
    }

    pub(super) fn count(&mut self, diagnostic: &Diagnostic) {
        *self.counts.entry(diagnostic.severity).or_default() += 1;
    }

    /// Records what the run assumes, whether or not the user silenced it.
    pub(super) fn note_footing<'a>(&mut self, said: impl IntoIterator<Item = &'a Diagnostic>) {
        for diagnostic in said {
            match diagnostic.code {
                Code::Fc401 => self.rests_on.insert(Question::Reset),
                Code::Fc409 => self.rests_on.insert(Question::LookAhead),
                Code::Fc210 | Code::Fc318 | Code::Fc325 | Code::Fc408 | Code::Fc902 => {
                    self.assumed.insert(diagnostic.code);
                }
                // The control stops on some ways only.
                code if code.severity() == Severity::Error
                    && diagnostic.severity < Severity::Error =>
                {
                    self.assumed.insert(code);
                }
                _ => {}
            }
        }
    }

    /// Counts an executed block and its feed moves.
    #[inline]
    pub(super) fn count_block(&mut self, block: &BlockMove<'_>) {
        self.blocks += 1;
        self.feed_moves.block(block);
    }

    /// Records the axes that a block moves or switches though nothing describes them (R18.2).
    #[cold]
    pub(super) fn note_undescribed(&mut self, machine: &Machine, executed: &Executed<'_>) {
        let is_undescribed = |axis: &AxisIndex| !machine.axis(*axis).is_described();
        let moved = executed.motions().map(|motion| motion.axis);
        for axis in moved.filter(is_undescribed) {
            self.undescribed.entry(axis).or_default();
        }
        for outcome in executed.outcomes {
            let command = &outcome.command;
            let named = || machine.find(&command.axis);
            let axis = outcome.result.as_ref().ok().copied().or_else(named);
            if let Some(axis) = axis.filter(is_undescribed)
                && command.selection.kinds().contains(Kind::Frict)
            {
                self.undescribed.entry(axis).or_default();
                self.unknown.insert((axis, Kind::Frict));
            }
        }
    }

    /// Adds to a verdict on an axis that it rests on `enable = true` (R18.2).
    pub(super) fn add_assumption(machine: &Machine, verdict: &mut Diagnostic) {
        use Code::{Fc401, Fc403, Fc407, Fc409, PErr70435};
        if !matches!(verdict.code, Fc401 | Fc403 | Fc407 | Fc409 | PErr70435) {
            return;
        }
        let axis = verdict.axis.as_deref().and_then(|it| machine.find(it));
        let origin = axis.map(|axis| &machine.axis(axis).frict_comp_origin);
        if let Some(origin @ Origin::Enabled { .. }) = origin {
            verdict.advice.push(format!("assuming {origin}").into());
        }
    }

    /// Returns whether a message only repeats that nothing describes an axis, which is said once in a session; an error
    /// of the control says it, too, but is never left out.
    pub(super) fn knows_undescribed(
        &mut self,
        machine: &Machine,
        (program, said): (u32, &Diagnostic),
    ) -> bool {
        if !matches!(said.code, Code::Fc408 | Code::PErr70495) {
            return false;
        }
        let axis = said.axis.as_deref().and_then(|it| machine.find(it));
        let Some(axis) = axis.filter(|axis| !machine.axis(*axis).is_described()) else {
            return false;
        };
        let place = (program, said.place.clone());
        let first = self.undescribed.entry(axis).or_default();
        let first = first.get_or_insert_with(|| place.clone());
        said.code == Code::Fc408 && *first != place
    }
}

/// An axis whose friction compensation is not active.
struct Watched {
    axis: AxisIndex,
    state: State,
    /// Position after the last block, in machine coordinates.
    stood: Option<f64>,
}

/// Counts feed moves, axis by axis.
pub(super) struct FeedMoveCounter {
    counts: Vec<FeedMoves>,
    watched: Vec<Watched>,
    /// The axes that the last block certainly moved so.
    moved: Vec<AxisIndex>,
    /// The version of the states that [`watched`](Self::watched) applies to.
    version: Option<u64>,
}

impl FeedMoveCounter {
    /// Creates a counter without moves for a number of axes.
    pub(super) fn new(axes: usize) -> Self {
        Self {
            counts: vec![FeedMoves::default(); axes],
            watched: Vec::new(),
            moved: Vec::new(),
            version: None,
        }
    }

    /// Returns the moves of an axis.
    pub(super) fn of(&self, axis: AxisIndex) -> FeedMoves {
        self.counts[axis.get()]
    }

    /// Returns the axes that the last block moved at feed without friction compensation.
    pub(super) fn moved(&self) -> &[AxisIndex] {
        &self.moved
    }

    /// Looks at an executed block. Where friction compensation is active on every axis, that is one
    /// comparison.
    #[inline]
    fn block(&mut self, block: &BlockMove<'_>) {
        if self.version != Some(block.version) {
            self.version = Some(block.version);
            self.watch(block.compensation);
        }
        self.moved.clear();
        if !self.watched.is_empty() {
            self.count(block);
        }
    }

    /// Watches the motion of a block after its commands, which act before it (R1.9), so that its own motion counts,
    /// too.
    #[inline(never)]
    fn watch(&mut self, compensation: &Compensation) {
        let before = std::mem::take(&mut self.watched);
        for axis in (0..self.counts.len()).map(AxisIndex::new) {
            let state = compensation.state(axis, Kind::Frict);
            if matches!(state, State::Active | State::Unconfigured) {
                continue;
            }
            let known = before.iter().find(|watched| watched.axis == axis);
            self.watched.push(Watched {
                axis,
                state,
                stood: known.and_then(|watched| watched.stood),
            });
        }
    }

    fn count(&mut self, block: &BlockMove<'_>) {
        for watched in &mut self.watched {
            let position = block.modal.position(watched.axis);
            let now = position
                .value
                .filter(|_| position.frame == PositionFrame::Machine);
            let stood = std::mem::replace(&mut watched.stood, now);
            let counts = &mut self.counts[watched.axis.get()];
            match block.pace(watched.axis) {
                None => {}
                Some(Certainty::Certain)
                    if watched.state != State::Unknown && block.branch.is_none() =>
                {
                    let moves = block.moves;
                    let is_plain = moves.also_moved().is_empty() && moves.row().is_none();
                    let travel = match block.modal.functions.motion {
                        1 => stood.zip(now).map(|(from, to)| (to - from).abs()),
                        _ => travel_on_arc(moves, watched.axis),
                    };
                    let travel = travel.filter(|_| is_plain);
                    if !travel.is_some_and(FeedMoves::is_standstill) {
                        counts.add(watched.state, travel);
                        self.moved.push(watched.axis);
                    }
                }
                Some(_) => counts.unknown += 1,
            }
        }
    }
}

/// Returns the travel of an axis along the arc or helix of a block, forth and back (R11.31); its length does not depend
/// on where the origin is.
fn travel_on_arc(moves: &BlockMotion, axis: AxisIndex) -> Option<f64> {
    let way = moves.arcs()[0]?;
    let PathForm::Arc(arc) = &way.form else {
        return None;
    };
    let ends = |axis: AxisIndex| Some([way.from[axis.get()]?, way.to[axis.get()]?]);
    let Some(place) = arc.axes.iter().position(|it| *it == axis) else {
        return ends(axis).map(|[from, to]| (to - from).abs());
    };
    let [one, two] = [ends(arc.axes[0])?, ends(arc.axes[1])?];
    let shape = arc.between([0, 1].map(|end| [one[end], two[end]])).ok()?;
    Some(shape.travel()[place])
}
