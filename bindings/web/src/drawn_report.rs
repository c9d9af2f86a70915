//! A picture with its report.

use frictcomp_report::ReportText;
use serde::Serialize;

/// A picture with its report.
#[derive(Debug, Serialize)]
pub(crate) struct DrawnReport {
    /// The picture; none where nothing was driven.
    pub(crate) svg: Option<String>,
    pub(crate) report: ReportText,
}
