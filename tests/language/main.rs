//! Properties of the language and of lists that only code can show: budgets, bytes, hosts, networks, any text, saved
//! runs.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod budgets;
mod comp;
mod fixes;
mod flow;
mod known_words;
mod lists;
mod programs;
mod properties;
mod readings;
mod resume;
mod states;
#[path = "../support/mod.rs"]
mod support;
mod text;
mod verdicts;
