//! The words that a `#` command begins with.

use super::pieces::is_blank;

/// The words of a `#` command in upper case, and how many bytes they take.
pub(crate) fn hash_name(code: &str) -> (String, usize) {
    let mut name = String::from("#");
    let mut end = 1;
    let mut rest = &code[1..];
    loop {
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
        let is_argument = name.len() > 1 && after.trim_start().starts_with('=');
        if !is_word || is_value || is_argument {
            return (name, end);
        }
        if name.len() > 1 {
            name.push(' ');
        }
        name.push_str(&word.to_ascii_uppercase());
        end = code.len() - after.len();
        rest = after;
    }
}

/// The words of a `#` command at the start of a block, after its number, in upper case.
pub(super) fn hash_word(code: &str) -> Option<String> {
    let start = code.trim_start_matches(is_blank);
    let start = match start.strip_prefix(['N', 'n']) {
        Some(number) => number.trim_start_matches(|c: char| c.is_ascii_digit() || is_blank(c)),
        None => start,
    };
    start.starts_with('#').then(|| hash_name(start).0)
}
