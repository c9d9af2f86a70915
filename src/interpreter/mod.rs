//! Executes programs block by block: flow, expressions, modal state, COMP commands.
//!
//! It opens no file and prints nothing. A host hands it texts and a [`Finder`] for called
//! programs, and listens with an [`Observer`]. Everything that a run depends on is data, so it
//! can be stopped, saved and resumed at any block of a program that is held in memory.

#![allow(
    clippy::unnecessary_box_returns,
    reason = "faults travel boxed in results; what makes one boxes it"
)]

mod blocks;
mod coordinates;
mod effects;
mod execution;
mod programs;
mod run;
mod unknown;
mod values;
mod ways;

pub use coordinates::arc::{ArcShape, SAME_PLACE};
pub use coordinates::axis_words::AxisWord;
pub use coordinates::contouring::{Contouring, Joining};
pub use coordinates::g_functions::GFunctions;
pub use coordinates::modal::{AxisPosition, Modal, PositionFrame};
pub use coordinates::motion::{
    Arc as CircularArc, BlockEnd, Centre, Motion, Motions, PathFeed, PathForm, ToolSide, Travel,
    Turn,
};
pub use coordinates::moving::MovedAxis;
pub use coordinates::pace::ProgrammedFeed;
pub use execution::snapshot::{ResumeError, Snapshot};
pub use programs::call_sites::{CallSite, call_sites, holds_program_end};
pub use programs::finder::{Finder, NoFiles, NoProgram};
pub use run::event::{
    Ended, EndedBy, Event, Executed, Joined, Note, NoteKind, Notes, Observer, Outcome, ProgramEnd,
};
pub use run::interpreter::Interpreter;
pub use run::limits::Limits;
pub use run::options::{Branches, Options, RunOutcome, StopPolicy};
pub use run::search::{NoSearchedBlock, SearchedBlock};
pub use values::carried::{ArrayShape, Carried};
pub use values::cause::{ChangedVariable, MissingProgram, Unknown, UnknownText};
pub use values::found::FoundVariables;
pub(crate) use values::found::VariableUse;
pub use values::value::Value;
pub(crate) use ways::block_site::BlockSite;
pub use ways::carried::CarriedWays;
pub(crate) use ways::found_states::{FoundOn, FoundStates, UntouchedOn};
pub(crate) use ways::history::{KindEffect, Split};
pub use ways::possible_state::{PossibleState, PossibleStates};
pub(crate) use ways::set::WayAnswer;
pub use ways::words::{BlockCondition, WayChange, WayCondition};
pub(crate) use ways::words::{limit_to, ways_in_words};

pub use crate::language::{Certainty, Group, MotionKind, Simplification, Simplifications};
