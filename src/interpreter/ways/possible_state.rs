//! The possible states, as users see them (R14.2), and as one program leaves them to the next (R14.7).

use std::sync::Arc;

use serde::ser::SerializeMap as _;
use serde::{Deserialize, Serialize, Serializer};

use crate::comp::{AxisIndex, Compensation, Kind, Membership, State};
use crate::interpreter::ways::history::{AxisKind, History, Split};
use crate::interpreter::ways::question::{Condition, ConditionKind, KeptAnswer, clash};
use crate::interpreter::ways::set::{Way, WayAnswer, WaySet};
use crate::interpreter::ways::words::{
    BlockCondition, MAX_NAMED, WayChange, WayCondition, after_if, all_need_change, needs_change,
    unless,
};
use crate::machine::Machine;

/// The states of a kind on an axis that is unknown, each with the ways that lead to it.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct PossibleStates {
    /// Index of the axis on the machine.
    pub axis: AxisIndex,
    /// The kind.
    pub kind: Kind,
    /// Each possible state. At most one has no ways: it is the state otherwise.
    pub states: Vec<PossibleState>,
}

/// A possible state.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct PossibleState {
    /// The state.
    pub state: State,
    /// The ways that lead to it, at most four, each a list of conditions that hold together; `None`
    /// for the state on all other ways.
    pub ways: Option<Vec<Vec<WayCondition>>>,
    /// Number of further ways to it.
    pub more: usize,
}

impl Serialize for PossibleState {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("state", &self.state)?;
        map.serialize_entry("ways", &self.ways)?;
        if self.ways.is_some() {
            map.serialize_entry("more", &self.more)?;
        }
        map.end()
    }
}

impl Serialize for PossibleStates {
    /// Serializes only the states; the axis and kind are given elsewhere.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.states.serialize(serializer)
    }
}

impl PossibleStates {
    /// Returns the words of the ways to a state, as seen from a file:
    /// `if V.E.A == 2 (line 12), or if skip level 1 is on`, or `only if V.E.A changes between lines 1 and 9`; `None`
    /// where it is the state otherwise, or not possible.
    pub fn ways_to(&self, state: State, file: &str) -> Option<String> {
        let found = self.states.iter().find(|it| it.state == state)?;
        found.words(file)
    }

    /// Returns the states in words, as seen from a file: `inactive if V.E.A == 2 (line 12), else active`.
    pub fn in_words(&self, file: &str) -> String {
        let named = self.states.iter().map(|state| match state.words(file) {
            Some(words) => format!("{} {words}", state.state),
            None => format!("else {}", state.state),
        });
        if self.is_widened() {
            let states: Vec<&str> = self.states.iter().map(|it| it.state.as_str()).collect();
            return format!("{}, on more ways than can be named", states.join(" or "));
        }
        named.collect::<Vec<_>>().join(", ")
    }

    /// Returns the condition for a state, as seen from a file: `if skip level 1 is on`, or `unless …` for the state on
    /// all other ways.
    pub(crate) fn when(&self, is_it: impl Fn(State) -> bool, file: &str) -> Option<String> {
        let (those, others): (Vec<_>, Vec<_>) = self.states.iter().partition(|it| is_it(it.state));
        let those = those.first()?;
        if let Some(words) = those.words(file) {
            return Some(words);
        }
        let others = others.first().and_then(|others| others.unless(file));
        Some(others.unwrap_or_else(|| "on more ways than can be named".to_owned()))
    }

    /// Returns the condition for the other state of two, as seen from a file: `unless …`, or `if …` where a state
    /// only needs one condition not to hold.
    pub(crate) fn unless(&self, state: State, file: &str) -> Option<String> {
        let found = self.states.iter().find(|it| it.state == state)?;
        let only = found.ways.iter().flatten().flatten().next();
        let denied = only.filter(|_| self.rests_on_one_condition());
        match denied.and_then(WayCondition::affirmed) {
            Some(other) => Some(format!("if {}", other.in_words(file))),
            None => found.unless(file),
        }
    }

    /// Returns whether the states depend only on what programs that only the machine has leave.
    pub(crate) fn rests_on_calls(&self) -> bool {
        let is_call = |condition: &WayCondition| matches!(condition, WayCondition::Call { .. });
        let named = self.states.iter().flat_map(|state| &state.ways);
        named.flatten().flatten().all(is_call)
    }

    /// Returns whether a state is possible only if a value of the machine changes between two conditions.
    pub fn needs_change(&self, state: State) -> bool {
        let found = self.states.iter().find(|it| it.state == state);
        found.is_some_and(PossibleState::needs_change)
    }

    /// Returns the ways to a state; `None` where it is the state otherwise.
    pub(crate) fn ways(&self, state: State) -> Option<&[Vec<WayCondition>]> {
        let found = self.states.iter().find(|it| it.state == state)?;
        found.ways.as_deref()
    }

    /// Returns a copy without the lines of the conditions, for comparison.
    pub(crate) fn without_lines(&self) -> Self {
        let mut copy = self.clone();
        let ways = copy.states.iter_mut().flat_map(|state| &mut state.ways);
        for condition in ways.flatten().flatten() {
            match condition {
                WayCondition::Condition(asked)
                | WayCondition::Case(asked)
                | WayCondition::Loop(asked)
                | WayCondition::Probe(asked) => {
                    asked.line = 0;
                    asked.changed = None;
                }
                WayCondition::Call { line, .. }
                | WayCondition::Search { line, .. }
                | WayCondition::Stop { line, .. }
                | WayCondition::Restart { line, .. } => *line = 0,
                WayCondition::Skip { line, changed, .. } => {
                    *line = 0;
                    *changed = None;
                }
                WayCondition::Found { .. } => {}
            }
        }
        copy
    }

    /// Returns whether there are more ways than can be named.
    pub(crate) fn is_widened(&self) -> bool {
        self.states.iter().any(PossibleState::is_always)
    }

    /// Returns whether one condition decides.
    fn rests_on_one_condition(&self) -> bool {
        let mut named = self.states.iter().flat_map(|state| &state.ways);
        named.all(|ways| matches!(ways.as_slice(), [way] if way.len() == 1))
    }

    /// Returns whether a state is possible.
    pub fn has(&self, state: State) -> bool {
        self.states.iter().any(|it| it.state == state)
    }
}

impl PossibleState {
    fn words(&self, file: &str) -> Option<String> {
        let ways = self.ways.as_ref().filter(|_| !self.is_always())?;
        Some(after_if(ways, self.more, file))
    }

    fn unless(&self, file: &str) -> Option<String> {
        let ways = self.ways.as_ref().filter(|_| !self.is_always())?;
        Some(unless(ways, self.more, file))
    }

    /// Returns whether there are too many ways to name any.
    fn is_always(&self) -> bool {
        self.ways.as_ref().is_some_and(Vec::is_empty)
    }

    fn needs_change(&self) -> bool {
        self.ways.as_deref().is_some_and(all_need_change)
    }
}

/// Returns the possible states of the unknown kinds on the ways of `reach`.
pub(crate) fn shown(
    (compensation, history): (&Compensation, &History),
    reach: &WaySet,
    conditions: &[Condition],
) -> Vec<PossibleStates> {
    let splits = history
        .open_kinds()
        .filter(|((axis, kind), _)| compensation.state(*axis, *kind) == State::Unknown);
    let rows =
        splits.map(|(key, split)| states_of((compensation, key), split, (reach, conditions)));
    rows.collect()
}

/// Returns the possible states of a kind of an axis on the ways of `reach`.
pub(crate) fn states_of(
    (compensation, (axis, kind)): (&Compensation, AxisKind),
    split: &Split,
    (reach, conditions): (&WaySet, &[Condition]),
) -> PossibleStates {
    let state = |membership| {
        let mut decided = compensation.clone();
        decided.decide(axis, kind, membership);
        decided.state(axis, kind)
    };
    let Split { on, off } = split;
    // Sets that were widened until they overlap do not tell which state a way leaves.
    let overlap = !on.and(off).and(reach).is_never();
    let [on, off] = [on, off].map(|ways| {
        if overlap {
            WaySet::always()
        } else {
            ways.within(reach).beyond(reach)
        }
    });
    // A state that is possible only if a value changes is marked as such, one that needs none is the other.
    let size = |ways: &WaySet| {
        let named = ways_of(ways, conditions);
        match named.as_slice() {
            [] => usize::MAX,
            named if all_need_change(named) => 0,
            _ => ways.conditions().count(),
        }
    };
    let (if_off, if_on) = (state(Membership::Out), state(Membership::In));
    let states = if size(&off) <= size(&on) {
        vec![named(if_off, &off, conditions), otherwise(if_on)]
    } else {
        vec![named(if_on, &on, conditions), otherwise(if_off)]
    };
    PossibleStates { axis, kind, states }
}

fn otherwise(state: State) -> PossibleState {
    PossibleState {
        state,
        ways: None,
        more: 0,
    }
}

fn named(state: State, ways: &WaySet, conditions: &[Condition]) -> PossibleState {
    let all = ways_of(ways, conditions);
    PossibleState {
        state,
        more: all.len().saturating_sub(MAX_NAMED),
        ways: Some(all.into_iter().take(MAX_NAMED).collect()),
    }
}

/// Returns the ways with the texts of their conditions; none where one of them only needs values to stay as the program
/// set them: it is taken for granted, and the others are exceptions (R2.99).
pub(crate) fn ways_of(ways: &WaySet, conditions: &[Condition]) -> Vec<Vec<WayCondition>> {
    let mut all: Vec<Vec<WayCondition>> = Vec::new();
    let mut in_order: Vec<_> = ways.ways().iter().collect();
    in_order.sort_by_key(|way| way.iter().map(|it| it.condition).collect::<Vec<_>>());
    for way in in_order {
        let asked = way.iter().filter_map(|answer| {
            let condition = conditions.get(answer.condition as usize)?;
            if condition.keeps(answer.sides) {
                return None;
            }
            let changed = change_of(answer, way, conditions);
            Some(condition_of(condition, *answer, changed))
        });
        let mut named: Vec<WayCondition> = Vec::new();
        for condition in asked {
            // Ways name lines, not passes.
            if !named.contains(&condition) {
                named.push(condition);
            }
        }
        if named.is_empty() {
            return Vec::new();
        }
        if !all.contains(&named) {
            all.push(named);
        }
    }
    all.sort_by_key(|way| needs_change(way));
    all
}

/// Returns the change without which a condition has only the answer that the program set.
pub(crate) fn change_since(kept: &KeptAnswer) -> WayChange {
    let names: Vec<String> = kept.names.iter().map(ToString::to_string).collect();
    WayChange {
        name: names.join(" or ").into(),
        file: kept.set.file.clone(),
        line: kept.set.line,
    }
}

fn change_of(answer: &WayAnswer, way: &Way, conditions: &[Condition]) -> Option<WayChange> {
    let kept = conditions.get(answer.condition as usize)?.kept.as_ref();
    if let Some(kept) = kept.filter(|kept| answer.sides & kept.sides == 0) {
        return Some(change_since(kept));
    }
    let found = clash(answer, way, conditions)?;
    let earlier = &conditions.get(found.earlier as usize)?.place;
    Some(WayChange {
        name: found.name.clone(),
        file: earlier.file.clone(),
        line: earlier.start().line,
    })
}

fn condition_of(
    condition: &Condition,
    answer: WayAnswer,
    changed: Option<WayChange>,
) -> WayCondition {
    let (file, line) = (condition.place.file.clone(), condition.place.start().line);
    let of = |sides: u64| {
        if let ([only], true) = (condition.texts.as_slice(), sides & 1 != 0) {
            return Arc::clone(only);
        }
        let texts = condition.texts.iter().enumerate();
        let texts = texts.filter(|(place, _)| sides & (1 << place) != 0);
        let texts: Vec<&str> = texts.map(|(_, text)| &**text).collect();
        Arc::from(texts.join(" || "))
    };
    // The last answer is that none of the texts holds.
    let is_else = answer.sides & (1 << condition.texts.len()) != 0;
    let asked = BlockCondition {
        file: file.clone(),
        line,
        text: if is_else {
            of(!answer.sides)
        } else {
            of(answer.sides)
        },
        holds: !is_else,
        changed: changed.clone(),
    };
    match condition.kind {
        ConditionKind::Branch => WayCondition::Condition(asked),
        ConditionKind::Case | ConditionKind::Jump => WayCondition::Case(asked),
        ConditionKind::Loop => WayCondition::Loop(asked),
        ConditionKind::Probe => WayCondition::Probe(asked),
        ConditionKind::Call(compensation) => {
            let text = |place: usize| condition.texts.get(place).cloned().unwrap_or_default();
            WayCondition::Call {
                file,
                line,
                text: text(0),
                axis: text(1),
                compensation,
                on: answer.sides == 1,
            }
        }
        ConditionKind::Found(compensation, selected) => WayCondition::Found {
            axis: condition.texts.concat(),
            compensation,
            state: if is_else { State::Inactive } else { selected },
        },
        ConditionKind::Search => WayCondition::Search {
            file,
            line,
            executed: !is_else,
        },
        ConditionKind::Stop => WayCondition::Stop {
            file,
            line,
            text: condition.texts.first().cloned().unwrap_or_default(),
            stops: !is_else,
        },
        ConditionKind::Restart => WayCondition::Restart {
            file,
            line,
            restarted: !is_else,
        },
        ConditionKind::Skip(level) => WayCondition::Skip {
            level,
            executed: is_else,
            file,
            line,
            changed,
        },
    }
}

/// The kinds that are unknown because ways through earlier programs differ, with the ways that lead
/// to each state.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CarriedWays {
    conditions: Vec<Condition>,
    states: Vec<CarriedState>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CarriedState {
    axis: String,
    kind: Kind,
    ways: Split,
}

impl CarriedWays {
    pub(crate) fn of(history: &History, conditions: &[Condition], machine: &Machine) -> Self {
        let of_states = history.open_kinds();
        let mut named: Vec<u32> = of_states
            .flat_map(|(_, split)| split.conditions())
            .collect();
        named.sort_unstable();
        named.dedup();
        let renumbered = |number: u32| {
            let place = named.binary_search(&number).ok()?;
            u32::try_from(place).ok()
        };
        let found = named.iter().filter_map(|it| conditions.get(*it as usize));
        let found = found.map(|condition| condition.renumbered(renumbered));
        let states = history
            .open_kinds()
            .map(|((axis, kind), split)| CarriedState {
                axis: machine.axis(axis).name.clone(),
                kind,
                ways: split.renumbered(|number| renumbered(number).unwrap_or(0)),
            });
        Self {
            conditions: found.collect(),
            states: states.collect(),
        }
    }

    /// Returns whether no state has more than one way to it.
    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// Returns whether every axis is one of the machine, and every condition is there with few enough
    /// answers.
    pub fn fits(&self, machine: &Machine) -> bool {
        let conditions = self.conditions.len();
        let mut states = self.states.iter();
        self.conditions.iter().all(Condition::fits)
            && states.all(|it| machine.find(&it.axis).is_some() && it.ways.fits(conditions))
    }

    /// Returns the conditions, and the states of those kinds that are unknown.
    pub(crate) fn into_parts(
        self,
        machine: &Machine,
        compensation: &Compensation,
    ) -> (Vec<Condition>, History) {
        let states = self.states.into_iter().filter_map(|state| {
            let axis = machine.find(&state.axis)?;
            let is_unknown = compensation.unknown(axis).contains(state.kind);
            is_unknown.then_some(((axis, state.kind), state.ways))
        });
        (self.conditions, History::of_states(states))
    }
}
