//! UTF-16 while it is read: two bytes per letter become UTF-8, piece by piece.

use std::borrow::Cow;

/// Encoding of the bytes of a file.
#[derive(Debug, Default)]
pub(super) enum Letters {
    /// Too few bytes to decide.
    #[default]
    Unknown,
    /// One byte per letter or UTF-8: unchanged.
    Narrow,
    /// UTF-16.
    Wide(Wide),
}

/// UTF-16 with the rest of a piece.
#[derive(Debug)]
pub(super) struct Wide {
    to_u16: fn([u8; 2]) -> u16,
    odd: Option<u8>,
    high: Option<u16>,
}

/// The mark of UTF-8.
const MARK: [u8; 3] = [0xef, 0xbb, 0xbf];

impl Letters {
    /// Examines the beginning of a file; returns the number of its bytes that are a mark.
    pub(super) fn begin(&mut self, first: &[u8]) -> usize {
        let wide = |to_u16| {
            Self::Wide(Wide {
                to_u16,
                odd: None,
                high: None,
            })
        };
        let (letters, mark) = match first {
            [0xff, 0xfe, ..] => (wide(u16::from_le_bytes), 2),
            [0xfe, 0xff, ..] => (wide(u16::from_be_bytes), 2),
            // Without a mark: every second byte of plain letters is 0.
            [low, 0, next, 0, ..] if *low != 0 && *next != 0 => (wide(u16::from_le_bytes), 0),
            [0, low, 0, next, ..] if *low != 0 && *next != 0 => (wide(u16::from_be_bytes), 0),
            _ if first.starts_with(&MARK) => (Self::Narrow, MARK.len()),
            _ => (Self::Narrow, 0),
        };
        *self = letters;
        mark
    }

    /// Returns the next piece with one byte per letter, or UTF-8.
    pub(super) fn narrow<'a>(&mut self, piece: &'a [u8]) -> Cow<'a, [u8]> {
        match self {
            Self::Wide(wide) => Cow::Owned(wide.narrow(piece)),
            _ => Cow::Borrowed(piece),
        }
    }
}

impl Wide {
    fn narrow(&mut self, piece: &[u8]) -> Vec<u8> {
        let mut out = Vec::with_capacity(piece.len() / 2 + 4);
        for &byte in piece {
            let Some(first) = self.odd.take() else {
                self.odd = Some(byte);
                continue;
            };
            let unit = (self.to_u16)([first, byte]);
            let units = self.high.take().into_iter().chain([unit]);
            let mut letters = char::decode_utf16(units).peekable();
            while let Some(letter) = letters.next() {
                match letter {
                    Ok(letter) => out.extend(letter.encode_utf8(&mut [0; 4]).as_bytes()),
                    Err(half) if letters.peek().is_none() && is_high(half.unpaired_surrogate()) => {
                        self.high = Some(half.unpaired_surrogate());
                    }
                    Err(_) => out.extend("\u{fffd}".as_bytes()),
                }
            }
        }
        out
    }
}

fn is_high(unit: u16) -> bool {
    (0xd800..0xdc00).contains(&unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_letters_may_be_cut_anywhere() {
        // R6.1
        let text = "x [µm];𝛿;ü\n";
        let bytes: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        for cut in 0..bytes.len() {
            let mut letters = Letters::default();
            letters.begin(&bytes);
            let (one, other) = bytes.split_at(cut);
            let mut all = letters.narrow(one).into_owned();
            all.extend(letters.narrow(other).as_ref());
            assert_eq!(String::from_utf8(all).unwrap(), text, "{cut}");
        }
    }
}
