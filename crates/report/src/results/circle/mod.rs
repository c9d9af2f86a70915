//! The result of a circular test as a document, JSON and CSV.

mod csv;
mod document;
mod json;
mod picture;
mod subject;

pub use csv::render_csv;
pub(crate) use document::stiction_line;
pub use document::{document, words};
pub use json::render_json;
pub use picture::picture;
pub use subject::{CircleReport, ListOrigin, NamedSide, Subject};
