//! Declarations with `#VAR` and `#DELETE` (R2.34), assignments, and the values of operands and system variables.

use std::collections::BTreeMap;

use crate::comp::{AxisIndex, Kind, KindSet, State};
use crate::diagnostic::Code;
use crate::interpreter::block::{BlockContext, declared_name};
use crate::interpreter::control::ControlState;
use crate::interpreter::events::{Note, NoteKind, Notes};
use crate::interpreter::executor::{Executor, RunState};
use crate::interpreter::motion::modal::PositionFrame;
use crate::interpreter::values::expression::{
    Evaluator, ExpressionScope, Macros, ParameterSource, misused,
};
use crate::interpreter::values::location::{Denoted, Location, Unknown};
use crate::interpreter::values::names::Sure;
use crate::interpreter::values::value::{Slot, TypedValue, Value, ValueType, exact, numeric};
use crate::interpreter::words::refusal::StopScope;
use crate::language::{ChannelState, Flushes, is_read_only};
use crate::lists::AxisType;
use crate::readings::{Alternative, Question};
use crate::syntax::ast::{
    Argument, Assignment, BinaryOperator, Declaration, Expression, Hash, Node, Operand, Owner,
};
use crate::syntax::{AxisOfVariable, Fault, Subscript, VariableFamily, VariableName};
use crate::text::Span;

impl Executor {
    pub(crate) fn delete(&mut self, hash: &Hash, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        for argument in &hash.arguments {
            let Operand::Expression(place) = *argument else {
                continue;
            };
            let Some(place) = self.target_place(place, at)? else {
                continue;
            };
            match place.assigned(Value::Number(0.0)) {
                (Location::Parameter(_, index), _) => {
                    self.state.write_anything();
                    self.state.control.memory.delete_parameter(index);
                }
                (Location::Variable(name), _) => {
                    self.refuse_outer(&name, hash.span, at)?;
                    self.state.write_anything();
                    self.state.control.memory.delete(&name);
                }
                (several, unknown) => self.write(&several, unknown),
            }
        }
        Ok(())
    }

    /// Reports P-ERR-20933: a `V.CYC.` variable of an outer level is deleted (R2.102).
    fn refuse_outer(
        &mut self,
        name: &VariableName,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        let outer = self.state.control.memory.of_outer_level(name);
        let Some(variable) = outer.filter(|_| name.family() == VariableFamily::Cycle) else {
            return Ok(());
        };
        let what = format!("`{name}` belongs to a program that calls this one");
        if variable.is_certain() {
            return Err(Fault::refused(Code::PErr20933, span, what));
        }
        self.may_refuse(20933, &what, span, at);
        Ok(())
    }

    /// Reports P-ERR-21772: a `V.I.` array is declared with other dimensions than it has (R2.102).
    fn refuse_other_shape(
        &mut self,
        name: &VariableName,
        dimensions: &[Result<u32, Value>],
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        let array = self.state.control.memory.array(name.array());
        let Some(array) = array.filter(|_| name.family() == VariableFamily::Internal) else {
            return Ok(());
        };
        let what = format!("`{name}` exists with other dimensions");
        let is_open = |size: &Result<u32, Value>| size.is_err();
        if dimensions.iter().any(is_open) || array.dimensions.contains(&None) {
            self.may_refuse(21772, &what, span, at);
        } else if dimensions
            .iter()
            .map(|size| size.as_ref().ok())
            .ne(array.dimensions.iter().map(Option::as_ref))
        {
            return Err(Fault::refused(Code::PErr21772, span, what));
        }
        Ok(())
    }

    pub(crate) fn declare(
        &mut self,
        declarations: &[Declaration],
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        self.state.write_anything();
        for declaration in declarations {
            refuse_declaration(declaration, at)?;
            let dimensions = self.with_evaluator(at, |evaluator, stack| {
                evaluator.dimensions(declaration.target.place, stack)
            })?;
            let name = declared_name(declaration, at);
            let mut values = Vec::with_capacity(declaration.initial.len());
            for operand in &declaration.initial {
                values.push(self.value(*operand, at)?);
            }
            let length = match declaration.length {
                Some(length) => self.operand_number(length, at).and_then(exact),
                None => None,
            };
            let kind = ValueType::named(declaration.kind.as_deref(), length);
            for value in &mut values {
                let taken = std::mem::replace(value, Value::Number(0.0));
                *value = self.typed(kind, &name, taken, declaration.target.span, at)?;
            }
            self.refuse_second(&name, declaration.target.span, at)?;
            self.refuse_other_shape(&name, &dimensions, declaration.target.span, at)?;
            let default = self.default_of(&name, kind);
            self.warn_kept(&name, !values.is_empty(), declaration.target.span, at);
            self.scratch.wrote = true;
            let is_scalar = dimensions.is_empty();
            self.note_declaration(&name, is_scalar.then(|| values.first().unwrap_or(&default)));
            let memory = &mut self.state.control.memory;
            let before = memory.before_declaration(&name);
            if is_scalar {
                let value = values.into_iter().next().unwrap_or(default);
                match Location::named(name.clone()) {
                    Location::Parameter(_, index) => memory.declare_parameter(index, value),
                    _ => memory.declare(&name, value),
                }
            } else {
                let elements: Vec<Option<VariableName>> = (0..values.len())
                    .map(|at| element(&name, &dimensions, at))
                    .collect();
                let unknown = dimensions.iter().find_map(|size| size.as_ref().err());
                let default = unknown.cloned().unwrap_or(default);
                let dimensions = dimensions.into_iter().map(Result::ok).collect();
                memory.declare_array(&name, dimensions, default);
                for (element, value) in elements.iter().zip(values) {
                    if let Some(element) = element {
                        memory.declare(element, value);
                    }
                }
            }
            // P parameters have no type.
            if name.family() != VariableFamily::Parameter {
                memory.set_declared(&name, kind);
            }
            if let Some(before) = before {
                memory.declare_anew(&name, &before);
            }
        }
        Ok(())
    }

    /// Returns the value that a declaration without one gives. A `V.I.` variable may exist, and then keeps its own
    /// (R2.102).
    fn default_of(&self, name: &VariableName, kind: ValueType) -> Value {
        if name.family() != VariableFamily::Internal {
            return kind.default();
        }
        let held = self.state.control.memory.variable(name);
        held.unwrap_or_else(|| Value::Unknown(Unknown::text(name.array())))
    }

    /// Reports FC328: a `V.I.` variable that may exist is declared with a value (R2.102).
    fn warn_kept(
        &mut self,
        name: &VariableName,
        has_value: bool,
        span: Span,
        at: &BlockContext<'_>,
    ) {
        if has_value && name.family() == VariableFamily::Internal {
            let what = format!(
                "`{name}` may exist from an earlier run, and this declaration gives it a value"
            );
            self.may_refuse(None, &what, span, at);
        }
    }

    /// Reports P-ERR-20909: a variable is declared again in its level (R2.102).
    fn refuse_second(
        &mut self,
        name: &VariableName,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        let outlives = matches!(
            name.family(),
            VariableFamily::Shared | VariableFamily::Internal
        );
        match self.state.control.memory.is_declared_here(name) {
            Some(declared) if !outlives && declared.certainty == Sure::Certain => {
                let what = format!("`{name}` is declared already");
                Err(Fault::refused(Code::PErr20909, span, what))
            }
            Some(_) if !outlives => {
                let what = format!("`{name}` may be declared already");
                self.may_refuse(20909, &what, span, at);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Returns the value that a variable of a type has after an assignment (R2.101).
    pub(crate) fn typed(
        &mut self,
        kind: ValueType,
        name: &VariableName,
        value: Value,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<Value, Box<Fault>> {
        let shown = value.as_written();
        match kind.take(name.array(), value) {
            TypedValue::Taken(value) => Ok(value),
            TypedValue::Fraction(number) => {
                self.state.rests_on.insert(Question::WholeNumber);
                let whole = match self.machine.readings.of(Question::WholeNumber) {
                    Some(Alternative::First) => Some(number.trunc()),
                    Some(Alternative::Second) => Some(number.round()),
                    None => None,
                };
                if let Some(whole) = whole {
                    return self.typed(kind, name, whole.into(), span, at);
                }
                if !kind.has(number.floor()) || !kind.has(number.ceil()) {
                    let what =
                        format!("`{shown}` is between the last value of `{name}` and the next one");
                    self.may_refuse(20847, &what, span, at);
                }
                Ok(Value::Unknown(Unknown::text(name.array())))
            }
            TypedValue::OutOfRange(least, most) => {
                let what = format!("`{name}` takes {least} to {most}, and the value is {shown}");
                Err(Fault::refused(Code::PErr20847, span, what))
            }
            TypedValue::OtherKind(why) => Err(Box::new(Fault::new(Code::Fc312, span, why))),
        }
    }

    /// Notes the start value of a variable, or an array, that may be there before.
    fn note_declaration(&self, name: &VariableName, start: Option<&Value>) {
        let location = Location::named(name.clone());
        let is_unwritten = self.state.control.memory.is_unwritten(&location);
        let array = Value::Unknown(Unknown::text(name.array()));
        self.note_use(|used| {
            if is_unwritten {
                used.want(location);
            }
            used.write_name(name, start.unwrap_or(&array));
        });
    }
}

impl RunState {
    /// Records that something is declared or deleted.
    fn write_anything(&mut self) {
        let (control, track) = (&mut self.control, &mut self.track);
        track.write_anything(&mut control.memory);
    }
}

/// Returns the name of the element at a place in row order; `None` where an unknown dimension decides which it is. The
/// first dimension does not.
fn element(
    name: &VariableName,
    dimensions: &[Result<u32, Value>],
    place: usize,
) -> Option<VariableName> {
    let mut subscripts = Vec::with_capacity(dimensions.len());
    let mut rest = place;
    for (at, size) in dimensions.iter().enumerate().rev() {
        let size = match size {
            Ok(size) => usize::try_from(*size).unwrap_or(usize::MAX).max(1),
            Err(_) if at == 0 => usize::MAX,
            Err(_) => return None,
        };
        let subscript = i64::try_from(rest % size).unwrap_or(i64::MAX);
        subscripts.push(Subscript::Number(subscript));
        rest /= size;
    }
    Some(name.at(subscripts.into_iter().rev().collect()))
}

/// Refuses the declaration of anything but the program's own variables (TF5200 Diagnosis, error 20908).
fn refuse_declaration(declaration: &Declaration, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
    let name = declared_name(declaration, at);
    let family = name.family();
    if family.is_written() || family == VariableFamily::Other {
        return Ok(());
    }
    let span = declaration.target.span;
    let message = format!(
        "`{}` cannot be declared: the control has it",
        span.of(at.text).trim()
    );
    let fault = Fault::new(Code::Fc207, span, message);
    Err(Box::new(fault.with_help(
        "declare `V.L.`, `V.S.` or `V.P.` variables only",
    )))
}

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
    /// Returns the value of an operand.
    pub(crate) fn value(
        &mut self,
        operand: Operand,
        at: &BlockContext<'_>,
    ) -> Result<Value, Box<Fault>> {
        if let Operand::Number(number) = operand {
            return Ok(Value::Number(number));
        }
        let value = self.with_evaluator(at, |evaluator, stack| evaluator.value(operand, stack));
        if self.scratch.read.may_be_refused() {
            self.warn_of_reading(at);
        }
        value
    }

    /// Reports what the control may refuse to read.
    #[cold]
    fn warn_of_reading(&mut self, at: &BlockContext<'_>) {
        if let Some(name) = self.scratch.read.flushing.take() {
            self.read_flushes(&name, at);
        }
        if let Some(name) = self.scratch.read.undeclared.take() {
            self.miss_internal(&name, Span::new(0, at.text.trim_end().len()), at);
        }
    }

    pub(crate) fn with_evaluator<T>(
        &self,
        at: &BlockContext<'_>,
        evaluate: impl FnOnce(&Evaluator<'_>, &mut Vec<Slot>) -> T,
    ) -> T {
        static NONE: BTreeMap<u32, Value> = BTreeMap::new();
        let frame = self.state.control.frames.running();
        let given = match frame {
            Some(frame) if frame.level > 0 => ParameterSource::ByCall,
            _ => ParameterSource::FromOutside,
        };
        let taken = self.options.notes == Notes::Taken;
        let evaluator = Evaluator {
            block: at.block,
            text: at.text,
            shown: None,
            macros: Macros {
                depth: at.macro_depth,
                limit: self.options.limits.macros,
                expansions: &self.scratch.read.expansions,
                until: self.work_bound(),
            },
            work: &self.state.work,
            scope: ExpressionScope {
                memory: &self.state.control.memory,
                reads: self.state.watching.then_some(&self.state.reads),
                used: self.used.as_ref(),
                own: frame.map_or(&NONE, |frame| &frame.own),
                given,
                unread: &self.scratch.read.unread,
                waits: self.scratch.moves.rest_flag(),
                flushing: &self.scratch.read.flushing,
                relied: &self.scratch.read.relied,
                held: self.scratch.read.held,
                nearly_equal: self.machine.readings.of(Question::NearlyEqual),
                system: &|name| self.system_variable(name),
                unknown: &|name, span| {
                    if taken {
                        self.scratch.read.notes.borrow_mut().push(Note {
                            kind: NoteKind::Unknown,
                            name: name.to_owned(),
                            place: at.place(span),
                        });
                    }
                },
            },
        };
        evaluate(&evaluator, &mut self.scratch.read.stack.borrow_mut())
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
            self.scratch.read.notes.borrow_mut().push(Note {
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
                .read
                .undeclared
                .replace(Some(name.array().to_owned()));
        }
        let own = self.own_variable(name)?;
        if matches!(own, OwnVariable::Active(..) | OwnVariable::Ready(..)) {
            self.scratch.read.flushing.replace(Some(name.clone()));
        }
        match own {
            OwnVariable::Active(axis, kind) => {
                self.scratch.read.asked.borrow_mut().push((axis, kind));
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

    /// Returns whether the value of a variable follows from the state of the run.
    pub(crate) fn is_own(&self, name: &VariableName) -> bool {
        self.own_variable(name).is_some()
    }

    /// Returns the kind of an axis whose state a variable shows.
    pub(crate) fn active_variable(&self, name: &VariableName) -> Option<(AxisIndex, Kind)> {
        match self.own_variable(name)? {
            OwnVariable::Active(axis, kind) => Some((axis, kind)),
            _ => None,
        }
    }

    /// Returns the variable of an axis whose value follows from the state of the run.
    fn own_variable(&self, name: &VariableName) -> Option<OwnVariable> {
        let (variable, axis) = name.of_axis()?;
        let axis = match axis {
            AxisOfVariable::Name(name) => self.axes().any(name)?,
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

    /// Reports FC322: the effect of an assignment to such a variable is not known.
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
        self.scratch.messages.diagnostics.push(at.diagnostic(fault));
    }

    /// Makes such a variable unknown, since something may have written it.
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

    /// Returns a value as the variable that it is assigned to takes it (R2.101, R2.102).
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
                name.is_element() || matches!(place.location, Location::Elements(_))
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

    /// Reports FC328: no program of the run declares a `V.I.` variable (R2.102).
    fn miss_internal(&mut self, name: &str, span: Span, at: &BlockContext<'_>) {
        let what = format!("no program of this run declares `{name}`");
        self.may_refuse(20392, &what, span, at);
    }

    pub(crate) fn target_place(
        &self,
        place: Expression,
        at: &BlockContext<'_>,
    ) -> Result<Option<Denoted>, Box<Fault>> {
        // A P parameter with its number denotes itself.
        let root = place.end.checked_sub(1).map(|root| root as usize);
        if let Some(Node::Parameter { owner, index }) = root.and_then(|it| at.block.nodes.get(it)) {
            return Ok(Some(Location::Parameter(*owner, *index).into()));
        }
        self.with_evaluator(at, |evaluator, stack| evaluator.place(place, stack))
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

    /// Returns a variable with a value from the user that the program counts on from there: the user's value was its
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

    /// Returns the number that an operand is, if it is known; FC312 for a string (R2.37).
    pub(crate) fn number(
        &mut self,
        operand: Operand,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<Option<f64>, Box<Fault>> {
        numeric(&self.value(operand, at)?, span)
    }

    /// Returns the number that an argument of a command means; `None` where it is not known.
    pub(crate) fn argument_number(
        &mut self,
        argument: &Argument,
        at: &BlockContext<'_>,
    ) -> Option<f64> {
        self.operand_number(argument.value?, at)
    }

    /// Returns the number of a value; `None` where it is not known.
    pub(crate) fn operand_number(&mut self, value: Operand, at: &BlockContext<'_>) -> Option<f64> {
        match self.value(value, at) {
            Ok(Value::Number(number)) => Some(number),
            _ => None,
        }
    }
}

impl Executor {
    /// Reports FC412 or FC328: the control may refuse to read the state of a compensation under G41 or G42 (R1.42), and
    /// a `V.E.` variable under these and under a spline, unless it is not synchronous (P-EXTV-00005, R2.111).
    fn read_flushes(&mut self, name: &VariableName, at: &BlockContext<'_>) {
        // One answer holds for all elements of an array.
        let written = name.array().to_owned();
        let found = at.text.find(&written);
        let span = found.map(|start| Span::new(start, start + written.len()));
        let span = span.unwrap_or_else(|| Span::new(0, at.text.trim_end().len()));
        if name.family() == VariableFamily::External {
            return self.check_flush(Flushes::Both, &written, span, at);
        }
        let modal = &self.state.control.modal;
        let mut states = Flushes::Radius.refused().iter().copied();
        let Some((state, number)) = states.find(|(state, _)| modal.is_in(*state)) else {
            return;
        };
        let when = match state {
            ChannelState::CutterRadius => "while G41 or G42 is active",
            _ => state.words(),
        };
        let message = format!(
            "reading `{written}` flushes the channel, which the control may refuse {when} (error {number})"
        );
        let fault = Fault::new(Code::Fc412, span, message)
            .with_help("read it before G41 or G42, for example into a parameter");
        self.say_before_parting(at.diagnostic(fault));
        let scope = StopScope::Alike(format!("V.A.FRICT_COMP {when}").into());
        self.perhaps_stop((Unknown::Refused(Some(number)), scope), span, at);
    }
}

impl ControlState {
    /// Returns as a value whether the call gave an own parameter (R2.79); `None` where that is not known.
    fn is_given(&self, index: u32) -> Option<Value> {
        let frame = self.frames.running()?;
        let name = VariableName::own_parameter(index);
        let given = frame.own.contains_key(&index) || self.memory.variable(&name).is_some();
        (given || frame.level > 0).then(|| given.into())
    }
}

/// Returns the number in `V.G.@P[1].VALID`.
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

/// Returns whether the value of an assignment is computed from the variable that it writes.
fn reads_itself(assignment: Assignment, name: &VariableName, at: &BlockContext<'_>) -> bool {
    let Operand::Expression(value) = assignment.value else {
        return false;
    };
    let range = value.start as usize..value.end as usize;
    let spans = at.block.spans.get(range).unwrap_or_default();
    let mut texts = spans.iter().map(|span| span.of(at.text));
    texts.any(|text| VariableName::read(text) == *name)
}

/// Returns whether an assignment counts: `P1 = P1 + 1`.
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
