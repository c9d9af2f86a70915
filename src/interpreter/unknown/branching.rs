//! Questions that only the machine answers: the run parts there (R14.1).

use std::sync::Arc;

use crate::comp::{AxisIndex, Kind, Membership};
use crate::interpreter::coordinates::motion::Motions;
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::condition::{Condition, ConditionKind};
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::options::Branches;
use crate::interpreter::run::path::{Asked, BranchSide};
use crate::interpreter::run::stack::Seeking;
use crate::interpreter::run::way_set::{Answer, WaySet};
use crate::interpreter::values::plain::Asking;
use crate::interpreter::values::target::Target;
use crate::interpreter::values::value::Value;
use crate::interpreter::values::work_budget::ITEM;
use crate::text::Span;

/// Ways that are open at a time; past them a condition is treated as R2.51 says.
const MAX_OPEN: usize = 40;

/// Conditions that ways may name.
const MAX_CONDITIONS: usize = 4096;

/// Conditions on values of the program whose answers are remembered; older ones are asked anew.
const MAX_ASKED: usize = 64;

/// Answers of one condition.
const MAX_ANSWERS: usize = 60;

/// Number of questions at a place before its earlier answers are dropped.
const MAX_ROUNDS: u8 = 4;

/// A question to the machine.
pub(in crate::interpreter) struct Question {
    pub(in crate::interpreter) kind: ConditionKind,
    pub(in crate::interpreter) span: Span,
    /// Text of the condition for each answer but the last.
    pub(in crate::interpreter) texts: Vec<Arc<str>>,
    pub(in crate::interpreter) cause: Arc<str>,
    /// Values that it reads, where only the program writes them.
    pub(in crate::interpreter) reads: Option<Asking>,
}

/// Block at which a way goes on.
pub(in crate::interpreter) struct Goal {
    pub(in crate::interpreter) to: EntryIndex,
    pub(in crate::interpreter) seeking: Option<Seeking>,
    pub(in crate::interpreter) values: Vec<(Target, Value)>,
}

impl Goal {
    /// A block.
    pub(in crate::interpreter) fn block(to: EntryIndex) -> Self {
        Self {
            to,
            seeking: None,
            values: Vec::new(),
        }
    }
}

impl Interpreter {
    /// Whether the ways that part at the block can be followed, so many of them.
    pub(in crate::interpreter) fn may_part(&self, answers: usize, at: &BlockContext<'_>) -> bool {
        let Some(program) = self.state.control.frames.program() else {
            return false;
        };
        // A path that is driven has no sides (R14.8).
        if self.options.branches == Branches::Passed || self.options.motions == Motions::Taken {
            return false;
        }
        let calls = self.state.control.frames.iter();
        let calls = calls.filter(|frame| frame.program() == program).count();
        let cost = ITEM * 8 + self.machine.axes.len() * 4;
        self.state.effort.charge(cost.saturating_mul(answers));
        calls == 1
            && at.macro_depth == 0
            && self.sides.is_empty()
            && (2..=MAX_ANSWERS).contains(&answers)
            && self.state.pending.len() + answers <= MAX_OPEN
            && self.state.conditions.len() + 1 < MAX_CONDITIONS
            && self.state.control.cycles.is_empty()
            && !self.programs.index(program.unit).entries.is_empty()
            && !self.is_exhausted()
    }

    /// The run parts at a question: one way for each answer. Whether it can.
    pub(in crate::interpreter) fn part(
        &mut self,
        question: Question,
        goals: Vec<Goal>,
        at: &BlockContext<'_>,
    ) -> bool {
        if self.scratch.unread.get() || !self.may_part(goals.len(), at) {
            return false;
        }
        if question.kind == ConditionKind::Loop {
            self.note_open_loop();
        }
        let of = u8::try_from(goals.len()).unwrap_or(u8::MAX);
        let condition = self.ask(question, at);
        let sides = goals.into_iter().enumerate().map(|(place, goal)| {
            let answer = Answer {
                condition,
                sides: 1 << place,
                of,
            };
            BranchSide {
                seeking: goal.seeking,
                values: goal.values,
                ..BranchSide::to(WaySet::of(answer), goal.to)
            }
        });
        self.sides = sides.collect();
        true
    }

    /// A loop whose own condition is not known is joined at its head from the second pass on.
    fn note_open_loop(&mut self) {
        let frames = &self.state.control.frames;
        if let Some(program) = frames.program()
            && let Some(entry) = frames.entry()
        {
            let place = (frames.depth(), program.unit, entry);
            self.state.track.open_loops.insert(place);
        }
    }

    /// The number of the condition that a question asks for.
    fn ask(&mut self, question: Question, at: &BlockContext<'_>) -> u32 {
        let key = question
            .reads
            .as_ref()
            .map(|asking| Arc::from(&*asking.meaning));
        if let Some(key) = &key {
            let mut asked = self.state.track.asked.iter();
            if let Some(asked) = asked.find(|asked| asked.key == *key) {
                return asked.condition;
            }
        }
        let condition = self.condition_at(&question, at);
        self.state.track.reach.havoc(condition);
        self.state.control.possible.havoc(condition);
        self.state.control.untouched.havoc(condition);
        let track = &mut self.state.track;
        track.asked.retain(|asked| asked.condition != condition);
        if let Some((Asking { reads, .. }, key)) = question.reads.zip(key) {
            if track.asked.len() >= MAX_ASKED {
                track.asked.remove(0);
            }
            track.asked.push(Asked {
                condition,
                key,
                reads,
            });
        }
        condition
    }

    /// The condition of a question: a new one, or one of this place that no way names any more.
    fn condition_at(&mut self, question: &Question, at: &BlockContext<'_>) -> u32 {
        let mut wanted = Condition {
            kind: question.kind,
            place: at.place(question.span),
            texts: question.texts.clone(),
            cause: question.cause.clone(),
            round: 0,
        };
        let mut last = None;
        for (number, known) in (0..).zip(&self.state.conditions) {
            if !known.is_like(&wanted) {
                continue;
            }
            last = Some(number);
            wanted.round = wanted.round.max(known.round + 1);
            let mut named = self.state.track.reach.conditions();
            let mut possible = self.state.control.possible.conditions();
            let mut untouched = self.state.control.untouched.conditions();
            let is_it = |it| it == number;
            if !(named.any(is_it) || possible.any(is_it) || untouched.any(is_it)) {
                return number;
            }
        }
        if let Some(last) = last.filter(|_| wanted.round >= MAX_ROUNDS) {
            return last;
        }
        let number = u32::try_from(self.state.conditions.len()).unwrap_or(u32::MAX);
        self.state.conditions.push(wanted);
        number
    }

    /// The states of a kind on the ways that lead here: a test of it tells them apart (R14.1).
    pub(in crate::interpreter) fn part_by_state(
        &mut self,
        (axis, kind): (AxisIndex, Kind),
        goals: [Goal; 2],
        at: &BlockContext<'_>,
    ) -> bool {
        let Some(split) = self.state.control.possible.of(axis, kind) else {
            return false;
        };
        let ways = [split.on.clone(), split.off.clone()];
        if !self.may_part(2, at) {
            return false;
        }
        let states = [Membership::In, Membership::Out];
        let sides = goals.into_iter().zip(ways).zip(states);
        let sides = sides.map(|((goal, ways), state)| BranchSide {
            seeking: goal.seeking,
            values: goal.values,
            state: Some((axis, kind, state)),
            ..BranchSide::to(ways, goal.to)
        });
        self.sides = sides.collect();
        true
    }
}
