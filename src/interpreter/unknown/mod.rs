//! Offline uncertainty: regions that may or may not be executed, and the ways around them.

pub(super) mod branching;
pub(super) mod leaving;
pub(super) mod passing;
pub(super) mod search;
pub(super) mod stops;
