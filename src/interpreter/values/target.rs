//! The target of an assignment.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::syntax::ast::Owner;

/// Something that a region could write.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub(in crate::interpreter) enum RegionTarget {
    Parameter(Owner, u32),
    Variable(String),
    /// Any element of an array.
    Elements(String),
    /// Any P parameter.
    Parameters,
}

impl fmt::Display for RegionTarget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parameter(Owner::Program, index) => write!(f, "P{index}"),
            Self::Parameter(Owner::Call, index) => write!(f, "@P{index}"),
            Self::Variable(name) | Self::Elements(name) => f.write_str(name),
            Self::Parameters => f.write_str("P"),
        }
    }
}

/// Place that an assignment writes.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::interpreter) enum AssignedPlace {
    Parameter(Owner, u32),
    Variable(String),
    /// Some element of an array; the value that decides which one is not known.
    Elements(String, Arc<str>),
    /// Some P parameter.
    Parameters(Arc<str>),
    /// Nothing can be written there.
    Nowhere,
}
