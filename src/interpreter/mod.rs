//! Executes programs block by block: flow, expressions, modal state, COMP commands.
//!
//! It opens no file and prints nothing. A host hands it texts and a [`Finder`] for called
//! programs, and listens with an [`Observer`]. Everything that a run depends on is data, so it
//! can be stopped, saved and resumed at any block of a program that is held in memory.

#![allow(
    clippy::unnecessary_box_returns,
    reason = "faults travel boxed in results; what makes one boxes it"
)]

mod axes;
mod block;
mod control;
mod coupling;
mod drive;
mod events;
mod executor;
mod lasting;
mod motion;
mod options;
mod programs;
mod stack;
mod values;
mod ways;
mod words;

pub use drive::host::Interpreter;
pub use drive::snapshot::{ResumeError, Snapshot};
pub(crate) use events::RefusedMotion;
pub use events::{
    BlockMove, Ended, EndedBy, Event, Executed, Joined, Note, NoteKind, Notes, Observer, Outcome,
    ProgramEnd,
};
pub(crate) use motion::block::BlockMotion;
pub use motion::form::{
    Arc as CircularArc, ArcShape, AxisWord, BlockEnd, Centre, Motion, Motions, MovedAxis, PathFeed,
    PathForm, SAME_PLACE, ToolSide, Travel, Turn,
};
pub use motion::modal::{AxisPosition, GFunctions, Modal, PositionFrame};
pub use motion::pace::ProgrammedFeed;
pub use motion::pace::{Contouring, Joining};
pub use options::{
    Branches, Limits, NoSearchedBlock, Options, RunOutcome, SearchedBlock, StopPolicy,
};
pub use programs::calls::{CallSite, Finder, NoFiles, NoProgram, call_sites, holds_program_end};
pub(crate) use values::handover::VariableUse;
pub use values::handover::{ArrayShape, Carried, FoundVariables};
pub use values::location::{ChangedVariable, MissingProgram, Unknown, UnknownText};
pub use values::value::Value;
pub(crate) use ways::history::{BlockSite, FoundOn, FoundStates, KindEffect, Split, UntouchedOn};
pub use ways::possible_state::{CarriedWays, PossibleState, PossibleStates};
pub(crate) use ways::set::WayAnswer;
pub use ways::words::{BlockCondition, WayChange, WayCondition};
pub(crate) use ways::words::{limit_to, ways_in_words};

pub use crate::language::{Certainty, Group, MotionKind, Simplification, Simplifications};
