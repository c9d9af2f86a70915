//! Circular tests on valid plants: figures, or a drive that is reported as unstable.
#![no_main]

use frictcomp_fuzz::{Choices, check_circle};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|input: &[u8]| check_circle(&mut Choices::of_bytes(input)));
