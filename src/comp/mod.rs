//! The slice itself: the kinds of compensation, the state of every axis, and what a COMP command
//! does to it.
//!
//! It depends on no files, no interpreter and no clock. A host with its own interpreter passes it
//! the COMP commands that it meets and gets the changes, or the control's own error.

mod axis;
mod build;
mod command;
mod compensation;
mod error;
mod facts;
mod kind;

pub use axis::{AxisIndex, AxisSetup};
pub use build::{CncBuild, NoBuild};
pub use command::{CompCommand, Selection};
pub use compensation::{Change, State};
pub use compensation::{Compensation, Coupling};
pub use error::CompensationError;
pub use facts::Facts;
pub use kind::{Kind, KindSet, Membership, UnknownKind};
