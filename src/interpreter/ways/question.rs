//! Conditions that only the machine knows, as ways name them (R14.2), and answers that contradict each other while a value of the
//! machine stays as it is (R14.1).
//!
//! A value of the machine is asked for each time. A way that needs two answers that no single value gives is still possible,
//! but only if the value changes in between.

use std::collections::BTreeSet;
use std::sync::Arc;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::comp::{Kind, State};
use crate::interpreter::values::externals::SetAt;
use crate::interpreter::values::location::{Location, Unknown};
use crate::interpreter::values::plain::{Asking, ConditionMeaning, ConditionSubject, Writer};
use crate::interpreter::values::value::Value;
use crate::interpreter::ways::set::{Way, WayAnswer};
use crate::syntax::VariableName;
use crate::text::Place;

/// Answers of one condition, which have a bit each.
pub(crate) const MAX_ANSWERS: usize = 60;

/// Kind of the asking statement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum ConditionKind {
    /// `$IF`, `$ELSEIF`, `#IF`.
    Branch,
    /// `$SWITCH`.
    Case,
    /// The target of a jump.
    Jump,
    /// Repetition of a loop.
    Loop,
    /// A skip level.
    Skip(u8),
    /// The signal of a probe.
    Probe,
    /// Selection of a kind on an axis by a program that only the machine has; the texts are the names of the program
    /// and of the axis.
    Call(Kind),
    /// Selection of a kind on an axis as the program finds it, with its state then; the text is the name of the axis.
    Found(Kind, State),
    /// Execution of the commands that a block search passes.
    Search,
    /// End of the program at `#ERROR` without a remedy class (R2.100).
    Stop,
    /// Restart of the control after an error, not only a reset (R2.100).
    Restart,
}

/// Answers to an earlier condition and to a later one that no value gives.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Clash {
    pub(crate) earlier: u32,
    /// Number of the time that the earlier one was asked.
    pub(crate) time: u32,
    /// Value that must change in between.
    pub(crate) name: Arc<str>,
    /// The answers to the earlier one, and those to the later one, a bit each.
    pub(crate) answers: [u64; 2],
}

/// The answers that hold while a variable of the machine keeps the value that the program set (R2.99).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct KeptAnswer {
    /// The variables; states before schema 4 have them in words.
    #[serde(
        alias = "name",
        serialize_with = "in_words",
        deserialize_with = "one_or_more"
    )]
    pub(crate) names: Arc<[VariableName]>,
    /// The block that set it.
    pub(crate) set: SetAt,
    /// The answers, a bit each.
    pub(crate) sides: u64,
}

fn in_words<S: Serializer>(names: &[VariableName], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(names.iter().map(ToString::to_string))
}

fn one_or_more<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Arc<[VariableName]>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Names {
        One(String),
        More(Vec<String>),
    }
    let names = match Names::deserialize(deserializer)? {
        Names::One(name) => vec![name],
        Names::More(names) => names,
    };
    Ok(names.iter().map(|name| VariableName::read(name)).collect())
}

/// A condition that only the machine knows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Condition {
    pub(crate) kind: ConditionKind,
    pub(crate) place: Place,
    /// Text of the condition for each answer but the last, which is that none of them holds.
    pub(crate) texts: Vec<Arc<str>>,
    /// The value that decides.
    pub(crate) cause: Unknown,
    /// Number of the question at its place: a place that is reached again asks again.
    pub(crate) round: u8,
    /// Number of times that its number was given to a question.
    #[serde(default)]
    pub(crate) time: u32,
    /// The answers to earlier conditions that contradict answers to it, unless a value changes in between.
    #[serde(default)]
    pub(crate) clashes: Vec<Clash>,
    /// The answers that what the program wrote gives, unless the machine changes it in between.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) kept: Option<KeptAnswer>,
}

impl Condition {
    /// Returns a condition that is asked for the first time.
    pub(crate) fn new(
        kind: ConditionKind,
        place: Place,
        texts: Vec<Arc<str>>,
        cause: Unknown,
    ) -> Self {
        Self {
            kind,
            place,
            texts,
            cause,
            round: 0,
            time: 0,
            clashes: Vec::new(),
            kept: None,
        }
    }

    /// Renumbers the conditions; those without a number are left out.
    pub(crate) fn renumbered(&self, number: impl Fn(u32) -> Option<u32>) -> Self {
        let mut copy = self.clone();
        copy.clashes.retain_mut(|clash| {
            let earlier = number(clash.earlier);
            clash.earlier = earlier.unwrap_or(clash.earlier);
            earlier.is_some()
        });
        copy
    }

    /// Returns whether some answers hold unless the machine changes what the program wrote.
    pub(crate) fn keeps(&self, sides: u64) -> bool {
        self.kept
            .as_ref()
            .is_some_and(|kept| sides & !kept.sides == 0)
    }

    /// Returns whether each of its answers has a bit.
    pub(crate) fn fits(&self) -> bool {
        self.texts.len() < MAX_ANSWERS
    }

    /// Returns whether it is the same question at the same place, at any time.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.place.first_line == other.place.first_line
            && self.place.span == other.place.span
            && self.kind == other.kind
            && self.place.file == other.place.file
            && self.texts == other.texts
    }
}

/// Number of remembered conditions on values of the machine; older ones contradict nothing.
const MAX_READINGS: usize = 16;

/// Number of answers of a condition beyond which their values are not compared.
const MAX_COMPARED: usize = 8;

/// Values that follow from an answer.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct ImpliedValues {
    /// The values that follow from it.
    pub(crate) is: Vec<(Location, Value)>,
    /// The values that it rules out.
    pub(crate) is_not: Vec<(Location, Value)>,
}

impl ImpliedValues {
    /// Returns a variable for which no value gives both answers.
    fn contradicts<'a>(&'a self, other: &'a Self) -> Option<&'a Location> {
        let differs = |(target, value): &&(Location, Value)| {
            let mut known = other.is.iter();
            let mut ruled_out = other.is_not.iter();
            known.any(|(of, other)| of == target && other != value)
                || ruled_out.any(|(of, other)| of == target && other == value)
        };
        let is_ruled_out = |pair: &&(Location, Value)| other.is.contains(pair);
        let found = self.is.iter().find(differs);
        let found = found.or_else(|| self.is_not.iter().find(is_ruled_out));
        found.map(|(target, _)| target)
    }
}

/// A condition on values of the machine that the program has not written since.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct RememberedCondition {
    pub(crate) condition: u32,
    /// Number of the time that the condition is asked.
    time: u32,
    meaning: Arc<ConditionMeaning>,
    writer: Writer,
    answers: Vec<ImpliedValues>,
}

impl RememberedCondition {
    pub(crate) fn of(
        (condition, time): (u32, u32),
        asking: &Asking,
        answers: Vec<ImpliedValues>,
    ) -> Self {
        Self {
            condition,
            time,
            meaning: Arc::clone(&asking.meaning),
            writer: asking.writer,
            answers,
        }
    }

    /// Returns the pairs of answers of this condition and a later one that no value gives.
    fn clashes(&self, later: &Self) -> Vec<Clash> {
        let named = |name: String, answers| Clash {
            earlier: self.condition,
            time: self.time,
            name: name.into(),
            answers,
        };
        let all = |reading: &Self| (1_u64 << reading.answers.len()) - 1;
        if self.meaning == later.meaning {
            let sides = (0..self.answers.len()).map(|place| 1_u64 << place);
            let others = |side: u64| [side, all(later) & !side];
            return sides
                .map(|side| named(self.names(), others(side)))
                .collect();
        }
        let mut found = Vec::new();
        if self.answers.len().max(later.answers.len()) > MAX_COMPARED {
            return found;
        }
        for (mine, says) in self.answers.iter().enumerate() {
            for (theirs, other) in later.answers.iter().enumerate() {
                let of = says.contradicts(other).and_then(name_of);
                found.extend(of.map(|name| named(name, [1 << mine, 1 << theirs])));
            }
        }
        found
    }

    /// Returns the variables that it reads, or what it asks for.
    fn names(&self) -> String {
        if let ConditionSubject::Unknown(unknown) = &self.meaning.subject {
            return unknown.to_string();
        }
        let reads = self.meaning.reads.iter();
        let mut names: Vec<String> = reads.filter_map(name_of).collect();
        names.dedup();
        names.join(" or ")
    }
}

fn name_of(target: &Location) -> Option<String> {
    match target {
        Location::Variable(name) => Some(name.to_string()),
        Location::Parameter(..) | Location::Elements(_) | Location::Parameters => None,
    }
}

/// The conditions on values of the machine that are remembered, the latest last.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct RememberedConditions(Vec<Arc<RememberedCondition>>);

impl RememberedConditions {
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Adds a condition that is asked, and returns the answers that contradict earlier ones.
    pub(crate) fn ask(&mut self, reading: RememberedCondition) -> Vec<Clash> {
        let earlier = self.0.iter();
        let clashes = earlier.flat_map(|it| it.clashes(&reading)).collect();
        if self.0.len() >= MAX_READINGS {
            self.0.remove(0);
        }
        self.0.push(Arc::new(reading));
        clashes
    }

    /// Drops the conditions that read a value for whose change the program waits; without a condition that asks for it,
    /// all of them.
    pub(crate) fn wait_for(&mut self, asking: Option<&Asking>) {
        match asking {
            None => self.0.clear(),
            Some(asking) => {
                let is_read = |it: &Arc<RememberedCondition>| {
                    it.meaning
                        .reads
                        .iter()
                        .any(|of| asking.meaning.reads.contains(of))
                };
                self.0
                    .retain(|it| !is_read(it) && it.meaning != asking.meaning);
            }
        }
    }

    /// Drops the conditions that read a value that the program writes.
    pub(crate) fn write(&mut self, location: &Location) {
        match location {
            Location::Elements(_) | Location::Parameters => {
                self.0.retain(|it| it.meaning.reads.is_empty());
            }
            one => self.0.retain(|it| !it.meaning.reads.contains(one)),
        }
    }

    /// Drops the conditions that an action of the control may change: a motion, a tool change.
    pub(crate) fn act(&mut self) {
        self.0.retain(|it| it.writer != Writer::Control);
    }

    /// Drops the conditions that read any of the values that differ from here on.
    pub(crate) fn havoc(&mut self, is_other: impl Fn(&Location) -> bool) {
        self.0.retain(|it| !it.meaning.reads.iter().any(&is_other));
    }

    /// Returns whether each answer of each has a bit.
    pub(crate) fn fit(&self) -> bool {
        self.0.iter().all(|it| it.answers.len() <= MAX_ANSWERS)
    }

    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    pub(crate) fn conditions(&self) -> impl Iterator<Item = u32> {
        self.0.iter().map(|it| it.condition)
    }

    /// Merges another way: a condition that only one of them asked counts if the other names no answer to it.
    pub(crate) fn join(&mut self, other: &Self, named: [&BTreeSet<u32>; 2]) {
        let [mine, theirs] = named;
        let is_only_mine = |it: &Arc<RememberedCondition>| !theirs.contains(&it.condition);
        self.0.retain(|it| other.0.contains(it) || is_only_mine(it));
        for reading in &other.0 {
            let is_known = self.conditions().any(|it| it == reading.condition);
            let is_new = !is_known && !mine.contains(&reading.condition);
            if is_new && self.0.len() < MAX_READINGS {
                self.0.push(Arc::clone(reading));
            }
        }
        self.0.sort_by_key(|it| it.condition);
    }
}

/// Returns the clash of an answer with an earlier one of the same way, the nearest of them.
pub(crate) fn clash<'a>(
    answer: &WayAnswer,
    way: &Way,
    conditions: &'a [Condition],
) -> Option<&'a Clash> {
    let clashes = &conditions.get(answer.condition as usize)?.clashes;
    way.iter().rev().find_map(|earlier| {
        let is_same_time = |it: &&Clash| {
            let condition = conditions.get(it.earlier as usize);
            condition.is_some_and(|condition| condition.time == it.time)
        };
        let mut of = clashes.iter().filter(|it| it.earlier == earlier.condition);
        let is_all = (0..u64::BITS)
            .filter(|place| answer.sides & (1 << place) != 0)
            .all(|place| {
                let of = of.clone().filter(is_same_time);
                let of = of.filter(|it| it.answers[1] & (1 << place) != 0);
                let ruled_out = of.fold(0, |sides, it| sides | it.answers[0]);
                earlier.sides & !ruled_out == 0
            });
        of.next().filter(|_| is_all)
    })
}

/// Returns whether a condition can contradict another one: a loop waits for its value to change.
pub(crate) fn is_compared(kind: ConditionKind) -> bool {
    matches!(
        kind,
        ConditionKind::Branch | ConditionKind::Case | ConditionKind::Jump | ConditionKind::Skip(_)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_in_words_are_read() {
        // R9.32
        for names in ["\"name\":\"V.E.A\"", "\"names\":[\"V.E.A\"]"] {
            let saved = format!("{{{names},\"set\":{{\"file\":\"a.nc\",\"line\":3}},\"sides\":1}}");
            let kept: KeptAnswer = serde_json::from_str(&saved).expect("an answer");
            assert_eq!(*kept.names, [VariableName::read("V.E.A")]);
        }
    }
}
