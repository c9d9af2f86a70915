//! Values of the language: numbers, texts, what only the machine knows, and the types of declared variables (R2.101).

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::interpreter::values::location::Unknown;
use crate::syntax::Fault;

/// A value of an expression, parameter or variable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A text.
    Text(Arc<str>),
    /// Something that only the machine knows (R2.50).
    Unknown(Unknown),
}

/// One operand on the stack. A failure waits until something needs its value, so that `EXIST` and
/// the second operand of `&&` and `||` may fail without harm.
pub(crate) type Slot = Result<Value, Box<Fault>>;

impl Value {
    /// The number, where it is one.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// The value as a program writes it.
    pub(crate) fn as_written(&self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Text(text) => format!("\"{text}\""),
            Self::Unknown(unknown) => unknown.to_string(),
        }
    }

    /// Whether the value counts as true: |value| ≥ 0.5 (R2.31). `None` where it is not a number.
    pub fn truth(&self) -> Option<bool> {
        self.number().map(is_true)
    }
}

/// R2.31
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

/// R2.40: both values count as equal when they differ by less than 0.001 (PM/206908427).
pub(crate) fn same_case(wanted: &Value, value: &Value) -> bool {
    match (wanted, value) {
        (Value::Number(wanted), Value::Number(value)) => (wanted - value).abs() < 0.001,
        (wanted, value) => wanted == value,
    }
}

/// A number that is a whole number, 0 or more.
#[inline]
pub(crate) fn exact(number: f64) -> Option<u32> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // compared below
    let whole = number as u32;
    #[allow(clippy::float_cmp)] // whole numbers are exact
    let is_whole = f64::from(whole) == number;
    is_whole.then_some(whole)
}

/// A number as a whole number, rounded half away from zero; `None` if out of range.
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
    /// The variable has it.
    Taken(Value),
    /// The variable has one of the two whole numbers beside this one.
    Fraction(f64),
    /// The type does not have it: its least and its greatest value.
    OutOfRange(f64, f64),
    /// A text for a number, a number for a text, or a text that is too long.
    OtherKind(String),
}

impl ValueType {
    /// The type of a word in upper case, with the length in its bracket.
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

    /// The value of a variable that nothing was written to.
    pub(crate) fn default(self) -> Value {
        match self {
            Self::Text(_) => Value::Text("".into()),
            _ => Value::Number(0.0),
        }
    }

    /// Whether a whole number is one of its own.
    pub(crate) fn has(self, number: f64) -> bool {
        let limits = self.limits();
        limits.is_none_or(|(least, most)| (least..=most).contains(&number))
    }

    /// The least and the greatest of its whole numbers.
    fn limits(self) -> Option<(f64, f64)> {
        let power = |bits: u8| f64::from(bits).exp2();
        match self {
            Self::Any | Self::Text(_) => None,
            Self::Boolean => Some((0.0, 1.0)),
            Self::Unsigned(bits) => Some((0.0, power(bits) - 1.0)),
            Self::Signed(bits) => Some((-power(bits - 1), power(bits - 1) - 1.0)),
        }
    }

    /// What a variable of the type and of a name has after an assignment.
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
