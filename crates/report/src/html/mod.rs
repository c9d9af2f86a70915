//! Reports as one self-contained HTML file: no network, no script, no second file.
//!
//! [`render_document`] writes the document of any result, [`render_with_lines`] adds the lines of programs to which it
//! leads. A run has a page of its own, and a contour has lines besides its document, because these lead to the source,
//! which is read once more.
//!
//! A [`RunDigest`] takes the records of a session and keeps what a report needs, in memory that does
//! not grow with the length of a run; [`render_run`] writes it with the sources. Long stretches of
//! source without a change are folded into elements that a browser opens by itself. The page forbids
//! everything except its own style, so nothing in a program can become active.

mod assumptions;
mod contour;
mod digest;
mod document;
mod given;
mod lines;
mod machine;
mod messages;
mod page;
mod parts;
mod reversed;
mod run;
mod source;
mod states;
mod track;
mod ways;

pub use contour::render_contour;
pub use digest::RunDigest;
pub use document::render_document;
pub use given::{GivenForRun, RunInputs};
pub use lines::render_with_lines;
pub use run::render_run;
pub use source::Sources;
