//! Chapter 3, rule by rule: the contents of lists and the control's reaction to them.

#![allow(clippy::unwrap_used, reason = "a test that cannot continue fails")]

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
