//! Calls of the system that write and fail (R9.95): each of them once in each command that writes, with a
//! full disk, a broken one, a signal, a right that is lost, and a write that takes only a part.
//!
//! A shim in C stands between the tool and the C library; where it cannot be built, this says so.

#![cfg(target_os = "linux")]
#![allow(clippy::print_stderr, reason = "what a system cannot try")]

mod folder;

#[path = "faults/calls.rs"]
mod calls;
#[path = "faults/commands.rs"]
mod commands;
mod workspace;
