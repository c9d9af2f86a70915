//! Execution block by block: the beginning, the course and the end of a program.

pub(super) mod asking;
mod between;
mod block;
pub(super) mod budget;
pub(super) mod calling;
pub(super) mod charging;
pub(super) mod effects_of_calls;
mod ending;
pub(super) mod endless;
pub(super) mod fingerprint;
pub(super) mod handover;
mod heads;
pub(super) mod merging;
pub(super) mod parting;
pub(super) mod paths;
pub(super) mod remarks;
pub(super) mod running;
pub(super) mod snapshot;
pub(super) mod start;
pub(super) mod stream;
pub(super) mod trust;
pub(super) mod widening;
