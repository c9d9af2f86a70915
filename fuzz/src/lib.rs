//! Shared code of the targets and the campaign: inputs from bytes, a session with small budgets,
//! and the properties of every run.

mod bench;
mod checks;
mod circles;
mod damage;
mod dice;
mod files;
mod grammar;
mod phrases;
mod snapshots;

pub use bench::{Bench, POLICIES, machine};
pub use checks::{check_growth, check_run, check_saved};
pub use circles::check_circle;
pub use dice::{Dice, numbered};
pub use files::{Files, MAIN};
pub use grammar::{Theme, program};
pub use snapshots::check_snapshot;

/// Returns the program of an input: decisions of the grammar after a NUL byte, else its text.
pub fn text_of(input: &[u8], theme: Theme) -> Option<String> {
    match input.split_first() {
        Some((0, decisions)) => Some(program(&mut Dice::new(decisions), theme)),
        _ => String::from_utf8(input.to_vec()).ok(),
    }
}
