//! Motions, currents, feed drives and circles, against rules, references and independent simulations.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    clippy::float_cmp,
    reason = "rows and times of recordings that the tests make themselves, compared exactly where that is meant"
)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod backlash;
mod circle;
mod contour;
mod current;
mod diagnosis;
mod glitch;
mod motion;
mod plant_fit;
mod recorded;
mod recorded_machines;
mod recorder;
mod stiction;
