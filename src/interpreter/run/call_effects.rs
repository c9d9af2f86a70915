//! The effects of programs that were called on other ways (R14.4).

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::loop_heads::{Arrival, HeadPlace};
use super::path::Path;
use super::stack::{CallFrame, CallStack};
use crate::interpreter::programs::index::ProgramId;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::rows;
use crate::interpreter::ways::set::WaySet;

/// A program, with the depth of calls at which it runs.
pub(crate) type CalledAt = (usize, ProgramId);

/// The effect of a program on the states in which it was called.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct CallEffect {
    /// The join of these states, with the called program alone on the call stack.
    entry: Path,
    /// The join of the states in which it came back, with an empty call stack; `None` where no way comes back.
    exit: Option<Path>,
    /// The blocks to which the last executed call returns.
    pub(crate) context: HeadPlace,
    /// The conditions by which the ways to the calls differ: the effect holds whatever their answers.
    left_out: BTreeSet<u32>,
}

impl CallEffect {
    pub(crate) fn of(entry: Path, context: HeadPlace) -> Self {
        Self {
            entry,
            exit: None,
            context,
            left_out: BTreeSet::new(),
        }
    }

    pub(crate) fn entry(&self) -> &Path {
        &self.entry
    }

    pub(crate) fn states(&self) -> impl Iterator<Item = &Path> {
        self.exit.iter().chain([&self.entry])
    }

    pub(crate) fn states_mut(&mut self) -> impl Iterator<Item = &mut Path> {
        self.exit.iter_mut().chain([&mut self.entry])
    }

    /// The program is called in a further state.
    pub(crate) fn take_in(&mut self, way: Path, cause: &Unknown) -> Arrival {
        let mut both = self.entry.clone();
        let mut left_out = self.left_out.clone();
        let reach = &mut both.track.reach;
        for condition in reach
            .conditions()
            .collect::<BTreeSet<_>>()
            .into_iter()
            .rev()
        {
            if way.track.reach.is_within(reach) {
                break;
            }
            reach.havoc(condition);
            left_out.insert(condition);
        }
        let reach = reach.clone();
        let named: BTreeSet<u32> = reach.conditions().collect();
        let others = way.track.reach.conditions();
        left_out.extend(others.filter(|condition| !named.contains(condition)));
        both.join(way, cause);
        both.track.reach = reach;
        leave_out(&left_out, &mut both);
        if both.control == self.entry.control && both.track.reach == self.entry.track.reach {
            return Arrival::Covered;
        }
        (self.entry, self.left_out) = (both, left_out);
        Arrival::Grown
    }

    /// A way comes back from the last call.
    pub(crate) fn come_back(&mut self, way: Path, cause: &Unknown) {
        match &mut self.exit {
            Some(exit) => _ = exit.join(way, cause),
            None => self.exit = Some(way),
        }
    }

    /// The state after the call on some ways; `None` where none of them comes back.
    pub(crate) fn after(&self, reach: &WaySet) -> Option<Path> {
        let mut exit = self.exit.clone()?;
        leave_out(&self.left_out, &mut exit);
        let mut reach = reach.clone();
        let before: BTreeSet<u32> = self.entry.conditions();
        for condition in exit.conditions().difference(&before) {
            reach.havoc(*condition);
        }
        exit.track.reach = reach.and(&exit.track.reach);
        if exit.track.reach.is_never() {
            return None;
        }
        let control = &mut exit.control;
        control
            .history
            .narrow(&exit.track.reach, &mut control.compensation);
        Some(exit)
    }
}

fn leave_out(conditions: &BTreeSet<u32>, state: &mut Path) {
    for condition in conditions {
        state.track.reach.havoc(*condition);
        state.control.history.havoc(*condition);
    }
}

/// The effects of programs, once following the ways through their calls takes much work: calls multiply their ways.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct CallEffects(#[serde(with = "rows")] BTreeMap<CalledAt, CallEffect>);

impl CallEffects {
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn get_mut(&mut self, called: CalledAt) -> Option<&mut CallEffect> {
        self.0.get_mut(&called)
    }

    pub(crate) fn insert(&mut self, called: CalledAt, effect: CallEffect) {
        self.0.insert(called, effect);
    }

    pub(crate) fn remove(&mut self, called: CalledAt) {
        self.0.remove(&called);
    }

    pub(crate) fn states(&self) -> impl Iterator<Item = &Path> {
        self.0.values().flat_map(CallEffect::states)
    }

    pub(crate) fn states_mut(&mut self) -> impl Iterator<Item = &mut Path> {
        self.0.values_mut().flat_map(CallEffect::states_mut)
    }
}

/// The blocks to which the calls of a call stack down to a depth return.
pub(crate) fn context(calls: &CallStack, depth: usize) -> HeadPlace {
    let callers = calls.iter().take(depth.saturating_sub(1));
    callers.map(CallFrame::place).collect()
}
