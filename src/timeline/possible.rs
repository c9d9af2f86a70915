//! The serialised form of states if several are possible (R14.2).

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};

use super::record::StateView;
use crate::comp::KindSet;
use crate::interpreter::PossibleStates;

/// Axis → kind → the possible states, if a state is unknown because ways differ.
#[derive(Debug, Clone, Copy)]
pub struct Possible<'a> {
    state: StateView<'a>,
    kinds: KindSet,
}

impl<'a> Possible<'a> {
    /// Selects the states of some kinds.
    pub fn of(state: StateView<'a>, kinds: KindSet) -> Self {
        Self { state, kinds }
    }

    fn iter(&self) -> impl Iterator<Item = &'a PossibleStates> {
        let (kinds, listed) = (self.kinds, self.state.listed);
        let is_shown = move |it: &&PossibleStates| {
            let is_listed = listed.get(it.axis.get()).is_some_and(|listed| *listed);
            is_listed && kinds.contains(it.kind)
        };
        self.state.possible.iter().filter(is_shown)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.iter().next().is_none()
    }
}

impl Serialize for Possible<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut axes: BTreeMap<&str, BTreeMap<&str, &[_]>> = BTreeMap::new();
        for states in self.iter() {
            let kinds = axes.entry(self.state.name(states.axis)).or_default();
            kinds.insert(states.kind.as_str(), states.states.as_slice());
        }
        axes.serialize(serializer)
    }
}
