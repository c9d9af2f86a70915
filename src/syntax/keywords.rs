//! Words that are known by name (R2.70), apart from G functions; those that a `#` command begins with; words in lower case,
//! written in upper case (R1.8). What looks like them and is not
//! listed is FC210.
//!
//! PM/n is page n of the TF5200 programming manual.

use super::ast::{Address, Block, Item, Operand, Word};
use super::parse::Fault;
use super::pieces::is_blank;
use crate::diagnostic::{Code, Fix};
use crate::language::{AxisCommand, FurtherWord, HashAction, HashCommand, HashWords};
use crate::text::Span;

/// The `$` statements.
pub(super) const FLOW_WORDS: [&str; 19] = [
    "$IF",
    "$ELSEIF",
    "$ELSE",
    "$ENDIF",
    "$SWITCH",
    "$CASE",
    "$DEFAULT",
    "$ENDSWITCH",
    "$FOR",
    "$ENDFOR",
    "$WHILE",
    "$ENDWHILE",
    "$DO",
    "$ENDDO",
    "$REPEAT",
    "$UNTIL",
    "$BREAK",
    "$CONTINUE",
    "$GOTO",
];

/// Keywords in the bracket of a spindle, in addition to M, H and G with their numbers (PM/208178187).
const SPINDLE_COMMANDS: [&str; 10] = [
    "REV",
    "POS",
    "CALLAX",
    "PUTAX",
    "GET_DYNAMIC_DATA",
    "GET_DYNAMIK_DATA",
    "FEED_LINK",
    "OVERRIDE",
    "SLOPE_TYPE",
    "SYN",
];

/// Letters of words that are not axes and touch neither flow, parameters, calls nor COMP by themselves,
/// or are followed here (PM/205952267): tool data, feed, G and M functions, H functions, centre and
/// radius of circles, block numbers, spindle speed, tools.
const LETTERS: &[u8] = b"DEFGHIJKMNRST";

/// Words after `S.` (PM/208038923).
const SPINDLE_WORDS: [&str; 2] = ["POS", "OFFSET"];

/// Returns whether a keyword of a spindle's bracket opens a command that is passed over. A number, a parameter or a
/// variable may follow it at once.
pub(super) fn is_spindle_command(word: &str) -> bool {
    let upper = word.to_ascii_uppercase();
    let begins = |known: &str| {
        let rest = upper.strip_prefix(known);
        rest.is_some_and(|rest| {
            !rest.starts_with(|c: char| matches!(c, 'A'..='O' | 'Q'..='U' | 'W'..='Z' | '_'))
        })
    };
    AxisCommand::is_known(word)
        || numbered(&upper, &['G'])
        || SPINDLE_COMMANDS.iter().any(|known| begins(known))
}

/// Returns whether a block is a program number, `O1234`, and nothing else (R2.93): with other words an O is a typing
/// mistake for a zero.
pub(crate) fn is_program_number(block: &Block) -> bool {
    #[allow(clippy::float_cmp)] // whole numbers are exact
    let is_number = |value: f64| value >= 0.0 && value.fract() == 0.0;
    let is_opening = |word: &Word| {
        word.address == Address::Letter(b'O')
            && matches!(word.value, Some(Operand::Number(number)) if is_number(number))
    };
    match (block.words.as_slice(), block.items.as_slice()) {
        ([word], []) | ([], [Item::Word(word)]) => is_opening(word),
        _ => false,
    }
}

/// Returns whether a letter begins words that are known.
pub(crate) fn is_letter(letter: u8) -> bool {
    LETTERS.contains(&letter) || matches!(letter, b'A'..=b'C' | b'Q' | b'U'..=b'Z')
}

/// Returns whether `S.WORD` is known.
pub(super) fn is_spindle_word(word: &str) -> bool {
    SPINDLE_WORDS
        .iter()
        .any(|known| known.eq_ignore_ascii_case(word))
}

/// Returns whether a statement begins with a word of the language, and not with a misspelt one.
pub(crate) fn is_statement(text: &str) -> bool {
    let letters = text.get(1..).unwrap_or_default();
    let length = letters.find(|c: char| !c.is_ascii_alphabetic());
    let word = &letters[..length.unwrap_or(letters.len())];
    FLOW_WORDS
        .iter()
        .any(|known| known[1..].eq_ignore_ascii_case(word))
}

/// Returns whether a word is one of the letters with a number, `M3`.
fn numbered(upper: &str, letters: &[char]) -> bool {
    let number = upper.strip_prefix(letters);
    number.is_some_and(|digits| digits.starts_with(|c: char| c.is_ascii_digit()))
}

/// Returns FC210 for a text that is not known.
pub(crate) fn not_known(text: &str, span: Span) -> Fault {
    let shown: String = text.trim().chars().take(40).collect();
    Fault::new(
        Code::Fc210,
        span,
        format!(
            "`{shown}` is not known to frictcomp; whatever it could change is unknown from here on"
        ),
    )
    .with_help("if the control knows it, check yourself what it does to compensation")
}

/// Returns whether the parts of a name, `V` left out, make a variable: a sign begins only the name of a software limit,
/// `V.A.+SWE.X`, an `@` only what a call gave, `V.G.@P[1].VALID`.
pub(super) fn is_variable<'a>(mut parts: impl Iterator<Item = &'a str>) -> bool {
    let plain = |part: &str| !part.starts_with(['+', '-', '@']);
    let family = parts.next().unwrap_or_default();
    let name = parts.next().unwrap_or_default();
    let is_limit = family.eq_ignore_ascii_case("A") && !name.starts_with('@');
    let is_given = family.eq_ignore_ascii_case("G") && name.starts_with('@');
    plain(family) && (plain(name) || is_limit || is_given) && parts.all(plain)
}

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
    /// Name in upper case with one blank between the words.
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

/// Returns whether an unknown word follows the name of a command, `#HSC ON SOFTLY [1]`, rather than text that looks
/// like an axis.
pub(super) fn goes_on(code: &str, name: &str) -> bool {
    let known = name.split(' ').count();
    let next = words(code).nth(known);
    next.is_some_and(|(word, _)| !word[1..].bytes().all(|byte| byte.is_ascii_digit()))
}

/// Returns the words after the `#`, and where each ends.
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
    /// Words.
    pub(super) name: CommandName,
    /// The text after them.
    pub(super) rest: &'a str,
}

impl OpeningCommand<'_> {
    /// Returns its action, where it is known.
    pub(super) fn action(&self) -> Option<HashAction> {
        self.name.command.map(|command| command.action)
    }

    /// Returns whether nothing follows the words.
    pub(super) fn is_alone(&self) -> bool {
        self.rest.trim_matches(is_blank).is_empty()
    }
}

/// Returns the `#` command at the start of a block, after its number.
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

/// Returns the change that writes words in upper case: the first, and those after it up to a place that may hold
/// something that the parser does not see. A comment or a foreign character is at least two blanks in `code`, a
/// continued line has a line end.
pub(super) fn in_upper_case(code: &str, words: &[Span]) -> Option<Fix<Span>> {
    let (first, others) = words.split_first()?;
    let mut whole = *first;
    let mut text = first.of(code).to_ascii_uppercase();
    for word in others {
        let between = code.get(whole.range().end..word.range().start);
        let Some(between) = between.filter(|it| !it.contains("  ") && !it.contains('\n')) else {
            break;
        };
        text.push_str(between);
        text.push_str(&word.of(code).to_ascii_uppercase());
        whole = whole.to(*word);
    }
    Some(Fix::safe(whole, text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_written_in_upper_case_as_far_as_all_is_seen() {
        let words = |spans: &[(usize, usize)]| -> Vec<Span> {
            let spans = spans.iter();
            spans.map(|(start, end)| Span::new(*start, *end)).collect()
        };
        let fixed = |code: &str, spans| {
            let fix = in_upper_case(code, &words(spans)).expect("a word");
            let mut code = code.to_owned();
            code.replace_range(fix.place.range(), &fix.text);
            code
        };
        assert_eq!(
            fixed("X[COMP on\tfrict]", &[(7, 9), (10, 15)]),
            "X[COMP ON\tFRICT]"
        );
        assert_eq!(fixed("g1 x2", &[(0, 1), (3, 4)]), "G1 X2");
        // There may be a comment.
        assert_eq!(
            fixed("X[COMP on  frict]", &[(7, 9), (11, 16)]),
            "X[COMP ON  frict]"
        );
        assert_eq!(fixed("g1\nx2", &[(0, 1), (3, 4)]), "G1\nx2");
        assert_eq!(in_upper_case("", &[]), None);
    }
}
