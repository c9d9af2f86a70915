//! Choices of a generator: those of a seed, or those that bytes make.

use crate::Random;

/// Choices that are the same for the same seed or the same bytes.
#[derive(Debug, Clone)]
pub struct Choices<'a> {
    source: Source<'a>,
}

#[derive(Debug, Clone)]
enum Source<'a> {
    /// Random numbers, of which so many are left.
    Seed(Random, usize),
    /// A byte for each choice, so that a fuzzer that changes one byte changes one choice.
    Bytes(&'a [u8]),
}

impl Choices<'static> {
    /// Makes the choices of a seed, without end.
    pub fn of_seed(seed: u64) -> Self {
        Self::limited(seed, usize::MAX)
    }

    /// Makes a number of choices of a seed, after which every choice is the first option.
    pub fn limited(seed: u64, count: usize) -> Self {
        Self {
            source: Source::Seed(Random::new(seed), count),
        }
    }
}

impl<'a> Choices<'a> {
    /// Makes a choice of each byte, after which every choice is the first option.
    pub fn of_bytes(bytes: &'a [u8]) -> Self {
        Self {
            source: Source::Bytes(bytes),
        }
    }

    /// Returns whether every further choice would be the first option.
    pub fn is_used_up(&self) -> bool {
        matches!(self.source, Source::Seed(_, 0) | Source::Bytes([]))
    }

    /// Returns a number below `count`, which is at most 256 for choices of bytes; below 1 nothing is chosen.
    pub fn below(&mut self, count: usize) -> usize {
        match &mut self.source {
            _ if count < 2 => 0,
            Source::Seed(_, 0) | Source::Bytes([]) => 0,
            Source::Seed(random, left) => {
                *left -= 1;
                let high = usize::try_from(random.bits() >> 33).expect("31 bits");
                high % count
            }
            Source::Bytes(bytes) => {
                let byte = usize::from(bytes[0]);
                *bytes = &bytes[1..];
                byte % count
            }
        }
    }

    /// Returns a number between two others, both of which it may be.
    pub fn between(&mut self, [least, most]: [usize; 2]) -> usize {
        least + self.below(most - least + 1)
    }

    /// Returns one of several options.
    pub fn one_of<T: Copy>(&mut self, options: &[T]) -> T {
        options[self.below(options.len())]
    }

    /// Returns one of several options, each as often as its weight says.
    pub fn weighted<T: Copy>(&mut self, options: &[(T, usize)]) -> T {
        let mut at = self.below(options.iter().map(|(_, weight)| weight).sum());
        for (option, weight) in options {
            if at < *weight {
                return *option;
            }
            at -= weight;
        }
        options[0].0
    }

    /// Returns whether one of a hundred options is among the last `percent`.
    pub fn chance(&mut self, percent: usize) -> bool {
        self.below(100) >= 100 - percent
    }

    /// Returns a number from 0 to 1.
    pub fn share(&mut self) -> f64 {
        let high = self.below(256);
        let number = u32::try_from(high * 256 + self.below(256)).expect("two bytes");
        f64::from(number) / 65535.0
    }
}
