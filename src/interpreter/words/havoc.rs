//! Simultaneous loss of what is known (R2.50, R2.70), and states known only to the machine, as separate ways (R14.1):
//! those left by a program that only the machine has, and those found by a program (R10.1).

use std::sync::Arc;

use crate::comp::{AxisIndex, Kind, KindSet, Membership};
use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::block::{BlockContext, LeftOpen};
use crate::interpreter::control::{ControlState, Description};
use crate::interpreter::executor::Executor;
use crate::interpreter::values::handover::VariableUse;
use crate::interpreter::values::location::{Location, Unknown};
use crate::interpreter::values::value::Value;
use crate::interpreter::values::work_budget::ITEM;
use crate::interpreter::ways::history::Split;
use crate::interpreter::ways::question::{Condition, ConditionKind};
use crate::interpreter::ways::set::WaySet;
use crate::interpreter::words::questions::answers;
use crate::syntax::ast::{Effect as Unread, Hash};
use crate::text::Place;

impl Executor {
    /// Makes unknown what text of unknown meaning could change (R2.70).
    pub(crate) fn havoc_unread(&mut self, effect: Unread, cause: &Unknown) {
        match effect {
            Unread::Everything => self.havoc_by_call(cause),
            Unread::Parameters => {
                self.write(&Location::Parameters, Value::Unknown(cause.clone()));
            }
            Unread::Spindle => self.state.control.modal.pace.havoc_spindle(),
        }
    }

    /// Makes everything unknown that a program can change: every kind of every axis, positions and modal words,
    /// parameters and variables (R2.52).
    pub(crate) fn havoc_all(&mut self, cause: &Unknown) {
        self.havoc_memory(cause);
        self.state.control.memory.havoc_macros(cause, |_, _| false);
        self.state.control.modal.havoc_words();
        self.perhaps_move_all();
        self.state.control.havoc_couplings();
        self.havoc_compensation();
    }

    /// Makes everything unknown because a part of the block may call any program, and once more after the words of the
    /// block, since programs are called after them.
    pub(crate) fn havoc_by_call(&mut self, cause: &Unknown) {
        self.havoc_all(cause);
        let calls = &mut self.scratch.read.unknown_call;
        calls.get_or_insert_with(|| cause.clone());
    }

    /// Records that every axis possibly moves.
    pub(crate) fn perhaps_move_all(&mut self) {
        let axes = (0..self.machine.axes.len()).map(AxisIndex::new);
        self.scratch.moves.perhaps_move_all(axes);
    }

    /// Makes every parameter and variable unknown.
    pub(crate) fn havoc_memory(&mut self, cause: &Unknown) {
        self.scratch.read.plc_acts = true;
        self.scratch.wrote = true;
        self.state
            .track
            .write_anything(&mut self.state.control.memory);
        self.state.control.memory.havoc_all(cause);
        self.note_use(VariableUse::write_anything);
    }

    /// Makes every kind of every axis unknown.
    pub(crate) fn havoc_compensation(&mut self) {
        self.state.control.history.close_all();
        for position in 0..self.machine.axes.len() {
            let axis = AxisIndex::new(position);
            self.state
                .control
                .compensation
                .havoc(axis, KindSet::ALL, &mut self.scratch.changes);
        }
    }

    /// Makes the kinds of all axes unknown, since it is not known which one a COMP command switched.
    pub(crate) fn havoc_any_axis(&mut self, kinds: KindSet) {
        for axis in (0..self.machine.axes.len()).map(AxisIndex::new) {
            self.havoc(axis, kinds);
        }
    }
}

impl ControlState {
    /// Begins a description of geometry by the blocks up to the end.
    pub(crate) fn describe(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        if self.described.is_none() {
            self.described = Some(Box::new(Description {
                opener: hash.command.row(),
                place: at.place(hash.span),
                before: self.modal.clone(),
            }));
        }
    }

    /// Ends the description that a command belongs to, where that is open. Returns whether it does.
    pub(crate) fn end_description(&mut self, end: &str) -> bool {
        let open = self
            .described
            .take_if(|open| open.opener.until == Some(end));
        if let Some(open) = &open {
            self.modal.end_description(&open.before);
        }
        open.is_some()
    }

    /// Returns FC208: the program ends inside a description.
    pub(crate) fn open_description(&mut self) -> Option<Diagnostic> {
        let open = self.described.take()?;
        let end = open.opener.until?;
        let message = format!("`{}` has no `{end}`", open.opener.words);
        let help = format!("write `{end}` in a separate block");
        Some(Diagnostic::new(Code::Fc208, open.place, message).with_help(help))
    }
}

impl Executor {
    /// Leaves open for each configured kind of each axis whether it is selected after the call.
    #[cold]
    pub(crate) fn leave_open(&mut self, left: &LeftOpen) {
        for axis in (0..self.machine.axes.len()).map(AxisIndex::new) {
            let unknown = self.state.control.compensation.unknown(axis);
            let configured = self.machine.axis(axis).configured;
            for kind in unknown.intersection(configured).iter() {
                if self.state.control.history.states(axis, kind).is_some() {
                    // The program keeps it.
                    continue;
                }
                self.state.work.charge(ITEM * 8);
                let name: Arc<str> = self.machine.axis(axis).name.as_str().into();
                let condition = Condition::new(
                    ConditionKind::Call(kind),
                    left.place.clone(),
                    vec![left.program.to_string().into(), name],
                    Unknown::Program(left.program.clone()),
                );
                self.open((axis, kind), condition);
            }
        }
    }

    /// Opens whether the next program finds a kind of an axis selected. Returns the number of the condition, of which
    /// the first answer is that it is; `None` where too many are asked.
    pub(crate) fn find_open(&mut self, axis: AxisIndex, kind: Kind) -> Option<u32> {
        let name: Arc<str> = self.machine.axis(axis).name.as_str().into();
        let compensation = &mut self.state.control.compensation;
        compensation.decide(axis, kind, Membership::In);
        let selected = compensation.state(axis, kind);
        compensation.havoc(axis, KindSet::of(kind), &mut Vec::new());
        self.version += 1;
        let condition = Condition::new(
            ConditionKind::Found(kind, selected),
            Place::head_of(&Arc::default()),
            vec![Arc::clone(&name)],
            Unknown::text(&*name),
        );
        self.open((axis, kind), condition)
    }

    /// Opens a kind of an axis on the ways that lead here, by a condition on whether it is selected.
    fn open(&mut self, (axis, kind): (AxisIndex, Kind), condition: Condition) -> Option<u32> {
        if !self.state.can_ask() {
            return None;
        }
        let condition = self.state.ask_anew(condition);
        let reach = &self.state.track.reach;
        let mut sides = answers(condition, 2).map(|answer| reach.and(&WaySet::of(answer)));
        if let (Some(on), Some(off)) = (sides.next(), sides.next()) {
            let history = &mut self.state.control.history;
            history.open(axis, kind, Split { on, off });
        }
        Some(condition)
    }
}
