//! System calls that write and fail (R9.95): each of them once in each command that writes, with a
//! full disk, a broken disk, a signal, a lost permission, and a partial write.
//!
//! A shim in C intercepts calls between the tool and the C library; if it cannot be built, the test reports it.

#![cfg(target_os = "linux")]
#![allow(clippy::print_stderr, reason = "what a system cannot try")]

mod calls;
mod commands;
