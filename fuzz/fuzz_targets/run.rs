//! Whole runs: any text and any program of the grammar, in memory and line by line, with every
//! policy, into the formats.
#![no_main]

use frictcomp_fuzz::{Files, Profile, check_run, text_of};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    if let Some(text) = text_of(input, &Profile::HOSTILE) {
        // Each policy with its format, in memory and line by line.
        for way in [0, 4, 8, 9, 13, 17] {
            check_run(Files::new(&text), way);
        }
    }
});
