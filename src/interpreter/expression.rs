//! Expressions to values.
//!
//! The nodes of an expression stand in postfix order, so a stack is all it takes: no recursion,
//! whatever a program writes.

use std::collections::BTreeMap;

use super::memory::Memory;
use super::value::{Value, is_true, rounded};
use crate::codes::Code;
use crate::source::Span;
use crate::syntax::Fault;
use crate::syntax::ast::{BinaryOperator, Block, Expression, Function, Node, Operand, Owner};

/// What an expression reads: the memory of the run and what the machine offers.
pub(super) struct Scope<'a> {
    pub(super) memory: &'a Memory,
    /// Own parameters of the call.
    pub(super) own: &'a BTreeMap<u32, Value>,
    /// System variables: `V.A.…`, `V.G.…`; `None` when only the machine knows it.
    pub(super) system: &'a dyn Fn(&str) -> Option<Value>,
}

/// One operand on the stack. A failure waits until something needs its value, so that `EXIST` and
/// the second operand of `&&` and `||` may fail without harm.
type Slot = Result<Value, Box<Fault>>;

/// Evaluates expressions of one block.
pub(super) struct Evaluator<'a> {
    pub(super) block: &'a Block,
    pub(super) text: &'a str,
    pub(super) scope: Scope<'a>,
}

impl Evaluator<'_> {
    /// The value of an operand.
    pub(super) fn value(&self, operand: Operand, stack: &mut Vec<Slot>) -> Slot {
        match operand {
            Operand::Number(number) => Ok(Value::Number(number)),
            Operand::Expression(expression) => {
                let bottom = stack.len();
                self.run(expression, stack);
                let value = stack.pop().unwrap_or_else(|| Ok(Value::Number(0.0)));
                stack.truncate(bottom);
                value
            }
        }
    }

    fn run(&self, expression: Expression, stack: &mut Vec<Slot>) {
        for at in expression.start..expression.end {
            let at = at as usize;
            let span = self.block.spans[at];
            let slot = match self.block.nodes[at] {
                Node::Number(number) if number.is_nan() => {
                    Err(fault(Code::Fc312, span, "this is no number"))
                }
                Node::Number(number) => Ok(Value::Number(number)),
                Node::Text => Ok(Value::Text(unquoted(span.of(self.text)).into())),
                Node::Parameter { owner, index } => self.parameter(owner, index, span),
                Node::IndexedParameter { owner, subscripts } => self
                    .parameter_key(owner, usize::from(subscripts), stack)
                    .and_then(|key| self.keyed_parameter(&key, span)),
                Node::Variable { subscripts: 0 } => {
                    self.variable(variable_name(span, self.text).as_ref(), span)
                }
                Node::Variable { subscripts } => self
                    .variable_key(at, usize::from(subscripts), stack)
                    .and_then(|name| self.variable(&name, span)),
                Node::Negate => pop(stack).and_then(|value| match value {
                    Value::Number(number) => Ok(Value::Number(-number)),
                    Value::Text(_) => Err(wrong_type(span, "a text has no sign")),
                    unknown @ Value::Unknown(_) => Ok(unknown),
                }),
                Node::Binary(operator) => {
                    let right = pop(stack);
                    let left = pop(stack);
                    binary(operator, left, right, span)
                }
                Node::Call {
                    function: Function::Sizeof,
                    arguments,
                } => {
                    stack.truncate(stack.len().saturating_sub(usize::from(arguments)));
                    self.sizeof(at, span)
                }
                Node::Call {
                    function,
                    arguments,
                } => {
                    let from = stack.len().saturating_sub(usize::from(arguments));
                    let slots: Vec<Slot> = stack.drain(from..).collect();
                    call(function, slots, span)
                }
            };
            stack.push(slot);
        }
    }

    fn parameter(&self, owner: Owner, index: u32, span: Span) -> Slot {
        let found = match owner {
            Owner::Program => self.scope.memory.parameter(index),
            Owner::Call => self.scope.own.get(&index),
        };
        found.cloned().ok_or_else(|| never_written(span, self.text))
    }

    fn keyed_parameter(&self, key: &ParameterKey, span: Span) -> Slot {
        match key {
            ParameterKey::Plain(owner, index) => self.parameter(*owner, *index, span),
            ParameterKey::Element(name) => self
                .scope
                .memory
                .variable(name)
                .ok_or_else(|| never_written(span, self.text)),
            ParameterKey::Unknown(cause) => Ok(cause.clone()),
        }
    }

    /// Pops the number and the subscripts of a parameter.
    fn parameter_key(
        &self,
        owner: Owner,
        subscripts: usize,
        stack: &mut Vec<Slot>,
    ) -> Result<ParameterKey, Box<Fault>> {
        let from = stack.len().saturating_sub(subscripts + 1);
        let mut numbers = Vec::with_capacity(subscripts + 1);
        for slot in stack.drain(from..) {
            match slot? {
                Value::Number(number) => numbers.push(rounded(number).unwrap_or(i64::MAX)),
                unknown => return Ok(ParameterKey::Unknown(unknown)),
            }
        }
        let index = numbers.first().copied().unwrap_or_default();
        let index = u32::try_from(index).unwrap_or(u32::MAX);
        if subscripts == 0 {
            return Ok(ParameterKey::Plain(owner, index));
        }
        let mut name = format!("P{index}");
        for number in &numbers[1..] {
            name.push_str(&format!("[{number}]"));
        }
        Ok(ParameterKey::Element(name))
    }

    /// The full name of a variable whose subscripts are on the stack.
    fn variable_key(
        &self,
        at: usize,
        subscripts: usize,
        stack: &mut Vec<Slot>,
    ) -> Result<String, Box<Fault>> {
        let from = stack.len().saturating_sub(subscripts);
        let mut values = Vec::with_capacity(subscripts);
        for slot in stack.drain(from..) {
            match slot? {
                Value::Number(number) => {
                    values.push(rounded(number).unwrap_or(i64::MAX).to_string())
                }
                Value::Text(text) => values.push(text.to_string()),
                Value::Unknown(_) => values.push("?".to_owned()),
            }
        }
        let text = self.block.spans[at].of(self.text);
        Ok(with_subscripts(text, &values))
    }

    fn variable(&self, name: &str, span: Span) -> Slot {
        if let Some(value) = self.scope.memory.variable(name) {
            return Ok(value);
        }
        if is_program_variable(name) && !name.contains('?') {
            return Err(never_written(span, self.text));
        }
        Ok((self.scope.system)(name).unwrap_or_else(|| Value::Unknown(name.into())))
    }

    fn sizeof(&self, at: usize, span: Span) -> Slot {
        let argument = at
            .checked_sub(1)
            .map(|argument| self.block.spans[argument].of(self.text));
        let name = argument
            .unwrap_or_default()
            .split('[')
            .next()
            .unwrap_or_default()
            .trim();
        match self.scope.memory.dimensions(name) {
            Some(dimensions) => {
                let first = dimensions.first().copied().unwrap_or(1);
                Ok(Value::Number(f64::from(first)))
            }
            None => Err(never_written(span, self.text)),
        }
    }

    /// The place that an assignment writes.
    pub(super) fn place(
        &self,
        place: Expression,
        stack: &mut Vec<Slot>,
    ) -> Result<Place, Box<Fault>> {
        let bottom = stack.len();
        let Some(root) = place.end.checked_sub(1) else {
            return Ok(Place::Nowhere);
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
            Node::Parameter { owner, index } => Ok(Place::Parameter(owner, index)),
            Node::IndexedParameter { owner, subscripts } => self
                .parameter_key(owner, usize::from(subscripts), stack)
                .map(|key| match key {
                    ParameterKey::Plain(owner, index) => Place::Parameter(owner, index),
                    ParameterKey::Element(name) => Place::Variable(name),
                    ParameterKey::Unknown(_) => Place::Nowhere,
                }),
            Node::Variable { subscripts: 0 } => {
                Ok(Place::Variable(variable_name(span, self.text).into_owned()))
            }
            Node::Variable { subscripts } => self
                .variable_key(root, usize::from(subscripts), stack)
                .map(|name| {
                    if name.contains('?') {
                        Place::Nowhere
                    } else {
                        Place::Variable(name)
                    }
                }),
            _ => Ok(Place::Nowhere),
        };
        stack.truncate(bottom);
        found
    }

    /// The dimensions in a declaration's subscripts.
    pub(super) fn dimensions(&self, place: Expression, stack: &mut Vec<Slot>) -> Vec<u32> {
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
        let dimensions = stack
            .drain(bottom..)
            .skip(skip)
            .map(|slot| {
                let number = slot.ok().and_then(|value| value.number()).and_then(rounded);
                number
                    .and_then(|number| u32::try_from(number).ok())
                    .unwrap_or_default()
            })
            .collect();
        dimensions
    }
}

/// Where an assignment goes.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Place {
    Parameter(Owner, u32),
    Variable(String),
    /// The subscripts are not known, or nothing can be written there.
    Nowhere,
}

enum ParameterKey {
    Plain(Owner, u32),
    Element(String),
    Unknown(Value),
}

fn pop(stack: &mut Vec<Slot>) -> Slot {
    stack.pop().unwrap_or_else(|| Ok(Value::Number(0.0)))
}

fn fault(code: Code, span: Span, message: impl Into<String>) -> Box<Fault> {
    Box::new(Fault::new(code, span, message))
}

fn wrong_type(span: Span, message: &str) -> Box<Fault> {
    fault(Code::Fc312, span, message)
}

fn never_written(span: Span, text: &str) -> Box<Fault> {
    let name = span.of(text);
    Box::new(
        Fault::new(
            Code::Fc311,
            span,
            format!("`{name}` is read, but was never written"),
        )
        .with_help(format!(
            "write `{name} = …` before, or `--set {name}=VALUE` for a value from elsewhere"
        )),
    )
}

fn unquoted(text: &str) -> &str {
    text.trim_matches('"')
}

/// `V.P.`, `V.L.`, `V.S.`: what only programs write.
fn is_program_variable(name: &str) -> bool {
    ["V.P.", "V.L.", "V.S."]
        .iter()
        .any(|prefix| name.starts_with(prefix))
        || name.starts_with('P')
}

/// The text of a variable without the blanks that may stand in it.
fn variable_name(span: Span, text: &str) -> std::borrow::Cow<'_, str> {
    let name = span.of(text);
    if name.contains([' ', '\t']) || name.starts_with('v') {
        let compact: String = name.split_whitespace().collect();
        std::borrow::Cow::Owned(format!("V{}", &compact[1..]))
    } else {
        std::borrow::Cow::Borrowed(name)
    }
}

/// A variable's text with its subscripts replaced by values, one bracket each.
fn with_subscripts(text: &str, values: &[String]) -> String {
    let mut name = String::with_capacity(text.len());
    let mut depth = 0_usize;
    let mut values = values.iter();
    let mut next = |name: &mut String| {
        name.push('[');
        name.push_str(values.next().map_or("", String::as_str));
        name.push(']');
    };
    for c in text.chars() {
        match c {
            '[' => {
                if depth == 0 {
                    next(&mut name);
                }
                depth += 1;
            }
            ']' => depth = depth.saturating_sub(1),
            ',' if depth == 1 => next(&mut name),
            _ if depth > 0 || c.is_whitespace() => {}
            _ => name.push(c),
        }
    }
    name
}

fn binary(operator: BinaryOperator, left: Slot, right: Slot, span: Span) -> Slot {
    match operator {
        BinaryOperator::And | BinaryOperator::Or => return logic(operator, left, right, span),
        _ => {}
    }
    match (left?, right?) {
        (Value::Number(left), Value::Number(right)) => arithmetic(operator, left, right, span),
        (unknown @ Value::Unknown(_), _) | (_, unknown @ Value::Unknown(_)) => Ok(unknown),
        (Value::Text(left), Value::Text(right)) => match operator {
            BinaryOperator::Add => Ok(Value::Text(format!("{left}{right}").into())),
            BinaryOperator::Equal => Ok((left == right).into()),
            BinaryOperator::NotEqual => Ok((left != right).into()),
            _ => Err(wrong_type(span, "this operator does not take texts")),
        },
        _ => Err(wrong_type(span, "a text and a number cannot be combined")),
    }
}

/// `&&` and `||`: one operand may decide alone, whatever the other is.
fn logic(operator: BinaryOperator, left: Slot, right: Slot, span: Span) -> Slot {
    let deciding = operator == BinaryOperator::Or;
    let truth = |slot: &Slot| slot.as_ref().ok().and_then(Value::truth);
    if truth(&left) == Some(deciding) {
        return Ok(deciding.into());
    }
    let left = left?;
    if truth(&right) == Some(deciding) {
        return Ok(deciding.into());
    }
    match (left, right?) {
        (Value::Text(_), _) | (_, Value::Text(_)) => {
            Err(wrong_type(span, "a text is neither true nor false"))
        }
        (unknown @ Value::Unknown(_), _) | (_, unknown @ Value::Unknown(_)) => Ok(unknown),
        (Value::Number(_), Value::Number(_)) => Ok((!deciding).into()),
    }
}

fn arithmetic(operator: BinaryOperator, left: f64, right: f64, span: Span) -> Slot {
    use BinaryOperator::{
        Add, And, BitAnd, BitOr, Divide, Equal, Greater, GreaterOrEqual, Less, LessOrEqual, Modulo,
        Multiply, NotEqual, Or, Power, Subtract, Xor,
    };
    #[allow(clippy::float_cmp)] // comparison is the language's own
    let value = match operator {
        Add => left + right,
        Subtract => left - right,
        Multiply => left * right,
        Divide | Modulo if right == 0.0 => {
            return Err(fault(Code::Fc312, span, "division by zero"));
        }
        Divide => left / right,
        Modulo => left % right,
        Power => left.powf(right),
        Equal => return Ok((left == right).into()),
        NotEqual => return Ok((left != right).into()),
        GreaterOrEqual => return Ok((left >= right).into()),
        LessOrEqual => return Ok((left <= right).into()),
        Less => return Ok((left < right).into()),
        Greater => return Ok((left > right).into()),
        BitAnd | BitOr => return bitwise(operator, left, right, span),
        Xor => return Ok((is_true(left) != is_true(right)).into()),
        And | Or => return Ok((is_true(left) && is_true(right)).into()),
    };
    finite(value, span)
}

fn finite(value: f64, span: Span) -> Slot {
    if value.is_finite() {
        Ok(Value::Number(value))
    } else {
        Err(fault(Code::Fc312, span, "the result is no number"))
    }
}

fn bitwise(operator: BinaryOperator, left: f64, right: f64, span: Span) -> Slot {
    let (Some(left), Some(right)) = (rounded(left), rounded(right)) else {
        return Err(wrong_type(span, "bits exist in whole numbers only"));
    };
    let bits = if operator == BinaryOperator::BitAnd {
        left & right
    } else {
        left | right
    };
    #[allow(clippy::cast_precision_loss)] // below 2^53
    Ok(Value::Number(bits as f64))
}

fn call(function: Function, slots: Vec<Slot>, span: Span) -> Slot {
    if function == Function::Exist {
        let exists = slots.first().is_some_and(Result::is_ok);
        return Ok(exists.into());
    }
    let mut values = Vec::with_capacity(slots.len());
    for slot in slots {
        values.push(slot?);
    }
    if let Some(unknown) = values
        .iter()
        .find(|value| matches!(value, Value::Unknown(_)))
    {
        return Ok(unknown.clone());
    }
    match function {
        Function::Left
        | Function::Mid
        | Function::Right
        | Function::Len
        | Function::Find
        | Function::Ord => text_function(function, &values, span),
        _ => {
            let numbers: Option<Vec<f64>> = values.iter().map(Value::number).collect();
            match numbers.as_deref() {
                Some([x]) => number_function(function, *x, span),
                Some([y, x]) if function == Function::Atan2 => {
                    finite(y.atan2(*x).to_degrees(), span)
                }
                Some(_) => Err(wrong_type(span, "wrong number of arguments")),
                None => Err(wrong_type(span, "this function takes numbers")),
            }
        }
    }
}

fn number_function(function: Function, x: f64, span: Span) -> Slot {
    let domain = |message: &str| Err(fault(Code::Fc312, span, message.to_owned()));
    let value = match function {
        Function::Abs => x.abs(),
        Function::Sqr => x * x,
        Function::Sqrt if x < 0.0 => return domain("square root of a negative number"),
        Function::Sqrt => x.sqrt(),
        Function::Exp => x.exp(),
        Function::Ln | Function::Log if x <= 0.0 => {
            return domain("logarithm of a number that is not positive");
        }
        Function::Ln => x.ln(),
        Function::Log => x.log10(),
        Function::Dexp => 10_f64.powf(x),
        Function::Sin => degrees(x, f64::sin),
        Function::Cos => degrees(x + 90.0, f64::sin),
        Function::Tan | Function::Cot => {
            let (sine, cosine) = (degrees(x, f64::sin), degrees(x + 90.0, f64::sin));
            let (above, below) = if function == Function::Tan {
                (sine, cosine)
            } else {
                (cosine, sine)
            };
            if below == 0.0 {
                return domain("the function has a pole here");
            }
            above / below
        }
        Function::Asin | Function::Acos if x.abs() > 1.0 => {
            return domain("argument outside -1 … 1");
        }
        Function::Asin => x.asin().to_degrees(),
        Function::Acos => x.acos().to_degrees(),
        Function::Atan => x.atan().to_degrees(),
        Function::Acot => 90.0 - x.atan().to_degrees(),
        Function::Int => x.trunc(),
        Function::Fract => x.fract(),
        Function::Ceil => x.ceil(),
        Function::Floor => x.floor(),
        Function::Round => x.round(),
        Function::Not => f64::from(u8::from(!is_true(x))),
        Function::Inv => {
            let Some(bits) = rounded(x).and_then(|bits| u32::try_from(bits).ok()) else {
                return domain("bits exist in whole numbers from 0 to 4294967295 only");
            };
            f64::from(!bits)
        }
        _ => return domain("wrong number of arguments"),
    };
    finite(value, span)
}

/// Multiples of a quarter turn come out exact.
fn degrees(x: f64, function: fn(f64) -> f64) -> f64 {
    let turn = x.rem_euclid(360.0);
    if turn == 0.0 || turn == 180.0 {
        0.0
    } else if turn == 90.0 {
        1.0
    } else if turn == 270.0 {
        -1.0
    } else {
        function(turn.to_radians())
    }
}

fn text_function(function: Function, values: &[Value], span: Span) -> Slot {
    let wrong = || wrong_type(span, "this function takes a text first, then whole numbers");
    let count = |value: Option<&Value>| -> Result<usize, Box<Fault>> {
        let number = value
            .and_then(Value::number)
            .and_then(rounded)
            .ok_or_else(wrong)?;
        usize::try_from(number.max(0)).map_err(|_| wrong())
    };
    let Some(Value::Text(text)) = values.first() else {
        return Err(wrong());
    };
    let text_of = |characters: String| Ok(Value::Text(characters.into()));
    #[allow(clippy::cast_precision_loss)] // lengths of lines
    let number_of = |number: usize| Ok(Value::Number(number as f64));
    let length = text.chars().count();
    match function {
        Function::Left => text_of(text.chars().take(count(values.get(1))?).collect()),
        Function::Right => {
            let skip = length.saturating_sub(count(values.get(1))?);
            text_of(text.chars().skip(skip).collect())
        }
        Function::Mid => {
            let (first, number) = (count(values.get(1))?, count(values.get(2))?);
            text_of(
                text.chars()
                    .skip(first.saturating_sub(1))
                    .take(number)
                    .collect(),
            )
        }
        Function::Len => number_of(length),
        Function::Find => {
            let Some(Value::Text(wanted)) = values.get(1) else {
                return Err(wrong());
            };
            let found = text.find(&**wanted);
            number_of(found.map_or(0, |at| text[..at].chars().count() + 1))
        }
        _ => text.chars().next().map_or_else(
            || Err(wrong_type(span, "an empty text has no first character")),
            |first| Ok(Value::Number(f64::from(u32::from(first)))),
        ),
    }
}
