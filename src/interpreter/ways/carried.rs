//! Kinds with several possible states, as one program leaves them to the next (R14.7).

use serde::{Deserialize, Serialize};

use super::history::{History, Split};
use super::question::Condition;
use crate::comp::{Compensation, Kind};
use crate::machine::Machine;

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

    /// Whether no state has more than one way to it.
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

    /// The conditions, and the states of those kinds that are unknown.
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
