//! Transitions to the unknown (R2.50, R2.70).

use crate::comp::{AxisIndex, KindSet};
use crate::interpreter::coordinates::moving::MovedAxis;
use crate::interpreter::run::block_scratch::BlockScratch;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::found::VariableUse;
use crate::interpreter::values::location::Location;
use crate::interpreter::values::value::Value;
use crate::language::{Certainty, MotionKind};
use crate::syntax::ast::Effect as Unread;
use crate::text::Span;

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

    /// Everything that a program could change becomes unknown: every kind of every axis, positions and
    /// modal words, parameters and variables (R2.52).
    pub(crate) fn havoc_all(&mut self, cause: &Unknown) {
        self.havoc_memory(cause);
        self.state.control.memory.havoc_macros(cause, |_, _| false);
        self.state.control.modal.havoc_words();
        self.perhaps_move_all();
        self.havoc_couplings();
        self.havoc_compensation();
    }

    /// A part of the block that may call any program: everything becomes unknown, and once more after the
    /// words of the block, since programs are called after them.
    pub(crate) fn havoc_by_call(&mut self, cause: &Unknown) {
        self.havoc_all(cause);
        let calls = &mut self.scratch.unknown_call;
        calls.get_or_insert_with(|| cause.clone());
    }

    /// It is not known whether any axis moves.
    pub(crate) fn perhaps_move_all(&mut self) {
        let count = self.machine.axes.len();
        let possible = |it: &&MovedAxis| it.certainty == Certainty::Possible;
        if self.scratch.also_moved.iter().filter(possible).count() < count {
            for axis in (0..count).map(AxisIndex::new) {
                self.scratch.perhaps_move(axis);
            }
        }
    }

    /// Every parameter and variable becomes unknown.
    pub(crate) fn havoc_memory(&mut self, cause: &Unknown) {
        self.scratch.plc_acts = true;
        self.scratch.wrote = true;
        self.state
            .track
            .write_anything(&mut self.state.control.memory);
        self.state.control.memory.havoc_all(cause);
        self.note_use(VariableUse::write_anything);
    }

    /// Every kind of every axis becomes unknown.
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

    /// A COMP command switched kinds of an axis, but it is not known which axis.
    pub(crate) fn havoc_any_axis(&mut self, kinds: KindSet) {
        for axis in (0..self.machine.axes.len()).map(AxisIndex::new) {
            self.havoc(axis, kinds);
        }
    }
}

impl BlockScratch {
    /// It is not known whether an axis moves.
    pub(crate) fn perhaps_move(&mut self, axis: AxisIndex) {
        self.also_moved.push(MovedAxis {
            axis,
            span: Span::default(),
            kind: MotionKind::Unknown,
            certainty: Certainty::Possible,
        });
    }
}
