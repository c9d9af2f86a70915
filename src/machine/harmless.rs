//! Commands of the user's own machine that are declared harmless (R2.70).

use crate::syntax::hash_name;

/// `#` commands and M functions that change no state, no position and no value.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct HarmlessWords {
    /// `#MYCMD ON`, in upper case with one blank between the words.
    commands: Vec<String>,
    /// The numbers of the M functions.
    functions: Vec<i64>,
}

impl HarmlessWords {
    /// Adds a word; `false` when it is neither a `#` command nor an M function.
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
        let number = word.strip_prefix(['M', 'm']);
        let number = number.filter(|digits| digits.bytes().all(|byte| byte.is_ascii_digit()));
        match number.and_then(|digits| digits.parse().ok()) {
            Some(number) => {
                self.functions.push(number);
                true
            }
            None => false,
        }
    }

    /// Whether a text begins with a `#` command that is one of them; one stands for all that
    /// continue it.
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

    /// Whether an M function is one of them.
    pub fn has_function(&self, number: i64) -> bool {
        self.functions.contains(&number)
    }

    /// All of them as they are written.
    pub fn words(&self) -> impl Iterator<Item = String> {
        let functions = self.functions.iter().map(|number| format!("M{number}"));
        self.commands.iter().cloned().chain(functions)
    }
}
