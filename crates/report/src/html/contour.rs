//! The report of a contour: its document, then each line with its reversals, to which the picture leads.

use std::collections::BTreeMap;
use std::io::{self, Write};

use maud::{Markup, html};

use super::document::DocumentPage;
use super::page::PagePart;
use super::parts::{Caption, ColumnHeading, HtmlRow, HtmlTable, linked};
use super::reversed::ReversedFiles;
use super::source::Sources;
use crate::pictures::ContourPicture;
use crate::results::contour::{ContourRecorder, ContourSubject, document};
use frictcomp::comp::State;
use frictcomp_physics::contour::{ContourReport, ContourReversal};

const LINES: PagePart<'_> = PagePart::new("lines", "Reversals by line");
const SOURCE: PagePart<'_> = PagePart::new("source", "Source with its reversals");

/// Lines with a separate row, those with the worst reversals first.
const MAX_LINES: usize = 500;

/// Writes the report of a contour as one page: each mark of the picture leads to its line, and each
/// line shows its reversals.
///
/// # Errors
/// The errors of `out`.
pub fn render_contour(
    (contour, recorder): (&ContourReport, &ContourRecorder<'_>),
    subject: &ContourSubject,
    picture: &ContourPicture,
    (sources, out): (&mut dyn Sources, &mut dyn Write),
) -> io::Result<()> {
    let name = subject.heading(contour);
    let is_whole = contour.is_whole();
    let reversals = recorder.reversals();
    let files = ReversedFiles::of(reversals);
    let mut document = document(contour, recorder, subject);
    document.leading_figure(|| {
        let picture = picture.clone();
        picture.linked_chart(&name, |file, line| files.link(file, line))
    });
    let page = DocumentPage {
        document: &document,
        further: &[LINES, SOURCE],
        link: &|at| files.link(&at.file, at.line),
    };
    page.render(out, |page| {
        page.part(LINES, &table(reversals, &files))?;
        page.long_part(SOURCE, |page| match (reversals, is_whole) {
            ([], true) => page.push(&html! { p { "No axis reverses." } }),
            ([], false) => page.push(&html! { p { "No axis reverses in what was driven." } }),
            _ => files.render(page, sources),
        })
    })
}

/// Returns the reversals of each line, the lines with the worst first.
fn table(reversals: &[ContourReversal], files: &ReversedFiles<'_>) -> Markup {
    let mut lines: BTreeMap<(&str, u32, &str), Vec<&ContourReversal>> = BTreeMap::new();
    for reversal in reversals {
        let key = (&*reversal.file, reversal.line, reversal.axis.as_str());
        lines.entry(key).or_default().push(reversal);
    }
    let worst = |reversals: &[&ContourReversal]| {
        let glitches = reversals.iter().map(|it| it.glitch_um.programmed);
        glitches.fold(0.0, f64::max)
    };
    let mut lines: Vec<_> = lines.into_iter().collect();
    lines.sort_by(|one, other| worst(&other.1).total_cmp(&worst(&one.1)));
    let shown = lines.len().min(MAX_LINES);
    let rows = lines[..shown].iter().map(|((file, line, axis), all)| {
        let off = all.iter().filter(|it| it.state != State::Active).count();
        let most = |of: fn(&ContourReversal) -> f64| {
            let values = all.iter().map(|it| of(it));
            format!("{:.2}", values.fold(0.0, f64::max))
        };
        let feeds = all.iter().map(|it| it.feed_mm_per_min);
        let slowest = feeds.fold(f64::INFINITY, f64::min);
        let programmed = all.iter().filter_map(|it| it.programmed_mm_per_min);
        let programmed = programmed.reduce(f64::max).map(|feed| format!("{feed:.0}"));
        let cells = [
            html! { (axis) },
            html! { (all.len()) },
            html! { @if off > 0 { span.state.away { (off) } } @else { "0" } },
            html! { (programmed.as_deref().unwrap_or("\u{2013}")) },
            html! { (format!("{slowest:.0}")) },
            html! { (most(|it| it.glitch_um.programmed)) },
            html! { (most(|it| it.glitch_um.all_on)) },
            html! { (most(|it| it.glitch_um.all_off)) },
        ];
        let name = format!("{file}:{line}");
        HtmlRow::under(linked(&name, files.link(file, *line)), cells)
    });
    let table = HtmlTable {
        caption: Caption::Shown("Reversals by line and axis; glitches in µm, feeds in mm/min"),
        columns: &[
            ColumnHeading::Text("line"),
            ColumnHeading::Text("axis"),
            ColumnHeading::Number("reversals"),
            ColumnHeading::Number("without compensation"),
            ColumnHeading::Number("F"),
            ColumnHeading::Number("slowest"),
            ColumnHeading::Number("programmed"),
            ColumnHeading::Number("all on"),
            ColumnHeading::Number("all off"),
        ],
    };
    html! {
        (table.render(rows))
        @if lines.len() > shown { p { "… " (lines.len() - shown) " more lines" } }
    }
}
