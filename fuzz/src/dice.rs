//! Decisions from bytes: the same bytes give the same decisions, and a fuzzer that changes one byte
//! changes one decision.

/// Bytes that decide. When they are used up, every decision takes the first option.
#[derive(Debug)]
pub struct Dice<'a> {
    bytes: &'a [u8],
}

impl<'a> Dice<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    /// Whether every further decision would take the first option.
    pub fn is_used_up(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Returns a number below `count`, which is at most 256.
    pub fn below(&mut self, count: usize) -> usize {
        match self.bytes.split_first() {
            Some((&byte, rest)) => {
                self.bytes = rest;
                usize::from(byte) % count.max(1)
            }
            None => 0,
        }
    }

    pub fn one_of<'b>(&mut self, words: &[&'b str]) -> &'b str {
        let place = self.below(words.len());
        words[place]
    }

    /// Returns a number from 0 to 1.
    pub fn share(&mut self) -> f64 {
        let high = self.below(256);
        let number = u32::try_from(high * 256 + self.below(256)).expect("two bytes");
        f64::from(number) / 65535.0
    }
}

/// Returns the bytes of the input with this number, in a fixed sequence of inputs.
pub fn numbered(number: u64, length: usize) -> Vec<u8> {
    let mut state = number;
    let mut bytes = Vec::with_capacity(length + 8);
    while bytes.len() < length {
        // SplitMix64, whose successive seeds give independent numbers.
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut word = state ^ number.rotate_left(32);
        word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bytes.extend((word ^ (word >> 31)).to_le_bytes());
    }
    bytes.truncate(length);
    bytes
}
