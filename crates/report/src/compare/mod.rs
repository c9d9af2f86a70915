//! Two versions of a program side by side, `diff`.

mod contour;
mod report;

pub use contour::ContoursReport;
pub(super) use report::sign;
pub use report::{VersionsReport, render_json, render_text};
