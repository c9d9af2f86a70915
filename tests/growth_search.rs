//! Growth is searched for, not listed (R9.90): what the language consists of is repeated within a line,
//! within a continued block, over lines, over files and over list lines, and twice as much of it may
//! take at most 2.2 times the processor time.
//!
//! Time is measured on the processor of the thread, and again where it grows too fast, so that other
//! work on the machine fails nothing.

#![cfg(unix)]

#[path = "growth/golden.rs"]
mod golden;
#[path = "growth/measure.rs"]
mod measure;
#[path = "growth/search.rs"]
mod search;
#[path = "growth/tokens.rs"]
mod tokens;
