//! The parameter that an expression with subscripts denotes (R2.72).

use super::functions::numeric;
use super::value::{Slot, Value, rounded};
use crate::syntax::Fault;
use crate::syntax::ast::Owner;
use crate::text::Span;

/// A parameter whose number and subscripts were computed.
pub(super) enum ParameterKey {
    Plain(Owner, u32),
    Element(String),
    /// The number or a subscript is not known; the array where its name is.
    Unknown(Option<String>, Value),
}

impl ParameterKey {
    /// Pops the number and the subscripts of a parameter.
    pub(super) fn pop(
        owner: Owner,
        subscripts: usize,
        span: Span,
        stack: &mut Vec<Slot>,
    ) -> Result<Self, Box<Fault>> {
        let from = stack.len().saturating_sub(subscripts + 1);
        let mut numbers = Vec::with_capacity(subscripts + 1);
        let mut unknown = None;
        for slot in stack.drain(from..) {
            let value = slot?;
            if let Some(number) = numeric(&value, span)? {
                numbers.push(rounded(number).unwrap_or(i64::MAX));
            } else {
                numbers.push(i64::MAX);
                unknown = unknown.or(Some((numbers.len() == 1, value)));
            }
        }
        let index = numbers.first().copied().unwrap_or_default();
        let index = u32::try_from(index).unwrap_or(u32::MAX);
        let array = format!("P{index}");
        if let Some((no_index, cause)) = unknown {
            let array = (!no_index).then_some(array);
            return Ok(Self::Unknown(array, cause));
        }
        if subscripts == 0 {
            return Ok(Self::Plain(owner, index));
        }
        let mut name = array;
        for number in &numbers[1..] {
            name.push('[');
            name.push_str(&number.to_string());
            name.push(']');
        }
        Ok(Self::Element(name))
    }
}
