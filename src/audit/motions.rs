//! The selection at every motion of a run, so that two runs can be compared (R10.8).

use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use super::scope::Selected;
use crate::interpreter::PossibleStates;

/// Number of changes kept individually; for the rest only a fingerprint is compared.
const MOST: usize = 4096;

/// The selection at a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stood {
    pub(super) selected: Selected,
    /// A digest of the ways to each state, if more than one is possible.
    pub(super) ways: u64,
}

impl Stood {
    /// The selection of a subject, with its possible states if there are several.
    pub(super) fn new(selected: Selected, possible: Option<&PossibleStates>) -> Self {
        let mut digest = DefaultHasher::new();
        if let Some(possible) = possible {
            // Inserted blocks shift the lines.
            possible.without_lines().hash(&mut digest);
        }
        Self {
            selected,
            ways: possible.map_or(0, |_| digest.finish()),
        }
    }
}

/// The selection of one kind on one axis at every motion, in the order of the run.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct SelectionAtMotions {
    stretches: Vec<(Stood, u64)>,
    /// A digest of the changes that are not kept.
    rest: u64,
}

impl SelectionAtMotions {
    #[inline]
    pub(super) fn note(&mut self, stood: Stood) {
        match self.stretches.last_mut() {
            Some((last, count)) if *last == stood && self.rest == 0 => *count += 1,
            _ => self.change(stood),
        }
    }

    #[inline(never)]
    fn change(&mut self, stood: Stood) {
        if self.rest == 0 && self.stretches.len() < MOST {
            self.stretches.push((stood, 1));
            return;
        }
        // FNV-1a.
        let step = self.rest ^ stood.selected.digit() ^ stood.ways;
        self.rest = step.wrapping_mul(0x0100_0000_01b3).max(1);
    }

    /// Whether every motion of another run has the same selection as in this one, or the wanted
    /// one.
    pub(super) fn only_become(&self, after: &Self, wanted: Selected) -> bool {
        if self == after {
            return true;
        }
        if self.rest != 0 || after.rest != 0 {
            return false;
        }
        let (mut before, mut after) = (self.stretches.iter(), after.stretches.iter());
        let (mut old, mut new) = (before.next().copied(), after.next().copied());
        loop {
            let (Some((was, left)), Some((is, more))) = (old, new) else {
                return old.is_none() && new.is_none();
            };
            if was != is && is.selected != wanted {
                return false;
            }
            let common = left.min(more);
            let rest = |of: Stood, count: u64| (count > common).then(|| (of, count - common));
            old = rest(was, left).or_else(|| before.next().copied());
            new = rest(is, more).or_else(|| after.next().copied());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> SelectionAtMotions {
        let mut motions = SelectionAtMotions::default();
        for letter in text.chars() {
            let selected = match letter {
                '1' => Selected::On,
                '0' => Selected::Off,
                _ => Selected::Unknown,
            };
            motions.note(Stood::new(selected, None));
        }
        motions
    }

    #[test]
    fn motions_may_only_become_what_is_wanted() {
        // R10.8
        for (before, after, only) in [
            ("", "", true),
            ("1100", "1100", true),
            ("1100", "1111", true),
            ("0?0", "1?1", true),
            ("1100", "1000", false),
            ("110", "1100", false),
            ("11", "1?", false),
        ] {
            let found = of(before).only_become(&of(after), Selected::On);
            assert_eq!(found, only, "{before} {after}");
        }
    }
}
