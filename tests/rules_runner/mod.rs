//! What a case shows.

pub(crate) mod fixes;
pub(crate) mod lists;
pub(crate) mod runs;
