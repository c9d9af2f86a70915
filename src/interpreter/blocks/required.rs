//! The compensations that P-AXIS-00465 requires while an axis moves (R1.36).

use std::sync::Arc;

use crate::comp::{AxisIndex, Kind, State};
use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::coordinates::moving::MovedAxis;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::block_scratch::AfterError;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::options::StopPolicy;
use crate::interpreter::ways::history::Split;
use crate::interpreter::ways::possible_state::ways_of;
use crate::interpreter::ways::words::limit_to;
use crate::language::{AxisWords, Certainty, MotionKind};
use crate::readings::Question;
use crate::syntax::Fault;
use crate::text::Span;

impl Executor {
    /// The axes that the block certainly moves, except by homing, and the words that move them (R1.36).
    fn moved_in_automatic(&self, words: AxisWords) -> Vec<(AxisIndex, Span)> {
        let homing_counts = self.machine.readings.takes_second(Question::Homing);
        let is_motion = matches!(words, AxisWords::Motion | AxisWords::Measuring)
            || (homing_counts && words == AxisWords::Homing);
        let of_words = self.scratch.moved.iter().filter(|_| is_motion);
        let of_words = of_words.map(|word| (word.axis, word.span));
        let counts = |motion: &&MovedAxis| {
            motion.certainty == Certainty::Certain
                && (homing_counts || motion.kind != MotionKind::Homing)
        };
        let others = self.scratch.also_moved.iter().filter(counts);
        of_words
            .chain(others.map(|motion| (motion.axis, motion.span)))
            .collect()
    }

    /// Notes that it matters whether homing is monitored: G74 moves an axis without a compensation that it
    /// requires.
    fn note_homing(&mut self, words: AxisWords) {
        let compensation = &self.state.control.compensation;
        let lacks = |axis: AxisIndex| {
            let mut required = self.machine.axis(axis).monitored().iter();
            required.any(|kind| compensation.state(axis, kind) != State::Active)
        };
        let of_words = self.scratch.moved.iter().map(|word| word.axis);
        let others = self.scratch.also_moved.iter();
        let others = others.filter(|it| it.kind == MotionKind::Homing);
        if of_words.filter(|_| words == AxisWords::Homing).any(lacks)
            || others.map(|it| it.axis).any(lacks)
        {
            self.state.rests_on.insert(Question::Homing);
        }
    }

    /// Notes that it matters whether a command acts before the motion of its block (R1.9).
    pub(crate) fn note_command_with_motion(&mut self) {
        let is_taken = self.scratch.outcomes.iter().any(|it| it.result.is_ok());
        if is_taken && !self.scratch.moved.is_empty() {
            self.state.rests_on.insert(Question::WithMotion);
        }
    }

    /// The state in which the block moves an axis (R1.9).
    fn state_in_motion(&self, axis: AxisIndex, kind: Kind) -> State {
        let mut changes = self.scratch.changes.iter();
        let first = changes.find(|change| (change.axis, change.kind) == (axis, kind));
        let is_after = self.machine.readings.takes_second(Question::WithMotion);
        match first.filter(|_| is_after) {
            Some(change) => change.from,
            None => self.state.control.compensation.state(axis, kind),
        }
    }

    /// P-ERR-70435: an axis moves without a compensation that it requires.
    pub(crate) fn check_required(&mut self, words: AxisWords, at: &BlockContext<'_>) {
        if !self.any_required {
            return;
        }
        let machine = Arc::clone(&self.machine);
        self.note_homing(words);
        for (axis, span) in self.moved_in_automatic(words) {
            let state = |kind| self.state_in_motion(axis, kind);
            let required = machine.axis(axis).monitored();
            let missing = required
                .iter()
                .find(|kind| !matches!(state(*kind), State::Active | State::Unknown));
            let name = &machine.axis(axis).name;
            let Some(kind) = missing else {
                if let Some(kind) = required.iter().find(|kind| state(*kind) == State::Unknown) {
                    if self.end_ways_without((axis, kind), span, at) {
                        continue;
                    }
                    let keyword = kind.as_str();
                    let message = format!(
                        "whether axis `{name}` moves with `{keyword}`, which P-AXIS-00465 requires, \
                         is not known offline; the rest assumes that it does"
                    );
                    let help = format!("set it before, with `{name}[COMP ON {keyword}]`");
                    let fault = Fault::new(Code::Fc902, span, message).with_help(help);
                    let diagnostic = at.diagnostic(fault).with_axis(name.clone());
                    self.scratch.diagnostics.push(diagnostic);
                }
                continue;
            };
            let refused = moves_without(name, kind, span, at);
            self.scratch.diagnostics.push(refused);
        }
    }

    /// P-ERR-70435 on some ways only: they end, and the others continue (R14.5). Returns whether that is so.
    #[cold]
    fn end_ways_without(
        &mut self,
        (axis, kind): (AxisIndex, Kind),
        span: Span,
        at: &BlockContext<'_>,
    ) -> bool {
        let mut changes = self.scratch.changes.iter();
        let is_switched = changes.any(|change| (change.axis, change.kind) == (axis, kind));
        let history = &self.state.control.history;
        let reach = &self.state.track.reach;
        let split = history.states(axis, kind).filter(|_| !is_switched);
        let Some(Split { on, off }) = split.map(|split| split.and(reach)) else {
            return false;
        };
        if on.is_never() || off.is_never() {
            return false;
        }
        let mut refused = moves_without(&self.machine.axis(axis).name, kind, span, at);
        limit_to(&mut refused, &ways_of(&off, &self.state.conditions));
        self.scratch.of_some_ways.push(refused);
        self.stop_on(&off, AfterError::Reset, at);
        if self.options.stop != StopPolicy::KeepGoing {
            self.state.go_on_with(on);
        }
        true
    }
}

/// P-ERR-70435: an axis moves without a compensation that it requires.
fn moves_without(name: &str, kind: Kind, span: Span, at: &BlockContext<'_>) -> Diagnostic {
    let keyword = kind.as_str();
    let fault = Fault::new(
        Code::PErr70435,
        span,
        format!("axis `{name}` moves without `{keyword}`, which P-AXIS-00465 requires"),
    )
    .with_help(format!(
        "switch it on first, with `{name}[COMP ON {keyword}]`"
    ));
    at.diagnostic(fault).with_axis(name)
}
