//! Reports as one self-contained HTML file: no network, no script, no second file.
//!
//! [`render_document`] writes the document of any result. A run and an audit have pages of their own, and a contour has
//! lines besides its document, because these lead to the source, which is read once more.
//!
//! A [`RunDigest`] takes the records of a session and keeps what a report needs, in memory that does
//! not grow with the length of a run; [`render_run`] writes it with the sources. Long stretches of
//! source without a change are folded into elements that a browser opens by itself. The page forbids
//! everything except its own style, so nothing in a program can become active.

mod assumptions;
mod audit;
mod contour;
mod digest;
mod document;
mod given;
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

pub use audit::render_audit;
pub use contour::render_contour;
pub use digest::RunDigest;
pub use document::render_document;
pub use given::{GivenForRun, RunInputs};
pub use run::render_run;
pub use source::Sources;
