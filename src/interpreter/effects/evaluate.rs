//! Values of operands, system variables, and the effects of assignments.

use std::collections::BTreeMap;

use crate::comp::{AxisIndex, Kind, KindSet, State};
use crate::diagnostic::Code;
use crate::interpreter::coordinates::modal::PositionFrame;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::event::{Note, NoteKind, Notes};
use crate::interpreter::run::executor::Executor;
use crate::interpreter::values::expression::{
    Evaluator, ExpressionScope, Macros, ParameterSource, misused,
};
use crate::interpreter::values::functions::numeric;
use crate::interpreter::values::location::{Denoted, Location};
use crate::interpreter::values::value::Value;
use crate::language::{Flushes, is_read_only};
use crate::lists::AxisType;
use crate::readings::Question;
use crate::syntax::ast::{Argument, Assignment, BinaryOperator, Expression, Node, Operand, Owner};
use crate::syntax::{AxisOfVariable, Fault, Subscript, VariableFamily, VariableName};
use crate::text::Span;

/// Different words that are counted as passed over, one by one.
const MAX_OPAQUE: usize = 1000;

/// Name under which further words are counted.
const OTHER_WORDS: &str = "other words";

/// The widest step of a counter. It would take longer than any run to leave the range of numbers.
const WIDEST_STEP: f64 = 1e9;

/// A variable of an axis whose value follows from the state of the run (R1.35, R2.36).
#[derive(Debug, Clone, Copy)]
enum OwnVariable {
    /// `V.A.FRICT_COMP_ACTIVE.X`
    Active(AxisIndex, Kind),
    /// `V.A.FRICT_COMP_INIT.X`
    Ready(AxisIndex, Kind),
    /// `V.A.ABS.X`
    Absolute(AxisIndex),
    /// `V.A.PROG.X`
    Programmed(AxisIndex),
}

impl Executor {
    /// The value of an operand.
    pub(crate) fn value(
        &mut self,
        operand: Operand,
        at: &BlockContext<'_>,
    ) -> Result<Value, Box<Fault>> {
        if let Operand::Number(number) = operand {
            return Ok(Value::Number(number));
        }
        let mut stack = std::mem::take(&mut self.scratch.stack);
        let value = self.with_evaluator(at, |evaluator| evaluator.value(operand, &mut stack));
        self.scratch.stack = stack;
        if let Some(name) = self.scratch.flushing.take() {
            self.read_flushes(&name, at);
        }
        if let Some(name) = self.scratch.undeclared.take() {
            self.miss_internal(&name, Span::new(0, at.text.trim_end().len()), at);
        }
        value
    }

    pub(crate) fn with_evaluator<T>(
        &self,
        at: &BlockContext<'_>,
        evaluate: impl FnOnce(&Evaluator<'_>) -> T,
    ) -> T {
        static NONE: BTreeMap<u32, Value> = BTreeMap::new();
        let frame = self.state.control.frames.running();
        let given = match frame {
            Some(frame) if frame.level > 0 => ParameterSource::ByCall,
            _ => ParameterSource::FromOutside,
        };
        let taken = self.options.notes == Notes::Taken;
        evaluate(&Evaluator {
            block: at.block,
            text: at.text,
            shown: None,
            macros: Macros {
                depth: at.macro_depth,
                limit: self.options.limits.macros,
                expansions: &self.scratch.expansions,
                until: self.work_bound(),
            },
            work: &self.state.work,
            scope: ExpressionScope {
                memory: &self.state.control.memory,
                reads: self.state.watching.then_some(&self.state.reads),
                used: self.used.as_ref(),
                own: frame.map_or(&NONE, |frame| &frame.own),
                given,
                unread: &self.scratch.unread,
                waits: &self.scratch.rests,
                flushing: &self.scratch.flushing,
                relied: &self.scratch.relied,
                held: self.scratch.held,
                nearly_equal: self.machine.readings.of(Question::NearlyEqual),
                system: &|name| self.system_variable(name),
                unknown: &|name, span| {
                    if taken {
                        self.scratch.notes.borrow_mut().push(Note {
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
    pub(crate) fn pass_over(&mut self, word: &str, span: Span, at: &BlockContext<'_>) {
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
            self.scratch.notes.borrow_mut().push(Note {
                kind: NoteKind::Opaque,
                name: word.to_owned(),
                place: at.place(span),
            });
        }
    }

    /// Returns the value of a variable of the machine itself that is known to the dry run (R1.35, R2.36).
    fn system_variable(&self, name: &VariableName) -> Option<Value> {
        if let Some(index) = given_parameter(name) {
            return self.state.control.is_given(index);
        }
        if name.family() == VariableFamily::Internal && self.state.control.memory.is_absent(name) {
            self.scratch
                .undeclared
                .replace(Some(name.array().to_owned()));
        }
        let own = self.own_variable(name)?;
        if matches!(own, OwnVariable::Active(..) | OwnVariable::Ready(..)) {
            self.scratch.flushing.replace(Some(name.clone()));
        }
        match own {
            OwnVariable::Active(axis, kind) => {
                self.scratch.asked.borrow_mut().push((axis, kind));
                match self.state.control.compensation.state(axis, kind) {
                    State::Unknown => None,
                    state => Some((state == State::Active).into()),
                }
            }
            OwnVariable::Ready(axis, kind) => {
                let machine = self.machine.axis(axis);
                let ready =
                    machine.configured.contains(kind) && machine.parameterised().contains(kind);
                Some(ready.into())
            }
            OwnVariable::Absolute(axis) => {
                let position = self.state.control.modal.position(axis);
                let is_of_machine = position.frame == PositionFrame::Machine
                    && self.machine.axis(axis).axis_type == AxisType::Linear
                    && self.state.control.modal.is_without_offsets(axis);
                let value = position.value.filter(|_| is_of_machine);
                value.map(Value::Number)
            }
            OwnVariable::Programmed(axis) => {
                self.state.control.modal.programmed(axis).map(Value::Number)
            }
        }
    }

    /// Whether the value of a variable follows from the state of the run.
    pub(crate) fn is_own(&self, name: &VariableName) -> bool {
        self.own_variable(name).is_some()
    }

    /// The kind of an axis whose state a variable shows.
    pub(crate) fn active_variable(&self, name: &VariableName) -> Option<(AxisIndex, Kind)> {
        match self.own_variable(name)? {
            OwnVariable::Active(axis, kind) => Some((axis, kind)),
            _ => None,
        }
    }

    /// The variable of an axis whose value follows from the state of the run.
    fn own_variable(&self, name: &VariableName) -> Option<OwnVariable> {
        let (variable, axis) = name.of_axis()?;
        let axis = match axis {
            AxisOfVariable::Name(name) => self.axis_now(name)?,
            AxisOfVariable::Index(position) => {
                let are_own = self.state.control.channel_axes.are_own();
                let is_there = are_own && position < self.machine.axes.len();
                is_there.then(|| AxisIndex::new(position))?
            }
        };
        let kind = |end: &str| variable.strip_suffix(end).and_then(compensation_kind);
        if let Some(kind) = kind("_COMP_ACTIVE") {
            return Some(OwnVariable::Active(axis, kind));
        }
        if let Some(kind) = kind("_COMP_INIT") {
            return Some(OwnVariable::Ready(axis, kind));
        }
        match variable {
            "ABS" => Some(OwnVariable::Absolute(axis)),
            "PROG" => Some(OwnVariable::Programmed(axis)),
            _ => None,
        }
    }

    /// FC322: the effect of an assignment to such a variable is not known.
    pub(crate) fn warn_own(&mut self, place: Option<&Denoted>, span: Span, at: &BlockContext<'_>) {
        let Some(name) = place.and_then(Denoted::variable) else {
            return;
        };
        let (axis, kind, is_switch) = match self.own_variable(name) {
            Some(OwnVariable::Active(axis, kind)) => (axis, kind, true),
            Some(OwnVariable::Ready(axis, kind)) => (axis, kind, false),
            // Positions can only be read, which is an error.
            Some(OwnVariable::Absolute(_) | OwnVariable::Programmed(_)) | None => return,
        };
        let axis = &self.machine.axis(axis).name;
        let message = format!(
            "`{name}` shows a state of the control and is not meant to be written; `{kind}` of `{axis}` is unknown after \
             this assignment"
        );
        let mut fault = Fault::new(Code::Fc322, span, message);
        if is_switch {
            fault = fault.with_help(format!(
                "switch it with `{axis}[COMP ON {kind}]` or `{axis}[COMP OFF {kind}]`"
            ));
        }
        self.scratch.diagnostics.push(at.diagnostic(fault));
    }

    /// Something may have written such a variable: its value is not known any more.
    fn havoc_own(&mut self, own: OwnVariable) {
        match own {
            OwnVariable::Active(axis, kind) | OwnVariable::Ready(axis, kind) => {
                self.havoc(axis, KindSet::of(kind));
            }
            OwnVariable::Absolute(axis) | OwnVariable::Programmed(axis) => {
                self.state.control.modal.havoc_position(axis);
            }
        }
    }

    pub(crate) fn assign(
        &mut self,
        assignment: Assignment,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        let watching = self.state.watching;
        if watching {
            // A counter is not read (R2.84).
            let place = self.target_place(assignment.target.place, at)?;
            self.state.watching =
                !place.is_some_and(|it| only_counts(assignment, &it.location, at));
        }
        let value = self.value(assignment.value, at);
        self.state.watching = watching;
        let value = value?;
        let place = self.target_place(assignment.target.place, at)?;
        self.warn_own(place.as_ref(), assignment.target.span, at);
        let value = self.as_declared(place.as_ref(), value, assignment.target.span, at)?;
        let counts = self.counts_given(assignment, place.as_ref(), at);
        self.set_by(place, value, at);
        if let Some(name) = counts {
            self.state.control.memory.release(&name);
        }
        Ok(())
    }

    /// A value as the variable that it is assigned to takes it (R2.101, R2.102).
    pub(crate) fn as_declared(
        &mut self,
        place: Option<&Denoted>,
        value: Value,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<Value, Box<Fault>> {
        let Some(place) = place else {
            return Ok(value);
        };
        let (Location::Variable(name) | Location::Elements(name)) = &place.location else {
            return Ok(value);
        };
        if is_read_only(name.array()) {
            let what = format!("`{name}` can only be read");
            return Err(Fault::refused(Code::PErr20100, span, what));
        }
        let memory = &self.state.control.memory;
        if let Some(misuse) = place.variable().and_then(|name| memory.misuse(name)) {
            return Err(misused(misuse, span, at.text));
        }
        if let Some(declared) = memory.declaration(name) {
            return self.typed(declared.kind, name, value, span, at);
        }
        let needs_declaration = match name.family() {
            VariableFamily::Local => true,
            VariableFamily::Program | VariableFamily::Cycle | VariableFamily::Parameter => {
                name.is_element()
            }
            _ => false,
        };
        if needs_declaration && memory.is_absent(name) {
            self.miss_declaration(name.array(), span, at);
        } else if name.family() == VariableFamily::Internal && memory.is_absent(name) {
            self.miss_internal(name.array(), span, at);
        }
        Ok(value)
    }

    /// FC328: no program of the run declares a `V.I.` variable (R2.102).
    fn miss_internal(&mut self, name: &str, span: Span, at: &BlockContext<'_>) {
        let what = format!("no program of this run declares `{name}`");
        self.may_refuse(20392, &what, span, at);
    }

    pub(crate) fn target_place(
        &mut self,
        place: Expression,
        at: &BlockContext<'_>,
    ) -> Result<Option<Denoted>, Box<Fault>> {
        let mut stack = std::mem::take(&mut self.scratch.stack);
        let found = self.with_evaluator(at, |evaluator| evaluator.place(place, &mut stack));
        self.scratch.stack = stack;
        found
    }

    pub(crate) fn write(&mut self, location: &Location, value: Value) {
        if let Location::Variable(name) = location
            && let Some(own) = self.own_variable(name)
        {
            return self.havoc_own(own);
        }
        self.scratch.wrote = true;
        self.note_use(|used| used.write(location, &value));
        let state = &mut self.state;
        let control = &mut state.control;
        state.track.write(location, &mut control.memory);
        match location {
            Location::Parameter(Owner::Call, index) => {
                if let Some(frame) = control.frames.running_mut() {
                    frame.own.insert(*index, value);
                }
            }
            _ => control.memory.write(location, value),
        }
    }

    /// Writes a value that a block sets.
    pub(crate) fn set_by(&mut self, place: Option<Denoted>, value: Value, at: &BlockContext<'_>) {
        let Some((location, value)) = place.map(|place| place.assigned(value)) else {
            return;
        };
        self.write(&location, value);
        if let Location::Variable(name) = &location
            && name.family() == VariableFamily::External
        {
            self.state.control.memory.hold(name, at.as_setter());
        }
    }

    /// A variable with a value from the user that the program counts on from there: the user's value was its
    /// first one, and is not what the PLC writes.
    fn counts_given(
        &self,
        assignment: Assignment,
        place: Option<&Denoted>,
        at: &BlockContext<'_>,
    ) -> Option<VariableName> {
        let name = place?.variable()?;
        let is_given = name.family() == VariableFamily::External
            && self.state.control.memory.given(name).is_some();
        (is_given && reads_itself(assignment, name, at)).then(|| name.clone())
    }

    /// The number that an operand is, if it is known; FC312 for a string (R2.37).
    pub(crate) fn number(
        &mut self,
        operand: Operand,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<Option<f64>, Box<Fault>> {
        numeric(&self.value(operand, at)?, span)
    }

    /// The number that an argument of a command means; `None` where it is not known.
    pub(crate) fn argument_number(
        &mut self,
        argument: &Argument,
        at: &BlockContext<'_>,
    ) -> Option<f64> {
        self.operand_number(argument.value?, at)
    }

    /// The number of a value; `None` where it is not known.
    pub(crate) fn operand_number(&mut self, value: Operand, at: &BlockContext<'_>) -> Option<f64> {
        match self.value(value, at) {
            Ok(Value::Number(number)) => Some(number),
            _ => None,
        }
    }
}

impl Executor {
    /// FC412, FC328: the control may refuse to read the state of a compensation under G41 or G42 (R1.42), and a `V.E.`
    /// variable under these and under a spline, unless it is not synchronous (P-EXTV-00005, R2.111).
    fn read_flushes(&mut self, name: &VariableName, at: &BlockContext<'_>) {
        // One answer holds for all elements of an array.
        let written = name.array().to_owned();
        let found = at.text.find(&written);
        let span = found.map(|start| Span::new(start, start + written.len()));
        let span = span.unwrap_or_else(|| Span::new(0, at.text.trim_end().len()));
        if name.family() == VariableFamily::External {
            return self.check_flush(Flushes::Both, &written, span, at);
        }
        if !self.state.control.modal.transformed.contains("G41") {
            return;
        }
        let message = format!(
            "reading `{written}` flushes the channel, which the control may refuse while G41 or G42 is active (error 20651)"
        );
        let fault = Fault::new(Code::Fc412, span, message)
            .with_help("read it before G41 or G42, for example into a parameter");
        self.scratch.diagnostics.push(at.diagnostic(fault));
    }
}

impl ControlState {
    /// Whether the call gave an own parameter (R2.79).
    fn is_given(&self, index: u32) -> Option<Value> {
        let frame = self.frames.running()?;
        let name = VariableName::own_parameter(index);
        let given = frame.own.contains_key(&index) || self.memory.variable(&name).is_some();
        (given || frame.level > 0).then(|| given.into())
    }
}

/// The number in `V.G.@P[1].VALID`.
fn given_parameter(name: &VariableName) -> Option<u32> {
    match name.subscripts().as_slice() {
        [Subscript::Number(index), Subscript::Field(field)]
            if name.array() == "V.G.@P" && &**field == "VALID" =>
        {
            u32::try_from(*index).ok()
        }
        _ => None,
    }
}

fn compensation_kind(name: &str) -> Option<Kind> {
    name.parse().ok().filter(|kind| *kind != Kind::Backlash)
}

/// Whether the value of an assignment is computed from the variable that it writes.
fn reads_itself(assignment: Assignment, name: &VariableName, at: &BlockContext<'_>) -> bool {
    let Operand::Expression(value) = assignment.value else {
        return false;
    };
    let range = value.start as usize..value.end as usize;
    let spans = at.block.spans.get(range).unwrap_or_default();
    let mut texts = spans.iter().map(|span| span.of(at.text));
    texts.any(|text| VariableName::read(text) == *name)
}

/// Whether an assignment counts: `P1 = P1 + 1`.
pub(crate) fn only_counts(
    assignment: Assignment,
    location: &Location,
    at: &BlockContext<'_>,
) -> bool {
    let Operand::Expression(value) = assignment.value else {
        return false;
    };
    let range = value.start as usize..value.end as usize;
    let (Some(nodes), Some(spans)) = (at.block.nodes.get(range.clone()), at.block.spans.get(range))
    else {
        return false;
    };
    let steps = |step: &f64| step.abs() <= WIDEST_STEP;
    let read = match nodes {
        [
            read,
            Node::Number(step),
            Node::Binary(BinaryOperator::Add | BinaryOperator::Subtract),
        ] if steps(step) => Some((read, spans.first())),
        [Node::Number(step), read, Node::Binary(BinaryOperator::Add)] if steps(step) => {
            Some((read, spans.get(1)))
        }
        _ => None,
    };
    match (read, location) {
        (Some((Node::Parameter { owner, index }, _)), Location::Parameter(to, number)) => {
            owner == to && index == number
        }
        (Some((Node::Variable { subscripts: 0 }, Some(span))), Location::Variable(name)) => {
            VariableName::read(span.of(at.text)) == *name
        }
        _ => false,
    }
}
