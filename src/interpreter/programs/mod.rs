//! The texts of a run: the index of each, and the lookup of calls.

pub(super) mod builder;
pub(super) mod calls;
pub(super) mod index;
pub(super) mod store;
