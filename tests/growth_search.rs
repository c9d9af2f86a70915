//! Searches for growth instead of listing it (R9.90): the elements of the language are repeated within a line, within a
//! continued block, over lines, over files and over list lines, and twice as many of them may take at most 2.2 times
//! the processor time.
//!
//! The measured time is the processor time of the thread, and it is measured again if it grows too fast, so that other
//! work on the machine does not cause a failure.

#![cfg(unix)]

#[path = "growth/golden.rs"]
mod golden;
#[path = "growth/measure.rs"]
mod measure;
#[path = "growth/search.rs"]
mod search;
#[path = "growth/tokens.rs"]
mod tokens;
