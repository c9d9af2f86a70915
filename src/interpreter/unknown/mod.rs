//! What cannot be known offline: regions that may or may not be executed, and the ways around them.

pub(super) mod branching;
pub(super) mod departing;
pub(super) mod gathering;
pub(super) mod meeting;
pub(super) mod regions;
pub(super) mod telling;
