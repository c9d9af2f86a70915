//! The audited axes and kinds of a machine, their states, the effect of a program on them, and the ways on which it leaves the start-up
//! state (R10.10, R14.6).

use std::sync::Arc;

use serde::{Serialize, Serializer};

use super::observation::Observation;
use super::runs::{ProgramRuns, RunStart};
use crate::comp::{AxisIndex, Compensation, Kind, KindSet, State};
use crate::diagnostic::Code;
use crate::interpreter::{MotionKind, PossibleState, PossibleStates, WayCondition, ways_in_words};
use crate::machine::Machine;

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
        /// No change: the selection at the end is the one that the program found.
        Keeps = "keeps",
        /// Kind selected at the end, whatever the state found.
        #[serde(rename = "leaves on")]
        LeavesOn = "leaves on",
        /// Kind deselected at the end, whatever the state found.
        #[serde(rename = "leaves off")]
        LeavesOff = "leaves off",
        /// State at the end that depends on values known only to the machine, or on the state found: the ways to each
        /// selection are known (R14.6, R10.10).
        Depends = "depends",
        /// Effect of which neither the state at the end nor its conditions are known offline.
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
    /// Whether the control refuses it in that state, since the axis requires the compensation (R1.36).
    /// Records contain this field only then.
    #[serde(rename = "refused", skip_serializing_if = "std::ops::Not::not")]
    pub is_refused: bool,
    /// Whether it is uncertain offline that the program reaches the motion in the state that is meant: one that it did
    /// not set itself, or one away from the start-up state.
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

/// Inheritance of a state: a motion of an axis in the state that a program finds (R10.1).
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Inherits {
    /// No inheritance: the axis does not move, or a command comes first.
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
    /// Returns the motion, or `"no"` or `"unknown"`.
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
    /// States that depend on values known only to the machine.
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

/// A kind of compensation on an axis that is configured for it, or friction compensation on an axis that nothing
/// describes (R18.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct AuditedKind {
    /// Position of the axis in the machine.
    pub axis: AxisIndex,
    /// Kind of compensation.
    pub kind: Kind,
}

/// The audited part of a machine: each configured kind of each axis, and friction compensation of axes that nothing
/// describes; only friction compensation counts unless other kinds are requested.
#[derive(Debug, Clone)]
pub struct Scope {
    subjects: Vec<AuditedKind>,
    /// The range of subjects of each axis.
    by_axis: Vec<std::ops::Range<usize>>,
    /// The subjects whose axes nothing describes, with the names of these.
    undescribed: Vec<(String, usize)>,
    start_up: Compensation,
}

impl Scope {
    /// Creates the scope from the configured axes of a machine and the kinds that count.
    pub fn new(machine: &Machine, kinds: KindSet) -> Self {
        let start_up = machine.compensation();
        let mut subjects = Vec::new();
        let by_axis = (0..start_up.len()).map(AxisIndex::new).map(|axis| {
            let from = subjects.len();
            let is_open = !machine.axis(axis).is_described();
            let counts = |kind: &Kind| {
                start_up.is_configured(axis, *kind) || (is_open && *kind == Kind::Frict)
            };
            let counting = kinds.iter().filter(counts);
            subjects.extend(counting.map(|kind| AuditedKind { axis, kind }));
            from..subjects.len()
        });
        let by_axis = by_axis.collect();
        let open = subjects.iter().enumerate();
        let open = open.filter(|(_, it)| !start_up.is_configured(it.axis, it.kind));
        let named = open.map(|(at, it)| (machine.axis(it.axis).name.clone(), at));
        Self {
            undescribed: named.collect(),
            subjects,
            by_axis,
            start_up,
        }
    }

    /// Returns the audited kinds of the axes, in the order of the machine's axes.
    pub fn subjects(&self) -> &[AuditedKind] {
        &self.subjects
    }

    /// Returns whether anything says that the axis of a subject is configured for it (R18.2).
    pub(super) fn is_described(&self, at: usize) -> bool {
        self.undescribed.iter().all(|(_, open)| *open != at)
    }

    /// Returns the subject of an axis that nothing describes.
    pub(super) fn undescribed(&self, name: &str) -> Option<usize> {
        let mut open = self.undescribed.iter();
        open.find(|(axis, _)| axis == name).map(|(_, at)| *at)
    }

    /// Returns the state at the start of the control (R1.22).
    pub fn start_up(&self) -> &Compensation {
        &self.start_up
    }

    /// Returns a state that programs may leave: some subjects are away from the start-up state.
    pub(super) fn found(&self, is_away: impl Fn(usize) -> bool) -> Compensation {
        let mut found = self.start_up.clone();
        for (position, range) in self.by_axis.iter().enumerate() {
            let axis = AxisIndex::new(position);
            let mut selected = found.selected(axis);
            for at in range.clone().filter(|at| is_away(*at)) {
                let kind = self.subjects[at].kind;
                if selected.contains(kind) {
                    selected.remove(kind);
                } else {
                    selected.insert(kind);
                }
            }
            let unknown = found.unknown(axis);
            found.restore(axis, selected, unknown);
        }
        found
    }

    /// Returns the range of an axis' subjects.
    #[inline]
    pub(super) fn of_axis(&self, axis: AxisIndex) -> std::ops::Range<usize> {
        self.by_axis[axis.get()].clone()
    }

    /// Returns the selection of a subject that starts in its start-up state or away from it.
    pub(super) fn selected_at_start(&self, subject: AuditedKind, is_away: bool) -> Selected {
        if self.is_on_at_start_up(subject) == is_away {
            Selected::Off
        } else {
            Selected::On
        }
    }

    /// Returns the state of a subject that is in its start-up state or away from it.
    pub(super) fn state(&self, at: usize, is_away: bool) -> State {
        let AuditedKind { axis, kind } = self.subjects[at];
        self.found(|it| is_away && it == at).state(axis, kind)
    }

    /// Returns whether a subject is selected at the start of the control.
    pub(super) fn is_on_at_start_up(&self, subject: AuditedKind) -> bool {
        self.start_up.selected(subject.axis).contains(subject.kind)
    }
}

crate::words! {
    /// The selection of a kind of compensation on an axis (R1.23), whatever the parameterisation.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
    #[serde(rename_all = "lowercase")]
    #[non_exhaustive]
    pub enum Selected {
        /// Selected.
        On = "on",
        /// Deselected.
        Off = "off",
        /// Motion not known offline.
        Unknown = "unknown",
    }
}

impl Selected {
    pub(super) fn digit(self) -> u64 {
        match self {
            Self::On => 1,
            Self::Off => 2,
            Self::Unknown => 3,
        }
    }

    pub(super) fn of(compensation: &Compensation, subject: AuditedKind) -> Self {
        let AuditedKind { axis, kind } = subject;
        if compensation.unknown(axis).contains(kind) {
            Self::Unknown
        } else if compensation.selected(axis).contains(kind) {
            Self::On
        } else {
            Self::Off
        }
    }
}
