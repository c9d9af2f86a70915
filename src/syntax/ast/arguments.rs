//! The arguments in the brackets of a command.

use super::expression::Operand;
use crate::text::Span;

/// The arguments in the brackets of a command, from left to right.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BracketArguments(pub(crate) Vec<Argument>);

/// A word or value in a bracket, with the key before it where there is one: `ON`, `5`, `AX=X`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Argument {
    /// The bracket that holds it, from one on; zero outside of brackets.
    pub(crate) group: u32,
    /// Number of commas before it.
    pub(crate) item: u32,
    /// The word before the equals sign.
    pub(crate) key: Option<Span>,
    /// The word or value.
    pub(crate) span: Span,
    /// The value, where it is one.
    pub(crate) value: Option<Operand>,
}

impl Argument {
    /// The logical number of an axis, where it is one.
    pub(crate) fn logical_number(&self, text: &str) -> Option<u32> {
        self.span.of(text).parse().ok()
    }

    /// The text of a value in quotes, without them.
    pub(crate) fn quoted<'a>(&self, text: &'a str) -> Option<&'a str> {
        self.span.of(text).strip_prefix('"')?.strip_suffix('"')
    }
}

impl BracketArguments {
    /// Returns all of them.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Argument> {
        self.0.iter()
    }

    /// Returns what is in the same brackets without commas in between, `NAME=X NR=1` of `[NAME=X NR=1, 2]`.
    pub(crate) fn items(&self) -> impl Iterator<Item = &[Argument]> {
        let together =
            |one: &Argument, other: &Argument| (one.group, one.item) == (other.group, other.item);
        self.0.chunk_by(together)
    }

    /// Returns what is in each bracket.
    pub(crate) fn groups(&self) -> impl Iterator<Item = &[Argument]> {
        self.0.chunk_by(|one, other| one.group == other.group)
    }

    /// Whether a word is among them, in upper or lower case.
    pub(crate) fn has(&self, word: &str, text: &str) -> bool {
        let words = |it: &Argument| it.key.into_iter().chain([it.span]);
        let mut words = self.0.iter().flat_map(words);
        words.any(|span| span.of(text).eq_ignore_ascii_case(word))
    }

    /// Returns the argument after a key, with an equals sign or without.
    pub(crate) fn after<'a>(&'a self, key: &'a str, text: &'a str) -> Option<&'a Argument> {
        let mut found = self.after_each(|word| word.eq_ignore_ascii_case(key), text);
        found.next()
    }

    /// Returns the arguments after keys that begin with some letters, `AX1=X AX2=Y`.
    pub(crate) fn after_beginning<'a>(
        &'a self,
        letters: &'a str,
        text: &'a str,
    ) -> impl Iterator<Item = &'a Argument> {
        let begins = |word: &str| {
            let start = word.get(..letters.len());
            start.is_some_and(|start| start.eq_ignore_ascii_case(letters))
        };
        self.after_each(begins, text)
    }

    fn after_each<'a>(
        &'a self,
        is_key: impl Fn(&str) -> bool + 'a,
        text: &'a str,
    ) -> impl Iterator<Item = &'a Argument> {
        let places = self.0.iter().enumerate();
        places.filter_map(move |(at, argument)| match argument.key {
            Some(key) => is_key(key.of(text)).then_some(argument),
            None if argument.value.is_none() && is_key(argument.span.of(text)) => self
                .0
                .get(at + 1)
                .filter(|next| next.group == argument.group),
            None => None,
        })
    }

    /// Whether a word or value contains some letters, in upper or lower case.
    pub(crate) fn mention(&self, letters: &str, text: &str) -> bool {
        let mut words = self.words(text).map(str::to_ascii_lowercase);
        words.any(|word| word.contains(letters))
    }

    /// Returns the logical axis numbers after the coupling group, `8` and `2` of `[1, 8 = 2]`.
    pub(crate) fn logical_numbers(&self, text: &str) -> Vec<u32> {
        let members = self.0.iter().skip(1);
        let spans = members.flat_map(|it| it.key.into_iter().chain([it.span]));
        spans
            .filter_map(|span| span.of(text).parse().ok())
            .collect()
    }

    /// Returns their words, keys and values alike.
    pub(crate) fn words<'a>(&'a self, text: &'a str) -> impl Iterator<Item = &'a str> {
        let spans = self
            .0
            .iter()
            .flat_map(|it| it.key.into_iter().chain([it.span]));
        spans.map(move |span| span.of(text))
    }
}
