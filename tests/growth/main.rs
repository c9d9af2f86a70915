//! Time and memory of programs, as counts that are the same in every run and as processor time of a thread (R2.60, R2.85,
//! R9.90, R9.91). It is a program of its own, since its allocator counts.

mod brief;
#[cfg(unix)]
mod golden;
#[cfg(unix)]
mod measure;
#[cfg(unix)]
mod search;
mod shapes;
#[cfg(unix)]
mod tokens;
