//! Values of the language: numbers, texts, what only the machine knows, and the types of declared variables (R2.101);
//! operators and functions on them (R2.30, R2.31, R2.35).

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::diagnostic::Code;
use crate::interpreter::values::location::Unknown;
use crate::readings::Alternative;
use crate::syntax::Fault;
use crate::syntax::ast::{BinaryOperator, Function};
use crate::text::Span;

/// A value of an expression, parameter or variable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A text.
    Text(Arc<str>),
    /// Value that only the machine knows (R2.50).
    Unknown(Unknown),
}

/// Operand on the stack. A failure waits until something needs its value, so that `EXIST` and the second operand of
/// `&&` and `||` may fail without harm.
pub(crate) type Slot = Result<Value, Box<Fault>>;

impl Value {
    /// Returns the number, where it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// Returns the value as a program writes it.
    pub(crate) fn as_written(&self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Text(text) => format!("\"{text}\""),
            Self::Unknown(unknown) => unknown.to_string(),
        }
    }

    /// Returns whether the value counts as true: |value| ≥ 0.5 (R2.31). `None` where it is not a number.
    pub fn truth(&self) -> Option<bool> {
        self.number().map(is_true)
    }
}

/// Returns whether a number counts as true (R2.31).
pub(crate) fn is_true(number: f64) -> bool {
    number.abs() >= 0.5
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<bool> for Value {
    fn from(truth: bool) -> Self {
        Self::Number(f64::from(u8::from(truth)))
    }
}

impl From<&crate::machine::Setting> for Value {
    fn from(setting: &crate::machine::Setting) -> Self {
        match setting {
            crate::machine::Setting::Number(number) => Self::Number(*number),
            crate::machine::Setting::Text(text) => Self::Text(text.as_str().into()),
        }
    }
}

/// Returns whether both values count as equal: they differ by less than 0.001 (R2.40; PM/206908427).
pub(crate) fn same_case(wanted: &Value, value: &Value) -> bool {
    match (wanted, value) {
        (Value::Number(wanted), Value::Number(value)) => (wanted - value).abs() < 0.001,
        (wanted, value) => wanted == value,
    }
}

/// Returns a number that is a whole number, 0 or more.
#[inline]
pub(crate) fn exact(number: f64) -> Option<u32> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // compared below
    let whole = number as u32;
    #[allow(clippy::float_cmp)] // whole numbers are exact
    let is_whole = f64::from(whole) == number;
    is_whole.then_some(whole)
}

/// Returns a number as a whole number, rounded half away from zero; `None` if out of range.
pub(crate) fn rounded(number: f64) -> Option<i64> {
    // 2^53: beyond it, numbers of the language are not exact whole numbers any more.
    const LIMIT: f64 = 9_007_199_254_740_992.0;
    if number.is_nan() || number.abs() > LIMIT {
        return None;
    }
    // Most numbers are whole; they need no call of the mathematics library.
    #[allow(clippy::cast_possible_truncation)] // below 2^53
    let whole = number as i64;
    #[allow(clippy::cast_precision_loss, clippy::float_cmp)] // both are exact
    let is_whole = whole as f64 == number;
    #[allow(clippy::cast_possible_truncation)] // below 2^53
    Some(if is_whole {
        whole
    } else {
        number.round() as i64
    })
}

/// Type of a declared variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum ValueType {
    /// REAL64, or a type that frictcomp does not know.
    Any,
    /// BOOLEAN.
    Boolean,
    /// UNS08, UNS16, UNS32, with the number of bits.
    Unsigned(u8),
    /// SGN08, SGN16, SGN32, with the number of bits.
    Signed(u8),
    /// STRING, with the most characters where they are known.
    Text(Option<u32>),
}

/// A value as a variable of a type takes it.
pub(crate) enum TypedValue {
    /// Value that the variable has.
    Taken(Value),
    /// Value between two whole numbers, of which the variable has one.
    Fraction(f64),
    /// Value out of the range of the type, with its least and its greatest value.
    OutOfRange(f64, f64),
    /// A text for a number, a number for a text, or a text that is too long.
    OtherKind(String),
}

impl ValueType {
    /// Returns the type of a word in upper case, with the length in its bracket.
    pub(crate) fn named(word: Option<&str>, length: Option<u32>) -> Self {
        match word {
            Some("BOOLEAN") => Self::Boolean,
            Some("UNS08") => Self::Unsigned(8),
            Some("UNS16") => Self::Unsigned(16),
            Some("UNS32") => Self::Unsigned(32),
            Some("SGN08") => Self::Signed(8),
            Some("SGN16") => Self::Signed(16),
            Some("SGN32") => Self::Signed(32),
            Some("STRING") => Self::Text(length),
            Some(_) | None => Self::Any,
        }
    }

    /// Returns the value of a variable that nothing was written to.
    pub(crate) fn default(self) -> Value {
        match self {
            Self::Text(_) => Value::Text("".into()),
            _ => Value::Number(0.0),
        }
    }

    /// Returns whether a whole number is one of its own.
    pub(crate) fn has(self, number: f64) -> bool {
        let limits = self.limits();
        limits.is_none_or(|(least, most)| (least..=most).contains(&number))
    }

    /// Returns the least and the greatest of its whole numbers.
    fn limits(self) -> Option<(f64, f64)> {
        let power = |bits: u8| f64::from(bits).exp2();
        match self {
            Self::Any | Self::Text(_) => None,
            Self::Boolean => Some((0.0, 1.0)),
            Self::Unsigned(bits) => Some((0.0, power(bits) - 1.0)),
            Self::Signed(bits) => Some((-power(bits - 1), power(bits - 1) - 1.0)),
        }
    }

    /// Returns the value of a variable of the type and of a name after an assignment.
    pub(crate) fn take(self, name: &str, value: Value) -> TypedValue {
        match (self, value, self.limits()) {
            (Self::Text(most), Value::Text(text), _) => match most {
                Some(most) if text.chars().count() > most as usize => {
                    TypedValue::OtherKind(format!("`{name}` has {most} characters at most"))
                }
                _ => TypedValue::Taken(Value::Text(text)),
            },
            (Self::Text(_), Value::Number(_), _) => {
                TypedValue::OtherKind(format!("`{name}` is a STRING, and the value a number"))
            }
            (_, Value::Text(_), Some(_)) => {
                TypedValue::OtherKind(format!("`{name}` is a number, and the value a string"))
            }
            (_, Value::Number(number), Some((least, most))) => {
                if number.floor() > most || number.ceil() < least {
                    TypedValue::OutOfRange(least, most)
                } else if number.fract() == 0.0 {
                    TypedValue::Taken(Value::Number(number))
                } else {
                    TypedValue::Fraction(number)
                }
            }
            (_, value, _) => TypedValue::Taken(value),
        }
    }
}

pub(crate) fn fault(code: Code, span: Span, message: impl Into<String>) -> Box<Fault> {
    Box::new(Fault::new(code, span, message))
}

pub(crate) fn wrong_type(span: Span, message: &str) -> Box<Fault> {
    fault(Code::Fc312, span, message)
}

/// Returns the number where a number is expected; `None` for what only the machine knows, FC312 for a string (R2.37).
pub(crate) fn numeric(value: &Value, span: Span) -> Result<Option<f64>, Box<Fault>> {
    match value {
        Value::Text(_) => Err(wrong_type(
            span,
            "found a string where a number is expected",
        )),
        Value::Number(number) => Ok(Some(*number)),
        Value::Unknown(_) => Ok(None),
    }
}

/// Returns the value of an operation; a reading decides whether comparisons have a tolerance (R2.112).
pub(crate) fn binary(
    operator: BinaryOperator,
    (left, right): (Slot, Slot),
    reading: Option<Alternative>,
    span: Span,
) -> Slot {
    match operator {
        BinaryOperator::And | BinaryOperator::Or => return logic(operator, left, right, span),
        _ => {}
    }
    match (left?, right?) {
        (Value::Number(left), Value::Number(right)) => {
            numbers(operator, (left, right), reading, span)
        }
        (unknown @ Value::Unknown(_), _) | (_, unknown @ Value::Unknown(_)) => Ok(unknown),
        (Value::Text(left), Value::Text(right)) => match operator {
            BinaryOperator::Add => Ok(Value::Text(format!("{left}{right}").into())),
            BinaryOperator::Equal => Ok((left == right).into()),
            BinaryOperator::NotEqual => Ok((left != right).into()),
            _ => Err(wrong_type(span, "this operator does not take strings")),
        },
        _ => Err(wrong_type(span, "a string and a number cannot be combined")),
    }
}

/// Returns the value of an operation on two numbers.
#[inline]
pub(crate) fn numbers(
    operator: BinaryOperator,
    (left, right): (f64, f64),
    reading: Option<Alternative>,
    span: Span,
) -> Slot {
    if compares(operator) && are_nearly_equal(left, right) {
        return match reading {
            None => Ok(Value::Unknown(Unknown::Rounding)),
            Some(Alternative::First) => arithmetic(operator, left, left, span),
            Some(Alternative::Second) => arithmetic(operator, left, right, span),
        };
    }
    if operator == BinaryOperator::Modulo && is_nearly_multiple(left, right) {
        return match reading {
            None => Ok(Value::Unknown(Unknown::Rounding)),
            Some(Alternative::First) => Ok(Value::Number(0.0)),
            Some(Alternative::Second) => arithmetic(operator, left, right, span),
        };
    }
    arithmetic(operator, left, right, span)
}

/// Returns whether rounding alone keeps a number from being a multiple of another.
fn is_nearly_multiple(left: f64, right: f64) -> bool {
    let rest = (left % right).abs();
    let least = rest.min(right.abs() - rest);
    rest > 0.0 && least <= ROUNDING * left.abs().max(right.abs())
}

/// Returns the number beside which rounding decides the value of a function (R2.112).
fn jump_of(function: Function, x: f64) -> Option<f64> {
    match function {
        Function::Ceil | Function::Floor => Some(x.round()),
        Function::Int | Function::Fract => Some(x.round()).filter(|it| *it != 0.0),
        Function::Round | Function::IntToStr => Some(x.floor() + 0.5),
        Function::Sign => Some(0.0),
        Function::Not => Some(0.5_f64.copysign(x)),
        _ => None,
    }
}

/// Returns `&&` and `||`: one operand alone may decide, whatever the other is.
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
            Err(wrong_type(span, "a string is neither true nor false"))
        }
        (unknown @ Value::Unknown(_), _) | (_, unknown @ Value::Unknown(_)) => Ok(unknown),
        (Value::Number(_), Value::Number(_)) => Ok((!deciding).into()),
    }
}

fn compares(operator: BinaryOperator) -> bool {
    use BinaryOperator::{Equal, Greater, GreaterOrEqual, Less, LessOrEqual, NotEqual};
    matches!(
        operator,
        Equal | NotEqual | GreaterOrEqual | LessOrEqual | Less | Greater
    )
}

fn arithmetic(operator: BinaryOperator, left: f64, right: f64, span: Span) -> Slot {
    use BinaryOperator::{
        Add, And, BitAnd, BitOr, BitXor, Divide, Equal, Greater, GreaterOrEqual, Less, LessOrEqual,
        Modulo, Multiply, NotEqual, Or, Power, Subtract, Xor,
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
        BitAnd | BitOr | BitXor => return bitwise(operator, left, right, span),
        Xor => return Ok((is_true(left) != is_true(right)).into()),
        And => return Ok((is_true(left) && is_true(right)).into()),
        Or => return Ok((is_true(left) || is_true(right)).into()),
    };
    finite(value, span)
}

/// Greatest difference of two numbers, as a share of them, that the rounding of a computation may make; of a number and 0,
/// as it stands (R2.112).
const ROUNDING: f64 = 1e-9;

/// Returns whether two numbers differ, and by no more than rounding: the control may have rounded otherwise.
pub(crate) fn are_nearly_equal(left: f64, right: f64) -> bool {
    let difference = (left - right).abs();
    let scale = if left == 0.0 || right == 0.0 {
        1.0
    } else {
        left.abs().max(right.abs())
    };
    difference > 0.0 && difference <= ROUNDING * scale
}

/// Returns FC312 for a result that is not a number: it could not be used in computations, nor saved in a state.
pub(crate) fn finite(value: f64, span: Span) -> Slot {
    if value.is_finite() {
        Ok(Value::Number(value))
    } else {
        Err(fault(Code::Fc312, span, "the result is not a number"))
    }
}

fn bitwise(operator: BinaryOperator, left: f64, right: f64, span: Span) -> Slot {
    let (Some(left), Some(right)) = (rounded(left), rounded(right)) else {
        return Err(wrong_type(span, "bit operators need whole numbers"));
    };
    let bits = match operator {
        BinaryOperator::BitAnd => left & right,
        BinaryOperator::BitXor => left ^ right,
        _ => left | right,
    };
    #[allow(clippy::cast_precision_loss)] // below 2^53
    Ok(Value::Number(bits as f64))
}

/// Returns `IS_STRING[v]`, `IS_NUMBER[v]` (R2.79).
fn type_test(function: Function, slots: Vec<Slot>, span: Span) -> Slot {
    let [slot]: [Slot; 1] = slots
        .try_into()
        .map_err(|_| wrong_type(span, "this function takes one argument"))?;
    Ok(match slot? {
        Value::Text(_) => (function == Function::IsString).into(),
        Value::Number(_) => (function == Function::IsNumber).into(),
        unknown @ Value::Unknown(_) => unknown,
    })
}

pub(crate) fn call(
    function: Function,
    slots: Vec<Slot>,
    reading: Option<Alternative>,
    span: Span,
) -> Slot {
    if function == Function::Exist {
        return match slots.into_iter().next() {
            Some(Ok(unknown @ Value::Unknown(_))) => Ok(unknown),
            first => Ok(first.is_some_and(|slot| slot.is_ok()).into()),
        };
    }
    if let Function::IsString | Function::IsNumber = function {
        return type_test(function, slots, span);
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
        | Function::Ord
        | Function::Insert
        | Function::Delete
        | Function::Replace
        | Function::StrToInt
        | Function::StrToReal => text_function(function, &values, span),
        _ => {
            let mut numbers: Option<Vec<f64>> = values.iter().map(Value::number).collect();
            if let Some([x]) = numbers.as_deref_mut()
                && let Some(at) = jump_of(function, *x).filter(|at| are_nearly_equal(*x, *at))
            {
                match reading {
                    None => return Ok(Value::Unknown(Unknown::Rounding)),
                    Some(Alternative::First) => *x = at,
                    Some(Alternative::Second) => {}
                }
            }
            match numbers.as_deref() {
                Some([x]) if function == Function::IntToStr => {
                    Ok(Value::Text(format!("{:.0}", x.round()).into()))
                }
                Some([x]) if function == Function::RealToStr => {
                    Ok(Value::Text(x.to_string().into()))
                }
                Some([x]) => number_function(function, *x, span),
                Some([first, rest @ ..]) if function == Function::Min && !rest.is_empty() => {
                    Ok(Value::Number(rest.iter().fold(*first, |a, b| a.min(*b))))
                }
                Some([first, rest @ ..]) if function == Function::Max && !rest.is_empty() => {
                    Ok(Value::Number(rest.iter().fold(*first, |a, b| a.max(*b))))
                }
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
        Function::Sign if x == 0.0 => 0.0,
        Function::Sign => x.signum(),
        Function::Int => x.trunc(),
        Function::Fract => x.fract(),
        Function::Ceil => x.ceil(),
        Function::Floor => x.floor(),
        Function::Round => x.round(),
        Function::Not => f64::from(u8::from(!is_true(x))),
        Function::Inv => {
            let Some(bits) = rounded(x).and_then(|bits| u32::try_from(bits).ok()) else {
                return domain("bit operators need whole numbers from 0 to 4294967295");
            };
            f64::from(!bits)
        }
        _ => return domain("wrong number of arguments"),
    };
    finite(value, span)
}

/// Multiples of a quarter turn come out exact.
#[allow(clippy::float_cmp, reason = "exact quarter turns are meant")]
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
    let wrong = || {
        wrong_type(
            span,
            "this function takes a string first, then whole numbers",
        )
    };
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
    let second = || match values.get(1) {
        Some(Value::Text(text)) => Ok(&**text),
        _ => Err(wrong()),
    };
    let text_of = |characters: String| Ok(Value::Text(characters.into()));
    #[allow(clippy::cast_precision_loss)] // lengths of lines
    let number_of = |number: usize| Ok(Value::Number(number as f64));
    let length = text.chars().count();
    // Positions count from 1.
    let part = |from: usize, to: usize| -> String { text.chars().take(to).skip(from).collect() };
    match function {
        Function::Left => text_of(part(0, count(values.get(1))?)),
        Function::Right => text_of(part(length.saturating_sub(count(values.get(1))?), length)),
        // Count first, then position (PM/206023179).
        Function::Mid => {
            let (number, first) = (count(values.get(1))?, count(values.get(2))?.max(1) - 1);
            text_of(part(first, first.saturating_add(number)))
        }
        Function::Delete => {
            let (number, first) = (count(values.get(1))?, count(values.get(2))?.max(1) - 1);
            text_of(part(0, first) + &part(first.saturating_add(number), length))
        }
        Function::Insert => {
            let place = count(values.get(2))?;
            text_of(part(0, place) + second()? + &part(place, length))
        }
        Function::Replace => {
            let (number, first) = (count(values.get(2))?, count(values.get(3))?.max(1) - 1);
            let rest = part(first.saturating_add(number), length);
            text_of(part(0, first) + second()? + &rest)
        }
        Function::Len => number_of(length),
        Function::Find => {
            let found = text.find(second()?);
            number_of(found.map_or(0, |at| text[..at].chars().count() + 1))
        }
        Function::StrToInt | Function::StrToReal => {
            let number: Result<f64, _> = text.trim().parse();
            match number {
                Ok(number) if function == Function::StrToInt => finite(number.trunc(), span),
                Ok(number) => finite(number, span),
                Err(_) => Err(wrong_type(span, "the string is not a number")),
            }
        }
        _ => {
            let place = match values.get(1) {
                Some(_) => count(values.get(1))?,
                None => 1,
            };
            match text.chars().nth(place.max(1) - 1) {
                Some(character) => Ok(Value::Number(f64::from(u32::from(character)))),
                None => Err(wrong_type(
                    span,
                    "the string has no character at this position",
                )),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_type_takes_its_whole_numbers_only() {
        // R2.101
        let taken = |word: &str, number: f64| match ValueType::named(Some(word), None)
            .take("V.P.A", number.into())
        {
            TypedValue::Taken(Value::Number(number)) => number.to_string(),
            TypedValue::Taken(_) => "unknown".to_owned(),
            TypedValue::Fraction(number) => format!("beside {number}"),
            TypedValue::OutOfRange(least, most) => format!("{least} to {most}"),
            TypedValue::OtherKind(why) => why,
        };
        assert_eq!(taken("UNS08", 255.0), "255");
        assert_eq!(taken("UNS08", 256.0), "0 to 255");
        assert_eq!(taken("UNS08", 255.5), "beside 255.5");
        assert_eq!(taken("SGN16", -32769.0), "-32768 to 32767");
        assert_eq!(taken("SGN32", 2.5), "beside 2.5");
        assert_eq!(taken("BOOLEAN", 2.0), "0 to 1");
        assert_eq!(taken("REAL64", 2.5), "2.5");
    }
}
