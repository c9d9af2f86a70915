//! The conditions of breakpoints.

use frictcomp::interpreter::{Interpreter, Value};
use frictcomp::syntax::ast::Block;
use frictcomp::syntax::parse_expression;

/// An expression of the language that must be true, as after `$IF`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Condition(String);

impl Condition {
    /// # Errors
    /// The text is not an expression; the reason in words.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let is_expression = parse_expression(text, &mut Block::default()).is_some();
        let refused = || {
            format!(
                "the condition `{text}` is not an expression of the language; write for example `P1 == 5`"
            )
        };
        is_expression
            .then(|| Self(text.to_owned()))
            .ok_or_else(refused)
    }

    /// Returns whether it is true at the current block of a run.
    ///
    /// # Errors
    /// It cannot be decided; the reason in words.
    pub(super) fn holds(&self, here: &Interpreter) -> Result<bool, String> {
        let Self(text) = self;
        let value = here
            .evaluate(text)
            .map_err(|why| format!("the condition `{text}` has no value here: {why}"))?;
        match (value.truth(), value) {
            (Some(truth), _) => Ok(truth),
            (None, Value::Unknown(cause)) => Err(format!(
                "the condition `{text}` depends on `{cause}`, which only the machine knows"
            )),
            (None, _) => Err(format!(
                "the condition `{text}` is a text, not true or false"
            )),
        }
    }
}

/// Selection of the hits of a breakpoint that count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum HitCount {
    /// `5`, `= 5`: that one.
    Exactly(u64),
    /// `>= 5`: that one and all after it.
    From(u64),
    /// `<= 5`: those up to it.
    UpTo(u64),
    /// `% 5`: every fifth.
    Every(u64),
}

impl HitCount {
    /// # Errors
    /// The text is not a number of hits; the reason in words.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let digits = text.trim_start_matches(['=', '<', '>', '%', ' ']);
        let operator = text[..text.len() - digits.len()].trim();
        let number: Option<u64> = digits.trim().parse().ok();
        let found = number.filter(|number| *number > 0).and_then(|number| {
            Some(match operator {
                "" | "=" | "==" => Self::Exactly(number),
                ">=" => Self::From(number),
                ">" => Self::From(number.checked_add(1)?),
                "<=" => Self::UpTo(number),
                "<" => Self::UpTo(number - 1),
                "%" => Self::Every(number),
                _ => return None,
            })
        });
        found.ok_or_else(|| {
            format!(
                "`{text}` is not a number of hits; write for example `5`, `>= 5`, `<= 5` or `% 5`"
            )
        })
    }

    /// Returns whether a hit counts; the first one is 1.
    pub(super) fn includes(self, time: u64) -> bool {
        match self {
            Self::Exactly(number) => time == number,
            Self::From(number) => time >= number,
            Self::UpTo(number) => time <= number,
            Self::Every(number) => time.is_multiple_of(number),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_of_hits_may_have_an_operator() {
        // R12.15
        for (text, expected) in [
            ("5", [5, 0, 0]),
            (" = 5", [5, 0, 0]),
            (">= 5", [5, 6, 7]),
            (">5", [6, 7, 8]),
            ("<=2", [1, 2, 0]),
            ("< 2", [1, 0, 0]),
            ("% 3", [3, 6, 9]),
        ] {
            let hits = HitCount::parse(text).expect(text);
            let mut times = (1..=9).filter(|time| hits.includes(*time));
            let first: [u64; 3] = std::array::from_fn(|_| times.next().unwrap_or_default());
            assert_eq!(first, expected, "{text}");
        }
        for wrong in ["", "x", "0", "5 5", "-1", "!= 4", "%", "1.5"] {
            assert!(HitCount::parse(wrong).is_err(), "{wrong}");
        }
    }
}
