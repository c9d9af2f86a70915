//! The report of an audit: findings, the matrix of programs and axes, and the relevant lines.
//!
//! It is no document: cells lead to the lines of thousands of programs, which are read once more while the page is
//! written, and a terminal folds what a page has to show.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};

use maud::{Markup, html};

use super::page::{Page, PagePart};
use super::parts::{Caption, ColumnHeading, HtmlRow, HtmlTable, line_id, with_code};
use super::source::Sources;
use crate::assumptions::rests_on_text;
use crate::document::Headline;
use crate::results::audit::{AuditReport, CurePlace, MachineAudit, Word, axis_name};
use crate::wording::counted;
use frictcomp::audit::{AxisAudit, AxisFinding, Cure, Site};

const FINDINGS: PagePart = PagePart::new("findings", "Findings");
const MATRIX: PagePart = PagePart::new("programs", "Programs and axes");
const LINES: PagePart = PagePart::new("lines", "Lines");

/// Programs with a separate row, the most dangerous ones first.
const ROWS: usize = 2000;

/// Lines that are shown with their surroundings.
const MARKS: usize = 4000;

/// Lines around a relevant one.
const AROUND: u32 = 2;

/// Writes the report of an audit as one page. The programs are read once more, line by line.
///
/// # Errors
/// Those of `out`.
pub fn render_audit(
    report: &AuditReport,
    sources: &mut dyn Sources,
    out: &mut dyn Write,
) -> io::Result<()> {
    let marks = Marks::of(report);
    let parts = [FINDINGS, MATRIX, LINES];
    let mut page = Page::open(
        out,
        "What the order of programs does",
        &lead(report),
        &parts,
    )?;
    page.long_part(FINDINGS, |page| {
        findings(page, report, &marks)?;
        for assumption in report.assumptions() {
            page.push(&html! { p { (with_code(assumption)) } })?;
        }
        match rests_on_text(&report.rests_on()) {
            Some(text) => page.push(&html! { p { (with_code(&text)) } }),
            None => Ok(()),
        }
    })?;
    page.long_part(MATRIX, |page| matrices(page, report, &marks))?;
    page.long_part(LINES, |page| {
        if marks.files.is_empty() && !report.has_unknown() {
            page.push(&html! { p { "No program leaves or inherits anything." } })?;
        }
        lines(page, &marks, sources)
    })?;
    page.close()
}

fn lead(report: &AuditReport) -> Headline {
    let mut headline = report.headline();
    if let Some(programs) = &report.not_checked {
        headline.text = format!("{}; not checked: {programs}", headline.text);
    }
    headline
}

/// The relevant lines, by file.
struct Marks {
    files: BTreeMap<String, (usize, BTreeSet<u32>)>,
    left_out: usize,
}

impl Marks {
    fn of(report: &AuditReport) -> Self {
        let mut marks = Self {
            files: BTreeMap::new(),
            left_out: 0,
        };
        let mut count = 0;
        for machine in &report.machines {
            for program in machine.archive.programs() {
                for axis in &program.axes {
                    for site in sites(axis) {
                        if count == MARKS {
                            marks.left_out += 1;
                            continue;
                        }
                        let next = marks.files.len();
                        let file = marks.files.entry(site.file.to_string());
                        let (_, lines) = file.or_insert_with(|| (next, BTreeSet::new()));
                        count += usize::from(lines.insert(site.line));
                    }
                }
            }
        }
        marks
    }

    /// The identifier of a line, if it is shown.
    fn id(&self, (file, line): (&str, u32)) -> Option<String> {
        let (number, lines) = self.files.get(file)?;
        lines.contains(&line).then(|| line_id(*number, line))
    }

    fn link(&self, place: (&str, u32), text: &str) -> Markup {
        html! {
            @match self.id(place) {
                Some(id) => a href={ "#" (id) } { (text) },
                None => (text),
            }
        }
    }
}

/// Returns the places of dangerous effects of a program on an axis.
fn sites(axis: &AxisAudit) -> impl Iterator<Item = &Site> {
    let leaves = axis.by.as_ref().filter(|_| axis.leaves_away());
    let reason = axis.reason.as_ref().and_then(|reason| reason.site.as_ref());
    let inherits = axis.inherits.motion().map(|motion| &motion.site);
    [leaves, reason, inherits].into_iter().flatten()
}

fn findings(page: &mut Page<'_>, report: &AuditReport, marks: &Marks) -> io::Result<()> {
    page.push(&html! {
        p {
            "The state of compensation outlives a program. A hazard is an ordered pair: a program \
             that leaves an axis away from its start-up state, and one that moves the axis in the state that it \
             finds."
        }
    })?;
    for machine in &report.machines {
        if let (true, Some(origin)) = (report.machines.len() > 1, &machine.origin) {
            page.push(&html! { h3 { (origin) } })?;
        }
        let table = HtmlTable {
            caption: Caption::Heard("Findings by axis"),
            columns: &[
                ColumnHeading::Text("axis"),
                ColumnHeading::Number("leave it away"),
                ColumnHeading::Number("inherit it"),
                ColumnHeading::Number("may inherit it"),
                ColumnHeading::Number("both"),
                ColumnHeading::Number("not known"),
                ColumnHeading::Number("hazards"),
                ColumnHeading::Number("possible hazards"),
                ColumnHeading::Text("cure"),
            ],
        };
        let rows = machine.shown().map(|finding| {
            let cells = [
                html! { (finding.leavers.len()) },
                html! { (finding.inheritors.len()) },
                html! { (finding.possible_inheritors.len()) },
                html! { (finding.both.len()) },
                html! { (finding.unknown.len()) },
                html! { (finding.hazards()) },
                html! { (finding.possible_hazards()) },
                html! { span class="sentence" { (cure(finding)) } },
            ];
            HtmlRow::new(&axis_name(&finding.axis, finding.kind), cells)
        });
        page.push(&table.render(rows))?;
        for finding in machine.shown().filter(|it| it.cure() != Cure::None) {
            page.push(&blocks(machine, finding, marks))?;
        }
    }
    Ok(())
}

fn cure(finding: &AxisFinding) -> &'static str {
    match finding.cure() {
        Cure::Leavers => "a block before the end of each program that leaves it",
        Cure::Inheritors => "a block before the first motion of each program that inherits it",
        _ if !finding.unknown.is_empty() => "not known",
        _ => "nothing to do",
    }
}

/// The blocks that end the hazards of an axis.
fn blocks(machine: &MachineAudit, finding: &AxisFinding, marks: &Marks) -> Markup {
    let cures = machine.cures(finding);
    let shown = cures.len().min(ROWS);
    html! {
        details open[cures.len() <= 10] {
            summary {
                "Cure of " (axis_name(&finding.axis, finding.kind)) ": "
                (counted(cures.len(), "program"))
            }
            ul {
                @for (program, place) in &cures[..shown] {
                    li {
                        (program.file) ": " code { (program.axes[finding.at].way_home()) } " "
                        @match *place {
                            CurePlace::Beginning => "at the beginning",
                            CurePlace::Before(line) => {
                                "before " (marks.link((&program.file, line), &format!("line {line}")))
                            },
                            CurePlace::End => "at the end",
                        }
                    }
                }
            }
            @if cures.len() > shown { p { "… " (cures.len() - shown) " more" } }
        }
    }
}

fn matrices(page: &mut Page<'_>, report: &AuditReport, marks: &Marks) -> io::Result<()> {
    page.push(&html! {
        dl.legend {
            @for word in Word::ALL {
                dt { (cell_word(word, &html! { (word.as_str()) })) }
                dd { (word.meaning()) }
            }
        }
    })?;
    for machine in &report.machines {
        page.push(&matrix(machine, marks))?;
    }
    Ok(())
}

fn matrix(machine: &MachineAudit, marks: &Marks) -> Markup {
    let findings: Vec<&AxisFinding> = machine.shown().collect();
    let heads: Vec<String> = findings
        .iter()
        .map(|it| axis_name(&it.axis, it.kind))
        .collect();
    let columns: Vec<ColumnHeading<'_>> = std::iter::once(ColumnHeading::Text("program"))
        .chain(heads.iter().map(|head| ColumnHeading::Text(head)))
        .collect();
    let programs = machine.by_danger();
    let shown = programs.len().min(ROWS);
    let rows = programs[..shown].iter().map(|(program, _)| {
        let cells: Vec<Markup> = findings
            .iter()
            .map(|finding| cell(&program.file, &program.axes[finding.at], marks))
            .collect();
        HtmlRow::new(&program.file, cells)
    });
    let table = HtmlTable {
        caption: Caption::Heard("What each program does to each axis"),
        columns: &columns,
    };
    html! {
        (table.render(rows))
        @if programs.len() > shown {
            p { "… " (programs.len() - shown) " more programs, none of them more dangerous" }
        }
    }
}

/// Returns the effect of a program on an axis, with links to the places.
fn cell(file: &str, axis: &AxisAudit, marks: &Marks) -> Markup {
    let link = |site: Option<&Site>, text: &str| {
        let link = |site: &Site| marks.link((&site.file, site.line), text);
        site.map_or_else(|| html! { (text) }, link)
    };
    let inherits = axis.inherits.motion().map(|motion| &motion.site);
    let word = Word::of(axis);
    let content = match word {
        Word::Both => html! {
            (link(axis.by.as_ref(), "leaves")) ", " (link(inherits, "inherits"))
        },
        Word::Leaves | Word::Depends => link(axis.by.as_ref(), word.as_str()),
        Word::Unknown => {
            let reason = axis.reason.as_ref().and_then(|reason| reason.site.as_ref());
            link(reason, word.as_str())
        }
        Word::Inherits | Word::Perhaps => link(inherits, word.as_str()),
        Word::StartUp | Word::Keeps => html! { (word.as_str()) },
    };
    let content = html! {
        (content)
        @if let Some(when) = axis.leaves_away_when(file) { " " span class="when" { "(" (when) ")" } }
    };
    cell_word(word, &content)
}

/// A word, distinguished by more than colour.
fn cell_word(word: Word, content: &Markup) -> Markup {
    let class = match word {
        Word::Both | Word::Leaves | Word::Depends => "state away",
        Word::Unknown => "state unknown",
        Word::Inherits | Word::Perhaps => "state inactive",
        Word::StartUp => "state active",
        Word::Keeps => "quiet",
    };
    html! { span class=(class) { (content) } }
}

/// The relevant lines, with their surroundings.
fn lines(page: &mut Page<'_>, marks: &Marks, sources: &mut dyn Sources) -> io::Result<()> {
    for (file, (number, lines)) in &marks.files {
        page.push(&html! { h3 { (file) } "\n" })?;
        let Some(mut source) = sources.open(file) else {
            page.push(&html! { p { "The file cannot be read again." } })?;
            continue;
        };
        let label = html! { "Lines of " (file) }.0;
        page.raw(&format!(
            "<div class=\"source\" role=\"group\" aria-label=\"{label}\" tabindex=\"0\"><pre>"
        ));
        let last = lines.last().copied().unwrap_or_default() + AROUND;
        let mut at = 0;
        let mut written = 0;
        while at < last && source.advance() {
            at += 1;
            let near = lines.range(at.saturating_sub(AROUND)..=at + AROUND).next();
            if near.is_none() {
                continue;
            }
            if written + 1 != at {
                page.push(&html! { "      …\n" })?;
            }
            written = at;
            let text = source.line().text.to_owned();
            let id = lines.contains(&at).then(|| line_id(*number, at));
            page.push(&html! {
                (format!("{at:>6}  "))
                @match id {
                    Some(id) => mark id=(id) { (text) },
                    None => (text),
                }
                "\n"
            })?;
        }
        page.raw("</pre></div>\n");
    }
    if marks.left_out > 0 {
        page.push(&html! { p { "… " (marks.left_out) " more lines are not shown." } })?;
    }
    Ok(())
}
