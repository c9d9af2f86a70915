//! `#VAR` and `#DELETE` (R2.34).

use crate::diagnostic::Code;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::hash_parts::declared_name;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::state::State;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::location::Location;
use crate::interpreter::values::value::Value;
use crate::syntax::ast::{Declaration, Hash, Operand};
use crate::syntax::{Fault, Subscript, VariableFamily, VariableName};

impl Interpreter {
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
                    self.state.write_anything();
                    self.state.control.memory.delete(&name);
                }
                (several, unknown) => self.write(&several, unknown),
            }
        }
        Ok(())
    }

    pub(crate) fn declare(
        &mut self,
        declarations: &[Declaration],
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        self.journal.begin_anew();
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
            let default = if declaration.kind.as_deref() == Some("STRING") {
                Value::Text("".into())
            } else {
                Value::Number(0.0)
            };
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
            if let Some(before) = before {
                memory.declare_anew(&name, &before);
            }
        }
        Ok(())
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

impl State {
    /// Something is declared or deleted.
    fn write_anything(&mut self) {
        let seq = self.seq;
        let (control, track) = (&mut self.control, &mut self.track);
        track.ways.write_anything(seq);
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
