//! The additive current as a document; its numbers are a table of their own.

use crate::document::{Document, Headline, Standing};
use crate::pictures::CurrentPlot;

/// Returns the current over time under its verdict.
pub fn document<'a>(plot: &'a CurrentPlot, verdict: &str) -> Document<'a> {
    let mut out = Document::new(plot.title(), Headline::new(Standing::Plain, verdict));
    out.figure(|| plot.chart());
    out
}
