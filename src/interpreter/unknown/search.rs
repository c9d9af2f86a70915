//! Block search: the states at the block at which a program is started (R2.96).

use std::sync::Arc;

use super::branching::answers;
use crate::comp::{AxisIndex, Kind, KindSet, State};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::path::Last;
use crate::interpreter::run::search::EarlierStates;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::ways::history::HistorySide;
use crate::interpreter::ways::question::{Condition, ConditionKind};
use crate::interpreter::ways::set::WaySet;
use crate::readings::{Alternative, Question};
use crate::text::Span;

impl Executor {
    /// Returns whether the block at which the program is to be started was not reached yet.
    pub(crate) fn is_searching(&self) -> bool {
        self.state.track.searching.is_some()
    }

    /// FC413: the program ended before the block at which it was to be started.
    pub(crate) fn missed_search(&self) -> Option<Diagnostic> {
        let wanted = self.options.search.filter(|_| self.is_searching())?;
        let start = || {
            let main = self.programs.units().first()?;
            Some(main.index.source.place(Span::new(0, 0)))
        };
        let last = self.state.last.as_ref().map(Last::place);
        let place = last.or_else(start)?;
        let message = format!(
            "the program ends here without reaching {wanted}, at which it is to be started"
        );
        let said = Diagnostic::new(Code::Fc413, place, message).raised(Severity::Error);
        Some(said.with_help(
            "name a block that the main program executes, by its number or by its first line",
        ))
    }

    pub(crate) fn begin_search(&mut self) {
        if self.options.search.is_some() {
            let earlier = self.state.control.earlier_states();
            self.state.track.searching = Some(Box::new(earlier));
        }
    }

    /// Ends the search if the block is the searched one.
    #[cold]
    pub(crate) fn search(&mut self, at: &BlockContext<'_>) {
        if !self.options.search.is_some_and(|wanted| wanted.is(at)) {
            return;
        }
        let Some(before) = self.state.track.searching.take() else {
            return;
        };
        if !self.differing_since(&before).is_empty() {
            self.state.rests_on.insert(Question::BlockSearch);
        }
        match self.machine.readings.of(Question::BlockSearch) {
            Some(Alternative::First) => {}
            Some(Alternative::Second) => {
                let control = &mut self.state.control;
                control.compensation = before.compensation;
                control.history = before.history;
                self.version += 1;
            }
            None => self.search_either_way(&before, at),
        }
    }

    /// Continues with both readings of a block search.
    fn search_either_way(&mut self, before: &EarlierStates, at: &BlockContext<'_>) {
        let differing = self.differing_since(before);
        if differing.is_empty() {
            return;
        }
        for (axis, kind) in &differing {
            let said = self.open_search((*axis, *kind), before, at);
            self.scratch.diagnostics.push(said);
        }
        self.version += 1;
        if !self.state.can_ask() {
            for (axis, kind) in differing {
                self.havoc(axis, KindSet::of(kind));
            }
            return;
        }
        let condition = self.state.ask_anew(Condition::new(
            ConditionKind::Search,
            at.place(Span::new(0, at.text.trim_end().len())),
            vec![Arc::from("executed")],
            Unknown::Search,
        ));
        self.join_earlier(condition, before);
    }

    /// The states are those of an earlier block where a condition does not hold.
    pub(crate) fn join_earlier(&mut self, condition: u32, earlier: &EarlierStates) {
        let reach = &self.state.track.reach;
        let mut sides = answers(condition, 2).map(|answer| reach.and(&WaySet::of(answer)));
        let (Some(holds), Some(fails)) = (sides.next(), sides.next()) else {
            return;
        };
        let control = &mut self.state.control;
        let theirs = HistorySide {
            compensation: &earlier.compensation,
            history: &earlier.history,
            reach: &fails,
        };
        control
            .history
            .join(&mut control.compensation, &holds, &theirs);
        self.version += 1;
    }

    fn differing_since(&self, before: &EarlierStates) -> Vec<(AxisIndex, Kind)> {
        let now = &self.state.control.compensation;
        let axes = (0..self.machine.axes.len()).map(AxisIndex::new);
        let of_axis = |axis: AxisIndex| {
            let kinds = now.differing(&before.compensation, axis);
            let kinds = kinds.intersection(self.machine.axis(axis).configured);
            kinds
                .iter()
                .map(move |kind| (axis, kind))
                .collect::<Vec<_>>()
        };
        axes.flat_map(of_axis).collect()
    }

    /// FC413: a state that depends on what the block search does.
    fn open_search(
        &self,
        (axis, kind): (AxisIndex, Kind),
        before: &EarlierStates,
        at: &BlockContext<'_>,
    ) -> Diagnostic {
        let name = &self.machine.axis(axis).name;
        let states = [&self.state.control.compensation, &before.compensation];
        let [executed, decoded]: [State; 2] = states.map(|it| it.state(axis, kind));
        let message = format!(
            "`{kind}` of axis `{name}` is {executed} here if the block search executes the COMP commands \
             that it passes, and {decoded} if it only decodes them"
        );
        let to = if matches!(executed, State::Active | State::Ineffective) {
            "ON"
        } else {
            "OFF"
        };
        Diagnostic::new(Code::Fc413, at.place(Span::new(0, at.text.trim_end().len())), message).with_help(format!(
            "the control's documents leave this open; repeat `{name}[COMP {to} {kind}]` after this block, or \
             check `V.A.{kind}_COMP_ACTIVE.{name}` before the start"
        ))
    }
}
