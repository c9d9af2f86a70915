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
    /// Returns the set of all ways.
    pub(crate) fn always() -> Self {
        Self(vec![Vec::new()])
    }

    /// Returns a set without ways.
    pub(crate) fn never() -> Self {
        Self(Vec::new())
    }

    /// Returns the ways on which a condition has an answer.
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

    /// Returns the conditions that the ways name.
    pub(crate) fn conditions(&self) -> impl Iterator<Item = u32> {
        self.0.iter().flatten().map(|answer| answer.condition)
    }

    /// Returns the number of its answers that are compared with each of its ways.
    pub(crate) fn pairs(&self) -> u64 {
        let answers: usize = self.0.iter().map(|way| 1 + way.len()).sum();
        (answers as u64).saturating_mul(self.0.len() as u64)
    }

    /// Returns the ways on which both hold; ways that contradict each other are dropped.
    pub(crate) fn and(&self, other: &Self) -> Self {
        if other.is_always() {
            return self.clone();
        }
        if self.is_always() {
            return other.clone();
        }
        if self.is_within(other) {
            return self.clone();
        }
        let mut both = Reduction::default();
        for mine in &self.0 {
            let ways = other.0.iter();
            both.add(ways.filter_map(|theirs| together(mine, theirs)));
        }
        Self(both.ways)
    }

    /// Returns the ways on which a condition has an answer, without naming it.
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

    /// Returns whether each of the ways is one of others.
    pub(crate) fn is_within(&self, others: &Self) -> bool {
        let is_one = |way: &Way| {
            let mut others = others.0.iter();
            others.any(|other| relation(way, other) == Relation::Contained)
        };
        self.0.iter().all(is_one)
    }

    /// Returns whether no way is one of both sets.
    pub(crate) fn is_apart_from(&self, other: &Self) -> bool {
        let is_apart = |way: &Way| other.0.iter().all(|other| contradict(way, other));
        self.0.iter().all(is_apart)
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

    /// Returns the ways that do not contradict others, unchanged.
    pub(crate) fn within(&self, others: &Self) -> Self {
        let ways = self.0.iter();
        let agree = |way: &&Way| others.0.iter().any(|other| !contradict(way, other));
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

    /// Adds the ways on which the other one holds.
    pub(crate) fn or(&mut self, other: &Self) {
        if !self.is_always() {
            let mut either = Reduction::of_reduced(std::mem::take(&mut self.0));
            either.add(other.0.iter().cloned());
            self.0 = either.ways;
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
        let mut reduction = Reduction::default();
        reduction.add(std::mem::take(&mut self.0).into_iter());
        self.0 = reduction.ways;
    }
}

/// The relation of a way to another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Relation {
    /// Way that the other one contains.
    Contained,
    /// Way that the other one contains except for one answer, by which it can be widened.
    Adjacent,
    Neither,
}

/// The relations of a way to others, a bit for each of them.
#[derive(Debug, Clone, Copy, Default)]
struct WayRelations {
    /// The conditions that it names, a bit each; conditions may share one.
    named: u64,
    /// The ways that contain it.
    contained: u64,
    /// The ways that it can be widened by.
    adjacent: u64,
}

/// Most ways that are compared at a time.
const MAX_COMPARED: usize = u64::BITS as usize;

/// Ways of which none contains another one or can be widened by it. Each pair is compared once for each change.
#[derive(Default)]
struct Reduction {
    ways: Vec<Way>,
    pairs: Vec<WayRelations>,
}

impl Reduction {
    /// Ways that are a whole set.
    fn of_reduced(ways: Vec<Way>) -> Self {
        let pairs = ways.iter().map(|way| WayRelations {
            named: names(way),
            ..WayRelations::default()
        });
        Self {
            pairs: pairs.collect(),
            ways,
        }
    }

    /// Takes further ways; while there are too many, conditions are left out.
    fn add(&mut self, further: impl Iterator<Item = Way>) {
        for mut way in further {
            if self.ways.len() == MAX_COMPARED {
                self.simplify();
            }
            let beyond = way.len().saturating_sub(MAX_CONDITIONS);
            way.drain(..beyond);
            self.ways.push(way);
            self.pairs.push(WayRelations::default());
            self.compare(self.ways.len() - 1);
        }
        self.simplify();
    }

    fn simplify(&mut self) {
        self.reduce();
        while self.ways.len() > MAX_WAYS {
            let Some(condition) = most_named(&self.ways) else {
                return;
            };
            for way in &mut self.ways {
                way.retain(|answer| answer.condition != condition);
            }
            (0..self.ways.len()).for_each(|way| self.compare(way));
            self.reduce();
        }
    }

    /// Drops ways that others contain, and widens an answer of a way by another way that agrees with all the rest
    /// of it.
    fn reduce(&mut self) {
        loop {
            if let Some(inner) = self.pairs.iter().position(|it| it.contained != 0) {
                self.ways.remove(inner);
                self.pairs.remove(inner);
                for pairs in &mut self.pairs {
                    pairs.contained = without(pairs.contained, inner);
                    pairs.adjacent = without(pairs.adjacent, inner);
                }
            } else if let Some(inner) = self.pairs.iter().position(|it| it.adjacent != 0) {
                let outer = self.pairs[inner].adjacent.trailing_zeros() as usize;
                let Some((place, sides)) = adjacent(&self.ways[inner], &self.ways[outer]) else {
                    return;
                };
                let way = &mut self.ways[inner];
                way[place].sides |= sides;
                if way[place].is_any() {
                    way.remove(place);
                }
                self.compare(inner);
            } else {
                return;
            }
        }
    }

    /// Compares a way that is new or has changed with all others.
    fn compare(&mut self, changed: usize) {
        self.pairs[changed].named = names(&self.ways[changed]);
        for other in (0..self.ways.len()).filter(|other| *other != changed) {
            for (inner, outer) in [(changed, other), (other, changed)] {
                let (named, bit) = (self.pairs[outer].named, 1 << outer);
                let pairs = &mut self.pairs[inner];
                pairs.contained &= !bit;
                pairs.adjacent &= !bit;
                if named & !pairs.named != 0 {
                    continue;
                }
                match relation(&self.ways[inner], &self.ways[outer]) {
                    Relation::Contained => pairs.contained |= bit,
                    Relation::Adjacent => pairs.adjacent |= bit,
                    Relation::Neither => {}
                }
            }
        }
    }
}

/// Bits without the one at a place: those above it take its place.
fn without(bits: u64, place: usize) -> u64 {
    let below = (1 << place) - 1;
    (bits & below) | (bits >> 1 & !below)
}

/// Returns the condition that most ways name.
fn most_named(ways: &[Way]) -> Option<u32> {
    let answers = ways.iter().flatten();
    let mut named: Vec<u32> = answers.map(|answer| answer.condition).collect();
    named.sort_unstable();
    let groups = named.chunk_by(|one, other| one == other);
    groups
        .max_by_key(|group| group.len())
        .and_then(|group| group.first())
        .copied()
}

fn names(way: &Way) -> u64 {
    way.iter()
        .fold(0, |named, answer| named | 1 << (answer.condition % 64))
}

fn relation(inner: &Way, outer: &Way) -> Relation {
    let mut differing = 0;
    let mut rest = inner.iter();
    for theirs in outer {
        let Some(mine) = rest.find(|it| it.condition >= theirs.condition) else {
            return Relation::Neither;
        };
        if mine.condition != theirs.condition {
            return Relation::Neither;
        }
        differing += usize::from(mine.sides & !theirs.sides != 0);
    }
    match differing {
        0 => Relation::Contained,
        1 if adjacent(inner, outer).is_some() => Relation::Adjacent,
        _ => Relation::Neither,
    }
}

/// Returns the first answer of a way that differs from that of one that contains the rest of it, and the sides that the
/// other one adds.
fn adjacent(inner: &Way, outer: &Way) -> Option<(usize, u64)> {
    let mut theirs = outer.iter().peekable();
    inner.iter().enumerate().find_map(|(place, mine)| {
        let theirs = theirs.next_if(|it| it.condition == mine.condition)?;
        let differs = mine.sides & !theirs.sides != 0 && theirs.sides & !mine.sides != 0;
        differs.then_some((place, theirs.sides))
    })
}

/// Returns both ways together; `None` where they contradict each other.
fn together(mine: &Way, theirs: &Way) -> Option<Way> {
    if contradict(mine, theirs) {
        return None;
    }
    let mut both = mine.clone();
    for answer in theirs {
        match both.binary_search_by_key(&answer.condition, |it| it.condition) {
            Ok(place) => both[place].sides &= answer.sides,
            Err(place) => both.insert(place, *answer),
        }
    }
    Some(both)
}

/// Returns whether two ways have different answers to a condition.
fn contradict(mine: &Way, theirs: &Way) -> bool {
    let mut rest = mine.iter().peekable();
    theirs.iter().any(|theirs| {
        while rest.next_if(|it| it.condition < theirs.condition).is_some() {}
        let same = rest.next_if(|it| it.condition == theirs.condition);
        same.is_some_and(|mine| mine.sides & theirs.sides == 0)
    })
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
