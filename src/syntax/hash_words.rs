//! The words that a `#` command begins with.

use super::keywords::command_words;
use super::pieces::is_blank;

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

/// Returns the same without words that cannot follow a known command: of `#COMMENT END X[COMP ON FRICT]`
/// the first two.
pub(super) fn command_name(code: &str) -> (String, usize) {
    let (name, length) = hash_name(code);
    let known = command_words(&name);
    let Some((_, end)) = known.checked_sub(1).and_then(|last| words(code).nth(last)) else {
        return (name, length);
    };
    let mut known_name = String::from("#");
    words(code)
        .take(known)
        .for_each(|(word, _)| push_word(&mut known_name, word));
    (known_name, end)
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
    /// Its words in upper case.
    pub(super) name: String,
    /// The text after them.
    pub(super) rest: &'a str,
}

impl OpeningCommand<'_> {
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
        let (name, length) = command_name(start);
        let rest = &start[length..];
        OpeningCommand { name, rest }
    })
}
