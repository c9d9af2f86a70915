//! Lines that need not mean anything.

use super::Choices;
use super::phrases::{FLOW, PIECES};

/// Makes lines of pieces of any kind, with line ends of any kind.
pub fn any_lines(choices: &mut Choices<'_>) -> String {
    let mut text = String::new();
    for _ in 0..choices.below(12) {
        for _ in 0..choices.below(8) {
            piece(choices, &mut text);
        }
        text += choices.one_of(&["\n", "\n", "\r\n", "\r"]);
    }
    text
}

/// Makes plain words, of which one character is changed or removed.
pub fn plain_line(choices: &mut Choices<'_>) -> String {
    let mut line = String::new();
    for _ in 0..choices.between([1, 5]) {
        letter(choices, &mut line);
        line += choices.one_of(&["", "+", "-"]);
        number(choices, [1, 5], &mut line);
        line += choices.one_of(&["", " "]);
    }
    let at = choices.below(line.len());
    // A tab, a printable character, or nothing.
    let change = choices.below(97);
    let change = match u8::try_from(31 + change).expect("ASCII") {
        31 => "\t".to_owned(),
        127 => String::new(),
        code => char::from(code).to_string(),
    };
    line.replace_range(at..=at, &change);
    line
}

/// Makes plain words, with blanks between them.
pub fn spaced_words(choices: &mut Choices<'_>) -> String {
    let mut line = String::new();
    for _ in 0..choices.between([1, 5]) {
        if choices.chance(25) {
            line.push('N');
            digits(choices, [1, 5], &mut line);
            line.push(' ');
            continue;
        }
        // L calls, and N is a block number.
        line.push(choices.one_of(&b"ABCDEFGHIJKMOPQRSTUVWXYZ".map(char::from)));
        line += choices.one_of(&["", "+", "-"]);
        if choices.chance(50) {
            line.push('.');
            digits(choices, [1, 4], &mut line);
        } else {
            number(choices, [1, 20], &mut line);
        }
        line += choices.one_of(&[" ", "  "]);
    }
    line
}

fn piece(choices: &mut Choices<'_>, text: &mut String) {
    match choices.below(15) {
        0..=3 => {
            letter(choices, text);
            *text += choices.one_of(&["", "-"]);
            number(choices, [0, 4], text);
        }
        4..=6 => {
            for _ in 0..choices.between([1, 2]) {
                *text += choices.one_of(&[" ", "\t"]);
            }
        }
        7..=8 => {
            text.push('N');
            digits(choices, [1, 5], text);
            *text += choices.one_of(&["", ":"]);
        }
        9..=10 => {
            text.push('G');
            digits(choices, [1, 3], text);
        }
        11 => {
            let mut letters = String::new();
            letter(choices, &mut letters);
            *text += &letters.to_lowercase();
            digits(choices, [0, 3], text);
        }
        12..=13 => *text += choices.one_of(PIECES),
        _ => *text += choices.one_of(FLOW),
    }
}

fn letter(choices: &mut Choices<'_>, text: &mut String) {
    text.push(choices.one_of(&b"ABCDEFGHIJKLMNOPQRSTUVWXYZ".map(char::from)));
}

fn digits(choices: &mut Choices<'_>, count: [usize; 2], text: &mut String) {
    for _ in 0..choices.between(count) {
        text.push(choices.one_of(&b"0123456789".map(char::from)));
    }
}

/// Makes digits, and perhaps a point with others.
fn number(choices: &mut Choices<'_>, count: [usize; 2], text: &mut String) {
    digits(choices, count, text);
    if choices.chance(50) {
        text.push('.');
        digits(choices, [0, 4], text);
    }
}
