//! The slice itself: the kinds of compensation, the state of every axis, and what a COMP command
//! does to it.
//!
//! It depends on no files, no interpreter and no clock. A host with its own interpreter passes it
//! the COMP commands that it meets and gets the changes, or the control's own error.

mod compensation;
mod kind;

pub use compensation::CompensationError;
pub use compensation::{
    AxisIndex, AxisSetup, Change, CompCommand, Compensation, Coupling, Selection, State,
};
pub use kind::{CncBuild, Facts, NoBuild};
pub use kind::{Kind, KindSet, Membership, UnknownKind};
