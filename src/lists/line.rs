//! The line format that all lists share: one entry per line, key, value, comment (R3.1 to R3.5), and a value as written, with its
//! place: a number, a text or a set of words.
//!
//! Keys matter here only if they lost their underscores. The permitted form of a value depends on the key, which is not interpreted
//! here.

use std::collections::HashMap;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use super::keywords::{blanked, is_known};
use super::parameter::resolve;
use crate::diagnostic::{Code, Diagnostic, Fix};
use crate::text::{Place, SourceFile, Span, changed_direction};

/// Number of invalid lines that are reported; further ones, more than a list has by mistake, are only counted.
const MAX_ODD: usize = 20;

/// The entries of one list.
#[derive(Debug, Clone)]
pub struct Entries {
    /// The entries in the order of their lines; only the last one of a repeated key.
    pub entries: Vec<Entry>,
    /// Messages on the lines themselves: FC120, FC121, FC124.
    pub diagnostics: Vec<Diagnostic>,
    /// The entries whose value is a reference that leads nowhere (R3.40).
    pub(super) unresolved: Vec<Entry>,
    /// Lines whose key lost its underscores.
    lost: usize,
    source: Arc<SourceFile>,
}

impl Entries {
    /// Reads the lines of a list up to `Ende` (R3.3). Never fails: a line that is not an entry is
    /// passed over with FC124.
    pub fn parse(source: &Arc<SourceFile>) -> Self {
        let mut reader = Reader {
            source,
            lines: Vec::new(),
            lost: Vec::new(),
            diagnostics: Vec::new(),
        };
        if source.text().trim_start().starts_with('<') {
            reader.refuse_xml();
            return Self::of(reader);
        }
        let ended = reader.read();
        if !ended {
            let end = source.text().trim_end().len();
            let start = source.text()[..end]
                .rfind(['\n', '\r'])
                .map_or(0, |at| at + 1);
            reader.diagnostics.push(
                Diagnostic::new(
                    Code::Fc120,
                    source.place(Span::new(start, end)),
                    "the list ends without `Ende`",
                )
                .with_help("write `Ende` on a separate line after the last entry"),
            );
        }
        reader.tell_lost();
        let mut entries = Self::of(reader);
        entries.drop_repeated();
        entries.unresolved = resolve(&mut entries.entries, &mut entries.diagnostics);
        entries
    }

    fn of(reader: Reader<'_>) -> Self {
        Self {
            entries: reader.lines,
            diagnostics: reader.diagnostics,
            unresolved: Vec::new(),
            lost: reader.lost.len(),
            source: reader.source.clone(),
        }
    }

    /// Returns whether keys lost their underscores, which has been reported.
    pub(crate) fn lost_underscores(&self) -> bool {
        self.lost > 0
    }

    /// Returns the source of the list.
    pub fn source(&self) -> &Arc<SourceFile> {
        &self.source
    }

    /// Returns the entry with this key, for keys without an index.
    pub fn find(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.pattern == key)
    }

    /// Returns the entries whose key has this pattern, `achs_mds[]`, each with its first index.
    pub fn indexed<'a>(&'a self, pattern: &'a str) -> impl Iterator<Item = (u32, &'a Entry)> {
        self.entries
            .iter()
            .filter(move |entry| entry.pattern == pattern)
            .filter_map(|entry| entry.indices.first().map(|&index| (index, entry)))
    }

    /// Keeps the last of several entries with the same key and reports them (R3.5).
    fn drop_repeated(&mut self) {
        let mut last: HashMap<(&str, &[u32]), usize> = HashMap::new();
        let mut repeated = Vec::new();
        for (at, entry) in self.entries.iter().enumerate() {
            if let Some(before) = last.insert((&entry.pattern, &entry.indices), at) {
                let earlier = &self.entries[before];
                self.diagnostics.push(
                    Diagnostic::new(
                        Code::Fc121,
                        entry.key_place(),
                        format!("`{}` is given twice; the last value applies", entry.key()),
                    )
                    .with_label(earlier.key_place(), "first given here"),
                );
                repeated.push(before);
            }
        }
        if repeated.is_empty() {
            return;
        }
        repeated.sort_unstable();
        let mut at = 0;
        self.entries.retain(|_| {
            let keep = repeated.binary_search(&at).is_err();
            at += 1;
            keep
        });
    }
}

/// Kind of a line.
enum LineKind {
    /// An empty line, or a comment.
    Blank,
    /// `Ende`.
    End,
    /// An entry.
    Entry(Entry),
    /// A key whose underscores turned into blanks, and the intended key.
    Lost(Span, &'static str),
    /// Anything else; the reason, to be completed to a sentence.
    Odd(&'static str),
}

struct Reader<'a> {
    source: &'a Arc<SourceFile>,
    lines: Vec<Entry>,
    /// Keys that lost their underscores, each with the intended one.
    lost: Vec<(Span, &'static str)>,
    diagnostics: Vec<Diagnostic>,
}

impl Reader<'_> {
    /// Reads line by line and returns whether `Ende` was found.
    fn read(&mut self) -> bool {
        let text = self.source.text();
        let lines = self.source.lines();
        let count = u32::try_from(lines.lines()).unwrap_or(u32::MAX);
        let mut odd: Vec<Span> = Vec::new();
        let mut ended = false;
        let first = lines.first();
        for number in first..first.saturating_add(count) {
            let span = lines.line_span(text, number);
            self.look_at(span);
            match self.line(span) {
                LineKind::Blank => {}
                LineKind::End => {
                    ended = true;
                    break;
                }
                LineKind::Entry(entry) => self.lines.push(entry),
                LineKind::Lost(written, key) => self.lost.push((written, key)),
                LineKind::Odd(why) => {
                    odd.push(span);
                    if odd.len() <= MAX_ODD {
                        self.pass_over(span, why);
                    }
                }
            }
        }
        if let Some(&first) = odd.get(MAX_ODD) {
            let more = odd.len() - MAX_ODD;
            let message = format!("{more} more lines from here on are not list entries");
            let diagnostic = Diagnostic::new(Code::Fc124, self.source.place(first), message)
                .with_help("check that this file is a list of the control");
            self.diagnostics.push(diagnostic);
        }
        ended
    }

    /// Reports FC102 for characters that change the order in which a line is shown (R9.94).
    fn look_at(&mut self, line: Span) {
        if let Some((span, message)) = changed_direction(line.of(self.source.text())) {
            let place = self.source.place(span.shifted(line.start));
            let said = Diagnostic::new(Code::Fc102, place, message);
            self.diagnostics
                .push(said.with_help("delete these characters"));
        }
    }

    /// Reports FC124 for a line that is not an entry.
    fn pass_over(&mut self, span: Span, why: &str) {
        let line = span.of(self.source.text());
        let start = line.len() - line.trim_start().len();
        let meant = Span::new(start, line.trim_end().len()).shifted(span.start);
        self.diagnostics.push(
            Diagnostic::new(
                Code::Fc124,
                self.source.place(meant),
                format!("{why}; the line is passed over"),
            )
            .with_help("an entry is `key value`, a comment begins with `#`"),
        );
    }

    /// Reports FC124 for keys without their underscores, once for all of them.
    fn tell_lost(&mut self) {
        let Some(&(span, key)) = self.lost.first() else {
            return;
        };
        let written = span.of(self.source.text());
        let lines = match self.lost.len() {
            1 => "this line is".to_owned(),
            several => format!("{several} such lines are"),
        };
        let message = format!(
            "the underscores of this list were lost, as in a copy from a PDF: `{written}` stands \
             for `{key}`; {lines} passed over"
        );
        self.diagnostics.push(
            Diagnostic::new(Code::Fc124, self.source.place(span), message)
                .with_help("put the underscores back, or take the list from the control"),
        );
    }

    /// Reports FC124 for a list in the control's other format.
    fn refuse_xml(&mut self) {
        let first = self.source.lines().first();
        let span = self.source.lines().line_span(self.source.text(), first);
        self.diagnostics.push(
            Diagnostic::new(
                Code::Fc124,
                self.source.place(span),
                "this is XML, which is not read",
            )
            .with_help("export the ASCII list (`.lis`) from the control"),
        );
    }

    fn line(&self, span: Span) -> LineKind {
        let whole = span.of(self.source.text());
        let whole = whole.trim_end();
        let mut line = whole.trim_start_matches('\u{feff}').trim_start();
        while let Some(comment) = line.strip_prefix("/*") {
            match comment.split_once("*/") {
                Some((_, after)) => line = after.trim_start(),
                None => return LineKind::Odd("a comment is not closed on its line"),
            }
        }
        // Printed samples use `:` or `...` for omitted entries (R3.2).
        let left_out = |c: char| matches!(c, ':' | '.' | '\u{2026}' | ' ' | '\t');
        if line.starts_with('#') || line.chars().all(left_out) {
            return LineKind::Blank;
        }
        let first = line
            .split(|c: char| c.is_whitespace() || matches!(c, '#' | '('))
            .next()
            .unwrap_or_default();
        if first.eq_ignore_ascii_case("Ende") || first.eq_ignore_ascii_case("End") {
            return LineKind::End;
        }
        let start = span.range().start + (whole.len() - line.len());
        self.entry(line, start)
    }

    /// Reads an entry. `line` begins with its key, at `start` of the text.
    fn entry(&self, line: &str, start: usize) -> LineKind {
        let mut pattern = String::new();
        let mut indices = Vec::new();
        let mut rest = line;
        loop {
            let end = rest
                .find(|c: char| !(c.is_ascii_alphanumeric() || matches!(c, '_' | '.')))
                .unwrap_or(rest.len());
            pattern.push_str(&rest[..end]);
            rest = &rest[end..];
            let Some(bracket) = rest.trim_start().strip_prefix('[') else {
                break;
            };
            if pattern.is_empty() {
                break;
            }
            let Some((index, after)) = bracket.split_once(']') else {
                return LineKind::Odd("an index is not closed");
            };
            let index = index.trim();
            match index.parse() {
                Ok(index) if !pattern.ends_with('.') => indices.push(index),
                _ => return LineKind::Odd("this is not a valid table index"),
            }
            pattern.push_str("[]");
            rest = after;
        }
        let key_end = line.len() - rest.len();
        let value = rest.trim();
        let separated = rest.is_empty() || rest.starts_with(char::is_whitespace);
        let is_path = pattern.contains(['.', '[', '_']);
        let opens = pattern.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
        if !opens {
            return LineKind::Odd("this is not a list key");
        }
        if !separated {
            return LineKind::Odd("there is no blank between the key and its value");
        }
        if value.is_empty() && !is_path {
            return LineKind::Odd("the key has no value");
        }
        let value_start = if value.is_empty() {
            key_end
        } else {
            key_end + (rest.len() - rest.trim_start().len())
        };
        let is_odd = value.starts_with(|c: char| c.is_ascii_alphabetic()) && !is_known(&pattern);
        if let Some(found) = is_odd.then(|| blanked(line)).flatten() {
            return LineKind::Lost(Span::new(start, start + found.length), found.pattern);
        }
        let value = Span::new(start + value_start, start + value_start + value.len());
        LineKind::Entry(Entry {
            pattern,
            indices,
            key_span: Span::new(start, start + key_end),
            value_span: value,
            meant: value,
            source: self.source.clone(),
        })
    }
}

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
    /// Span of everything after the key, without blanks at either end.
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
    /// Number without decimal point and exponent, decimal or hexadecimal.
    Integer(i64),
    /// Number with decimal point or exponent; always finite.
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
    /// Number, if it is one.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Entries {
        Entries::parse(&Arc::new(SourceFile::new("a.lis", text)))
    }

    #[test]
    fn an_entry_keeps_its_places() {
        // R3.1
        let list = parse("  a.b[ 1 ].c\t7 # seven\r\nEnde\r\n");
        let entry = &list.entries[0];
        assert_eq!(entry.pattern, "a.b[].c");
        assert_eq!(entry.key(), "a.b[1].c");
        assert_eq!(entry.key_span.of(list.source().text()), "a.b[ 1 ].c");
        assert_eq!(entry.number().value.number, Some(Number::Integer(7)));
        assert_eq!(entry.number().place().start().column, 14);
    }
}
