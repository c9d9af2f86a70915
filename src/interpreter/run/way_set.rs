//! Sets of ways on which something holds: conditions that only the machine knows, and their answers (R14.2).

use serde::{Deserialize, Serialize};

/// Ways beyond which conditions are left out, which only widens (R14.3).
const MAX_WAYS: usize = 16;

/// Conditions of one way beyond which the first ones are left out, which only widens.
const MAX_CONDITIONS: usize = 32;

/// An answer to a condition, or several possible answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct WayAnswer {
    /// The condition, by its number in the run.
    pub(crate) condition: u32,
    /// The answers that are possible, a bit each.
    pub(crate) sides: u64,
    /// Number of answers to the condition.
    pub(crate) of: u8,
}

impl WayAnswer {
    fn is_any(self) -> bool {
        self.sides.count_ones() >= u32::from(self.of)
    }
}

/// Answers that hold together, by the number of their condition.
pub(crate) type Way = Vec<WayAnswer>;

/// The ways on which something holds: on any of them, and on no other.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct WaySet(Vec<Way>);

impl Default for WaySet {
    fn default() -> Self {
        Self::always()
    }
}

impl WaySet {
    /// Every way.
    pub(crate) fn always() -> Self {
        Self(vec![Vec::new()])
    }

    /// No way.
    pub(crate) fn never() -> Self {
        Self(Vec::new())
    }

    /// The ways on which a condition has an answer.
    pub(crate) fn of(answer: WayAnswer) -> Self {
        if answer.is_any() {
            Self::always()
        } else {
            Self(vec![vec![answer]])
        }
    }

    pub(crate) fn is_always(&self) -> bool {
        self.0.iter().any(Vec::is_empty)
    }

    pub(crate) fn is_never(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn ways(&self) -> &[Way] {
        &self.0
    }

    /// The conditions that the ways name.
    pub(crate) fn conditions(&self) -> impl Iterator<Item = u32> {
        self.0.iter().flatten().map(|answer| answer.condition)
    }

    /// The number of pairs of its answers.
    pub(crate) fn pairs(&self) -> u64 {
        let answers: usize = self.0.iter().map(|way| 1 + way.len()).sum();
        (answers as u64).saturating_mul(answers as u64)
    }

    /// The ways on which both hold; ways that contradict each other are dropped.
    pub(crate) fn and(&self, other: &Self) -> Self {
        if other.is_always() {
            return self.clone();
        }
        if self.is_always() {
            return other.clone();
        }
        let mut both = Self::never();
        for mine in &self.0 {
            for theirs in &other.0 {
                both.0.extend(together(mine, theirs));
            }
            both.simplify();
        }
        both
    }

    /// The ways on which a condition has an answer, without naming it.
    pub(crate) fn given(&self, answer: WayAnswer) -> Self {
        if let [way] = self.0.as_slice()
            && let [only] = way.as_slice()
            && only.condition == answer.condition
        {
            let holds = only.sides & answer.sides != 0;
            return if holds { Self::always() } else { Self::never() };
        }
        let mut given = self.and(&Self::of(answer));
        given.havoc(answer.condition);
        given
    }

    /// Renumbers the conditions, in the same order.
    pub(crate) fn renumbered(&self, number: impl Fn(u32) -> u32) -> Self {
        let answer = |answer: &WayAnswer| WayAnswer {
            condition: number(answer.condition),
            ..*answer
        };
        let ways = self.0.iter();
        Self(ways.map(|way| way.iter().map(answer).collect()).collect())
    }

    /// Those of the ways that do not contradict others, as they are.
    pub(crate) fn within(&self, others: &Self) -> Self {
        let ways = self.0.iter();
        let agree = |way: &&Way| others.0.iter().any(|other| together(way, other).is_some());
        Self(ways.filter(agree).cloned().collect())
    }

    /// Returns the conditions of the ways beyond those that hold on all of others.
    pub(crate) fn beyond(mut self, others: &Self) -> Self {
        let holds = |answer: &WayAnswer| {
            !others.is_never()
                && others.0.iter().all(|other| {
                    let same = |it: &&WayAnswer| it.condition == answer.condition;
                    let found = other.iter().find(same);
                    found.is_some_and(|found| found.sides & !answer.sides == 0)
                })
        };
        for way in &mut self.0 {
            way.retain(|answer| !holds(answer));
        }
        self.simplify();
        self
    }

    /// The ways on which at least one of both holds.
    pub(crate) fn or(&mut self, other: &Self) {
        if !self.is_always() {
            self.0.extend_from_slice(&other.0);
            self.simplify();
        }
    }

    /// Drops the answers to a condition: it is asked again.
    pub(crate) fn havoc(&mut self, condition: u32) {
        for way in &mut self.0 {
            way.retain(|answer| answer.condition != condition);
        }
        self.simplify();
    }

    /// Drops ways without information, and conditions while there are too many ways.
    fn simplify(&mut self) {
        for way in &mut self.0 {
            let beyond = way.len().saturating_sub(MAX_CONDITIONS);
            way.drain(..beyond);
        }
        while self.absorb() || self.shorten() {}
        while self.0.len() > MAX_WAYS {
            let Some(condition) = self.most_named() else {
                return;
            };
            for way in &mut self.0 {
                way.retain(|answer| answer.condition != condition);
            }
            while self.absorb() || self.shorten() {}
        }
    }

    /// Drops a way that another one contains.
    fn absorb(&mut self) -> bool {
        let count = self.0.len();
        for inner in 0..count {
            for outer in 0..count {
                if inner != outer && contains(&self.0[outer], &self.0[inner], None) {
                    self.0.remove(inner);
                    return true;
                }
            }
        }
        false
    }

    /// Widens an answer of a way by another way that agrees with all the rest of it.
    fn shorten(&mut self) -> bool {
        let count = self.0.len();
        for inner in 0..count {
            for outer in (0..count).filter(|outer| *outer != inner) {
                for place in 0..self.0[inner].len() {
                    let answer = self.0[inner][place];
                    let same = |it: &&WayAnswer| it.condition == answer.condition;
                    let Some(other) = self.0[outer].iter().find(same).copied() else {
                        continue;
                    };
                    if other.sides & !answer.sides == 0
                        || !contains(&self.0[outer], &self.0[inner], Some(answer.condition))
                    {
                        continue;
                    }
                    let way = &mut self.0[inner];
                    way[place].sides |= other.sides;
                    if way[place].is_any() {
                        way.remove(place);
                    }
                    return true;
                }
            }
        }
        false
    }

    /// The condition that most ways name.
    fn most_named(&self) -> Option<u32> {
        let mut named: Vec<u32> = self.conditions().collect();
        named.sort_unstable();
        let groups = named.chunk_by(|one, other| one == other);
        groups
            .max_by_key(|group| group.len())
            .and_then(|group| group.first())
            .copied()
    }
}

/// Whether a way contains another one, except for a condition.
fn contains(outer: &Way, inner: &Way, but: Option<u32>) -> bool {
    outer
        .iter()
        .filter(|answer| Some(answer.condition) != but)
        .all(|answer| {
            let same = |it: &&WayAnswer| it.condition == answer.condition;
            let found = inner.iter().find(same);
            found.is_some_and(|found| found.sides & !answer.sides == 0)
        })
}

/// Both ways together; `None` where they contradict each other.
fn together(mine: &Way, theirs: &Way) -> Option<Way> {
    let mut both = mine.clone();
    for answer in theirs {
        match both.binary_search_by_key(&answer.condition, |it| it.condition) {
            Ok(place) => {
                both[place].sides &= answer.sides;
                if both[place].sides == 0 {
                    return None;
                }
            }
            Err(place) => both.insert(place, *answer),
        }
    }
    Some(both)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is(condition: u32, holds: bool) -> WaySet {
        WaySet::of(WayAnswer {
            condition,
            sides: if holds { 1 } else { 2 },
            of: 2,
        })
    }

    #[test]
    fn ways_are_simplified() {
        // R14.2
        let mut ways = is(1, true);
        ways.or(&is(1, false));
        assert!(ways.is_always());
        // A or (not A and B) is A or B.
        let mut ways = is(1, true);
        ways.or(&is(1, false).and(&is(2, true)));
        let mut short = is(1, true);
        short.or(&is(2, true));
        assert_eq!(ways, short);
        assert!(is(1, true).and(&is(1, false)).is_never());
    }

    #[test]
    fn many_ways_are_merged_and_only_widened() {
        // R14.3
        let mut ways = WaySet::never();
        for condition in 0..40 {
            ways.or(&is(condition, true).and(&is(100 + condition, true)));
        }
        assert!(ways.ways().len() <= MAX_WAYS);
        for condition in 0..40 {
            let one = is(condition, true).and(&is(100 + condition, true));
            assert!(!ways.and(&one).is_never());
        }
    }

    #[test]
    fn a_condition_that_is_asked_anew_is_left_out() {
        let mut ways = is(1, true).and(&is(2, true));
        ways.havoc(1);
        assert_eq!(ways, is(2, true));
    }
}
