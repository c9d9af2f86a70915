//! A contour in every format (R11.4, R11.6).

mod agreed;
mod document;
mod golden;
mod json;
pub(crate) mod places;
mod recorder;
mod records;
mod remarks;

pub use agreed::AgreedContour;
pub use document::{ContourSubject, document, headline};
pub use golden::{GoldenContour, agreed_contour};
pub use json::{render_json, render_summary};
pub use recorder::ContourRecorder;
pub use remarks::{contour_remarks, limit_remarks, why_not_judged};
