//! `#FILE NAME`: words and the programs that they call (PM/207504523).

/// Whether a command names programs; the older manuals write one word.
pub(in crate::interpreter) fn is_file_name(name: &str) -> bool {
    matches!(name, "#FILE NAME" | "#FILENAME")
}

/// The words that get a program after `#FILE NAME`.
pub(in crate::interpreter) fn named_words(text: &str) -> impl Iterator<Item = String> {
    file_names(text).into_iter().map(|(word, _)| word)
}

/// The name of a program after `#FILE NAME`.
pub(in crate::interpreter) enum FileName<'a> {
    /// A literal name.
    Written(&'a str),
    /// The value of a variable, or of something that is not followed.
    Elsewhere(&'a str),
}

/// The letters of the words that may get a program.
const LETTERS: [&str; 4] = ["D", "G", "M", "T"];

/// The words and program names of `[ G80="part.nc" M6 "change.nc" ]`; the equals sign is optional. With any
/// other text, the program of every word is unknown.
pub(in crate::interpreter) fn file_names(text: &str) -> Vec<(String, FileName<'_>)> {
    let mut names = Vec::new();
    let mut rest = text.trim_start().strip_prefix('[').unwrap_or(text);
    loop {
        rest = rest.trim_start_matches([' ', '\t', '\r', '\n', ',']);
        let length = rest
            .find(|c: char| !c.is_ascii_alphanumeric() && c != '_')
            .unwrap_or(rest.len());
        if length == 0 {
            if !rest.is_empty() && !rest.starts_with(']') {
                names.extend(unknown_words(rest));
            }
            return names;
        }
        let (word, after) = rest.split_at(length);
        if !is_word(word) {
            names.extend(unknown_words(word));
        }
        let after = after.trim_start();
        let after = after.strip_prefix('=').unwrap_or(after).trim_start();
        let word = crate::machine::canonical_word(word);
        if let Some((name, after)) = after.strip_prefix('"').and_then(|it| it.split_once('"')) {
            names.push((word, FileName::Written(name.trim())));
            rest = after;
        } else {
            let end = after
                .find([' ', '\t', '\n', ']', ','])
                .unwrap_or(after.len());
            names.push((word, FileName::Elsewhere(&after[..end])));
            rest = &after[end..];
        }
    }
}

fn unknown_words(text: &str) -> impl Iterator<Item = (String, FileName<'_>)> {
    LETTERS
        .map(|letter| (letter.to_owned(), FileName::Elsewhere(text.trim())))
        .into_iter()
}

fn is_word(word: &str) -> bool {
    let (letter, number) = word.split_at(1);
    LETTERS.contains(&letter.to_ascii_uppercase().as_str())
        && number.bytes().all(|byte| byte.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_names_are_read_with_and_without_an_equals_sign() {
        // R2.75
        let shown = |text| {
            let names = file_names(text).into_iter();
            let names = names.map(|(word, name)| match name {
                FileName::Written(name) => format!("{word}={name}"),
                FileName::Elsewhere(name) => format!("{word}?{name}"),
            });
            names.collect::<Vec<_>>().join(" ")
        };
        let text = " [ G080=\"a b.nc\" m06 \"c.nc\",T = \"\" D=V.P.NAME ]";
        assert_eq!(shown(text), "G80=a b.nc M6=c.nc T= D?V.P.NAME");
        assert_eq!(shown(""), "");
        assert_eq!(shown("[G80=\"open"), "G80?\"open");
        assert_eq!(
            shown("[M6=\"a.nc\" / T]"),
            "M6=a.nc D?/ T] G?/ T] M?/ T] T?/ T]"
        );
        assert_eq!(shown("[FOO=\"a.nc\"]"), "D?FOO G?FOO M?FOO T?FOO FOO=a.nc");
    }
}
