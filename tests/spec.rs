//! What only code can show of the language and of lists: budgets, bytes, hosts, networks, any text.

#![allow(clippy::unwrap_used, reason = "a test that cannot continue fails")]

mod language;
mod lists;
mod support;
