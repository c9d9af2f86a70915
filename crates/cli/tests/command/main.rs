//! The command from outside, and what only all packages together show: one program, since each test program is linked
//! with all packages.
//!
//! Programs of their own are `lsp_many`, which measures the processor time of its process, `unbreakable`, which takes
//! memory, files and time away from the command, and `windows`, which is tried on another system.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    clippy::float_cmp,
    reason = "rows and times of recordings that the tests make themselves, compared exactly where that is meant"
)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod archives;
mod arriving;
mod cases;
mod causes;
mod circle;
mod cli;
mod commission;
mod commission_machines;
mod commission_run;
mod console;
mod contour;
mod docs;
mod explain;
mod failing_calls;
#[path = "../folder/mod.rs"]
mod folder;
mod friction_states;
mod git;
mod hostile;
mod html;
mod identify;
mod in_memory;
mod learn;
mod lsp;
mod machine;
mod mending;
mod motion;
mod options;
mod order;
mod outputs;
mod pictures;
mod programs;
mod questions;
mod reach;
mod recognised;
mod records;
mod replay;
mod schema;
mod states;
mod watch;
mod what_moves;
mod widths;
mod workspace;
