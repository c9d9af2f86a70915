//! Values of the language: numbers, texts, and what only the machine knows.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::cause::Unknown;
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
