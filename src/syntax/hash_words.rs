//! The words that a `#` command begins with.

use super::pieces::is_blank;
use crate::language::{FurtherWord, HashAction, HashCommand, HashWords};

/// Returns the words of a `#` command in upper case, and how many bytes they take.
pub(crate) fn hash_name(code: &str) -> (String, usize) {
    let mut name = String::from("#");
    let mut end = 1;
    for (word, word_end) in words(code) {
        push_word(&mut name, word);
        end = word_end;
    }
    (name, end)
}

/// The words that a `#` command begins with.
pub(super) struct CommandName {
    /// In upper case with one blank between them.
    pub(super) name: String,
    /// Number of bytes that they take.
    pub(super) length: usize,
    /// The command, where it is known.
    pub(super) command: Option<HashWords>,
}

/// Returns the words of a command. Words that cannot follow a known one are left out: of
/// `#COMMENT END X[COMP ON FRICT]` the first two remain.
pub(super) fn command_name(code: &str) -> CommandName {
    let (name, length) = hash_name(code);
    let Some(row) = HashCommand::of(&name) else {
        let command = None;
        return CommandName {
            name,
            length,
            command,
        };
    };
    let further = name[row.words.len()..].split_ascii_whitespace();
    let further = further.take_while(|word| FurtherWord::of(word).is_some());
    let known = row.words.split(' ').count() + further.count();
    let mut length = length;
    let mut name = String::from("#");
    for (word, end) in words(code).take(known) {
        push_word(&mut name, word);
        length = end;
    }
    CommandName {
        command: HashWords::of(&name),
        name,
        length,
    }
}

/// Whether an unknown word follows the name of a command, `#HSC ON SOFTLY [1]`, rather than text that looks
/// like an axis.
pub(super) fn goes_on(code: &str, name: &str) -> bool {
    let known = name.split(' ').count();
    let next = words(code).nth(known);
    next.is_some_and(|(word, _)| !word[1..].bytes().all(|byte| byte.is_ascii_digit()))
}

/// The words after the `#`, and where each ends.
fn words(code: &str) -> impl Iterator<Item = (&str, usize)> {
    let mut from = 1;
    std::iter::from_fn(move || {
        let rest = &code[from..];
        let trimmed = rest.trim_start_matches([' ', '\t']);
        let length = trimmed
            .find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
            .unwrap_or(trimmed.len());
        let (word, after) = trimmed.split_at(length);
        let is_word = word.starts_with(|c: char| c.is_ascii_alphabetic());
        let is_parameter = word.len() > 1
            && word.starts_with(['P', 'p'])
            && word[1..].bytes().all(|byte| byte.is_ascii_digit());
        let is_value = is_parameter || after.starts_with('.');
        let is_argument = from > 1 && after.trim_start().starts_with('=');
        if !is_word || is_value || is_argument {
            return None;
        }
        from = code.len() - after.len();
        Some((word, from))
    })
}

fn push_word(name: &mut String, word: &str) {
    if name.len() > 1 {
        name.push(' ');
    }
    name.push_str(&word.to_ascii_uppercase());
}

/// A `#` command at the start of a block.
pub(super) struct OpeningCommand<'a> {
    /// Its words.
    pub(super) name: CommandName,
    /// The text after them.
    pub(super) rest: &'a str,
}

impl OpeningCommand<'_> {
    /// Its action, where it is known.
    pub(super) fn action(&self) -> Option<HashAction> {
        self.name.command.map(|command| command.action)
    }

    /// Whether nothing follows the words.
    pub(super) fn is_alone(&self) -> bool {
        self.rest.trim_matches(is_blank).is_empty()
    }
}

/// The `#` command at the start of a block, after its number.
pub(super) fn opening_command(code: &str) -> Option<OpeningCommand<'_>> {
    let start = code.trim_start_matches(is_blank);
    let start = match start.strip_prefix(['N', 'n']) {
        Some(number) => number.trim_start_matches(|c: char| c.is_ascii_digit() || is_blank(c)),
        None => start,
    };
    start.starts_with('#').then(|| {
        let name = command_name(start);
        let rest = &start[name.length..];
        OpeningCommand { name, rest }
    })
}
