//! A picture with its report.

use frictcomp_report::{Detail, Document, ShownDocument};
use serde::Serialize;

/// A picture with its report.
#[derive(Debug, Serialize)]
pub(crate) struct DrawnReport<'a> {
    /// The picture; none where nothing was driven.
    pub(crate) svg: Option<String>,
    pub(crate) report: ShownDocument<'a>,
}

impl<'a> From<&'a Document<'a>> for DrawnReport<'a> {
    fn from(document: &'a Document<'a>) -> Self {
        Self {
            svg: document.picture(),
            report: document.shown(Detail::Brief),
        }
    }
}
