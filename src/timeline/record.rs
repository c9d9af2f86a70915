//! The records and the sinks that take them.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::ops::ControlFlow;

use serde::Serialize;

use crate::comp::{AxisIndex, Change, Compensation, Kind, KindSet, State};
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::interpreter::{EndedBy, Modal, Motion, PossibleStates, WayCondition, ways_in_words};
use crate::lint::EndNote;
use crate::machine::Machine;
use crate::readings::QuestionSet;
use crate::text::Position;

/// The number of the record format.
pub const SCHEMA: u32 = 2;

/// The name and version that the session record carries.
pub const TOOL: &str = concat!("frictcomp ", env!("CARGO_PKG_VERSION"));

/// The compensation of all axes at one moment.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct StateView<'a> {
    /// The machine, for the names of the axes.
    pub machine: &'a Machine,
    /// The state of all kinds on all axes.
    pub compensation: &'a Compensation,
    /// Kinds that are unknown because ways differ, with their possible states.
    pub possible: &'a [PossibleStates],
    /// The listed axes, by position: all of a configured machine; of an unconfigured one those that occurred so far.
    pub listed: &'a [bool],
    /// Number that increases whenever a state or the axis list changes, so that a writer may reuse its output.
    pub version: u64,
}

impl<'a> StateView<'a> {
    /// Returns the listed axes in the machine's order, with their names.
    pub fn axes(self) -> impl Iterator<Item = (AxisIndex, &'a str)> {
        self.machine
            .axes
            .iter()
            .zip(self.listed)
            .enumerate()
            .filter(|(_, (_, listed))| **listed)
            .map(|(index, (axis, _))| (AxisIndex::new(index), axis.name.as_str()))
    }

    /// Returns the state of one kind on one axis.
    pub fn state(self, axis: AxisIndex, kind: Kind) -> State {
        self.compensation.state(axis, kind)
    }

    /// Returns the possible states of one kind on one axis, if it is unknown because ways differ.
    pub fn possible_of(self, axis: AxisIndex, kind: Kind) -> Option<&'a PossibleStates> {
        let mut possible = self.possible.iter();
        possible.find(|it| (it.axis, it.kind) == (axis, kind))
    }

    /// Returns the name of an axis.
    pub fn name(self, axis: AxisIndex) -> &'a str {
        &self.machine.axis(axis).name
    }
}

/// One executed block.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Row<'a> {
    /// The program of the session, from 1.
    pub program: u32,
    /// The executed block of the program, from 1, loops included.
    pub seq: u64,
    /// The file that contains the block.
    pub file: &'a str,
    /// The line on which the block starts, from 1.
    pub line: u32,
    /// The block number, if it is known.
    pub number: Option<i64>,
    /// The call depth, from 1; absent in the main program.
    pub level: Option<u32>,
    /// The source lines joined by `\n`, without trailing blanks.
    pub text: &'a str,
    /// Changes by the block, of every kind, in the order of the commands.
    pub changes: &'a [Change],
    /// The state after the block.
    pub state: StateView<'a>,
    /// G functions and positions after the block.
    pub modal: &'a Modal,
    /// The axes that the block certainly moves at feed without friction compensation (R13.12).
    pub uncompensated: &'a [AxisIndex],
    /// Motion of the block, where the session takes motions.
    pub motion: Option<&'a Motion>,
    /// The machine's answers that lead to the block, if it is executed on some ways only: a list of ways, each a list
    /// of conditions that hold together.
    pub branch: Option<&'a [Vec<WayCondition>]>,
    /// Messages on the block, written right after it.
    pub diagnostics: &'a [Diagnostic],
    /// Messages of the interpreter on the block, before the user's severities and `allow` comments.
    pub reported: &'a [Diagnostic],
}

impl Row<'_> {
    /// Returns the ways on which the block is executed, in words: `V.E.A == 2 (line 12), or if skip level 1 is off`;
    /// `None` if it is executed on all of them (R14.2).
    pub fn branch_in_words(&self) -> Option<String> {
        self.branch.map(|ways| ways_in_words(ways, self.file))
    }
}

/// A block before which ways that differ in an answer of the machine meet again (R14.2).
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Join<'a> {
    /// The program of the session, from 1.
    pub program: u32,
    /// Number of blocks of the program executed before it.
    pub seq: u64,
    /// The file that contains the block at which they meet.
    pub file: &'a str,
    /// The line on which that block starts, from 1.
    pub line: u32,
    /// The state that all of them may leave.
    pub state: StateView<'a>,
}

/// Repetitions of a remark that was made once.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Repeat {
    /// The remark.
    pub code: Code,
    /// Path of the file as shown.
    pub file: String,
    /// The line of the remark.
    pub line: u32,
    /// The number of executed blocks to which it applied.
    pub times: u64,
    /// Position of the remark.
    pub start: Position,
    /// Message.
    pub message: String,
}

/// The end of a program.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct End<'a> {
    /// The program of the session, from 1.
    pub program: u32,
    /// Number of executed blocks.
    pub seq: u64,
    /// The reason for its end.
    pub by: EndedBy,
    /// Notes at the end (FC401, FC403, …), written before the end record.
    pub notes: &'a [EndNote],
    /// Remarks made once for a place although they applied more often.
    pub repeated: &'a [Repeat],
    /// Changes by the program end itself (kinds with manual activation).
    pub changes: &'a [Change],
    /// The state that the next program starts with.
    pub state: StateView<'a>,
}

/// Summary of one axis.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct AxisSummary {
    /// Kinds other than friction compensation that differ from the start of the control.
    pub others_away: KindSet,
    /// Position of the axis in the machine.
    pub axis: AxisIndex,
    /// Friction compensation when the session began.
    pub start: State,
    /// Friction compensation now.
    pub end: State,
    /// Friction compensation at the start of the control (R1.22).
    pub start_up: State,
    /// Whether the axis is reported as left away from its start-up state (FC401, FC407), or the user silenced that
    /// message.
    pub told: bool,
    /// The blocks that changed it: file, line and block number of at most the first hundred.
    pub changed_by: Vec<ChangedBy>,
    /// Number of executed blocks that changed it.
    pub changes: u64,
    /// The feed moves of the axis while it was not active.
    pub feed_moves: FeedMoves,
    /// Whether programs move or switch the axis though no source describes its friction compensation: its states are
    /// then only assumed (R18.2).
    pub is_undescribed: bool,
    /// Whether a program wrote a parameter of its friction compensation into the machine data: a command does then not
    /// make its state known (R2.92).
    pub is_rewritten: bool,
}

impl AxisSummary {
    /// Returns whether friction compensation, or another kind, is certainly left away from its start-up state.
    pub fn is_left_away(&self) -> bool {
        let is_away = self.end != self.start_up && self.end != State::Unknown;
        is_away || !self.others_away.is_empty()
    }
}

/// A block that changed an axis.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ChangedBy {
    /// The program of the session, from 1.
    pub program: u32,
    /// The file that holds the block.
    pub file: String,
    /// The line of the block.
    pub line: u32,
    /// The block number.
    pub number: Option<i64>,
    /// The state after it.
    pub to: State,
}

/// A message that a comment silences (R9.24).
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct SilencedMessage {
    /// The file that holds the comment.
    pub file: String,
    /// The line of the block.
    pub line: u32,
    /// The silenced code.
    pub code: Code,
    /// The reason that the comment gives.
    pub reason: Option<String>,
}

impl fmt::Display for SilencedMessage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            file,
            line,
            code,
            reason,
        } = self;
        write!(f, "{file}:{line}: {code} is silenced")?;
        match reason {
            Some(reason) => write!(f, ": {reason}"),
            None => f.write_str(", without a reason"),
        }
    }
}

/// The end of a session.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Summary<'a> {
    /// Number of programs started.
    pub programs: u32,
    /// Number of executed blocks.
    pub blocks: u64,
    /// Number of diagnostics by severity.
    pub counts: BTreeMap<Severity, u64>,
    /// Words accepted and passed over, with their number.
    pub opaque: &'a BTreeMap<String, u64>,
    /// Summary of each listed axis.
    pub axes: Vec<AxisSummary>,
    /// The codes of messages that limit the validity of the states (R2.94): these rest on an assumption about what only
    /// the machine knows (FC210, FC325, FC902), or the control stops on some ways.
    pub assumed: BTreeSet<Code>,
    /// The messages that comments silence, with their reasons (R18.29).
    pub silenced: &'a BTreeSet<SilencedMessage>,
    /// The open questions whose readings the results depend on (R15.3).
    pub rests_on: QuestionSet,
    /// The final state.
    pub state: StateView<'a>,
}

impl Summary<'_> {
    /// Returns the number of diagnostics of a severity.
    pub fn count(&self, severity: Severity) -> u64 {
        self.counts.get(&severity).copied().unwrap_or_default()
    }

    /// Returns the axes with feed moves while their friction compensation was not active (R13.12).
    pub fn uncompensated(&self) -> impl Iterator<Item = &AxisSummary> {
        self.axes.iter().filter(|axis| !axis.feed_moves.is_empty())
    }
}

/// One record of a session.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Record<'a> {
    /// The control started, or the state file was loaded.
    Session {
        /// The state that the first program starts with.
        state: StateView<'a>,
        /// Remark at the top: no machine is described (R1.37).
        remark: Option<&'a str>,
    },
    /// A message about the machine's lists; the programs have not begun.
    Machine(&'a Diagnostic),
    /// A program begins.
    Program {
        /// The program of the session, from 1.
        program: u32,
        /// The file as the user named it.
        file: &'a str,
        /// The name after `%`.
        name: Option<&'a str>,
        /// The state that it starts with.
        state: StateView<'a>,
    },
    /// A block was executed.
    Block(Row<'a>),
    /// Ways meet.
    Join(Join<'a>),
    /// A program ended.
    End(End<'a>),
    /// The session ended.
    Summary(&'a Summary<'a>),
}

impl<'a> Record<'a> {
    /// Returns the diagnostics of the record, in the order in which they are written: those of a block after it, those
    /// of an end before it.
    pub fn diagnostics(&self) -> impl Iterator<Item = DiagnosticRecord<'a>> {
        let (program, row, notes): (_, Option<Row<'a>>, &'a [EndNote]) = match *self {
            Self::Block(row) => (row.program, Some(row), &[]),
            Self::End(end) => (end.program, None, end.notes),
            _ => (0, None, &[]),
        };
        let of_block = row.into_iter().flat_map(|row| {
            let block = (row.program, row.seq);
            let diagnostics = row.diagnostics.iter();
            diagnostics.map(move |diagnostic| DiagnosticRecord {
                block: Some(block),
                diagnostic,
            })
        });
        of_block.chain(notes.iter().map(move |note| DiagnosticRecord {
            block: Some((program, note.seq)),
            diagnostic: &note.diagnostic,
        }))
    }
}

/// A diagnostic as a separate record.
#[derive(Debug, Clone, Copy)]
pub struct DiagnosticRecord<'a> {
    /// The number of the program and the executed block; `None` for messages about the machine.
    pub(super) block: Option<(u32, u64)>,
    pub(super) diagnostic: &'a Diagnostic,
}

impl<'a> DiagnosticRecord<'a> {
    /// Returns the record of a message on the machine's lists.
    pub fn of_machine(diagnostic: &'a Diagnostic) -> Self {
        Self {
            block: None,
            diagnostic,
        }
    }

    /// Returns the diagnostic.
    pub fn diagnostic(&self) -> &'a Diagnostic {
        self.diagnostic
    }
}

/// Takes the records of a session.
///
/// A closure is a sink, too.
pub trait Sink {
    /// Takes one record. `Break` ends the dry run, for a closed pipe or a user's interrupt.
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()>;

    /// Returns whether the record of a quiet block is to follow. Most blocks are quiet: they switch nothing, nothing is
    /// said on them, and their axes have moved before.
    fn takes_quiet(&mut self) -> bool {
        true
    }
}

impl<F: FnMut(&Record<'_>) -> ControlFlow<()>> Sink for F {
    fn record(&mut self, record: &Record<'_>) -> ControlFlow<()> {
        self(record)
    }
}

/// The feed moves of an axis while its friction compensation was not active (R13.12). Rapid motion
/// does not count, nor does an axis without P-AXIS-00522 = 1.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct FeedMoves {
    /// Number of moves while it was inactive.
    pub off: u64,
    /// Number of moves while it was selected without effect.
    pub ineffective: u64,
    /// Number of moves for which it is unknown whether compensation was active, whether they are made, or whether they
    /// are rapid.
    pub unknown: u64,
    /// The longest travel of the axis without compensation, in mm or degrees, forth and back along an arc, among the
    /// moves of known length.
    pub longest: Option<f64>,
    /// Number of moves without compensation whose length is unknown: those whose start or end is unknown, and lines
    /// whose start or end is not a machine position.
    pub unmeasured: u64,
}

impl FeedMoves {
    /// Returns the number of moves made without compensation.
    pub fn without(&self) -> u64 {
        self.off + self.ineffective
    }

    /// Returns whether there are no such moves.
    pub fn is_empty(&self) -> bool {
        self.without() == 0 && self.unknown == 0
    }

    /// Adds the moves of another session.
    pub fn append(&mut self, other: &Self) {
        self.off += other.off;
        self.ineffective += other.ineffective;
        self.unknown += other.unknown;
        self.unmeasured += other.unmeasured;
        self.see(other.longest);
    }

    /// Returns whether a length is zero once it is rounded to a nanometre.
    pub(crate) fn is_standstill(length: f64) -> bool {
        length * 1e6 < 0.5
    }

    /// Adds a move in a state without compensation.
    pub(crate) fn add(&mut self, state: State, length: Option<f64>) {
        match state {
            State::Ineffective => self.ineffective += 1,
            _ => self.off += 1,
        }
        self.unmeasured += u64::from(length.is_none());
        self.see(length);
    }

    fn see(&mut self, length: Option<f64>) {
        let longer = length.filter(|length| self.longest.is_none_or(|longest| *length > longest));
        let longer = longer.map(|length| (length * 1e6).round() / 1e6);
        self.longest = longer.or(self.longest);
    }
}
