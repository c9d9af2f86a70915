//! Commands of the user's own machine that are declared harmless (R2.70).

use crate::language::GFunction;
use crate::syntax::hash_name;

/// `#` commands, G and M functions that change no state, no position and no value.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct HarmlessWords {
    /// `#MYCMD ON`, in upper case with one blank between the words.
    commands: Vec<String>,
    /// The letters and numbers of the functions.
    functions: Vec<(u8, i64)>,
}

impl HarmlessWords {
    /// Adds a word; `false` if it is neither a `#` command nor a G or M function.
    pub fn add(&mut self, word: &str) -> bool {
        let word = word.trim();
        let is_command = word
            .strip_prefix('#')
            .is_some_and(|rest| rest.starts_with(|letter: char| letter.is_ascii_alphabetic()));
        if is_command {
            let (name, length) = hash_name(word);
            self.commands.push(name);
            return length == word.len();
        }
        let letter = word
            .bytes()
            .next()
            .map(|letter| letter.to_ascii_uppercase());
        let Some(letter @ (b'G' | b'M')) = letter else {
            return false;
        };
        let digits = &word[1..];
        let number = digits.bytes().all(|byte| byte.is_ascii_digit());
        let number = number.then(|| digits.parse().ok()).flatten();
        let number = number.filter(|number| letter == b'M' || !is_followed(*number));
        self.functions.extend(number.map(|number| (letter, number)));
        number.is_some()
    }

    /// Whether a text begins with one of these `#` commands; a command includes all longer ones that begin with it.
    pub fn has_command(&self, text: &str) -> bool {
        if self.commands.is_empty() || !text.starts_with('#') {
            return false;
        }
        let (name, _) = hash_name(text);
        self.commands.iter().any(|known| {
            let rest = name.strip_prefix(known.as_str());
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
        })
    }

    /// Whether a G or M function is one of them.
    pub(crate) fn has_function(&self, letter: u8, number: i64) -> bool {
        self.functions.contains(&(letter, number))
    }

    /// Returns all of them as written.
    pub fn words(&self) -> impl Iterator<Item = String> {
        let functions = self.functions.iter();
        let functions =
            functions.map(|(letter, number)| format!("{}{number}", char::from(*letter)));
        self.commands.iter().cloned().chain(functions)
    }
}

/// Whether a G function takes effect in a dry run, so that it cannot be declared harmless.
fn is_followed(number: i64) -> bool {
    let function = u32::try_from(number).ok().and_then(GFunction::of);
    function.is_some_and(GFunction::is_followed)
}
