//! Executes programs block by block: flow, expressions, modal state, COMP commands.
//!
//! It opens no file and prints nothing. A host hands it texts and a [`Finder`] for called
//! programs, and listens with an [`Observer`]. Everything that a run depends on is data, so it
//! can be stopped, saved and resumed at any block of a program that is held in memory.

#![allow(
    clippy::unnecessary_box_returns,
    reason = "faults travel boxed in results; what makes one boxes it"
)]

mod at;
mod block;
mod budget;
mod builder;
mod call;
mod carried;
mod cause;
mod chain;
mod comp;
mod coupling;
mod cycles;
mod endless;
mod evaluate;
mod event;
mod exchange;
mod expression;
mod finder;
mod fingerprint;
mod flow;
mod functions;
mod hash;
mod implicit;
mod meeting;
mod memory;
mod modal;
mod motion;
mod names;
mod options;
mod program;
mod region;
mod remarks;
mod run;
mod sequence;
mod snapshot;
mod start;
mod state;
mod stream;
mod target;
mod trust;
mod unit;
mod unknown;
mod value;
mod variable;
mod ways;
mod words;
mod work;

pub use budget::Limits;
pub use carried::{ArrayShape, Carried};
pub use event::{
    AxisWord, Ended, EndedBy, Event, Executed, Note, NoteKind, Notes, Observer, Outcome,
};
pub use finder::{Finder, NoFiles, NoProgram};
pub use modal::{AxisPosition, Frame as PositionFrame, Group, Modal};
pub use motion::{
    Arc as CircularArc, BlockEnd, Centre, Form, Motion, Motions, PathFeed, Travel, Turn,
};
pub use options::{Options, RunOutcome, StopPolicy};
pub use run::Interpreter;
pub use snapshot::{ResumeError, Snapshot};
pub use value::Value;
pub(crate) use variable::set_name;
