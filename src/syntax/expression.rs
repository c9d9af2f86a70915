//! Expressions: a flat list in the grammar, precedence here, operands before operators in the
//! block's nodes.

use pest::iterators::Pair;

use super::ast::{BinaryOperator, Block, Expression, Function, Node, Operand, Owner};
use super::grammar::Rule;
use crate::text::Span;

/// Precedence of operators, loosest first.
const PRECEDENCE: &[&[BinaryOperator]] = {
    use BinaryOperator::{
        Add, And, BitAnd, BitOr, BitXor, Divide, Equal, Greater, GreaterOrEqual, Less, LessOrEqual,
        Modulo, Multiply, NotEqual, Or, Power, Subtract, Xor,
    };
    &[
        &[Or],
        &[Xor],
        &[And],
        &[BitOr],
        &[BitXor],
        &[BitAnd],
        &[Equal, NotEqual],
        &[Less, Greater, LessOrEqual, GreaterOrEqual],
        &[Add, Subtract],
        &[Multiply, Divide, Modulo],
        &[Power],
    ]
};

/// An operator whose operands are not complete yet.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Waiting {
    /// A sign before an operand; it binds less tightly than `**`, more than `*`.
    Negate,
    Binary(BinaryOperator),
}

impl Waiting {
    fn binding(self) -> usize {
        match self {
            Self::Negate => 2 * (PRECEDENCE.len() - 1) - 1,
            Self::Binary(operator) => {
                let level = PRECEDENCE
                    .iter()
                    .position(|level| level.contains(&operator));
                2 * level.unwrap_or_default()
            }
        }
    }
}

/// Lowers `expression`, whose spans count from `base` in the block.
pub(super) fn lower(pair: Pair<'_, Rule>, base: u32, block: &mut Block) -> Operand {
    let from = block.nodes.len();
    ExpressionLowering { base, block }.expression(pair);
    operand(from, block)
}

/// Lowers a text that is an expression and nothing else, as the code of a macro may be.
pub(super) fn lower_text(text: &str, block: &mut Block) -> Option<Operand> {
    use pest::Parser;
    let mut pairs = super::grammar::NcParser::parse(Rule::lone_expression, text).ok()?;
    let pair = pairs.next()?.into_inner().next()?;
    Some(lower(pair, 0, block))
}

/// Returns an operand whose text could not be read; the caller says what is wrong with it.
pub(super) fn unread(span: Span, block: &mut Block) -> Expression {
    let from = block.nodes.len();
    ExpressionLowering { base: 0, block }.push(Node::Unread, span);
    range(from, block)
}

/// Lowers `target += value` and the like to the value that is assigned: `operator` joins target
/// and value.
pub(super) fn compound(
    target: Pair<'_, Rule>,
    operator: BinaryOperator,
    value: Pair<'_, Rule>,
    block: &mut Block,
) -> Operand {
    let from = block.nodes.len();
    let place = target.as_span();
    let span = Span::new(place.start(), value.as_span().end());
    let mut lowering = ExpressionLowering { base: 0, block };
    target
        .into_inner()
        .for_each(|place| lowering.primary(place));
    lowering.expression(value);
    lowering.push(Node::Binary(operator), span);
    operand(from, block)
}

/// Lowers a single value.
pub(super) fn lower_primary(pair: Pair<'_, Rule>, base: u32, block: &mut Block) -> Operand {
    let from = block.nodes.len();
    ExpressionLowering { base, block }.primary(pair);
    operand(from, block)
}

/// Lowers a number with an optional sign.
pub(super) fn lower_number(text: &str, span: Span, block: &mut Block) -> Operand {
    let value = number(text);
    if value.is_finite() {
        return Operand::Number(value);
    }
    let from = block.nodes.len();
    let signs = text.len() - text.trim_start_matches(['+', '-']).len();
    let digits = Span::new(span.start as usize + signs, span.end as usize);
    ExpressionLowering { base: 0, block }.push(Node::Number(value), digits);
    operand(from, block)
}

/// Lowers a parameter or variable, or a rule that wraps one, as a place to write.
pub(super) fn place(pair: Pair<'_, Rule>, base: u32, block: &mut Block) -> Expression {
    let from = block.nodes.len();
    let mut inner = pair;
    while !matches!(inner.as_rule(), Rule::parameter | Rule::variable) {
        match inner.clone().into_inner().next() {
            Some(next) => inner = next,
            None => break,
        }
    }
    ExpressionLowering { base, block }.primary(inner);
    range(from, block)
}

fn range(from: usize, block: &Block) -> Expression {
    let span = Span::new(from, block.nodes.len());
    Expression {
        start: span.start,
        end: span.end,
    }
}

/// Returns a plain number, which stays out of the nodes.
fn operand(from: usize, block: &mut Block) -> Operand {
    match block.nodes[from..] {
        // A text that is not a number, or too large for one, is reported when it is evaluated.
        [Node::Number(value)] if value.is_finite() => {
            block.nodes.truncate(from);
            block.spans.truncate(from);
            Operand::Number(value)
        }
        _ => Operand::Expression(range(from, block)),
    }
}

/// Operands and operators that wait while an expression is lowered.
#[derive(Default)]
struct Stacks {
    /// Operators, each with the place of its sign.
    waiting: Vec<(Waiting, u32)>,
    /// The source of each operand.
    operands: Vec<Span>,
}

struct ExpressionLowering<'a> {
    base: u32,
    block: &'a mut Block,
}

impl ExpressionLowering<'_> {
    fn span(&self, pair: &Pair<'_, Rule>) -> Span {
        let span = pair.as_span();
        let text = span.as_str();
        // Most end with a digit, a letter or a bracket.
        let length = match text.as_bytes().last() {
            Some(last) if last.is_ascii_graphic() => text.len(),
            _ => text.trim_end().len(),
        };
        Span::new(span.start(), span.start() + length).shifted(self.base)
    }

    fn push(&mut self, node: Node, span: Span) {
        self.block.nodes.push(node);
        self.block.spans.push(span);
    }

    /// Adds an expression by precedence over the flat list: operators wait until one that binds less tightly follows,
    /// so nothing recurses but brackets.
    fn expression(&mut self, pair: Pair<'_, Rule>) {
        let mut stacks = Stacks::default();
        let mut signs = None;
        for part in pair.into_inner() {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::sign => {
                    let (start, negative) = signs.unwrap_or((span.start, false));
                    signs = Some((start, negative ^ (part.as_str() == "-")));
                }
                Rule::infix => {
                    let Some(operator) = operator(part.as_str()) else {
                        continue;
                    };
                    let operator = Waiting::Binary(operator);
                    self.reduce(&mut stacks, Some(operator));
                    stacks.waiting.push((operator, span.start));
                }
                _ => {
                    if let Some((start, true)) = signs.take() {
                        stacks.waiting.push((Waiting::Negate, start));
                    }
                    self.primary(part);
                    stacks.operands.push(span);
                }
            }
        }
        self.reduce(&mut stacks, None);
    }

    /// Writes the waiting operators that bind at least as tightly as the next one.
    fn reduce(&mut self, stacks: &mut Stacks, next: Option<Waiting>) {
        while let Some(&(last, start)) = stacks.waiting.last() {
            let goes_first = next.is_none_or(|next| {
                let rightwards = next == Waiting::Binary(BinaryOperator::Power);
                last.binding() > next.binding() || (last.binding() == next.binding() && !rightwards)
            });
            if !goes_first {
                return;
            }
            stacks.waiting.pop();
            let right = stacks.operands.pop().unwrap_or_default();
            let span = match last {
                Waiting::Binary(_) => stacks.operands.pop().unwrap_or(right).to(right),
                Waiting::Negate => Span {
                    start,
                    end: right.end,
                },
            };
            stacks.operands.push(span);
            match last {
                Waiting::Binary(operator) => self.push(Node::Binary(operator), span),
                Waiting::Negate => self.negate(span),
            }
        }
    }

    fn negate(&mut self, span: Span) {
        match self.block.nodes.last_mut() {
            Some(Node::Number(value)) => *value = -*value,
            _ => self.push(Node::Negate, span),
        }
    }

    fn primary(&mut self, pair: Pair<'_, Rule>) {
        let span = self.span(&pair);
        match pair.as_rule() {
            Rule::literal => self.push(Node::Number(number(pair.as_str())), span),
            Rule::quoted => self.push(Node::Number(quoted(pair.as_str())), span),
            Rule::constant => self.push(Node::Number(constant(pair.as_str())), span),
            Rule::text => self.push(Node::Text, span),
            Rule::group => {
                for inner in pair.into_inner() {
                    self.expression(inner);
                }
            }
            Rule::call => self.call(pair, span),
            Rule::parameter => self.parameter(pair, span),
            Rule::variable => self.variable(pair, span),
            Rule::own_word => self.push(Node::Variable { subscripts: 0 }, span),
            Rule::unread_call => self.unread(pair.as_str(), span),
            _ => {}
        }
    }

    /// Records text that has the form of a value, but no known meaning.
    fn unread(&mut self, text: &str, span: Span) {
        self.block
            .faults
            .push(super::keywords::not_known(text, span));
        self.push(Node::Unread, span);
    }

    fn call(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut inner = pair.into_inner();
        let Some(function) = inner.next().and_then(|name| function(name.as_str())) else {
            return;
        };
        let mut arguments = 0_u8;
        for argument in inner {
            self.expression(argument);
            arguments = arguments.saturating_add(1);
        }
        self.push(
            Node::Call {
                function,
                arguments,
            },
            span,
        );
    }

    fn parameter(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut owner = Owner::Program;
        let mut direct = None;
        let mut subscripts = 0_u8;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::own => owner = Owner::Call,
                Rule::index => direct = Some(part.as_str().parse().unwrap_or(u32::MAX)),
                Rule::parameter_index => self.inner_parameter(part),
                Rule::computed_index => part.into_inner().for_each(|index| self.expression(index)),
                _ => {
                    if let Some(index) = direct.take() {
                        self.push(Node::Number(f64::from(index)), span);
                    }
                    subscripts = subscripts.saturating_add(self.subscripts(part));
                }
            }
        }
        let node = match direct {
            Some(index) => Node::Parameter { owner, index },
            None => Node::IndexedParameter { owner, subscripts },
        };
        self.push(node, span);
    }

    /// Reads the parameter that gives the number of another one: `PP10` reads P10.
    fn inner_parameter(&mut self, pair: Pair<'_, Rule>) {
        let span = self.span(&pair);
        let owner = Owner::Program;
        let mut direct = None;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::index => direct = Some(part.as_str().parse().unwrap_or(u32::MAX)),
                _ => self.inner_parameter(part),
            }
        }
        let node = match direct {
            Some(index) => Node::Parameter { owner, index },
            None => Node::IndexedParameter {
                owner,
                subscripts: 0,
            },
        };
        self.push(node, span);
    }

    fn subscripts(&mut self, pair: Pair<'_, Rule>) -> u8 {
        let mut count = 0_u8;
        for value in pair.into_inner() {
            self.expression(value);
            count = count.saturating_add(1);
        }
        count
    }

    fn variable(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let parts = pair.clone().into_inner();
        let names = parts.filter(|part| part.as_rule() == Rule::variable_part);
        if !super::keywords::is_variable(names.map(|part| part.as_str())) {
            self.unread(pair.as_str(), span);
            return;
        }
        let mut subscripts = 0_u8;
        for part in pair.into_inner() {
            if part.as_rule() == Rule::variable_subscript {
                subscripts = subscripts.saturating_add(self.subscripts(part));
            }
        }
        self.push(Node::Variable { subscripts }, span);
    }
}

fn number(text: &str) -> f64 {
    text.parse().unwrap_or(f64::NAN)
}

/// Returns `'16#FA1B'`, `'0x0ED2'`, `'H1869f'`, `'2#1011'`, `'B1011'`; anything else is not a number.
fn quoted(text: &str) -> f64 {
    let inner = text.trim_matches('\'');
    let (radix, digits) = if let Some((radix, digits)) = inner.split_once('#') {
        (radix.parse().unwrap_or(16), digits)
    } else if let Some(digits) = inner.strip_prefix("0x").or(inner.strip_prefix("0X")) {
        (16, digits)
    } else if let Some(digits) = inner.strip_prefix(['H', 'h']) {
        (16, digits)
    } else if let Some(digits) = inner.strip_prefix(['B', 'b']) {
        (2, digits)
    } else {
        (10, inner)
    };
    if !(2..=36).contains(&radix) {
        return f64::NAN;
    }
    let value = u32::from_str_radix(digits, radix);
    value.map_or(f64::NAN, f64::from)
}

fn constant(text: &str) -> f64 {
    match text.to_ascii_uppercase().as_str() {
        "PI" => std::f64::consts::PI,
        "TRUE" => 1.0,
        _ => 0.0,
    }
}

pub(super) fn operator(text: &str) -> Option<BinaryOperator> {
    use BinaryOperator::{
        Add, And, BitAnd, BitOr, BitXor, Divide, Equal, Greater, GreaterOrEqual, Less, LessOrEqual,
        Modulo, Multiply, NotEqual, Or, Power, Subtract, Xor,
    };
    Some(match text.trim().to_ascii_uppercase().as_str() {
        "+" => Add,
        "-" => Subtract,
        "*" => Multiply,
        "/" => Divide,
        "**" => Power,
        "MOD" => Modulo,
        "==" => Equal,
        "!=" => NotEqual,
        ">=" => GreaterOrEqual,
        "<=" => LessOrEqual,
        "<" => Less,
        ">" => Greater,
        "&" => BitAnd,
        "|" => BitOr,
        "^" => BitXor,
        "&&" | "AND" => And,
        "||" | "OR" => Or,
        "XOR" => Xor,
        _ => return None,
    })
}

fn function(name: &str) -> Option<Function> {
    use Function::{
        Abs, Acos, Acot, Asin, Atan, Atan2, Ceil, Cos, Cot, Delete, Dexp, Exist, Exp, Find, Floor,
        Fract, Insert, Int, IntToStr, Inv, IsNumber, IsString, Left, Len, Ln, Log, Max, Mid, Min,
        Not, Ord, RealToStr, Replace, Right, Round, Sign, Sin, Sizeof, Sqr, Sqrt, StrToInt,
        StrToReal, Tan,
    };
    Some(match name.to_ascii_uppercase().as_str() {
        "ABS" => Abs,
        "SQR" => Sqr,
        "SQRT" => Sqrt,
        "EXP" => Exp,
        "LN" => Ln,
        "DEXP" => Dexp,
        "LOG" => Log,
        "SIN" => Sin,
        "COS" => Cos,
        "TAN" => Tan,
        "COT" => Cot,
        "ASIN" => Asin,
        "ACOS" => Acos,
        "ATAN" => Atan,
        "ATAN2" => Atan2,
        "ACOT" => Acot,
        "INT" => Int,
        "FRACT" => Fract,
        "CEIL" => Ceil,
        "FLOOR" => Floor,
        "ROUND" => Round,
        "INV" => Inv,
        "NOT" => Not,
        "EXIST" => Exist,
        "SIZEOF" => Sizeof,
        "IS_STRING" => IsString,
        "IS_NUMBER" => IsNumber,
        "LEFT" => Left,
        "MID" => Mid,
        "RIGHT" => Right,
        "LEN" => Len,
        "FIND" => Find,
        "ORD" => Ord,
        "MIN" => Min,
        "MAX" => Max,
        "SIGN" => Sign,
        "INSERT" => Insert,
        "DELETE" => Delete,
        "REPLACE" => Replace,
        "INT_TO_STR" => IntToStr,
        "REAL_TO_STR" => RealToStr,
        "STR_TO_INT" => StrToInt,
        "STR_TO_REAL" => StrToReal,
        _ => return None,
    })
}
