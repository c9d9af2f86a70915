//! Robustness against full disks, closed pipes, killed runs, damaged files and old encodings: nothing is lost.
//! `docs/reliability.md` lists the promises.
//!
//! Tests that take minutes are ignored: `cargo test --release --test unbreakable -- --ignored`.

#![allow(clippy::print_stderr, reason = "figures, and what a system cannot try")]

mod folder;

mod unbreakable {
    mod encodings;
    mod kill;
    #[cfg(unix)]
    mod resources;
    mod state;
}
