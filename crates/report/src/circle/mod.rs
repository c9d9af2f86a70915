//! The result of a circular test as text, JSON and CSV.

mod csv;
mod json;
mod subject;
mod text;

pub use csv::render_csv;
pub use json::render_json;
pub use subject::{CircleReport, ListOrigin, NamedSide, Subject};
pub(super) use text::{advice_lines, conditions, stiction_line, table};
pub use text::{render_text, report_text, words};
