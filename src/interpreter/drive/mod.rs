//! The drive: block after block, path after path.

pub(super) mod budgets;
pub(super) mod calling;
pub(super) mod host;
pub(super) mod joining;
pub(super) mod lines;
pub(super) mod loops;
pub(super) mod program;
pub(super) mod running;
pub(super) mod snapshot;
