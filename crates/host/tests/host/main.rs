//! Recordings and tuning through the files of a user.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    clippy::float_cmp,
    reason = "rows and times of recordings that the tests make themselves, compared exactly where that is meant"
)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod identify_faults;
mod recordings;
mod tune;
