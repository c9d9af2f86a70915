//! Plain blocks parsed by hand: `N10 G1 X12.3 Y-4.5 F1500 ; comment`.
//!
//! It yields exactly what the grammar yields, or declines; a property test holds the two together.

use super::ast::{Address, Block, Item, Number, Operand, Word};
use crate::source::Span;

/// Powers of ten that an `f64` holds exactly.
const POWERS: [f64; 16] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
];

/// Powers of ten for the digits that are read at once.
const TENS: [u64; 9] = [
    1,
    10,
    100,
    1_000,
    10_000,
    100_000,
    1_000_000,
    10_000_000,
    100_000_000,
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
    let first = at;
    let mut mantissa = 0;
    at = digits(bytes, at, &mut mantissa);
    let mut count = at - first;
    let mut decimals = 0;
    if bytes.get(at) == Some(&b'.') {
        let end = digits(bytes, at + 1, &mut mantissa);
        decimals = end - at - 1;
        count += decimals;
        at = end;
    }
    if count == 0 || count > 15 {
        return None;
    }
    let power = POWERS[decimals];
    let mantissa = i64::try_from(mantissa).ok()?;
    #[allow(clippy::cast_precision_loss)] // below 10^15
    let value = mantissa as f64 / if negative { -power } else { power };
    Some((value, at))
}

/// Appends digits to a mantissa; returns where they end. The caller refuses what overflows.
fn digits(bytes: &[u8], start: usize, mantissa: &mut u64) -> usize {
    let mut at = start;
    if let Some((eight, _)) = bytes[start..].split_first_chunk() {
        let (value, count) = leading_digits(*eight);
        *mantissa = mantissa.wrapping_mul(TENS[count]).wrapping_add(value);
        at += count;
        if count < eight.len() {
            return at;
        }
    }
    while let Some(&byte @ b'0'..=b'9') = bytes.get(at) {
        *mantissa = mantissa
            .wrapping_mul(10)
            .wrapping_add(u64::from(byte - b'0'));
        at += 1;
    }
    at
}

/// The number that eight bytes begin with, and how many digits it has. All bytes are taken at
/// once: a branch for each digit is guessed wrong too often.
fn leading_digits(eight: [u8; 8]) -> (u64, usize) {
    const ONES: u64 = 0x0101_0101_0101_0101;
    // Digits become 0 to 9, everything else something above.
    let digits = u64::from_le_bytes(eight) ^ (ONES * u64::from(b'0'));
    // The highest bit of each byte above 9; a carry touches only bytes behind the first of them.
    let others = (digits.wrapping_add(ONES * (0x80 - 10)) | digits) & (ONES * 0x80);
    let bits = others.trailing_zeros() / 8 * 8;
    // Zeros in front instead of what stands behind.
    let digits = digits.checked_shl(64 - bits).unwrap_or(0);
    let pairs = (digits * 10 + (digits >> 8)) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs * 100 + (pairs >> 16)) & 0x0000_ffff_0000_ffff;
    let value = (fours * 10_000 + (fours >> 32)) & 0xffff_ffff;
    (value, usize::try_from(bits / 8).unwrap_or(8))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_read_eight_at_once() {
        for (text, value, count) in [
            ("12345678", 12_345_678, 8),
            ("00000001", 1, 8),
            ("123.5 X1", 123, 3),
            ("9 Y12345", 9, 1),
            (" 1234567", 0, 0),
            ("1:;/0123", 1, 1),
            ("42\u{dc}8888", 42, 2),
        ] {
            let eight = *text.as_bytes().first_chunk().expect("eight bytes");
            assert_eq!(leading_digits(eight), (value, count), "{text}");
        }
    }
}
