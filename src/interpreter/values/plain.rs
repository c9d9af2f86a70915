//! Conclusions from plain conditions about the values that they read (R14.1).

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::interpreter::values::externals::ExternalNames;
use crate::interpreter::values::location::{Location, Unknown};
use crate::interpreter::values::value::{Value, rounded};
use crate::syntax::ast::{BinaryOperator, Block, Expression, Function, Node, Owner};
use crate::syntax::{Subscript, VariableFamily, VariableName};
use crate::text::Span;

/// Truth of a condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Truth {
    Holds,
    Fails,
}

impl Truth {
    /// Returns the position of a switch from its number: 1 is on, 0 is off.
    #[allow(clippy::float_cmp)] // Any other number says nothing.
    pub(crate) fn of_switch(number: f64) -> Option<Self> {
        match number {
            1.0 => Some(Self::Holds),
            0.0 => Some(Self::Fails),
            _ => None,
        }
    }

    pub(crate) fn turned(self) -> Self {
        match self {
            Self::Holds => Self::Fails,
            Self::Fails => Self::Holds,
        }
    }
}

/// Returns the values that follow from a condition that holds or does not: `V.E.A == 2`, `NOT`, `&&`.
pub(crate) fn conclusions(
    block: &Block,
    text: &str,
    condition: Expression,
    truth: Truth,
) -> Vec<(Location, Value)> {
    let mut found = Vec::new();
    let mut left = vec![(condition, truth)];
    while let Some((part, truth)) = left.pop() {
        let Some((node, operands)) = root(block, part) else {
            continue;
        };
        match (node, operands.as_slice()) {
            (
                Node::Call {
                    function: Function::Not,
                    ..
                },
                [inner],
            ) => left.push((*inner, truth.turned())),
            (Node::Binary(BinaryOperator::And), [one, other]) if truth == Truth::Holds => {
                left.extend([(*one, truth), (*other, truth)]);
            }
            (Node::Binary(BinaryOperator::Or), [one, other]) if truth == Truth::Fails => {
                left.extend([(*one, truth), (*other, truth)]);
            }
            (Node::Binary(BinaryOperator::Equal), [one, other]) if truth == Truth::Holds => {
                found.extend(equal(block, text, [*one, *other]));
            }
            (Node::Binary(BinaryOperator::NotEqual), [one, other]) if truth == Truth::Fails => {
                found.extend(equal(block, text, [*one, *other]));
            }
            _ if truth == Truth::Fails => {
                // Only |value| < 0.5 is known; a switch is then 0.
                let switch = variable(block, text, part).filter(is_switch);
                found.extend(switch.map(|target| (target, Value::Number(0.0))));
            }
            _ => {
                let switch = variable(block, text, part).filter(is_switch);
                found.extend(switch.map(|target| (target, Value::Number(1.0))));
            }
        }
    }
    found
}

/// Returns whether an expression only compares one variable with one number, so that either answer tells whether they
/// are equal.
pub(crate) fn is_one_comparison(block: &Block, text: &str, expression: Expression) -> bool {
    let Some((node, operands)) = root(block, expression) else {
        return false;
    };
    match (node, operands.as_slice()) {
        (
            Node::Call {
                function: Function::Not,
                ..
            },
            [inner],
        ) => is_one_comparison(block, text, *inner),
        (Node::Binary(BinaryOperator::Equal | BinaryOperator::NotEqual), [one, other]) => {
            equal(block, text, [*one, *other]).is_some()
        }
        _ => false,
    }
}

/// Returns whether a variable can only be 0 or 1.
fn is_switch(target: &Location) -> bool {
    let of_axis = match target {
        Location::Variable(name) => name.of_axis(),
        _ => None,
    };
    of_axis.is_some_and(|(variable, _)| variable.ends_with("_COMP_ACTIVE"))
}

/// Returns a variable and the number that it equals.
fn equal(block: &Block, text: &str, pair: [Expression; 2]) -> Option<(Location, Value)> {
    let [one, other] = pair;
    let known = |part| {
        let (node, _) = root(block, part)?;
        match node {
            Node::Number(number) => Some(Value::Number(number)),
            Node::Negate => match root(block, operands_of(block, part)?.first().copied()?)?.0 {
                Node::Number(number) => Some(Value::Number(-number)),
                _ => None,
            },
            _ => None,
        }
    };
    let target = variable(block, text, one).zip(known(other));
    target.or_else(|| variable(block, text, other).zip(known(one)))
}

/// Returns the parameter or variable of an expression that consists only of it.
pub(crate) fn variable(block: &Block, text: &str, part: Expression) -> Option<Location> {
    let (start, end) = (part.start as usize, part.end as usize);
    let [node] = block.nodes.get(start..end)? else {
        return None;
    };
    target(*node, block.spans.get(start)?.of(text))
}

fn target(node: Node, written: &str) -> Option<Location> {
    match node {
        Node::Parameter { owner, index } => Some(Location::Parameter(owner, index)),
        Node::Variable { subscripts: 0 } => {
            let name = VariableName::read(written);
            let is_variable = name.family() != VariableFamily::Other;
            is_variable.then_some(Location::Variable(name))
        }
        _ => None,
    }
}

/// Returns the last node of an expression and its operands.
fn root(block: &Block, part: Expression) -> Option<(Node, Vec<Expression>)> {
    let node = *block.nodes.get(part.end.checked_sub(1)? as usize)?;
    Some((node, operands_of(block, part)?))
}

fn operands_of(block: &Block, part: Expression) -> Option<Vec<Expression>> {
    let last = part.end.checked_sub(1)?;
    let count = popped(*block.nodes.get(last as usize)?);
    let mut operands = Vec::with_capacity(count);
    let mut end = last;
    for _ in 0..count {
        let start = start_of(block, part.start, end)?;
        operands.push(Expression { start, end });
        end = start;
    }
    operands.reverse();
    Some(operands)
}

/// Returns the beginning of the expression that ends before a node.
fn start_of(block: &Block, first: u32, end: u32) -> Option<u32> {
    let mut wanted = 1;
    let mut at = end;
    while wanted > 0 {
        at = at.checked_sub(1).filter(|at| *at >= first)?;
        wanted += popped(*block.nodes.get(at as usize)?);
        wanted -= 1;
    }
    Some(at)
}

/// Returns the number of values that a node takes from the stack.
fn popped(node: Node) -> usize {
    match node {
        Node::Number(_) | Node::Text | Node::Parameter { .. } | Node::Unread => 0,
        Node::IndexedParameter { subscripts, .. } => usize::from(subscripts) + 1,
        Node::Variable { subscripts } => usize::from(subscripts),
        Node::Negate => 1,
        Node::Binary(_) => 2,
        Node::Call { arguments, .. } => usize::from(arguments),
    }
}

/// Writer of a value other than the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) enum Writer {
    /// No other writer: parameters, `V.P.`, `V.L.`, `V.S.`, and `stable` variables.
    Nothing,
    /// The machine at any time: `V.E.`, skip levels.
    Machine,
    /// The control itself, for example by motion: `V.A.`, `V.G.`.
    Control,
}

impl Writer {
    fn of(name: &VariableName, externals: &ExternalNames) -> Self {
        use VariableFamily::{External, Local, Program, Shared};
        match name.family() {
            Program | Local | Shared => Self::Nothing,
            _ if externals.is_stable(name) => Self::Nothing,
            External => Self::Machine,
            _ => Self::Control,
        }
    }
}

/// Meaning of a condition, independent of its text.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ConditionMeaning {
    pub(crate) subject: ConditionSubject,
    /// The locations that its expression reads.
    pub(crate) reads: Vec<Location>,
    /// The steps of the expression.
    nodes: Vec<Node>,
}

/// Subject of a condition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum ConditionSubject {
    /// Truth of an expression.
    Truth,
    /// Choice of a case by the value of an expression.
    Cases(Vec<Arc<str>>),
    /// End of the program by an error whose remedy class is the expression.
    RemedyClass,
    /// Subject that only the machine knows.
    Unknown(Unknown),
    /// Acceptance by the control of blocks of a kind, in the words of FC328.
    Refusal(Arc<str>),
}

/// A condition and the writer of the values that it is about.
pub(crate) struct Asking {
    pub(crate) writer: Writer,
    pub(crate) meaning: Arc<ConditionMeaning>,
}

impl Asking {
    /// Returns a condition on something that only the machine knows.
    pub(crate) fn of_unknown(writer: Writer, unknown: Unknown) -> Self {
        let meaning = Arc::new(ConditionMeaning {
            subject: ConditionSubject::Unknown(unknown),
            reads: Vec::new(),
            nodes: Vec::new(),
        });
        Self { writer, meaning }
    }

    /// Returns the same expression for another subject.
    pub(crate) fn about(mut self, subject: ConditionSubject) -> Self {
        Arc::make_mut(&mut self.meaning).subject = subject;
        self
    }
}

/// Returns the values that an expression reads, where these are parameters and whole variables.
pub(crate) fn reads(
    block: &Block,
    text: &str,
    expression: Expression,
    externals: &ExternalNames,
) -> Option<Asking> {
    let mut found = Vec::new();
    let mut nodes = Vec::new();
    let mut writer = Writer::Nothing;
    for at in expression.start..expression.end {
        let at = at as usize;
        let node = *block.nodes.get(at)?;
        nodes.push(node);
        let read = match node {
            Node::Number(number) if !number.is_finite() => return None,
            Node::Number(_) | Node::Negate | Node::Binary(_) => continue,
            Node::Call { function, .. } if is_pure(function) => continue,
            node => target(node, block.spans.get(at)?.of(text))?,
        };
        writer = writer.max(match &read {
            Location::Parameter(Owner::Program | Owner::Call, _) => Writer::Nothing,
            Location::Variable(name) => Writer::of(name, externals),
            Location::Elements(_) | Location::Parameters => return None,
        });
        found.push(read);
    }
    let meaning = Arc::new(ConditionMeaning {
        subject: ConditionSubject::Truth,
        reads: found,
        nodes,
    });
    Some(Asking { writer, meaning })
}

/// Returns the values of the machine or the control that an expression reads by their names.
pub(crate) fn read_of_machine(
    block: &Block,
    text: &str,
    expression: Expression,
    externals: &ExternalNames,
) -> Vec<VariableName> {
    let range = expression.start as usize..expression.end as usize;
    let nodes = block.nodes.get(range.clone()).unwrap_or_default();
    let spans = block.spans.get(range).unwrap_or_default();
    let read = nodes.iter().zip(spans).filter_map(|(node, span)| {
        let Location::Variable(name) = target(*node, span.of(text))? else {
            return None;
        };
        (Writer::of(&name, externals) != Writer::Nothing).then_some(name)
    });
    read.collect()
}

/// Returns whether an expression reads, or may read, a value that the machine writes while the program waits.
pub(crate) fn is_written_by_machine(
    block: &Block,
    text: &str,
    expression: Expression,
    externals: &ExternalNames,
) -> bool {
    let range = expression.start as usize..expression.end as usize;
    let nodes = block.nodes.get(range.clone()).unwrap_or_default();
    let spans = block.spans.get(range).unwrap_or_default();
    nodes.iter().zip(spans).any(|(node, span)| match node {
        Node::Variable { .. } => {
            let name = VariableName::read(span.of(text));
            name.family() != VariableFamily::Cycle
                && Writer::of(&name, externals) != Writer::Nothing
        }
        Node::Text | Node::Unread => true,
        _ => false,
    })
}

/// Returns a subscript that is a plain number.
pub(crate) fn subscript(node: &Node) -> Subscript {
    let number = match node {
        Node::Number(number) => rounded(*number),
        _ => None,
    };
    Subscript::Number(number.unwrap_or(i64::MAX))
}

/// Returns whether a function of numbers always gives equal results for equal numbers.
fn is_pure(function: Function) -> bool {
    !matches!(
        function,
        Function::Exist | Function::Sizeof | Function::IsString | Function::IsNumber
    )
}

/// Returns the text of an expression, with the brackets that belong to it, and its span.
pub(crate) fn text_of(block: &Block, text: &str, expression: Expression) -> (String, Span) {
    let range = expression.start as usize..expression.end as usize;
    let spans = block.spans.get(range).unwrap_or_default();
    let start = spans.iter().map(|span| span.start as usize).min();
    let end = spans.iter().map(|span| span.end as usize).max();
    let (Some(mut start), Some(mut end)) = (start, end) else {
        return (String::new(), Span::default());
    };
    let depth = |part: &str| {
        let mut depth = 0_i32;
        let mut lowest = 0_i32;
        for it in part.chars() {
            depth += i32::from(it == '[') - i32::from(it == ']');
            lowest = lowest.min(depth);
        }
        (depth, lowest)
    };
    loop {
        let part = text.get(start..end).unwrap_or_default();
        let (left_open, lowest) = depth(part);
        if lowest < 0 {
            match text.get(..start).and_then(|before| before.rfind('[')) {
                Some(before) => start = before,
                None => break,
            }
        } else if left_open > 0 {
            match text.get(end..).and_then(|after| after.find(']')) {
                Some(after) => end += after + 1,
                None => break,
            }
        } else {
            break;
        }
    }
    let shown = text.get(start..end).unwrap_or_default();
    let words: Vec<&str> = shown.split_whitespace().collect();
    (words.join(" "), Span::new(start, end))
}
