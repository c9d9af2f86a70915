//! Values of operands, system variables, and what assignments write.

use std::collections::BTreeMap;

use super::at::At;
use super::event::{Note, NoteKind, Notes};
use super::expression::{Evaluator, Given, Macros, Place, Scope};
use super::modal::Frame as PositionFrame;
use super::run::Interpreter;
use super::value::Value;
use crate::comp::{AxisIndex, Kind, State};
use crate::syntax::Fault;
use crate::syntax::ast::{Assignment, Block, Expression, Operand, Owner};
use crate::text::Span;

/// Different words that are counted as passed over, one by one.
const MAX_OPAQUE: usize = 1000;

/// What further ones are counted under.
const OTHER_WORDS: &str = "other words";

impl Interpreter {
    /// The value of an operand.
    pub(super) fn value(
        &mut self,
        operand: Operand,
        block: &Block,
        at: &At<'_>,
    ) -> Result<Value, Box<Fault>> {
        if let Operand::Number(number) = operand {
            return Ok(Value::Number(number));
        }
        let mut stack = std::mem::take(&mut self.work.stack);
        let value =
            self.with_evaluator(block, at, |evaluator| evaluator.value(operand, &mut stack));
        self.work.stack = stack;
        value
    }

    pub(super) fn with_evaluator<T>(
        &self,
        block: &Block,
        at: &At<'_>,
        work: impl FnOnce(&Evaluator<'_>) -> T,
    ) -> T {
        static NONE: BTreeMap<u32, Value> = BTreeMap::new();
        let frame = self.state.frames.last();
        let given = match frame {
            Some(frame) if frame.level > 0 => Given::ByCall,
            _ => Given::FromOutside,
        };
        let taken = self.options.notes == Notes::Taken;
        work(&Evaluator {
            block,
            text: at.text,
            shown: None,
            macros: Macros {
                depth: at.macro_depth,
                limit: self.options.limits.macros,
                expansions: &self.work.expansions,
                until: self.work_bound(),
            },
            state: &self.state,
            scope: Scope {
                memory: &self.state.memory,
                reads: self.state.watching.then_some(&self.state.reads),
                own: frame.map_or(&NONE, |frame| &frame.own),
                given,
                unread: &self.work.unread,
                system: &|name| self.system_variable(name),
                unknown: &|name, span| {
                    if taken {
                        self.work.notes.borrow_mut().push(Note {
                            kind: NoteKind::Unknown,
                            name: name.to_owned(),
                            place: at.place(span),
                        });
                    }
                },
            },
        })
    }

    /// Counts something that was accepted and passed over.
    pub(super) fn pass_over(&mut self, word: &str, span: Span, at: &At<'_>) {
        let counts = &mut self.state.opaque;
        let full = counts.len() >= MAX_OPAQUE && !counts.contains_key(word);
        let word_or_rest = if full { OTHER_WORDS } else { word };
        match counts.get_mut(word_or_rest) {
            Some(count) => *count += 1,
            None => {
                counts.insert(word_or_rest.to_owned(), 1);
            }
        }
        if self.options.notes == Notes::Taken {
            self.work.notes.borrow_mut().push(Note {
                kind: NoteKind::Opaque,
                name: word.to_owned(),
                place: at.place(span),
            });
        }
    }

    /// What the dry run knows of the machine's own variables (R1.35, R2.36).
    fn system_variable(&self, name: &str) -> Option<Value> {
        if let Some(index) = given_parameter(name) {
            return self.is_given(index);
        }
        let rest = name.strip_prefix("V.A.")?;
        let (variable, axis) = if let Some((variable, index)) = rest.split_once('[') {
            let position = index.trim_end_matches(']').parse().ok()?;
            (
                variable,
                (position < self.machine.axes.len()).then(|| AxisIndex::new(position))?,
            )
        } else {
            let (variable, axis) = rest.rsplit_once('.')?;
            (variable, self.machine.find(axis)?)
        };
        if let Some(kind) = variable
            .strip_suffix("_COMP_ACTIVE")
            .and_then(compensation_kind)
        {
            return match self.state.compensation.state(axis, kind) {
                State::Unknown => None,
                state => Some((state == State::Active).into()),
            };
        }
        if let Some(kind) = variable
            .strip_suffix("_COMP_INIT")
            .and_then(compensation_kind)
        {
            let machine = self.machine.axis(axis);
            let ready = machine.configured.contains(kind) && machine.parameterised().contains(kind);
            return Some(ready.into());
        }
        match variable {
            "ABS" => {
                let position = self.state.modal.position(axis);
                let value = position
                    .value
                    .filter(|_| position.frame == PositionFrame::Machine);
                value.map(Value::Number)
            }
            "PROG" => self.state.modal.programmed(axis).map(Value::Number),
            _ => None,
        }
    }

    /// Whether the call gave an own parameter (R2.79).
    fn is_given(&self, index: u32) -> Option<Value> {
        let frame = self.state.frames.last()?;
        let name = format!("@P{index}");
        let given = frame.own.contains_key(&index) || self.state.memory.variable(&name).is_some();
        (given || frame.level > 0).then(|| given.into())
    }

    pub(super) fn assign(
        &mut self,
        assignment: Assignment,
        block: &Block,
        at: &At<'_>,
    ) -> Result<(), Box<Fault>> {
        let watching = self.state.watching;
        if watching {
            // What only counts is not read (R2.84).
            let place = self.target_place(assignment.target.place, block, at)?;
            self.state.watching = !Self::counts(assignment, &place, (block, at.text));
        }
        let value = self.value(assignment.value, block, at);
        self.state.watching = watching;
        let value = value?;
        let place = self.target_place(assignment.target.place, block, at)?;
        self.write(place, value);
        Ok(())
    }

    pub(super) fn target_place(
        &mut self,
        place: Expression,
        block: &Block,
        at: &At<'_>,
    ) -> Result<Place, Box<Fault>> {
        let mut stack = std::mem::take(&mut self.work.stack);
        let found = self.with_evaluator(block, at, |evaluator| evaluator.place(place, &mut stack));
        self.work.stack = stack;
        found
    }

    pub(super) fn write(&mut self, place: Place, value: Value) {
        self.work.wrote = true;
        self.journal.write(&place, &value);
        if self.state.ways.is_open() {
            self.state.ways.write(&place, self.state.seq);
        }
        match place {
            Place::Parameter(Owner::Program, index) => {
                self.state.memory.set_parameter(index, value);
            }
            Place::Parameter(Owner::Call, index) => {
                if let Some(frame) = self.state.frames.last_mut() {
                    frame.own.insert(index, value);
                }
            }
            Place::Variable(name) => self.state.memory.set_variable(&name, value),
            Place::Elements(name, cause) => self.state.memory.forget_elements(&name, &cause),
            Place::Parameters(cause) => self.state.memory.forget_parameters(&cause),
            Place::Nowhere => {}
        }
    }
}

/// The number in `V.G.@P[1].VALID`.
fn given_parameter(name: &str) -> Option<u32> {
    let rest = name.strip_prefix("V.G.@P")?;
    let index = rest.strip_suffix(".VALID")?;
    index.trim_matches(['[', ']']).parse().ok()
}

fn compensation_kind(name: &str) -> Option<Kind> {
    Kind::from_keyword(name).filter(|kind| *kind != Kind::Backlash)
}
