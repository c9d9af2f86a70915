//! The texts of a run: the index of each, and the lookup of calls.

pub(super) mod builder;
pub(super) mod call_sites;
pub(super) mod file_names;
pub(super) mod finder;
pub(super) mod index;
pub(super) mod store;
pub(super) mod unit;
pub(super) mod wanted;
mod weight;
