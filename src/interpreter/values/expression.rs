//! Evaluation of expressions.
//!
//! The nodes of an expression are in postfix order, so that a stack is enough: no recursion, whatever
//! a program contains.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

use crate::diagnostic::{Advice, Budget, Code};
use crate::interpreter::values::externals::HeldValues;
use crate::interpreter::values::handover::VariableUse;
use crate::interpreter::values::location::{Denoted, Location, Reads, Unknown};
use crate::interpreter::values::memory::Memory;
use crate::interpreter::values::names::Misuse;
use crate::interpreter::values::value::{
    Slot, Value, binary, call, fault, numbers, numeric, rounded, wrong_type,
};
use crate::interpreter::values::work_budget::{ITEM, WorkBudget};
use crate::readings::Alternative;
use crate::syntax::ast::{Block, Expression, Function, Node, Operand, Owner};
use crate::syntax::{
    Fault, MAX_LINE, Subscript, Subscripts, VariableFamily, VariableName, compact,
};
use crate::text::Span;

/// Number of macros that one block may expand, whatever their depth: each may use others several times.
const MAX_EXPANSIONS: u32 = 4096;

/// Sources of an expression: the memory of the run and the variables of the machine.
#[derive(Clone, Copy)]
pub(crate) struct ExpressionScope<'a> {
    pub(crate) memory: &'a Memory,
    /// Notes on the values read, while they matter (R2.84).
    pub(crate) reads: Option<&'a RefCell<Reads>>,
    /// Records of what earlier programs may have written, if requested (R2.34).
    pub(crate) used: Option<&'a RefCell<VariableUse>>,
    /// Own parameters of the call.
    pub(crate) own: &'a BTreeMap<u32, Value>,
    /// Source of the values that it does not hold.
    pub(crate) given: ParameterSource,
    /// System variables: `V.A.…`, `V.G.…`; `None` when only the machine knows it.
    pub(crate) system: &'a dyn Fn(&VariableName) -> Option<Value>,
    /// Called for every value that only the machine knows.
    pub(crate) unknown: &'a dyn Fn(&str, Span),
    /// Set where a text had no known meaning, which the block's faults report.
    pub(crate) unread: &'a Cell<bool>,
    /// Set where a variable is read for which the control waits until the axes rest.
    pub(crate) waits: &'a Cell<bool>,
    /// The last variable that was read and whose reading flushes the channel, where that matters (R1.42, R2.111).
    pub(crate) flushing: &'a RefCell<Option<VariableName>>,
    /// The variables read whose value is known and which the PLC may write.
    pub(crate) relied: &'a RefCell<Vec<VariableName>>,
    pub(crate) held: HeldValues,
    /// Reading of the equality of numbers that differ only by rounding (R2.112).
    pub(crate) nearly_equal: Option<Alternative>,
}

/// Source of the own parameters of a program, `@P1` ….
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ParameterSource {
    /// Call, which gives some parameters and no others.
    ByCall,
    /// Caller of a cycle that runs without a call.
    FromOutside,
}

/// Progress in the expansion of macros.
#[derive(Clone, Copy)]
pub(crate) struct Macros<'a> {
    pub(crate) depth: u32,
    pub(crate) limit: u32,
    /// Number of expansions in the block.
    pub(crate) expansions: &'a Cell<u32>,
    /// The level of work up to which macros may expand.
    pub(crate) until: u64,
}

impl Macros<'_> {
    /// Returns the progress inside a macro with this code; FC914 past the budget.
    pub(crate) fn expand(
        self,
        code: &str,
        work: &WorkBudget,
        span: Span,
    ) -> Result<Self, Box<Fault>> {
        work.charge(ITEM + code.len());
        if work.level() > self.until {
            // The block ends with FC919, which says it all.
            return Err(fault(Code::Fc919, span, "the budget of work is used up"));
        }
        let expansions = self.expansions.get() + 1;
        self.expansions.set(expansions);
        if self.depth >= self.limit {
            let message = format!("macros are nested more than {} levels deep", self.limit);
            return Err(Box::new(
                Fault::new(Code::Fc914, span, message)
                    .with_help(Advice::RaiseBudget(Budget::Macros)),
            ));
        }
        if expansions > MAX_EXPANSIONS {
            let message = format!("this block expands more than {MAX_EXPANSIONS} macros");
            return Err(fault(Code::Fc914, span, message));
        }
        Ok(Self {
            depth: self.depth + 1,
            ..self
        })
    }
}

/// Evaluates expressions of one block.
pub(crate) struct Evaluator<'a> {
    pub(crate) block: &'a Block,
    pub(crate) text: &'a str,
    /// Span of the macro whose code is evaluated.
    pub(crate) shown: Option<Span>,
    pub(crate) macros: Macros<'a>,
    pub(crate) scope: ExpressionScope<'a>,
    /// Meter of the work.
    pub(crate) work: &'a WorkBudget,
}

impl Evaluator<'_> {
    /// Returns the value of an operand.
    pub(crate) fn value(&self, operand: Operand, stack: &mut Vec<Slot>) -> Slot {
        match operand {
            Operand::Number(number) => Ok(Value::Number(number)),
            Operand::Expression(expression) => {
                let bottom = stack.len();
                self.run(expression, stack);
                let value = pop(stack);
                stack.truncate(bottom);
                value
            }
        }
    }

    fn run(&self, expression: Expression, stack: &mut Vec<Slot>) {
        let nodes = expression.end.saturating_sub(expression.start);
        self.work
            .charge(usize::try_from(nodes).unwrap_or(usize::MAX));
        for at in expression.start..expression.end {
            let at = at as usize;
            let span = self.block.spans[at];
            let slot = match self.block.nodes[at] {
                Node::Number(number) if !number.is_finite() => {
                    let reason = if number.is_nan() {
                        "this is not a number"
                    } else {
                        "this number is too large to compute with"
                    };
                    Err(fault(Code::Fc312, span, reason))
                }
                Node::Number(number) => Ok(Value::Number(number)),
                Node::Text => self.text(span),
                Node::Parameter { owner, index } => self.parameter(owner, index, span),
                Node::IndexedParameter { owner, subscripts } => {
                    Denoted::pop_parameter(owner, usize::from(subscripts), span, stack)
                        .and_then(|place| self.denoted(place, span))
                }
                Node::Variable { subscripts: 0 } => {
                    self.variable(&VariableName::read(span.of(self.text)), span)
                }
                Node::Variable { subscripts } => self
                    .computed_variable(at, usize::from(subscripts), stack)
                    .and_then(|place| self.denoted(place, span)),
                Node::Unread => {
                    self.scope.unread.set(true);
                    let text = span.of(self.text).trim();
                    Ok(Value::Unknown(Unknown::text(
                        text.chars().take(40).collect::<String>(),
                    )))
                }
                Node::Negate => pop(stack).and_then(|value| match value {
                    Value::Number(number) => Ok(Value::Number(-number)),
                    Value::Text(_) => Err(wrong_type(span, "a string has no sign")),
                    unknown @ Value::Unknown(_) => Ok(unknown),
                }),
                Node::Binary(operator) => {
                    let reading = self.scope.nearly_equal;
                    if let [.., Ok(Value::Number(left)), Ok(Value::Number(right))] = stack[..] {
                        stack.truncate(stack.len() - 2);
                        numbers(operator, (left, right), reading, span)
                    } else {
                        let right = pop(stack);
                        let left = pop(stack);
                        self.bounded(binary(operator, (left, right), reading, span), span)
                    }
                }
                Node::Call {
                    function: Function::Sizeof,
                    arguments,
                } => {
                    let from = stack.len().saturating_sub(usize::from(arguments));
                    let dimension = stack.drain(from..).nth(1);
                    self.sizeof(span, dimension)
                }
                Node::Call {
                    function,
                    arguments,
                } => {
                    let from = stack.len().saturating_sub(usize::from(arguments));
                    let slots: Vec<Slot> = stack.drain(from..).collect();
                    let read = slots.iter().map(|slot| match slot {
                        Ok(Value::Text(text)) => text.len(),
                        _ => 0,
                    });
                    self.work.charge(read.sum());
                    match self.existence(function, at) {
                        Some(unknown) => Ok(unknown),
                        None => {
                            self.bounded(call(function, slots, self.scope.nearly_equal, span), span)
                        }
                    }
                }
            };
            stack.push(slot);
        }
    }

    /// Returns the result of `EXIST` for a variable that an earlier program may or may not have left, and for a
    /// `V.CYC.` variable that no open level has (R2.102).
    fn existence(&self, function: Function, at: usize) -> Option<Value> {
        if function != Function::Exist {
            return None;
        }
        let argument = at.checked_sub(1)?;
        let location = match self.block.nodes[argument] {
            Node::Variable { subscripts: 0 } => {
                let name = VariableName::read(self.block.spans[argument].of(self.text));
                if name.family() == VariableFamily::Cycle && self.scope.memory.is_absent(&name) {
                    return Some(false.into());
                }
                Location::Variable(name)
            }
            Node::Parameter {
                owner: Owner::Program,
                index,
            } => Location::Parameter(Owner::Program, index),
            _ => return None,
        };
        self.scope.used?;
        let is_found = self.scope.memory.is_found(&location);
        is_found.then(|| Value::Unknown(Unknown::text(location.to_string())))
    }

    /// Notes a value that the program may have found.
    fn note_found(&self, location: impl FnOnce() -> Location) {
        if let Some(used) = self.scope.used {
            let location = location();
            if self.scope.memory.is_unwritten(&location) {
                used.borrow_mut().want(location);
            }
        }
    }

    /// Returns a text that an operation made; FC312 where it is longer than any text of a program.
    fn bounded(&self, slot: Slot, span: Span) -> Slot {
        if let Ok(Value::Text(text)) = &slot {
            self.work.charge(text.len());
            if text.len() > MAX_LINE && text.chars().count() > MAX_LINE {
                let message = format!("the string has more than {MAX_LINE} characters");
                return Err(fault(Code::Fc312, span, message));
            }
        }
        slot
    }

    fn parameter(&self, owner: Owner, index: u32, span: Span) -> Slot {
        if let Some(reads) = self.scope.reads {
            reads.borrow_mut().note(Location::Parameter(owner, index));
        }
        if owner == Owner::Program {
            self.note_found(|| Location::Parameter(owner, index));
        }
        let found = match owner {
            Owner::Program => self.scope.memory.parameter(index),
            Owner::Call => match (self.scope.own.get(&index), self.scope.given) {
                (None, ParameterSource::FromOutside) => {
                    return Ok(self.outside(&VariableName::own_parameter(index), span));
                }
                (found, _) => found.cloned(),
            },
        };
        let given = || {
            let name = VariableName::parameter(index);
            self.scope.memory.given(&name).cloned()
        };
        found
            .or_else(given)
            .ok_or_else(|| never_written(span, self.text))
    }

    /// Returns a value that only a call or the machine gives, unless the user has given it.
    fn outside(&self, name: &VariableName, span: Span) -> Value {
        self.scope.memory.variable(name).unwrap_or_else(|| {
            let name = name.to_string();
            (self.scope.unknown)(&name, self.shown.unwrap_or(span));
            Value::Unknown(Unknown::text(name))
        })
    }

    /// Returns the value of a parameter or variable that is computed.
    fn denoted(&self, place: Denoted, span: Span) -> Slot {
        match (place.location, place.decided_by) {
            (Location::Elements(name), Some(_))
                if name.family().is_of_programs() && self.scope.memory.is_absent(&name) =>
            {
                Err(never_written(span, self.text))
            }
            (_, Some(cause)) => Ok(self.as_set(span).unwrap_or(Value::Unknown(cause))),
            (Location::Parameter(owner, index), None) => self.parameter(owner, index, span),
            (Location::Variable(name) | Location::Elements(name), None) => {
                self.variable(&name, span)
            }
            (Location::Parameters, None) => Ok(Value::Unknown(Unknown::text("P"))),
        }
    }

    /// Returns a text: the name of a macro whose code is an expression denotes its value (PM/206014219), any other text
    /// itself.
    fn text(&self, span: Span) -> Slot {
        let name = unquoted(span.of(self.text));
        let plain = || Ok(Value::Text(name.replace("\\\"", "\"").into()));
        let code = match self.scope.memory.macro_code(name) {
            Some(Value::Text(code)) => &**code,
            Some(unknown @ Value::Unknown(_)) => return Ok(unknown.clone()),
            Some(Value::Number(_)) | None => return plain(),
        };
        let macros = self.macros.expand(code, self.work, span)?;
        let mut block = Block::default();
        let Some(operand) = crate::syntax::parse_expression(code, &mut block) else {
            return plain();
        };
        let shown = self.shown.unwrap_or(span);
        let inner = Evaluator {
            block: &block,
            text: code,
            shown: Some(shown),
            macros,
            scope: self.scope,
            work: self.work,
        };
        inner.value(operand, &mut Vec::new()).map_err(|mut fault| {
            fault.span = span;
            fault
        })
    }

    /// Returns the variable whose subscripts are on the stack.
    fn computed_variable(
        &self,
        at: usize,
        subscripts: usize,
        stack: &mut Vec<Slot>,
    ) -> Result<Denoted, Box<Fault>> {
        let from = stack.len().saturating_sub(subscripts);
        let mut values = Vec::with_capacity(subscripts);
        let mut unknown = None;
        for slot in stack.drain(from..) {
            match slot? {
                Value::Number(number) => {
                    values.push(Subscript::Number(rounded(number).unwrap_or(i64::MAX)));
                }
                Value::Text(text) => values.push(Subscript::read(&text)),
                Value::Unknown(cause) => unknown = unknown.or(Some(cause)),
            }
        }
        let text = self.block.spans[at].of(self.text);
        if let Some(cause) = unknown {
            let elements = Location::Elements(VariableName::array_of(text));
            return Ok(Denoted::any_of(elements, cause));
        }
        Ok(Location::Variable(VariableName::with_values(text, values)).into())
    }

    /// Returns the value that the user gave an element as the program writes it.
    fn as_set(&self, span: Span) -> Option<Value> {
        let name = VariableName::read(span.of(self.text));
        if !name.is_element() {
            return None;
        }
        let given = || self.scope.memory.given(&name).cloned();
        self.scope.memory.variable(&name).or_else(given)
    }

    fn note_read(&self, name: &VariableName) {
        self.note_found(|| Location::named(name.at(Subscripts::default())));
        if let Some(reads) = self.scope.reads {
            reads.borrow_mut().note(Location::Variable(name.clone()));
        }
    }

    fn variable(&self, name: &VariableName, span: Span) -> Slot {
        let family = name.family();
        if matches!(family, VariableFamily::Axis | VariableFamily::External) {
            self.scope.waits.set(true);
        }
        if family == VariableFamily::External {
            self.scope.flushing.replace(Some(name.clone()));
        }
        self.note_read(name);
        if let Some(value) = self.scope.memory.variable(name) {
            return Ok(self.relied_on(name, value, span));
        }
        if let Some(value) = self.scope.memory.given(name) {
            return Ok(value.clone());
        }
        if let Some(value) = self.as_set(span) {
            return Ok(value);
        }
        if let Some(misuse) = self.scope.memory.misuse(name) {
            return Err(misused(misuse, span, self.text));
        }
        if family.is_of_programs() {
            return Err(never_written(span, self.text));
        }
        Ok((self.scope.system)(name).unwrap_or_else(|| {
            let written = compact(span.of(self.text));
            (self.scope.unknown)(&written, self.shown.unwrap_or(span));
            Value::Unknown(Unknown::text(written))
        }))
    }

    /// Returns a value of a variable that the PLC may write, too (R2.99).
    fn relied_on(&self, name: &VariableName, value: Value, span: Span) -> Value {
        let memory = self.scope.memory;
        let is_known = !matches!(value, Value::Unknown(_));
        if let Value::Unknown(Unknown::Changed(_)) = &value {
            let written = compact(span.of(self.text));
            (self.scope.unknown)(&written, self.shown.unwrap_or(span));
        }
        if !memory.may_change(name) {
            return value;
        }
        let is_held = memory.set_at(name).is_some();
        if is_known || is_held {
            self.scope.relied.borrow_mut().push(name.clone());
        }
        match self.scope.held {
            HeldValues::Doubted if is_known && is_held => {
                Value::Unknown(Unknown::text(name.to_string()))
            }
            HeldValues::Taken | HeldValues::Doubted => value,
        }
    }

    /// Returns the number of elements of an array: of its first dimension, or of the requested one.
    fn sizeof(&self, span: Span, dimension: Option<Slot>) -> Slot {
        let name = VariableName::first_argument(span.of(self.text));
        self.note_found(|| Location::named(name.clone()));
        let place = match dimension.transpose()? {
            Some(Value::Unknown(cause)) => return Ok(Value::Unknown(cause)),
            Some(value) => numeric(&value, span)?.and_then(rounded).unwrap_or(1),
            None => 1,
        };
        let place = usize::try_from(place.max(1) - 1).unwrap_or(usize::MAX);
        match self.scope.memory.array(name.array()) {
            Some(array) => match array.dimensions.get(place) {
                Some(Some(size)) => Ok(Value::Number(f64::from(*size))),
                Some(None) => Ok(array.default.clone()),
                None => Err(wrong_type(
                    span,
                    "the array does not have that many dimensions",
                )),
            },
            None if self.scope.memory.is_found(&Location::named(name.clone())) => {
                Ok(Value::Unknown(Unknown::text(name.array())))
            }
            None if name.family().is_of_programs() => Err(never_written(span, self.text)),
            None => {
                (self.scope.unknown)(name.array(), self.shown.unwrap_or(span));
                Ok(Value::Unknown(Unknown::text(name.array())))
            }
        }
    }

    /// Returns the place that an assignment writes.
    pub(crate) fn place(
        &self,
        place: Expression,
        stack: &mut Vec<Slot>,
    ) -> Result<Option<Denoted>, Box<Fault>> {
        let bottom = stack.len();
        let Some(root) = place.end.checked_sub(1) else {
            return Ok(None);
        };
        self.run(
            Expression {
                start: place.start,
                end: root,
            },
            stack,
        );
        let root = root as usize;
        let span = self.block.spans[root];
        let found = match self.block.nodes[root] {
            Node::Parameter { owner, index } => Ok(Location::Parameter(owner, index).into()),
            Node::Unread => {
                self.scope.unread.set(true);
                let text = Unknown::text(span.of(self.text).trim());
                Ok(Denoted::any_of(Location::Parameters, text))
            }
            Node::IndexedParameter { owner, subscripts } => {
                Denoted::pop_parameter(owner, usize::from(subscripts), span, stack)
            }
            Node::Variable { subscripts: 0 } => {
                Ok(Location::Variable(VariableName::read(span.of(self.text))).into())
            }
            Node::Variable { subscripts } => {
                self.computed_variable(root, usize::from(subscripts), stack)
            }
            _ => {
                stack.truncate(bottom);
                return Ok(None);
            }
        };
        stack.truncate(bottom);
        found.map(Some)
    }

    /// Returns the dimensions in a declaration's subscripts; for an unknown one, the cause.
    pub(crate) fn dimensions(
        &self,
        place: Expression,
        stack: &mut Vec<Slot>,
    ) -> Result<Vec<Result<u32, Value>>, Box<Fault>> {
        let bottom = stack.len();
        let root = place.end.saturating_sub(1);
        self.run(
            Expression {
                start: place.start,
                end: root,
            },
            stack,
        );
        let skip = match self.block.nodes.get(root as usize) {
            Some(Node::IndexedParameter { .. }) => 1,
            _ => 0,
        };
        let span = self.block.spans[root as usize];
        let size = |slot: Slot| match slot? {
            Value::Number(number) if number < 0.5 => {
                let what = format!("a dimension of `{}` is below 1", span.of(self.text).trim());
                Err(Fault::refused(Code::PErr20966, span, what))
            }
            Value::Number(number) => {
                let size = rounded(number).and_then(|size| u32::try_from(size).ok());
                size.map(Ok)
                    .ok_or_else(|| wrong_type(span, "an array cannot have that many elements"))
            }
            Value::Text(_) => Err(wrong_type(span, "a string is not an array dimension")),
            unknown @ Value::Unknown(_) => Ok(Err(unknown)),
        };
        stack.drain(bottom..).skip(skip).map(size).collect()
    }
}

fn pop(stack: &mut Vec<Slot>) -> Slot {
    // An operand is missing: that is not a zero (R2.50).
    stack
        .pop()
        .unwrap_or_else(|| Ok(Value::Unknown(Unknown::text("an expression"))))
}

fn never_written(span: Span, text: &str) -> Box<Fault> {
    let name = span.of(text);
    Box::new(
        Fault::new(
            Code::Fc311,
            span,
            format!("`{name}` is read but was never written"),
        )
        .with_help(Advice::AssignVariable(name.to_owned())),
    )
}

/// Returns the use of a name that its declaration does not allow (R2.102).
pub(crate) fn misused(misuse: Misuse, span: Span, text: &str) -> Box<Fault> {
    let name = span.of(text).trim();
    match misuse {
        Misuse::NoIndex => Fault::refused(
            Code::PErr21216,
            span,
            format!("`{name}` is an array, and has no index here"),
        ),
        Misuse::Outside => wrong_type(span, "this index is outside the array"),
        Misuse::OtherCount(1) => wrong_type(span, "the array has one dimension"),
        Misuse::OtherCount(count) => wrong_type(span, &format!("the array has {count} dimensions")),
        Misuse::NoArray => wrong_type(span, "the variable is declared without dimensions"),
    }
}

/// Returns a text without its quotes.
pub(crate) fn unquoted(text: &str) -> &str {
    let inner = text.strip_prefix('"').unwrap_or(text);
    inner.strip_suffix('"').unwrap_or(inner)
}
