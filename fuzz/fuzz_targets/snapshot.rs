//! Snapshots: a run that is stopped and resumed ends as it would have otherwise; a damaged snapshot is rejected,
//! and a forged one is rejected or runs to some end. The first 32 bytes decide where it is stopped and what is damaged.
#![no_main]

use frictcomp_fuzz::{Choices, Files, Profile, check_snapshot, text_of};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    let Some((decisions, program)) = input.split_at_checked(32) else {
        return;
    };
    if let Some(text) = text_of(program, &Profile::HOSTILE) {
        check_snapshot(Files::new(&text), &mut Choices::of_bytes(decisions));
    }
});
