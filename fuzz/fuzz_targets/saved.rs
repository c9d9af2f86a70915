//! Saved states: the next run reads whatever a run saves, and starts with exactly that.
#![no_main]

use frictcomp_fuzz::{Files, Profile, check_saved, text_of};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    if let Some(text) = text_of(input, &Profile::HOSTILE) {
        for way in 0..3 {
            check_saved(Files::new(&text), way);
        }
    }
});
