//! The serialised form of records (chapter 9.2): the keys, and their order.

use serde::{Serialize, Serializer};

use super::possible::Possible;
use super::record::{
    DiagnosticRecord, End, Join, Record, Repeat, Row, SCHEMA, StateView, Summary, TOOL,
};
use crate::comp::{Change, Kind, KindSet, State};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::interpreter::WayCondition;

/// Axis → state of friction compensation.
struct Friction<'a>(StateView<'a>);

impl Serialize for Friction<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let states = self.0.axes();
        serializer.collect_map(states.map(|(axis, name)| (name, self.0.state(axis, Kind::Frict))))
    }
}

fn friction_of(state: StateView<'_>) -> Possible<'_> {
    Possible::of(state, KindSet::of(Kind::Frict))
}

/// The names of the listed axes.
struct Axes<'a>(StateView<'a>);

impl Serialize for Axes<'_> {
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

/// The changes of friction compensation.
struct Changes<'a> {
    changes: &'a [Change],
    state: StateView<'a>,
}

#[derive(Serialize)]
struct ChangeObject<'a> {
    axis: &'a str,
    kind: Kind,
    from: State,
    to: State,
}

impl<'a> Changes<'a> {
    fn of(changes: &'a [Change], state: StateView<'a>) -> Self {
        Self { changes, state }
    }

    fn iter(&self) -> impl Iterator<Item = &'a Change> {
        self.changes
            .iter()
            .filter(|change| change.kind == Kind::Frict)
    }

    fn is_empty(&self) -> bool {
        self.iter().next().is_none()
    }
}

impl Serialize for Changes<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter().map(|change| ChangeObject {
            axis: self.state.name(change.axis),
            kind: change.kind,
            from: change.from,
            to: change.to,
        }))
    }
}

#[derive(Serialize)]
#[serde(tag = "record", rename_all = "lowercase")]
enum Object<'a> {
    Session {
        schema: u32,
        tool: &'static str,
        axes: Axes<'a>,
        #[serde(skip_serializing_if = "Option::is_none")]
        remark: Option<&'a str>,
        friction: Friction<'a>,
        #[serde(skip_serializing_if = "Possible::is_empty")]
        possible: Possible<'a>,
    },
    Program {
        program: u32,
        file: &'a str,
        name: Option<&'a str>,
        friction: Friction<'a>,
        #[serde(skip_serializing_if = "Possible::is_empty")]
        possible: Possible<'a>,
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
        friction: Friction<'a>,
        #[serde(skip_serializing_if = "Possible::is_empty")]
        possible: Possible<'a>,
    },
    Join {
        program: u32,
        seq: u64,
        file: &'a str,
        line: u32,
        friction: Friction<'a>,
        #[serde(skip_serializing_if = "Possible::is_empty")]
        possible: Possible<'a>,
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
        #[serde(skip_serializing_if = "Changes::is_empty")]
        changes: Changes<'a>,
        #[serde(skip_serializing_if = "<[_]>::is_empty")]
        repeated: &'a [Repeat],
        friction: Friction<'a>,
        #[serde(skip_serializing_if = "Possible::is_empty")]
        possible: Possible<'a>,
    },
    Summary {
        programs: u32,
        blocks: u64,
        errors: u64,
        warnings: u64,
        opaque: &'a std::collections::BTreeMap<String, u64>,
        #[serde(skip_serializing_if = "Uncompensated::is_empty")]
        uncompensated: Uncompensated<'a>,
        friction: Friction<'a>,
        #[serde(skip_serializing_if = "Possible::is_empty")]
        possible: Possible<'a>,
    },
}

impl Serialize for Row<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let object = Object::Block {
            program: self.program,
            seq: self.seq,
            file: self.file,
            line: self.line,
            n: self.number,
            level: self.level,
            text: self.text,
            branch: self.branch,
            changes: Changes::of(self.changes, self.state),
            friction: Friction(self.state),
            possible: friction_of(self.state),
        };
        object.serialize(serializer)
    }
}

impl Serialize for Join<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let object = Object::Join {
            program: self.program,
            seq: self.seq,
            file: self.file,
            line: self.line,
            friction: Friction(self.state),
            possible: friction_of(self.state),
        };
        object.serialize(serializer)
    }
}

impl Serialize for End<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let object = Object::End {
            program: self.program,
            seq: self.seq,
            by: self.by.as_str(),
            changes: Changes::of(self.changes, self.state),
            repeated: self.repeated,
            friction: Friction(self.state),
            possible: friction_of(self.state),
        };
        object.serialize(serializer)
    }
}

impl Serialize for Summary<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let object = Object::Summary {
            programs: self.programs,
            blocks: self.blocks,
            errors: self.count(Severity::Error),
            warnings: self.count(Severity::Warning),
            opaque: self.opaque,
            uncompensated: Uncompensated(self),
            friction: Friction(self.state),
            possible: friction_of(self.state),
        };
        object.serialize(serializer)
    }
}

impl Serialize for Record<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match *self {
            Self::Session { state, remark } => Object::Session {
                schema: SCHEMA,
                tool: TOOL,
                axes: Axes(state),
                remark,
                friction: Friction(state),
                possible: friction_of(state),
            }
            .serialize(serializer),
            Self::Machine(diagnostic) => {
                DiagnosticRecord::of_machine(diagnostic).serialize(serializer)
            }
            Self::Program {
                program,
                file,
                name,
                state,
            } => Object::Program {
                program,
                file,
                name,
                friction: Friction(state),
                possible: friction_of(state),
            }
            .serialize(serializer),
            Self::Block(ref row) => row.serialize(serializer),
            Self::Join(ref join) => join.serialize(serializer),
            Self::End(ref end) => end.serialize(serializer),
            Self::Summary(summary) => summary.serialize(serializer),
        }
    }
}

impl Serialize for DiagnosticRecord<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let object = Object::Diagnostic {
            program: self.block.map(|(program, _)| program),
            seq: self.block.map(|(_, seq)| seq),
            diagnostic: self.diagnostic,
        };
        object.serialize(serializer)
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
