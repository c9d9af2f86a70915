//! The serialised form of records (chapter 9.2) and of possible states (R14.2): the keys, and their order.

use std::collections::BTreeMap;

use serde::{Serialize, Serializer};

use super::in_force::ReadingsInForce;
use super::record::{
    DiagnosticRecord, End, Join, Record, Repeat, Row, SCHEMA, StateView, Summary, TOOL,
};
use crate::comp::{AxisIndex, Change, Kind, KindSet, State};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::interpreter::{PossibleStates, WayCondition};
use crate::machine::Machine;

/// The states of axes at the end of a record: those of friction compensation, and those of each selected kind unless
/// only friction compensation is selected (R9.12).
#[derive(Debug, Clone, Copy, Serialize)]
pub struct States<'a> {
    friction: FrictionStates<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    compensation: Option<OfKinds<'a>>,
    #[serde(skip_serializing_if = "Possible::is_empty")]
    possible: Possible<'a>,
}

impl<'a> States<'a> {
    /// Selects the states of some kinds.
    pub fn of(state: StateView<'a>, kinds: KindSet) -> Self {
        let is_plain = kinds == KindSet::of(Kind::Frict);
        Self {
            friction: FrictionStates(state),
            compensation: (!is_plain).then_some(OfKinds { state, kinds }),
            possible: Possible::of(state, kinds),
        }
    }
}

/// Axis → state of friction compensation.
#[derive(Debug, Clone, Copy)]
struct FrictionStates<'a>(StateView<'a>);

impl Serialize for FrictionStates<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let states = self.0.axes();
        serializer.collect_map(states.map(|(axis, name)| (name, self.0.state(axis, Kind::Frict))))
    }
}

/// Axis → kind → state.
#[derive(Debug, Clone, Copy)]
struct OfKinds<'a> {
    state: StateView<'a>,
    kinds: KindSet,
}

impl Serialize for OfKinds<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let axes = self.state.axes();
        serializer.collect_map(axes.map(|(axis, name)| (name, OfAxis { of: *self, axis })))
    }
}

struct OfAxis<'a> {
    of: OfKinds<'a>,
    axis: AxisIndex,
}

impl Serialize for OfAxis<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let OfKinds { state, kinds } = self.of;
        serializer.collect_map(
            kinds
                .iter()
                .map(|kind| (kind, state.state(self.axis, kind))),
        )
    }
}

/// The names of the listed axes.
struct ListedAxes<'a>(StateView<'a>);

impl Serialize for ListedAxes<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.axes().map(|(_, name)| name))
    }
}

/// Axis → feed moves while it was not active (R13.12).
struct Uncompensated<'a>(&'a Summary<'a>);

impl Uncompensated<'_> {
    fn is_empty(&self) -> bool {
        self.0.uncompensated().next().is_none()
    }
}

impl Serialize for Uncompensated<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let axes = self.0.uncompensated();
        serializer.collect_map(axes.map(|axis| (self.0.state.name(axis.axis), axis.feed_moves)))
    }
}

/// A line of `frictcomp.toml` that assumes friction compensation of an axis (R18.2).
#[derive(Serialize)]
struct EnabledAxis<'a> {
    axis: &'a str,
    file: &'a str,
    line: u32,
}

impl<'a> EnabledAxis<'a> {
    fn of(machine: &'a Machine) -> Vec<Self> {
        let axes = machine.enabled_axes();
        let axes = axes.map(|(axis, file, line)| Self {
            axis: &axis.name,
            file,
            line,
        });
        axes.collect()
    }
}

/// The changes of some kinds.
struct Changes<'a> {
    all: &'a [Change],
    state: StateView<'a>,
    kinds: KindSet,
}

impl<'a> Changes<'a> {
    fn iter(&self) -> impl Iterator<Item = &'a Change> {
        let kinds = self.kinds;
        self.all
            .iter()
            .filter(move |change| kinds.contains(change.kind))
    }

    fn is_empty(&self) -> bool {
        self.iter().next().is_none()
    }
}

impl Serialize for Changes<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Object<'a> {
            axis: &'a str,
            kind: Kind,
            from: State,
            to: State,
        }
        serializer.collect_seq(self.iter().map(|change| Object {
            axis: self.state.name(change.axis),
            kind: change.kind,
            from: change.from,
            to: change.to,
        }))
    }
}

/// A record before its states.
#[derive(Serialize)]
#[serde(tag = "record", rename_all = "lowercase")]
enum Object<'a> {
    Session {
        schema: u32,
        tool: &'static str,
        axes: ListedAxes<'a>,
        #[serde(skip_serializing_if = "Option::is_none")]
        remark: Option<&'a str>,
    },
    Program {
        program: u32,
        file: &'a str,
        name: Option<&'a str>,
    },
    Block {
        program: u32,
        seq: u64,
        file: &'a str,
        line: u32,
        n: Option<i64>,
        #[serde(skip_serializing_if = "Option::is_none")]
        level: Option<u32>,
        text: &'a str,
        #[serde(skip_serializing_if = "Option::is_none")]
        branch: Option<&'a [Vec<WayCondition>]>,
        changes: Changes<'a>,
    },
    Join {
        program: u32,
        seq: u64,
        file: &'a str,
        line: u32,
    },
    Diagnostic {
        #[serde(skip_serializing_if = "Option::is_none")]
        program: Option<u32>,
        #[serde(skip_serializing_if = "Option::is_none")]
        seq: Option<u64>,
        #[serde(flatten)]
        diagnostic: &'a Diagnostic,
    },
    End {
        program: u32,
        seq: u64,
        by: &'static str,
        // Program end never changes friction compensation (R1.27); kinds with manual activation
        // switch off.
        #[serde(skip_serializing_if = "Changes::is_empty")]
        changes: Changes<'a>,
        #[serde(skip_serializing_if = "<[_]>::is_empty")]
        repeated: &'a [Repeat],
    },
    Summary {
        programs: u32,
        blocks: u64,
        errors: u64,
        warnings: u64,
        opaque: &'a BTreeMap<String, u64>,
        #[serde(skip_serializing_if = "Uncompensated::is_empty")]
        uncompensated: Uncompensated<'a>,
        #[serde(skip_serializing_if = "ReadingsInForce::is_empty")]
        rests_on: ReadingsInForce,
        #[serde(skip_serializing_if = "Vec::is_empty")]
        assuming: Vec<EnabledAxis<'a>>,
    },
}

impl<'a> Object<'a> {
    fn of(record: &Record<'a>, kinds: KindSet) -> Self {
        let changes = |all, state| Changes { all, state, kinds };
        match *record {
            Record::Session { state, remark } => Self::Session {
                schema: SCHEMA,
                tool: TOOL,
                axes: ListedAxes(state),
                remark,
            },
            Record::Machine(diagnostic) => Self::said(&DiagnosticRecord::of_machine(diagnostic)),
            Record::Program {
                program,
                file,
                name,
                ..
            } => Self::Program {
                program,
                file,
                name,
            },
            Record::Block(row) => Self::Block {
                program: row.program,
                seq: row.seq,
                file: row.file,
                line: row.line,
                n: row.number,
                level: row.level,
                text: row.text,
                branch: row.branch,
                changes: changes(row.changes, row.state),
            },
            Record::Join(join) => Self::Join {
                program: join.program,
                seq: join.seq,
                file: join.file,
                line: join.line,
            },
            Record::End(end) => Self::End {
                program: end.program,
                seq: end.seq,
                by: end.by.as_str(),
                changes: changes(end.changes, end.state),
                repeated: end.repeated,
            },
            Record::Summary(summary) => Self::Summary {
                programs: summary.programs,
                blocks: summary.blocks,
                errors: summary.count(Severity::Error),
                warnings: summary.count(Severity::Warning),
                opaque: summary.opaque,
                uncompensated: Uncompensated(summary),
                rests_on: ReadingsInForce::of(summary.rests_on, summary.state.machine),
                assuming: EnabledAxis::of(summary.state.machine),
            },
        }
    }

    fn said(record: &DiagnosticRecord<'a>) -> Self {
        Self::Diagnostic {
            program: record.block.map(|(program, _)| program),
            seq: record.block.map(|(_, seq)| seq),
            diagnostic: record.diagnostic,
        }
    }
}

impl<'a> Record<'a> {
    /// Returns the state after the record; `None` for a message about the machine's lists.
    pub fn state(&self) -> Option<StateView<'a>> {
        match *self {
            Self::Machine(_) => None,
            Self::Session { state, .. } | Self::Program { state, .. } => Some(state),
            Self::Block(row) => Some(row.state),
            Self::Join(join) => Some(join.state),
            Self::End(end) => Some(end.state),
            Self::Summary(summary) => Some(summary.state),
        }
    }

    /// Returns the serialised form with the changes and states of some kinds.
    pub fn with_states(&self, kinds: KindSet) -> impl Serialize {
        #[derive(Serialize)]
        struct Whole<'a> {
            #[serde(flatten)]
            object: Object<'a>,
            #[serde(flatten)]
            states: Option<States<'a>>,
        }
        Whole {
            object: Object::of(self, kinds),
            states: self.state().map(|state| States::of(state, kinds)),
        }
    }
}

impl Serialize for Record<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.with_states(KindSet::of(Kind::Frict))
            .serialize(serializer)
    }
}

impl Serialize for Row<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Record::Block(*self).serialize(serializer)
    }
}

impl Serialize for Join<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Record::Join(*self).serialize(serializer)
    }
}

impl Serialize for End<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Record::End(*self).serialize(serializer)
    }
}

impl Serialize for Summary<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Record::Summary(self).serialize(serializer)
    }
}

impl Serialize for DiagnosticRecord<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Object::said(self).serialize(serializer)
    }
}

impl Serialize for Repeat {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Object<'a> {
            code: Code,
            file: &'a str,
            line: u32,
            column: u32,
            times: u64,
        }
        let object = Object {
            code: self.code,
            file: &self.file,
            line: self.line,
            column: self.start.column,
            times: self.times,
        };
        object.serialize(serializer)
    }
}

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

    /// Returns whether there are none.
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
