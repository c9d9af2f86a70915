//! Plain blocks parsed by hand: `N10 G1 X12.3 Y-4.5 F1500 ; comment`.
//!
//! It yields exactly what the grammar yields, or declines; a property test holds the two together.

use super::ast::{Address, Block, BlockNumber, Operand, Word};
use super::raw::{Comments, MAX_LINE};
use crate::text::Span;

/// Powers of ten that an `f64` holds exactly, and their negatives.
const POWERS: [[f64; 16]; 2] = [
    [
        1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
    ],
    [
        -1e0, -1e1, -1e2, -1e3, -1e4, -1e5, -1e6, -1e7, -1e8, -1e9, -1e10, -1e11, -1e12, -1e13,
        -1e14, -1e15,
    ],
];

/// A one in each of eight bytes.
const ONES: u64 = 0x0101_0101_0101_0101;

/// A line that is plain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plain {
    /// Bytes without the line end.
    pub(super) length: usize,
    pub(super) comments: Comments,
}

/// Parses the first line of a text into an empty block. Declines, with the block empty, whatever is
/// not plain: only upper-case letters with a number after each, blanks, and one comment per place.
#[inline]
pub(super) fn parse(text: &str, block: &mut Block) -> Option<Plain> {
    let bytes = text.as_bytes();
    let plain = words(&bytes[..bytes.len().min(MAX_LINE + 1)], block);
    if plain.is_none() {
        block.clear();
    }
    plain
}

fn words(bytes: &[u8], block: &mut Block) -> Option<Plain> {
    let mut at = 0;
    let mut comments = Comments::Absent;
    while let Some(&byte) = bytes.get(at) {
        if is_blank(byte) {
            at += 1;
        } else if byte == b'N' {
            at = block_number(bytes, at, block)?;
        } else if is_address(byte) {
            at = words_in_a_row(bytes, at, block)?;
        } else if is_line_end(byte) {
            break;
        } else {
            comments = Comments::Possible;
            at = comment(bytes, at)?;
        }
    }
    let is_block = block.number.is_some() || !block.words.is_empty();
    (is_block && at <= MAX_LINE).then_some(Plain {
        length: at,
        comments,
    })
}

/// Takes the block number at a place and returns where it ends. One that has a sign, or
/// follows anything, is left to the grammar.
#[inline]
fn block_number(bytes: &[u8], start: usize, block: &mut Block) -> Option<usize> {
    let first = block.number.is_none() && block.words.is_empty();
    if !first || !bytes.get(start + 1)?.is_ascii_digit() {
        return None;
    }
    let digits = digits(bytes, start + 1)?;
    let end = start + 1 + digits.length;
    block.number = Some(BlockNumber {
        value: Operand::Number(whole(digits.mantissa) / POWERS[0][digits.decimals]),
        label: false,
        span: span(start, end),
    });
    Some(end)
}

/// Appends the word at a place and those after it, as long as at most one blank separates them;
/// returns where the last one ends. What is glued to its number, or continues it as an expression,
/// begins neither a word nor a comment and is declined there.
///
/// The letters show where words begin before their numbers are read, so that the processor need not
/// wait for the end of one number to begin with the next.
#[inline]
fn words_in_a_row(bytes: &[u8], start: usize, block: &mut Block) -> Option<usize> {
    let mut letters = letters(&bytes[start..]);
    let (mut at, mut letter) = (start, bytes[start]);
    loop {
        letters &= letters.wrapping_sub(1);
        let next = start + letters.trailing_zeros() as usize;
        let (value, end) = number(bytes, at + 1)?;
        block.words.push(Word {
            address: Address::Letter(letter),
            value: Some(Operand::Number(value)),
            span: span(at, end),
        });
        match bytes.get(end..=next) {
            Some(&([found] | [b' ', found])) if is_address(found) => (at, letter) = (next, found),
            _ => return Some(end),
        }
    }
}

/// Returns the places of letters among the next 40 bytes, a bit each, the first one lowest: of the bytes of words only
/// letters have their seventh bit set. None near the end of the text.
#[inline]
fn letters(bytes: &[u8]) -> u64 {
    let Some(window) = bytes.first_chunk::<40>() else {
        return 0;
    };
    let (eights, _) = window.as_chunks::<8>();
    let bits = eights.iter().map(|eight| seventh_bits(*eight));
    bits.rev().fold(0, |letters, bits| letters << 8 | bits)
}

/// Returns the seventh bit of each of eight bytes, the first one lowest.
#[inline]
fn seventh_bits(eight: [u8; 8]) -> u64 {
    let bits = (u64::from_le_bytes(eight) >> 6) & ONES;
    // Gathers one bit of each byte in the highest one.
    bits.wrapping_mul(0x0102_0408_1020_4080) >> 56
}

/// Returns a span in a line, which has at most [`MAX_LINE`] bytes.
#[inline]
#[allow(clippy::cast_possible_truncation)]
fn span(start: usize, end: usize) -> Span {
    Span {
        start: start as u32,
        end: end as u32,
    }
}

/// Returns the end of the comment at a place; a comment that holds another is not plain.
fn comment(bytes: &[u8], start: usize) -> Option<usize> {
    let rest = &bytes[start..];
    let line_end = memchr::memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
    // Characters that change the direction of a text begin with one of these (R9.94).
    if memchr::memchr2(0xd8, 0xe2, &rest[..line_end]).is_some() {
        return None;
    }
    match rest[0] {
        b';' => Some(start + line_end),
        b'(' => {
            let inside = &rest[1..line_end];
            let length = memchr::memchr2(b'(', b')', inside)?;
            (inside[length] == b')').then_some(start + length + 2)
        }
        _ => None,
    }
}

fn is_line_end(byte: u8) -> bool {
    byte == b'\n' || byte == b'\r'
}

/// Returns whether a letter begins a word that is plain: calls, parameters and block numbers do not, nor does E, which
/// may look like an exponent.
#[inline]
fn is_address(byte: u8) -> bool {
    ADDRESSES[usize::from(byte)]
}

/// The answer for each byte: one look instead of several comparisons for each word.
static ADDRESSES: [bool; 256] = {
    let mut table = [false; 256];
    let mut byte = b'A';
    while byte <= b'Z' {
        table[byte as usize] = !matches!(byte, b'E' | b'L' | b'N' | b'P');
        byte += 1;
    }
    table
};

fn is_blank(byte: u8) -> bool {
    byte == b' ' || byte == b'\t'
}

/// Returns a number with an optional sign: its value and where it ends. At most 15 digits, which an `f64` holds
/// exactly, so that the quotient is the nearest `f64` as in the grammar's path.
#[inline]
fn number(bytes: &[u8], start: usize) -> Option<(f64, usize)> {
    let sign = *bytes.get(start)?;
    let first = start + usize::from(matches!(sign, b'-' | b'+'));
    let digits = digits(bytes, first)?;
    // A table for the sign: a branch on it is guessed wrong too often.
    let power = POWERS[usize::from(sign == b'-')][digits.decimals];
    let value = whole(digits.mantissa) / power;
    Some((value, first + digits.length))
}

/// Returns the digits that begin at a place: at once where they are few, as most are.
#[expect(
    clippy::inline_always,
    reason = "half the time of a plain block goes by in here"
)]
#[inline(always)]
fn digits(bytes: &[u8], start: usize) -> Option<Digits> {
    match short_digits(eight_bytes(bytes, start)?) {
        Some(digits) => Some(digits),
        None => long_digits(&bytes[start..]),
    }
}

/// Returns a whole number below 2^52, exactly. A conversion by `as` waits on some processors for the division of the
/// number before.
#[inline]
fn whole(number: u64) -> f64 {
    const TWO_TO_52: f64 = 4_503_599_627_370_496.0;
    f64::from_bits(TWO_TO_52.to_bits() | number) - TWO_TO_52
}

/// The digits of a number, without its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Digits {
    /// The digits as one whole number, below 10^15.
    mantissa: u64,
    /// Number of digits after the point.
    decimals: usize,
    /// The bytes of the number.
    length: usize,
}

/// Returns the eight bytes that begin at a place, the first one lowest; zeros after the end of the text.
#[inline]
fn eight_bytes(bytes: &[u8], start: usize) -> Option<u64> {
    let rest = bytes.get(start..)?;
    match rest.first_chunk() {
        Some(eight) => Some(u64::from_le_bytes(*eight)),
        None => last_bytes(bytes, rest),
    }
}

/// Returns the eight bytes of a rest of less than eight, followed by zeros.
#[cold]
fn last_bytes(bytes: &[u8], rest: &[u8]) -> Option<u64> {
    if let Some(last) = bytes.last_chunk::<8>() {
        // `rest` is shorter than eight bytes; the bytes before it are shifted out.
        let before = 8 - rest.len();
        return u64::from_le_bytes(*last).checked_shr(u32::try_from(before).ok()? * 8);
    }
    let mut eight = [0; 8];
    eight[..rest.len()].copy_from_slice(rest);
    Some(u64::from_le_bytes(eight))
}

/// Returns the digits that eight bytes begin with, when another byte shows where they end. All bytes are taken at once:
/// a branch for each digit is guessed wrong too often.
#[inline]
fn short_digits(eight: u64) -> Option<Digits> {
    // Digits become 0 to 9, everything else something above.
    let digits = eight ^ (ONES * u64::from(b'0'));
    // The highest bit of each byte above 9; what a byte beyond ASCII carries only reaches bytes after it.
    let others = (digits.wrapping_add(ONES * (0x80 - 10)) | digits) & (ONES * 0x80);
    let whole = others.trailing_zeros() & !7;
    if whole == u64::BITS {
        return None;
    }
    let (digits, count, length) = if (eight >> whole) & 0xff == u64::from(b'.') {
        let end = (others & (others - 1)).trailing_zeros() & !7;
        if end == u64::BITS {
            return None;
        }
        // The digits after the point move over it.
        let before = (1 << whole) - 1;
        ((digits & before) | ((digits >> 8) & !before), end - 8, end)
    } else {
        (digits, whole, whole)
    };
    let mantissa = match count {
        0 => return None,
        // Zeros before the digits instead of the bytes after them.
        count => eight_digits(digits << (u64::BITS - count)),
    };
    Some(Digits {
        mantissa,
        decimals: usize::try_from((count - whole) / 8).ok()?,
        length: usize::try_from(length / 8).ok()?,
    })
}

/// Returns the number that eight digits make, the first one in the lowest byte.
#[inline]
fn eight_digits(digits: u64) -> u64 {
    let pairs = (digits * 10 + (digits >> 8)) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs * 100 + (pairs >> 16)) & 0x0000_ffff_0000_ffff;
    (fours * 10_000 + (fours >> 32)) & 0xffff_ffff
}

/// Returns the digits that bytes begin with, one after another; `None` where there are none or too many.
#[inline(never)]
fn long_digits(bytes: &[u8]) -> Option<Digits> {
    let mut mantissa = 0_u64;
    let mut point = None;
    let mut length = 0;
    for byte in bytes {
        match byte {
            b'0'..=b'9' => {
                mantissa = mantissa
                    .wrapping_mul(10)
                    .wrapping_add(u64::from(byte - b'0'));
            }
            b'.' if point.is_none() => point = Some(length),
            _ => break,
        }
        length += 1;
    }
    let count = length - usize::from(point.is_some());
    (1..=15).contains(&count).then_some(Digits {
        mantissa,
        decimals: point.map_or(0, |point| length - point - 1),
        length,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_numbers_are_read_at_once_as_the_long_ones_are() {
        for text in [
            "1234567",
            "0000001",
            "123.5 X1",
            "9 Y12345",
            "1:;/0123",
            "42\u{dc}8888",
            "1.",
            "1.;",
            ".5",
            ".5 X1.25",
            "12.345 Y",
            "-75",
            " 1234567",
            ".",
            ". X",
            "X",
            "1..5",
            "104.434",
            "104.4345",
            "12345678",
            "1234567.",
            "1.2.3 X",
            "5(1)",
            "0.000001",
        ] {
            let all = text.as_bytes();
            let padded = [b"N10 G01 X", all].concat();
            let eight = eight_bytes(&padded, 9).expect("inside the line");
            assert_eq!(
                eight,
                eight_bytes(all, 0).expect("inside the line"),
                "{text}"
            );
            let long = long_digits(all);
            match short_digits(eight) {
                Some(digits) => assert_eq!(Some(digits), long, "{text}"),
                None => assert!(long.is_none_or(|digits| digits.length > 7), "{text}"),
            }
        }
    }

    #[test]
    fn more_digits_than_a_float_holds_are_declined() {
        assert!(long_digits(b"123456789012345").is_some());
        assert!(long_digits(b"1234567890123.456").is_none());
        assert!(long_digits(&[b'9'; 400]).is_none());
    }
}
