//! The plant from recorded circles, and the lists that are tuned on it (R16.2, R16.3).

mod fit;
mod fitting;
mod tune;
mod verdicts;

pub(super) use fitting::Fitting;
