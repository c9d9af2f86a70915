//! Values as a client shows them.

use frictcomp::interpreter::Value;

/// Returns a value as it is shown.
pub(super) fn in_words(value: &Value) -> String {
    match value {
        Value::Number(number) => number.to_string(),
        Value::Text(text) => format!("\"{text}\""),
        Value::Unknown(cause) => format!("unknown, from {cause}"),
    }
}
