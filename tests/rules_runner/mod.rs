//! Results of a case.

pub(crate) mod fixes;
pub(crate) mod lists;
pub(crate) mod runs;
