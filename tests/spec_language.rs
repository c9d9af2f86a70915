//! What only code can show of the language: budgets, bytes, hosts.

#![allow(clippy::unwrap_used, reason = "a test that cannot continue fails")]

mod language;
mod support;
