//! Chapter 3, rule by rule: what lists say and what the control makes of them.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod lists {
    mod axes;
    mod config;
    mod drive;
    mod found;
    mod friction;
    mod host;
    mod lines;
    mod programs;
    mod robust;
    mod values;
    mod written;
}
