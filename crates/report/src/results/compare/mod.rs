//! Two versions of a program side by side, `diff`.

mod contour;
mod report;

pub use contour::ContoursReport;
pub use report::{VersionsReport, document, render_json, render_json_since};
