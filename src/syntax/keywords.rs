//! Words that are known by name (R2.70), apart from `#` commands and G functions. What looks like them and is not
//! listed is FC210.
//!
//! PM/n is page n of the TF5200 programming manual.

use super::ast::{Address, Block, Item, Operand, Word};
use super::fault::Fault;
use crate::diagnostic::Code;
use crate::language::AxisCommand;
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

/// Whether a keyword of a spindle's bracket opens a command that is passed over. A number, a
/// parameter or a variable may follow it at once.
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

/// Whether a block is a program number, `O1234`, and nothing else (R2.93): with other words an O is a
/// typing mistake for a zero.
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

/// Whether a letter begins words that are known.
pub(crate) fn is_letter(letter: u8) -> bool {
    LETTERS.contains(&letter) || matches!(letter, b'A'..=b'C' | b'Q' | b'U'..=b'Z')
}

/// Whether `S.WORD` is known.
pub(super) fn is_spindle_word(word: &str) -> bool {
    SPINDLE_WORDS
        .iter()
        .any(|known| known.eq_ignore_ascii_case(word))
}

/// Whether a statement begins with a word of the language, and not with a misspelt one.
pub(crate) fn is_statement(text: &str) -> bool {
    let letters = text.get(1..).unwrap_or_default();
    let length = letters.find(|c: char| !c.is_ascii_alphabetic());
    let word = &letters[..length.unwrap_or(letters.len())];
    FLOW_WORDS
        .iter()
        .any(|known| known[1..].eq_ignore_ascii_case(word))
}

/// A letter with a number, `M3`.
fn numbered(upper: &str, letters: &[char]) -> bool {
    let number = upper.strip_prefix(letters);
    number.is_some_and(|digits| digits.starts_with(|c: char| c.is_ascii_digit()))
}

/// FC210 for a text.
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

/// Whether the parts of a name, `V` left out, make a variable: a sign begins only the name of a
/// software limit, `V.A.+SWE.X`, an `@` only what a call gave, `V.G.@P[1].VALID`.
pub(super) fn is_variable<'a>(mut parts: impl Iterator<Item = &'a str>) -> bool {
    let plain = |part: &str| !part.starts_with(['+', '-', '@']);
    let family = parts.next().unwrap_or_default();
    let name = parts.next().unwrap_or_default();
    let is_limit = family.eq_ignore_ascii_case("A") && !name.starts_with('@');
    let is_given = family.eq_ignore_ascii_case("G") && name.starts_with('@');
    plain(family) && (plain(name) || is_limit || is_given) && parts.all(plain)
}
