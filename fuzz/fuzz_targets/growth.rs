//! Macros that use each other and texts that grow: the budget of work ends them.
#![no_main]

use frictcomp_fuzz::{Files, Profile, check_growth, text_of};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| {
    if let Some(text) = text_of(input, &Profile::GROWING) {
        for way in 0..3 {
            check_growth(Files::new(&text), way);
        }
    }
});
