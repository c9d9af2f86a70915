//! Values as written, with their places.

use std::fmt;
use std::sync::Arc;

use crate::diagnostic::Fix;
use crate::text::{Place, SourceFile, Span};

/// A number as written in a list or `frictcomp.toml`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Number {
    /// Without decimal point and exponent, decimal or hexadecimal.
    Integer(i64),
    /// With decimal point or exponent; always finite.
    Real(f64),
}

impl Number {
    /// Reads a number in the forms of R3.4. Returns `None` for anything else and for numbers that
    /// no type of the control can hold.
    pub fn parse(text: &str) -> Option<Self> {
        let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
        if let Some(hex) = digits
            .strip_prefix("0x")
            .or_else(|| digits.strip_prefix("0X"))
        {
            if !hex.starts_with(|first: char| first.is_ascii_hexdigit()) {
                return None;
            }
            let value = i64::from_str_radix(hex, 16).ok()?;
            return Some(Self::Integer(if text.starts_with('-') {
                -value
            } else {
                value
            }));
        }
        if !digits.starts_with(|first: char| first.is_ascii_digit() || first == '.') {
            return None;
        }
        if digits.bytes().all(|byte| byte.is_ascii_digit()) {
            return text.parse().ok().map(Self::Integer);
        }
        text.parse()
            .ok()
            .filter(|value: &f64| value.is_finite())
            .map(Self::Real)
    }

    /// Returns the number as a real number.
    pub fn to_f64(self) -> f64 {
        match self {
            Self::Real(value) => value,
            Self::Integer(value) => {
                let high = i32::try_from(value >> 32).expect("the upper half of an i64");
                let low = u32::try_from(value & 0xffff_ffff).expect("the lower half of an i64");
                f64::from(high) * 4_294_967_296.0 + f64::from(low)
            }
        }
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Integer(value) => value.fmt(f),
            Self::Real(value) => value.fmt(f),
        }
    }
}

/// A value where a number is expected.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Written {
    /// The word as written.
    pub text: String,
    /// Its number, if it is one.
    pub number: Option<Number>,
}

impl Written {
    /// Reads a word as a number.
    pub fn new(text: &str) -> Self {
        Self {
            text: text.to_owned(),
            number: Number::parse(text),
        }
    }
}

/// A value together with its place of origin.
#[derive(Debug, Clone)]
pub struct Given<T> {
    /// The value.
    pub value: T,
    source: Arc<SourceFile>,
    span: Span,
}

impl<T> Given<T> {
    /// Creates a value found at `span` of `source`.
    pub fn new(value: T, source: &Arc<SourceFile>, span: Span) -> Self {
        Self {
            value,
            source: source.clone(),
            span,
        }
    }

    /// Returns another value from the same place.
    pub fn with<U>(&self, value: U) -> Given<U> {
        Given::new(value, &self.source, self.span)
    }

    /// Returns the place of the value.
    pub fn place(&self) -> Place {
        self.source.place(self.span)
    }

    /// Returns the span of the value in its file.
    pub(crate) fn span(&self) -> Span {
        self.span
    }

    /// Returns the name of its file.
    pub fn file(&self) -> &str {
        self.source.name()
    }

    /// Returns its line, from 1.
    pub fn line(&self) -> u32 {
        self.source.lines().line(self.span.start)
    }
}

impl Given<bool> {
    /// Returns the change to the file that sets it to true.
    pub(crate) fn made_true(&self) -> Fix {
        let place = self.place();
        let word = match place.span.of(&place.text) {
            "false" => "true",
            word if word.eq_ignore_ascii_case("FALSE") => "TRUE",
            _ => "1",
        };
        Fix::guess(place, word)
    }
}
