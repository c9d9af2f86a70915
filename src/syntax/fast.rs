//! Plain blocks parsed by hand: `N10 G1 X12.3 Y-4.5 F1500 ; comment`.
//!
//! It yields exactly what the grammar yields, or declines; a property test holds the two together.

use super::ast::{Address, Block, Item, Number, Operand, Word};
use crate::source::Span;

/// Powers of ten that an `f64` holds exactly.
const POWERS: [f64; 16] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
];

/// Parses a line into an empty block. Declines, with the block empty, whatever is not plain: only
/// upper-case letters with a number behind each, blanks, and one comment per place.
pub(super) fn parse(line: &str, block: &mut Block) -> bool {
    let plain = words(line.as_bytes(), block);
    if !plain {
        block.clear();
    }
    plain
}

fn words(bytes: &[u8], block: &mut Block) -> bool {
    let mut at = 0;
    let mut number_may_follow = false;
    loop {
        match bytes.get(at) {
            None | Some(b';') => break,
            Some(b' ' | b'\t') => at += 1,
            Some(b'(') => match memchr::memchr2(b'(', b')', &bytes[at + 1..]) {
                Some(length) if bytes[at + 1 + length] == b')' => at += length + 2,
                _ => return false,
            },
            Some(letter) if letter.is_ascii_uppercase() => {
                let Some((value, end)) = number(bytes, at + 1) else {
                    return false;
                };
                let span = Span::new(at, end);
                match letter {
                    b'N' if block.number.is_none() && block.items.is_empty() => {
                        if !bytes[at + 1].is_ascii_digit() && bytes[at + 1] != b'.' {
                            return false;
                        }
                        block.number = Some(Number {
                            value: Operand::Number(value),
                            label: false,
                            span,
                        });
                        number_may_follow = true;
                    }
                    // A call, a parameter or a second number: the grammar's business.
                    b'L' | b'P' | b'N' => return false,
                    _ => block.items.push(Item::Word(Word {
                        address: Address::Letter(*letter),
                        value: Some(Operand::Number(value)),
                        span,
                    })),
                }
                at = end;
                // What is glued to the number, or continues it as an expression, is not plain.
                match bytes.get(at) {
                    Some(byte) if !is_separator(*byte) => return false,
                    _ => {}
                }
            }
            Some(_) => return false,
        }
    }
    number_may_follow || !block.items.is_empty()
}

fn is_separator(byte: u8) -> bool {
    byte.is_ascii_uppercase() || matches!(byte, b' ' | b'\t' | b';' | b'(')
}

/// A number with an optional sign: its value and where it ends. At most 15 digits, which an `f64`
/// holds exactly, so that the quotient is the nearest `f64` as in the grammar's path.
fn number(bytes: &[u8], start: usize) -> Option<(f64, usize)> {
    let (negative, mut at) = match bytes.get(start)? {
        b'-' => (true, start + 1),
        b'+' => (false, start + 1),
        _ => (false, start),
    };
    let mut mantissa = 0_u64;
    let mut digits = 0_usize;
    let mut decimals = None;
    while let Some(&byte) = bytes.get(at) {
        match byte {
            b'0'..=b'9' => {
                mantissa = mantissa * 10 + u64::from(byte - b'0');
                digits += 1;
                if digits > 15 {
                    return None;
                }
                decimals = decimals.map(|count: usize| count + 1);
            }
            b'.' if decimals.is_none() => decimals = Some(0),
            _ => break,
        }
        at += 1;
    }
    if digits == 0 {
        return None;
    }
    #[allow(clippy::cast_precision_loss)] // below 10^15
    let value = mantissa as f64 / POWERS[decimals.unwrap_or_default()];
    Some((if negative { -value } else { value }, at))
}
