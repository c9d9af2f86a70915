//! One line of a list: its key, and its value as written, with its place: a number, a text or a set of words.
//!
//! The permitted form of a value depends on the key, which is not interpreted here.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::Fix;
use crate::text::{Place, SourceFile, Span};

/// Quotes around a value that contains `(`; printed samples use typographic quotes (TF5200 Channel
/// parameters, comments in the ASCII list file).
const QUOTES: [char; 4] = ['"', '\u{201c}', '\u{201d}', '\u{2033}'];

/// One line `path.with[index].dots  value  comment`.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The key with all indices left empty: `frict_comp.table[].in`.
    pub pattern: String,
    /// The indices from left to right.
    pub indices: Vec<u32>,
    /// Span of the key.
    pub key_span: Span,
    /// Everything after the key, without blanks at either end.
    pub value_span: Span,
    /// Span of the effective value: the entry's own, or the target of a reference (R3.40).
    pub(super) meant: Span,
    pub(super) source: Arc<SourceFile>,
}

impl Entry {
    /// Returns the key without blanks: `frict_comp.table[0].in`.
    pub fn key(&self) -> String {
        let mut key = String::with_capacity(self.pattern.len() + 4 * self.indices.len());
        let mut indices = self.indices.iter();
        for part in self.pattern.split_inclusive('[') {
            key.push_str(part);
            if part.ends_with('[')
                && let Some(index) = indices.next()
            {
                key.push_str(&index.to_string());
            }
        }
        key
    }

    /// Returns the key as written.
    pub(super) fn written_key(&self) -> &str {
        self.key_span.of(self.source.text())
    }

    /// Returns the place of the key.
    pub fn key_place(&self) -> Place {
        self.source.place(self.key_span)
    }

    /// Returns the end of its line, and the columns of its key with the blanks after it.
    pub(super) fn end(&self) -> Given<usize> {
        let (source, start) = (&self.source, self.key_span.start);
        let line = source
            .lines()
            .line_span(source.text(), source.lines().line(start));
        let end = line.range().end;
        let columns = self.value_span.range().start - self.key_span.range().start;
        Given::new(columns, source, Span::new(end, end))
    }

    /// Returns the value as one word, the form of numbers and truth values: it ends at a blank or
    /// at the start of a comment (R3.2).
    pub fn word(&self) -> Given<&str> {
        let value = self.meant.of(self.source.text());
        let end = value
            .find(|c: char| c.is_whitespace() || matches!(c, '#' | '('))
            .unwrap_or(value.len());
        let end = value.find("/*").map_or(end, |comment| end.min(comment));
        self.part(0..end)
    }

    /// Returns the value as a text; only `(` opens a comment after it. A text in quotes may contain
    /// `(` (R3.2).
    pub fn text(&self) -> Given<&str> {
        let value = self.meant.of(self.source.text());
        if let Some(quote) = value.chars().next().filter(|first| QUOTES.contains(first))
            && let Some(length) = value[quote.len_utf8()..].find(QUOTES)
        {
            return self.part(quote.len_utf8()..quote.len_utf8() + length);
        }
        let end = value.find('(').unwrap_or(value.len());
        self.part(0..value[..end].trim_end().len())
    }

    /// Returns the value as a number, with the word as written.
    pub fn number(&self) -> Given<Written> {
        let word = self.word();
        word.with(Written::new(word.value))
    }

    /// Returns the value as a truth value, `0`, `1`, `FALSE` or `TRUE`; `None` for anything else
    /// (R3.4).
    pub fn truth(&self) -> Given<Option<bool>> {
        let word = self.word();
        let truth = match Number::parse(word.value) {
            Some(Number::Integer(0)) => Some(false),
            Some(Number::Integer(1)) => Some(true),
            None if word.value.eq_ignore_ascii_case("FALSE") => Some(false),
            None if word.value.eq_ignore_ascii_case("TRUE") => Some(true),
            _ => None,
        };
        word.with(truth)
    }

    /// Returns the value as a set of words and numbers, `A | '16#3' |` (R3.4). Everything after the
    /// last one is a comment.
    pub fn words(&self) -> Vec<Given<&str>> {
        let value = self.meant.of(self.source.text());
        let is_between = |c: char| c.is_whitespace() || QUOTES.contains(&c);
        let mut words = Vec::new();
        let mut rest = value;
        loop {
            rest = rest.trim_start_matches(is_between);
            let end = word_end(rest);
            if end == 0 {
                return words;
            }
            let start = value.len() - rest.len();
            words.push(self.part(start..start + end));
            rest = rest[end..].trim_start_matches(is_between);
            match rest.strip_prefix('|') {
                Some(after) => rest = after,
                None => return words,
            }
        }
    }

    /// Returns the bytes `range` of the value with their place; an empty part has the place of the
    /// key.
    fn part(&self, range: Range<usize>) -> Given<&str> {
        let start = self.meant.range().start;
        let span = if range.is_empty() {
            self.key_span
        } else {
            Span::new(start + range.start, start + range.end)
        };
        let value = self.meant.of(self.source.text());
        Given::new(&value[range], &self.source, span)
    }
}

/// Returns the end of the word or number at the start of a text; `'16#3'` and `16#3` are numbers.
fn word_end(text: &str) -> usize {
    let is_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-');
    let plain = |text: &str| text.find(|c| !is_word(c)).unwrap_or(text.len());
    if let Some(quoted) = text.strip_prefix('\'') {
        return quoted.find('\'').map_or(0, |end| end + 2);
    }
    let end = plain(text);
    let is_base = end > 0 && text[..end].bytes().all(|byte| byte.is_ascii_digit());
    match text[end..].strip_prefix('#') {
        Some(digits) if is_base => end + 1 + plain(digits),
        _ => end,
    }
}

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
