//! The engine inside `frictcomp.html`: the dropped files as a disk in memory, and answers to the
//! questions of the page about them.
//!
//! The page and the engine share only bytes (`border`). A question is JSON; an answer is JSON, a
//! page, a picture or records, as the question asks.

mod audits;
mod bars;
mod border;
mod circle;
mod contour;
mod current;
mod drawn_report;
mod dropped;
mod engine;
mod lines;
mod parameters;
mod questions;
mod recording;
mod refusal;
mod rows;
mod run;
mod timeline;
mod tuning;
mod watched;
mod wording;
mod written;
