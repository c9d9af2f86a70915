//! Chapter 3, rule by rule: what lists say and what the control makes of them.

mod lists {
    mod axes;
    mod config;
    mod friction;
    mod host;
    mod lines;
    mod robust;
}
