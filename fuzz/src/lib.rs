//! Shared code of the targets and the campaign: inputs from choices, a session with small budgets,
//! and the properties of every run.

mod bench;
mod checks;
mod circles;
mod damage;
mod files;
mod snapshots;

use files::SEPARATOR;
use frictcomp_testing::generator::{NcProgram, Style};

pub use bench::{Bench, POLICIES, machine};
pub use checks::{check_growth, check_run, check_saved};
pub use circles::check_circle;
pub use files::{Files, MAIN};
pub use frictcomp_testing::generator::{Choices, Profile};
pub use snapshots::check_snapshot;

/// Returns the program of an input: what it chooses after a NUL byte, else its text.
pub fn text_of(input: &[u8], profile: &Profile) -> Option<String> {
    match input.split_first() {
        Some((0, bytes)) => Some(program(profile, &mut Choices::of_bytes(bytes))),
        _ => String::from_utf8(input.to_vec()).ok(),
    }
}

/// Returns a hostile program, and often one that it calls.
pub fn program(profile: &Profile, choices: &mut Choices<'_>) -> String {
    let style = Style::hostile(choices);
    let mut text = NcProgram::choose(profile, choices).write(style);
    if profile.calls_files() && choices.below(3) > 0 {
        text.push(SEPARATOR);
        text += &NcProgram::choose(profile, choices).write(style);
    }
    text
}
