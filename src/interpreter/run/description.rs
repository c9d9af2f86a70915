//! A description of geometry that is open (R2.81).

use serde::{Deserialize, Serialize};

use crate::interpreter::coordinates::modal::Modal;
use crate::language::HashCommand;
use crate::text::Place;

/// A description of geometry whose blocks do not move (R2.81).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Description {
    /// Command that opened it, `#CONTOUR BEGIN`.
    pub(crate) opener: &'static HashCommand,
    pub(crate) place: Place,
    /// State in force before it.
    pub(crate) before: Modal,
}
