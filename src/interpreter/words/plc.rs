//! What the program shares with the PLC: variables (R2.99), and programs that only the machine has (R2.83).
//!
//! The PLC may write `V.E.` variables at any time. Until a block in which it acts by design, what the program wrote
//! answers conditions, and the other answer needs the variable to change in between. From that block on only the
//! machine knows the variable.

use std::sync::Arc;

use crate::interpreter::block::BlockContext;
use crate::interpreter::executor::{Executor, RunState};
use crate::interpreter::programs::calls::WantedCall;
use crate::interpreter::values::externals::{HeldValues, SetAt};
use crate::interpreter::values::location::{Location, MissingProgram, Unknown};
use crate::interpreter::values::value::Value;
use crate::interpreter::ways::question::KeptAnswer;
use crate::syntax::ast::{CallScope, Operand};
use crate::syntax::{Fault, VariableName};

/// A value that the program set and that decides a condition.
#[derive(Debug, Clone)]
pub(crate) struct KeptValue {
    /// The variables.
    pub(crate) names: Arc<[VariableName]>,
    /// The block that set it.
    pub(crate) set: SetAt,
    /// The value of the condition.
    pub(crate) value: Value,
}

/// Reason why a condition has more than one answer.
#[derive(Debug, Clone)]
pub(crate) enum Doubt {
    /// A value that only the machine knows.
    Unknown(Unknown),
    /// A value that the program set and that the PLC may change.
    Kept(KeptValue),
}

impl Doubt {
    /// The doubt about a value that is not known.
    pub(crate) fn of(value: &Value) -> Option<Self> {
        match value {
            Value::Unknown(cause) => Some(Self::Unknown(cause.clone())),
            Value::Number(_) | Value::Text(_) => None,
        }
    }

    /// The value that decides.
    pub(crate) fn cause(&self) -> Unknown {
        match self {
            Self::Unknown(cause) => cause.clone(),
            Self::Kept(kept) => {
                let name = kept.names.first().map(ToString::to_string);
                Unknown::text(name.unwrap_or_default())
            }
        }
    }

    /// The answer that the program set, by its place among the answers.
    pub(crate) fn kept_answer(&self, place: impl FnOnce(&Value) -> usize) -> Option<KeptAnswer> {
        let Self::Kept(kept) = self else {
            return None;
        };
        Some(KeptAnswer {
            names: kept.names.clone(),
            set: kept.set.clone(),
            sides: 1_u64.checked_shl(u32::try_from(place(&kept.value)).ok()?)?,
        })
    }
}

impl Executor {
    /// Whether the PLC may have to acknowledge an M or H function: all of which no list says that it does not,
    /// P-CHAN-00041, P-CHAN-00027.
    pub(crate) fn may_acknowledge(&self, letter: u8, number: Option<i64>) -> bool {
        let number = number.and_then(|number| u32::try_from(number).ok());
        let Some(number) = number.filter(|_| self.state.control.memory.holds_any()) else {
            return true;
        };
        let silent = &self.machine.channel.unacknowledged;
        let is_silent = silent.contains(&(letter, number)) && !(letter == b'M' && number < 2);
        // A program may set the kind of synchronisation (tf5200_m_and_h_func/285949579).
        let set = format!("V.G.{}_FCT[{number}].SYNCH", char::from(letter));
        let set = VariableName::read(&set);
        !is_silent || self.state.control.memory.variable(&set).is_some()
    }

    /// Whether the PLC acts by design at a word that may be executed: an M or H function but an end, a dwell.
    pub(crate) fn lets_plc_act_at(&self, letter: u8, number: Option<i64>) -> bool {
        match letter {
            b'M' if matches!(number, Some(2 | 17 | 29 | 30)) => false,
            b'M' | b'H' => self.may_acknowledge(letter, number),
            b'G' => number.is_none_or(|number| number == 4),
            _ => false,
        }
    }

    /// The PLC acts by design: every value that the program shares with it may be another one.
    #[inline]
    pub(crate) fn let_plc_act(&mut self) {
        let RunState { control, track, .. } = &self.state;
        if control.memory.holds_any() || !track.assumed.is_empty() {
            self.let_plc_write(|_| true);
            self.state.control.memory.end_initialisation();
        }
    }

    /// The PLC may write variables.
    #[cold]
    pub(crate) fn let_plc_write(&mut self, is_it: impl Fn(&VariableName) -> bool) {
        let RunState { control, track, .. } = &mut self.state;
        track.assumed.undo_external(&is_it, &mut control.memory);
        let changed = control.memory.let_change(is_it);
        let is_changed = |target: &Location| matches!(target, Location::Variable(name) if changed.contains(name));
        if !changed.is_empty() {
            track.readings.havoc(is_changed);
        }
    }

    /// The value of a condition, and what the program set that decides it.
    pub(crate) fn asked_value(
        &mut self,
        condition: Operand,
        at: &BlockContext<'_>,
    ) -> Result<(Value, Option<Doubt>), Box<Fault>> {
        let (value, mut relied) = self.value_with_reads(condition, at)?;
        if let Some(doubt) = Doubt::of(&value) {
            return Ok((value, Some(doubt)));
        }
        relied.retain(|name| self.state.control.memory.set_at(name).is_some());
        relied.sort_unstable();
        relied.dedup();
        let set = relied
            .iter()
            .filter_map(|name| self.state.control.memory.set_at(name));
        let Some(set) = set.min().cloned() else {
            return Ok((value, None));
        };
        let said = self.scratch.messages.diagnostics.len();
        self.scratch.read.held = HeldValues::Doubted;
        let doubted = self.value(condition, at);
        self.scratch.read.held = HeldValues::Taken;
        self.scratch.messages.diagnostics.truncate(said);
        let is_open = matches!(doubted, Ok(Value::Unknown(_)));
        let kept = is_open.then(|| {
            Doubt::Kept(KeptValue {
                names: relied.into(),
                set,
                value: value.clone(),
            })
        });
        Ok((value, kept))
    }

    /// The value of the condition of a loop: the PLC may write the variables that it asks for.
    pub(crate) fn loop_value(
        &mut self,
        condition: Operand,
        at: &BlockContext<'_>,
    ) -> Result<Value, Box<Fault>> {
        if let Operand::Number(number) = condition {
            return Ok(Value::Number(number));
        }
        let (value, relied) = self.value_with_reads(condition, at)?;
        if relied.is_empty() {
            return Ok(value);
        }
        self.state.control.memory.hold_initial(&relied);
        self.let_plc_write(|name| relied.iter().any(|it| it == name));
        self.value(condition, at)
    }

    fn value_with_reads(
        &mut self,
        operand: Operand,
        at: &BlockContext<'_>,
    ) -> Result<(Value, Vec<VariableName>), Box<Fault>> {
        self.scratch.read.relied.get_mut().clear();
        let value = self.value(operand, at)?;
        Ok((value, self.scratch.read.relied.take()))
    }
}

impl Executor {
    /// Whether only the machine has the program.
    pub(crate) fn is_external(&self, wanted: &WantedCall) -> bool {
        wanted.word.is_some()
            || wanted.scope == CallScope::Global && self.machine.programs.is_external(&wanted.name)
    }

    /// Makes unknown what a program that only the machine has does not keep.
    pub(crate) fn leave_to_machine(&mut self, program: &MissingProgram) {
        let name = program.to_string();
        let keeps = self.machine.programs.keeps(&name);
        self.scratch.read.plc_acts = true;
        if !keeps.compensation {
            self.state.control.havoc_couplings();
            self.havoc_compensation();
        }
        if !keeps.parameters {
            // It writes the P parameters and variables of its caller (R2.33, R2.52).
            self.havoc_memory(&Unknown::Program(program.clone()));
        }
        self.state.control.modal.functions.perhaps_give_feeds();
        if !keeps.positions {
            self.state.control.modal.havoc_positions();
            self.perhaps_move_all();
            self.state.control.modal.note_transformed(&name);
        }
    }
}
