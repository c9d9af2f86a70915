//! The ways on which a program leaves an axis away from its start-up state (R10.10, R14.6).

use super::observation::Observation;
use super::runs::{ProgramRuns, RunStart};
use super::scope::{Scope, Selected};
use crate::interpreter::{PossibleState, PossibleStates, WayCondition};

/// The most ways that are named.
const MAX_NAMED: usize = 4;

/// States left by a run that begins in the start-up state.
#[derive(PartialEq)]
enum Left<'a> {
    StartUp,
    Away,
    /// It depends on values that only the machine knows.
    Either(&'a PossibleStates),
}

impl ProgramRuns {
    /// Returns the possible final states of a subject found in its start-up state, each with the ways to it; `None` if
    /// it ends in the start-up state on all of them. `found` names the state in which a subject was found.
    pub(super) fn possible(
        &self,
        scope: &Scope,
        at: usize,
        found: &dyn Fn(usize, bool) -> WayCondition,
    ) -> Option<PossibleStates> {
        let starts: Vec<(&RunStart, &Observation)> = self
            .starts()
            .filter(|(start, _)| !start.is_away(at))
            .collect();
        let left = |run| left(scope, at, run);
        if starts.iter().all(|(_, run)| left(run) == Left::StartUp) {
            return None;
        }
        let decides = |asked: &usize| {
            starts.iter().any(|(start, run)| {
                let other = self.from(&start.but(*asked), scope);
                other.is_some_and(|other| left(other) != left(run))
            })
        };
        let deciding: Vec<usize> = self.asked().into_keys().filter(decides).collect();
        if let ([], Left::Either(possible)) = (deciding.as_slice(), left(starts[0].1)) {
            return Some(possible.clone());
        }
        let [away, start_up] = [true, false].map(|is_away| scope.state(at, is_away));
        let mut ways: Vec<Vec<WayCondition>> = Vec::new();
        for (start, run) in &starts {
            let named = deciding.iter().map(|it| found(*it, start.is_away(*it)));
            let named: Vec<WayCondition> = named.collect();
            let machine = match left(run) {
                Left::StartUp => continue,
                Left::Away => None,
                Left::Either(possible) => possible.ways(away),
            };
            for way in machine.unwrap_or(&[Vec::new()]) {
                let way = [named.as_slice(), way.as_slice()].concat();
                if !ways.contains(&way) {
                    ways.push(way);
                }
            }
        }
        let more = ways.len().saturating_sub(MAX_NAMED);
        ways.truncate(MAX_NAMED);
        let states = vec![
            PossibleState {
                state: away,
                ways: Some(ways),
                more,
            },
            PossibleState {
                state: start_up,
                ways: None,
                more: 0,
            },
        ];
        let subject = scope.subjects()[at];
        Some(PossibleStates {
            axis: subject.axis,
            kind: subject.kind,
            states,
        })
    }
}

fn left<'a>(scope: &Scope, at: usize, run: &'a Observation) -> Left<'a> {
    let is_start_up = run.left[at] == scope.selected_at_start(scope.subjects()[at], false);
    match (&run.possible[at], run.left[at]) {
        (Some(possible), Selected::Unknown) => Left::Either(possible),
        _ if is_start_up => Left::StartUp,
        _ => Left::Away,
    }
}
