//! `#VAR` and `#DELETE` (R2.34).

use crate::diagnostic::Code;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::hash_parts::declared_name;
use crate::interpreter::run::state::RunState;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::location::Location;
use crate::interpreter::values::names::Sure;
use crate::interpreter::values::value::{Value, exact};
use crate::interpreter::values::value_type::{TypedValue, ValueType};
use crate::readings::{Alternative, Question};
use crate::syntax::ast::{Declaration, Hash, Operand};
use crate::syntax::{Fault, Subscript, VariableFamily, VariableName};
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

    /// P-ERR-20933: a `V.CYC.` variable of an outer level is deleted (R2.102).
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

    /// P-ERR-21772: a `V.I.` array is declared with other dimensions than it has (R2.102).
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
            let mut stack = std::mem::take(&mut self.scratch.stack);
            let dimensions = self.with_evaluator(at, |evaluator| {
                evaluator.dimensions(declaration.target.place, &mut stack)
            });
            self.scratch.stack = stack;
            let dimensions = dimensions?;
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

    /// The value that a declaration without one gives. A `V.I.` variable may exist, and then keeps its own (R2.102).
    fn default_of(&self, name: &VariableName, kind: ValueType) -> Value {
        if name.family() != VariableFamily::Internal {
            return kind.default();
        }
        let held = self.state.control.memory.variable(name);
        held.unwrap_or_else(|| Value::Unknown(Unknown::text(name.array())))
    }

    /// FC328: a `V.I.` variable that may exist is declared with a value (R2.102).
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

    /// P-ERR-20909: a variable is declared again in its level (R2.102).
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

    /// The value that a variable of a type has after an assignment (R2.101).
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
    /// Something is declared or deleted.
    fn write_anything(&mut self) {
        let (control, track) = (&mut self.control, &mut self.track);
        track.write_anything(&mut control.memory);
    }
}

/// The name of the element at a place in row order; `None` where an unknown dimension decides which it
/// is. The first dimension does not.
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

/// Only the program's own variables can be declared (TF5200 Diagnosis, error 20908).
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
