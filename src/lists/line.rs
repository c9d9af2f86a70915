//! The line format that all lists share: one entry per line, key, value, comment (R3.1 to R3.5).
//!
//! Keys matter here only if they lost their underscores.

use std::collections::HashMap;
use std::sync::Arc;

use super::entry::Entry;
use super::keywords::{blanked, is_known};
use super::parameter::resolve;
use crate::diagnostic::{Code, Diagnostic};
use crate::text::{SourceFile, Span, changed_direction};

/// More invalid lines than a list has by mistake; further ones are only counted.
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

    /// Whether keys lost their underscores, which has been reported.
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
    /// None of these; the reason, to be completed to a sentence.
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

#[cfg(test)]
mod tests {
    use super::super::entry::Number;
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
