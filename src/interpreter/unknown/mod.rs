//! Offline uncertainty: regions that may or may not be executed, and the ways around them.

pub(super) mod branch;
pub(super) mod branching;
pub(super) mod join;
pub(super) mod leaving;
pub(super) mod may_effects;
pub(super) mod regions;
pub(super) mod search;
pub(super) mod stops;
pub(super) mod telling;
