//! The effect of a program on the state of an axis, and the ways on which it leaves the start-up state (R10.10, R14.6).

use std::sync::Arc;

use serde::{Serialize, Serializer};

use super::observation::Observation;
use super::runs::{ProgramRuns, RunStart};
use super::scope::{Scope, Selected};
use crate::diagnostic::Code;
use crate::interpreter::{MotionKind, PossibleState, PossibleStates, WayCondition, ways_in_words};

/// A line of a program.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Site {
    /// The file, as the user named it.
    pub file: Arc<str>,
    /// The line, from 1.
    pub line: u32,
}

crate::words! {
    /// Effect of a program on a selection (R1.23), whatever the parameterisation (R10.1).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
    #[serde(rename_all = "lowercase")]
    #[non_exhaustive]
    pub enum ProgramEffect {
        /// The program ends with the selection that it found.
        Keeps = "keeps",
        /// It ends selected, whatever it found.
        #[serde(rename = "leaves on")]
        LeavesOn = "leaves on",
        /// It ends deselected, whatever it found.
        #[serde(rename = "leaves off")]
        LeavesOff = "leaves off",
        /// It depends on values that only the machine knows, or on the state that it finds: the ways to each selection
        /// are known (R14.6, R10.10).
        Depends = "depends",
        /// Neither the state at the end nor its conditions are known offline.
        Unknown = "unknown",
    }
}

/// The first motion of an axis in a state that the program did not set.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct FirstMotion {
    /// Place of the words that move the axis.
    #[serde(flatten)]
    pub site: Site,
    /// Kind of motion.
    pub motion: MotionKind,
    /// Whether it is uncertain offline that the program reaches the motion in a state that it did not set itself.
    /// Records contain this field only then.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub perhaps: bool,
    /// The ways on which it moves so, each a list of conditions that hold together; empty if it does so whatever the
    /// machine answers (R14.6).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ways: Vec<Vec<WayCondition>>,
}

impl FirstMotion {
    /// Returns the ways in words after `if`, as seen from a file; `None` if it moves so on all of them.
    pub fn condition(&self, file: &str) -> Option<String> {
        (!self.ways.is_empty()).then(|| ways_in_words(&self.ways, file))
    }
}

/// Whether a program moves an axis in the state that it finds (R10.1).
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Inherits {
    /// It does not: the axis does not move, or a command comes first.
    No,
    /// The first motion before any command of the program.
    Motion(FirstMotion),
    /// The program stopped before it reached either.
    Unknown,
}

impl Inherits {
    /// Returns the motion, if there is one.
    pub fn motion(&self) -> Option<&FirstMotion> {
        match self {
            Self::Motion(motion) => Some(motion),
            Self::No | Self::Unknown => None,
        }
    }

    /// Returns the word for tables: `yes`, `perhaps`, `no` or `unknown`.
    pub fn as_str(&self) -> &'static str {
        match self {
            Self::No => "no",
            Self::Motion(motion) if motion.perhaps => "perhaps",
            Self::Motion(_) => "yes",
            Self::Unknown => "unknown",
        }
    }
}

impl Serialize for Inherits {
    /// The motion, or `"no"` or `"unknown"`.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::No => serializer.serialize_str("no"),
            Self::Motion(motion) => motion.serialize(serializer),
            Self::Unknown => serializer.serialize_str("unknown"),
        }
    }
}

/// The reason for which something is unknown.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct WhyUnknown {
    /// The code of the message about it, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub code: Option<Code>,
    /// The reason in words.
    pub message: String,
    /// Place of its origin.
    #[serde(flatten)]
    pub site: Option<Site>,
}

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
