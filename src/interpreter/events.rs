//! The events of a run.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::comp::{AxisIndex, Change, CompCommand, Compensation, CompensationError, Kind, KindSet};
use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::block::FailedAt;
use crate::interpreter::motion::block::BlockMotion;
use crate::interpreter::motion::form::{AxisWord, Motion, MovedAxis};
use crate::interpreter::motion::modal::Modal;
use crate::interpreter::values::location::Unknown;
use crate::interpreter::ways::history::{FoundStates, History, RepeatedSwitch};
use crate::interpreter::ways::possible_state::PossibleStates;
use crate::interpreter::ways::words::WayCondition;
use crate::language::{Certainty, MotionKind};
use crate::syntax::ast::Block;
use crate::syntax::{Comments, Remark};
use crate::text::Place;

crate::words! {
    /// Reason why a program ended.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
    #[cfg_attr(not(feature = "unstable"), non_exhaustive)]
    pub enum EndedBy {
        /// M30.
        M30 = "M30",
        /// M02.
        M02 = "M02",
        /// The file ended without either.
        EndOfFile = "end-of-file",
        /// An error of the control.
        Error = "error",
        /// A budget was used up.
        Budget = "budget",
    }
}

/// Result of a COMP command.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Outcome {
    /// The command.
    pub command: CompCommand,
    /// The axis, or the control's refusal.
    pub result: Result<AxisIndex, CompensationError>,
    /// Number of the block's changes that it made.
    pub changes: usize,
    /// The kinds that it switches as they were switched before.
    pub(crate) repeated: RepeatedSwitch,
}

/// Finding of a run that may interest a user.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Note {
    /// The reason.
    pub kind: NoteKind,
    /// The value's name, or the word that was passed over.
    pub name: String,
    /// Place of the finding.
    pub place: Place,
}

/// Reason for a [`Note`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum NoteKind {
    /// A value that only the machine knows was read (R2.50).
    Unknown,
    /// A word or command was accepted and passed over.
    Opaque,
}

/// Recording of notes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Notes {
    /// Notes are not taken.
    #[default]
    None,
    /// Notes are taken, with their places.
    Taken,
}

/// Details of a block that are rarely requested.
#[derive(Debug, Clone, Default)]
pub(crate) struct Aside {
    /// The states of compensation that it reads (R1.35).
    pub(crate) asked: Vec<(AxisIndex, Kind)>,
    /// Motions that the control refuses in the state that the program found (R1.36).
    pub(crate) refused: Vec<RefusedMotion>,
    /// Withheld messages about unknown values, because nothing differs or because they were reported
    /// before; a comment that allows one is in use (R2.95).
    pub(crate) withheld: Vec<Diagnostic>,
}

/// A motion of an axis that the control refuses for want of a compensation that the program did not switch.
#[derive(Debug, Clone)]
pub(crate) struct RefusedMotion {
    pub(crate) axis: AxisIndex,
    /// The compensation that it lacks.
    pub(crate) lacks: Kind,
    pub(crate) motion: MotionKind,
    /// The ways on which it is refused; empty for all.
    pub(crate) ways: Vec<Vec<WayCondition>>,
}

/// A block that was executed.
#[derive(Debug, Clone, Copy)]
pub struct Executed<'a> {
    /// The executed block of the program, from 1.
    pub seq: u64,
    /// The file that holds it.
    pub file: &'a Arc<str>,
    /// The line on which it starts, from 1.
    pub line: u32,
    /// The source lines joined by `\n`, without trailing blanks.
    pub text: &'a str,
    /// Comments of the text.
    pub comments: Comments,
    /// The comment line directly above that is addressed to this tool.
    pub remark: Option<&'a Remark>,
    /// Block number, where it is known.
    pub number: Option<i64>,
    /// The call depth, from 1; absent in the main program.
    pub level: Option<u32>,
    /// Tree of the block.
    pub block: &'a Block,
    /// Executed COMP commands, from left to right.
    pub outcomes: &'a [Outcome],
    /// Changes by the block.
    pub changes: &'a [Change],
    /// Kinds that the block leaves unknown though no command of it names them (R2.51).
    pub doubted: &'a [(AxisIndex, KindSet)],
    /// Axis words that move an axis; [`motions`](Self::motions) has every axis that it moves.
    pub moved: &'a [AxisWord],
    /// Motion of the block.
    pub(crate) moves: &'a BlockMotion,
    /// Details that are rarely requested.
    pub(crate) aside: &'a Aside,
    /// The axes that it moves, or may, without their own word: by a command in their bracket, through
    /// another axis, in a rotated frame, or by something that it calls or contains and that is not
    /// executed here (R10.7, R2.51, R2.52).
    pub also_moved: &'a [MovedAxis],
    /// Motion of its axis words, where the G functions in force do not decide it.
    pub word_motion: Option<MotionKind>,
    /// Motion of the block, where motions are taken.
    pub motion: Option<&'a Motion>,
    /// The notes on it, where they are taken.
    pub notes: &'a [Note],
    /// Messages on the block, in no order.
    pub diagnostics: &'a [Diagnostic],
    /// Whether an error stopped the program in this block.
    pub stopped: bool,
    /// Whether a block search passes the block: nothing moves in it (R2.96).
    pub passed: bool,
    /// The state after it.
    pub compensation: &'a Compensation,
    /// Kinds that are unknown because ways differ, with their possible states.
    pub possible: &'a [PossibleStates],
    /// Kinds in the state that the program found.
    pub(crate) found: FoundStates<'a>,
    /// The error before it at which the control stops, where the run goes on after errors (R9.20).
    pub(crate) failed: Option<&'a FailedAt>,
    /// The answers of the machine that lead here, where the block is executed on some ways only.
    pub branch: Option<&'a [Vec<WayCondition>]>,
    /// G functions and positions after it.
    pub modal: &'a Modal,
    /// The axes that occurred so far.
    pub occurred: &'a [bool],
    /// Rises whenever the state or the axes that occurred change.
    pub version: u64,
}

/// The part of an executed block that concerns motion.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct BlockMove<'a> {
    /// Comments of the text.
    pub comments: Comments,
    /// The comment line directly above that is addressed to this tool.
    pub remark: Option<&'a Remark>,
    /// Motion of the block.
    pub(crate) moves: &'a BlockMotion,
    /// The answers of the machine that lead here, where the block is executed on some ways only.
    pub branch: Option<&'a [Vec<WayCondition>]>,
    /// The state after it.
    pub compensation: &'a Compensation,
    /// G functions and positions after it.
    pub modal: &'a Modal,
    /// Rises whenever the state or the axes that occurred change.
    pub version: u64,
}

impl<'a> BlockMove<'a> {
    /// Returns every axis that the block moves, or may, and how (R10.7): its words first.
    #[inline]
    pub fn motions(&self) -> impl Iterator<Item = MovedAxis> + use<'a> {
        let kind = self.word_kind();
        let words = self.moves.words().iter();
        let words = words.map(move |word| MovedAxis::of_word(word, kind));
        words.chain(self.moves.also_moved().iter().copied())
    }

    /// Returns whether the axis moves certainly or possibly other than in rapid motion; `None` if it does not.
    pub(crate) fn pace(&self, axis: AxisIndex) -> Option<Certainty> {
        let kind = self.word_kind();
        let words = self.moves.words().iter().filter(|it| it.axis == axis);
        let words = words.map(|word| MovedAxis::of_word(word, kind));
        let also = self.moves.also_moved().iter().filter(|it| it.axis == axis);
        let motions = words.chain(also.copied());
        // `Certain` comes first.
        motions.filter_map(|moved| self.feeds(&moved)).min()
    }

    /// Returns whether one of its motions is, or may be, at feed: a coupled axis, or one in a turned frame, moves as the
    /// axis words do. `None` in rapid motion and towards a reference point (R13.12, R18.4).
    pub(crate) fn feeds(&self, moved: &MovedAxis) -> Option<Certainty> {
        use MotionKind::{Coupled, Feed, Frame, Homing, Independent, Rapid, Unknown};
        match (moved.kind, self.word_kind()) {
            (Rapid | Homing, _) | (Coupled | Frame, Rapid | Homing) => None,
            (Unknown, _) | (Coupled | Frame, Unknown) => Some(Certainty::Possible),
            (Feed | Independent | Coupled | Frame, _) => Some(moved.certainty),
        }
    }

    /// Returns the kind of motion of its axis words.
    #[inline]
    fn word_kind(&self) -> MotionKind {
        self.moves.word_kind(self.modal)
    }
}

impl Executed<'_> {
    /// Returns every axis that the block moves, or may, and how (R10.7): its words first.
    #[inline]
    pub fn motions(&self) -> impl Iterator<Item = MovedAxis> {
        self.moves().motions()
    }

    /// Returns the part of the block that concerns motion.
    #[inline]
    pub(crate) fn moves(&self) -> BlockMove<'_> {
        BlockMove {
            comments: self.comments,
            remark: self.remark,
            moves: self.moves,
            branch: self.branch,
            compensation: self.compensation,
            modal: self.modal,
            version: self.version,
        }
    }

    /// Returns the states of a kind of an axis that are possible after it, where ways differ.
    #[inline]
    pub fn possible_of(&self, axis: AxisIndex, kind: Kind) -> Option<&PossibleStates> {
        let mut possible = self.possible.iter();
        possible.find(|it| it.axis == axis && it.kind == kind)
    }
}

/// Ways that continue as one.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Joined<'a> {
    /// Number of blocks of the program executed before.
    pub seq: u64,
    /// The block at which they meet.
    pub place: &'a Place,
    /// The state that all of them may leave.
    pub compensation: &'a Compensation,
    /// Kinds that are unknown because ways differ, with their possible states.
    pub possible: &'a [PossibleStates],
    /// The axes that occurred so far.
    pub occurred: &'a [bool],
    /// Rises whenever the state or the axes that occurred change.
    pub version: u64,
}

/// A place where a program ends, or may.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ProgramEnd {
    /// The block: `M30`, the last one of the file, or the one that an error stops.
    pub place: Place,
    /// Cause of the end.
    pub by: EndedBy,
    /// Whether no jump goes to that block, so that blocks before it in the text come before the end.
    pub is_passed_into: bool,
    /// Value that only the machine knows and that decides whether the program ends there; `None`
    /// for the end of the dry run.
    pub cause: Option<Unknown>,
    /// The state that is left there.
    pub compensation: Compensation,
}

impl ProgramEnd {
    /// Returns the unknown value that decides whether the program ends there, in words: `` `V.E.A` ``, a missing jump
    /// label.
    pub(crate) fn decided_by(&self) -> Option<String> {
        self.cause.as_ref().map(Unknown::quoted)
    }
}

/// The state at the errors after which a run goes on: on the control, the program ends there (R9.20).
#[derive(Debug)]
pub(crate) struct StoppedState {
    pub(crate) ends: Vec<ProgramEnd>,
    pub(crate) compensation: Compensation,
    pub(crate) possible: Vec<PossibleStates>,
    pub(crate) history: History,
}

/// The end of a program.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Ended<'a> {
    /// Number of executed blocks.
    pub seq: u64,
    /// Cause of the end.
    pub by: EndedBy,
    /// Whether the program would run until a reset ends it: its state repeats (R2.84).
    pub endless: bool,
    /// The block that ends it, for example `M30`, where it is written in a program.
    pub at: Option<&'a Place>,
    /// Every end that the program may reach (R1.58): first that of the dry run.
    pub ends: &'a [ProgramEnd],
    /// The commands that switched each kind, on each way that ends.
    pub(crate) found: FoundStates<'a>,
    /// The state at the errors on all ways, where the run went on after them.
    pub(crate) stopped: Option<&'a StoppedState>,
    /// The error at which the control stops on all ways, where the run went on after it.
    pub(crate) failed: Option<&'a FailedAt>,
    /// Changes by the program end itself.
    pub changes: &'a [Change],
    /// Messages on the program that belong to no executed block.
    pub diagnostics: &'a [Diagnostic],
    /// Number of further messages by code (R2.85).
    pub unsaid: &'a BTreeMap<Code, u64>,
    /// The state that is left.
    pub compensation: &'a Compensation,
    /// Kinds that are unknown because ways differ, with their possible states.
    pub possible: &'a [PossibleStates],
    /// The axes that occurred so far.
    pub occurred: &'a [bool],
    /// Rises whenever the state or the axes that occurred change.
    pub version: u64,
}

/// Event of a run.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Event<'a> {
    /// A program begins; its name is the text after `%`.
    Started {
        /// The name, where it has one.
        name: Option<&'a str>,
        /// The state that it starts with.
        compensation: &'a Compensation,
        /// Kinds that are unknown because ways differ, with their possible states.
        possible: &'a [PossibleStates],
        /// The axes that occurred so far.
        occurred: &'a [bool],
        /// Rises whenever the state or the axes that occurred change.
        version: u64,
    },
    /// A block was executed.
    Executed(Executed<'a>),
    /// Ways that differ in an answer of the machine meet before a block (R14.1). A run does not stop
    /// here; `Break` has no effect.
    Joined(Joined<'a>),
    /// The program ended.
    Ended(Ended<'a>),
}

/// Listens to a run.
pub trait Observer {
    /// Takes an event; `Break` stops the run, which can be resumed.
    fn event(&mut self, event: Event<'_>) -> ControlFlow<()>;

    /// Returns whether an event is to follow about a quiet block, as most are: it switches nothing, nothing is said on it,
    /// and its axes have moved before. An observer that needs no more of it than this saves most of the time that events
    /// take.
    #[inline]
    fn takes_quiet(&mut self, _block: &BlockMove<'_>) -> bool {
        true
    }
}

impl<F: FnMut(Event<'_>) -> ControlFlow<()>> Observer for F {
    fn event(&mut self, event: Event<'_>) -> ControlFlow<()> {
        self(event)
    }
}
