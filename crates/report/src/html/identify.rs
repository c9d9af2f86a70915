//! The reports of a recorded trace and of an identification.

use std::io::{self, Write};

use maud::html;

use super::page::{Page, PagePart};
use super::parts::{Caption, ColumnHeading, HtmlRow, HtmlTable, figure, prose};
use crate::identify::{IdentifyReport, report_text};
use crate::pictures::{channels, friction_curve, residuals_over_position, segments_on_trace};
use crate::svg::Frame;
use crate::trace::{TraceReport, report_text as channels_text};
use frictcomp::diagnostic::Rounded;

const CURVE: PagePart = PagePart::new("curve", "Friction over speed");
const SPEEDS: PagePart = PagePart::new("speeds", "Speeds");
const POSITION: PagePart = PagePart::new("position", "Residuals over the position");
const SEGMENTS: PagePart = PagePart::new("segments", "Segments on the trace");
const FINDINGS: PagePart = PagePart::new("findings", "What to look at");
const REPORT: PagePart = PagePart::new("report", "Report");
const PICTURE: PagePart = PagePart::new("picture", "Channels over time");
const CHANNELS: PagePart = PagePart::new("channels", "Channels");

/// Writes the report of an identification as one page.
///
/// # Errors
/// Those of `out`.
pub fn render_identification(report: &IdentifyReport, out: &mut dyn Write) -> io::Result<()> {
    let chart = friction_curve(report);
    let findings: Vec<_> = report.findings().collect();
    let parts = [FINDINGS, CURVE, SPEEDS, POSITION, SEGMENTS, REPORT];
    let mut page = Page::open(out, &chart.title, &report.headline(), &parts)?;
    page.part(
        FINDINGS,
        &html! {
            @if findings.is_empty() {
                p { "Nothing is odd in this recording." }
            } @else {
                ul {
                    @for finding in &findings {
                        li { strong { (finding.code.as_str()) } ": " (finding.message) ". " (finding.help) "." }
                    }
                }
            }
        },
    )?;
    page.part(CURVE, &figure(chart.render(Frame::Inside("curve"))))?;
    let found = &report.identified;
    let table = HtmlTable {
        caption: Caption::Shown("Friction at each speed"),
        columns: &[
            ColumnHeading::Text("speed in mm/s"),
            ColumnHeading::Number("friction"),
            ColumnHeading::Number("error"),
            ColumnHeading::Number("offset"),
            ColumnHeading::Number("residual"),
        ],
    };
    let rows = found.pairs.iter().map(|pair| {
        let numbers = [
            Some(pair.friction),
            Some(pair.error),
            pair.offset,
            Some(pair.friction - found.curve.at(pair.speed)),
        ];
        let shown = |number: Option<f64>| {
            number.map_or("one-sided".to_owned(), |it| Rounded(it, 3).to_string())
        };
        let cells = numbers.map(|number| html! { (shown(number)) });
        HtmlRow::new(&format!("{:.3}", pair.speed), cells.to_vec())
    });
    page.part(SPEEDS, &table.render(rows))?;
    let positions = residuals_over_position(report).render(Frame::Inside("position"));
    page.part(POSITION, &figure(positions))?;
    let segments = segments_on_trace(report).render(Frame::Inside("segments"));
    page.part(SEGMENTS, &figure(segments))?;
    page.part(REPORT, &prose(&report_text(report)))?;
    page.close()
}

/// Writes the channels of a trace as one page.
///
/// # Errors
/// Those of `out`.
pub fn render_trace(report: &TraceReport<'_>, out: &mut dyn Write) -> io::Result<()> {
    let chart = channels(report);
    let mut page = Page::open(out, &chart.title, &report.headline(), &[PICTURE, CHANNELS])?;
    page.part(PICTURE, &figure(chart.render(Frame::Inside("channels"))))?;
    page.part(CHANNELS, &prose(&channels_text(report)))?;
    page.close()
}
