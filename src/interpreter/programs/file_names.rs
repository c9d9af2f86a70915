//! `#FILE NAME`: words and the programs that they call (PM/207504523).

use crate::machine::canonical_word;
use crate::syntax::ast::{Argument, Hash};

/// The name of a program after `#FILE NAME`.
pub(crate) enum FileName<'a> {
    /// A literal name.
    Written(&'a str),
    /// The value of a variable, or of something that is not followed.
    Elsewhere(&'a str),
}

/// The letters of the words that may get a program.
const LETTERS: [&str; 4] = ["D", "G", "M", "T"];

/// The words and program names of `[ G80="part.nc" M6 "change.nc" ]`; the equals sign is optional. With any
/// other text, the program of every word is unknown.
pub(crate) fn file_names<'a>(hash: &Hash, text: &'a str) -> Vec<(String, FileName<'a>)> {
    let mut names = Vec::new();
    let mut arguments = hash.brackets.iter();
    while let Some(argument) = arguments.next() {
        let (word, name) = match argument.key {
            Some(word) => (word, Some(argument)),
            None => (argument.span, arguments.next()),
        };
        let word = word.of(text);
        // The file of `#MSG SAVE` (PM/207504523).
        if word.eq_ignore_ascii_case("MSG") {
            continue;
        }
        if !is_word(word) {
            names.extend(LETTERS.map(|letter| (letter.to_owned(), FileName::Elsewhere(word))));
        }
        names.extend(name.map(|name| (canonical_word(word), file_name(name, text))));
    }
    names
}

fn file_name<'a>(argument: &Argument, text: &'a str) -> FileName<'a> {
    match argument.quoted(text) {
        Some(name) => FileName::Written(name.trim()),
        None => FileName::Elsewhere(argument.span.of(text)),
    }
}

fn is_word(word: &str) -> bool {
    let Some((letter, number)) = word.split_at_checked(1) else {
        return false;
    };
    let mut letters = LETTERS.iter();
    letters.any(|known| known.eq_ignore_ascii_case(letter))
        && number.bytes().all(|byte| byte.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::ast::Item;
    use crate::syntax::parse_block;

    #[test]
    fn file_names_are_read_with_and_without_an_equals_sign() {
        // R2.75
        let shown = |bracket: &str| {
            let text = format!("#FILE NAME {bracket}");
            let block = parse_block(&text);
            let Some(Item::Hash(hash)) = block.items.first() else {
                panic!("{text}")
            };
            let names = file_names(hash, &text).into_iter();
            let names = names.map(|(word, name)| match name {
                FileName::Written(name) => format!("{word}={name}"),
                FileName::Elsewhere(name) => format!("{word}?{name}"),
            });
            names.collect::<Vec<_>>().join(" ")
        };
        let text = " [ G080=\"a b.nc\" m06 \"c.nc\",T = \"\" D=V.P.NAME ]";
        assert_eq!(shown(text), "G80=a b.nc M6=c.nc T= D?V.P.NAME");
        assert_eq!(shown(""), "");
        assert_eq!(shown("[M6=\"a.nc\" / ]"), "M6=a.nc D?/ G?/ M?/ T?/");
        assert_eq!(shown("[FOO=\"a.nc\"]"), "D?FOO G?FOO M?FOO T?FOO FOO=a.nc");
    }
}
