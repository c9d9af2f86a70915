//! A contour in every format (R11.4, R11.6).

mod agreed;
mod document;
mod golden;
pub(crate) mod places;
mod recorder;
mod records;
mod remarks;
mod text;

pub use agreed::AgreedContour;
pub use document::{document, summary_record};
pub use golden::{GoldenContour, agreed_contour};
pub use recorder::ContourRecorder;
pub use records::{CSV_HEADER, csv_row, reversal_record};
pub use remarks::{contour_remarks, exceeded, why_not_judged};
pub use text::{ContourSubject, headline, render_text, report_text};
