//! The report of a session.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::messages::line_id;
use super::page::{Page, Part, state_word};
use super::source::{self, Sources};
use super::story::{ProgramStory, RunStory, SummaryStory};
use super::track::{Stretch, Track};
use super::{assumptions, machine, messages};
use crate::comp::Kind;
use crate::diagnostic::Severity;
use crate::lists::Parameter;
use crate::machine::AxisReport;
use crate::report::advice::{NOTHING_TO_DO, axis_advice, error_advice, is_home};
use crate::report::assumptions::Met;
use crate::report::markup::escaped;
use crate::report::svg::{Axis, Band, BandChart, BandRow, Frame};
use crate::timeline::ChangedBy;

/// What the report tells beside the records.
#[derive(Debug, Clone, Copy, Default)]
pub struct Given<'a> {
    /// What the user gave for the run: names and values.
    pub settings: &'a [(String, String)],
    /// The parameters in effect, by axis.
    pub parameters: &'a [AxisReport],
    /// The programs and macros that the configuration names.
    pub programs: &'a [Parameter],
}

const LEFT: Part = Part {
    id: "left",
    title: "What is left",
};
const STATES: Part = Part {
    id: "states",
    title: "States over the blocks",
};
const MESSAGES: Part = Part {
    id: "messages",
    title: "Messages",
};
const SOURCE: Part = Part {
    id: "source",
    title: "Source",
};
const MACHINE: Part = Part {
    id: "machine",
    title: "Machine and parameters",
};
const CURVES: Part = Part {
    id: "curves",
    title: "Value lists",
};
const READING: Part = Part {
    id: "reading",
    title: "Assumptions",
};

/// Writes the report of a session as one page. The sources are read once more, line by line.
///
/// # Errors
/// Those of `out`.
pub fn render_run(
    story: &RunStory,
    given: &Given<'_>,
    sources: &mut dyn Sources,
    out: &mut dyn Write,
) -> io::Result<()> {
    let parts = [LEFT, STATES, MESSAGES, SOURCE, MACHINE, CURVES, READING];
    let mut page = Page::open(out, &title(story), &lead(story), &parts)?;
    page.part(LEFT);
    render_left(&mut page, story);
    page.end_part()?;
    page.part(STATES);
    render_states(&mut page, story)?;
    page.end_part()?;
    page.part(MESSAGES);
    messages::render(&mut page, story)?;
    page.end_part()?;
    page.part(SOURCE);
    source::render(&mut page, story, sources)?;
    page.end_part()?;
    page.part(MACHINE);
    machine::render(&mut page, story, given);
    page.end_part()?;
    page.part(CURVES);
    machine::render_curves(&mut page, story);
    page.end_part()?;
    page.part(READING);
    assumptions::render(&mut page, &met(story));
    page.end_part()?;
    page.close()
}

/// What the session tells about the assumptions that it depends on.
fn met(story: &RunStory) -> Met {
    let codes = story.messages.iter().map(|message| message.diagnostic.code);
    let passed_over = story.summary.iter().flat_map(|it| it.opaque.values()).sum();
    Met {
        reported: codes.collect(),
        axis_set: story.axis_set,
        passed_over,
        ended: story.ended(),
    }
}

/// More programs are counted, not named.
const NAMED: usize = 3;

fn title(story: &RunStory) -> String {
    let mut names: Vec<&str> = Vec::new();
    for program in &story.programs {
        let name = story.files[program.file].name.as_str();
        names.push(name.rsplit(['/', '\\']).next().unwrap_or(name));
    }
    let total = story.programs.len();
    names.truncate(NAMED);
    let mut title = format!("Friction compensation: {}", names.join(", "));
    if total > NAMED {
        let _ = write!(title, " and {} more", total - NAMED);
    }
    title
}

/// What stands under the title, first of all that no machine is described (R1.37).
fn lead(story: &RunStory) -> String {
    match &story.remark {
        Some(remark) => format!("{remark}. {}", counts(story)),
        None => counts(story),
    }
}

fn counts(story: &RunStory) -> String {
    let Some(summary) = &story.summary else {
        return "The session did not run to its end.".to_owned();
    };
    let count = |severity| summary.counts.get(&severity).copied().unwrap_or_default();
    format!(
        "{}, {}, {}, {}",
        counted(u64::from(summary.programs), "program"),
        counted(summary.blocks, "executed block"),
        counted(count(Severity::Error), "error"),
        counted(count(Severity::Warning), "warning"),
    )
}

fn counted(number: u64, noun: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {noun}{plural}")
}

fn render_left(page: &mut Page<'_>, story: &RunStory) {
    let Some(summary) = &story.summary else {
        page.paragraph("The session did not run to its end.");
        return;
    };
    page.paragraph("Friction compensation (FRICT) by axis, after the last program. Home is the state after a start \
         of the control; \u{25b2} marks what is away from home and remains so.");
    page.open_table(
        "What is left",
        &["axis", "at start", "at end", "changed by"],
    );
    for axis in &summary.axes {
        let of = (axis.axis, Kind::Frict);
        let state = |state| state_word(state, story.standing(of, state));
        let cells = [
            state(axis.start),
            state(axis.end),
            changed_by(story, &axis.changed_by, axis.changes),
        ];
        page.row(story.axis_name(axis.axis), &cells);
    }
    page.close_table();
    render_advice(page, story, summary);
    if !summary.opaque.is_empty() {
        page.raw("<p>Passed over without effect on the states: ");
        for (at, (word, count)) in summary.opaque.iter().enumerate() {
            let comma = if at == 0 { "" } else { ", " };
            page.raw(&format!(
                "{comma}<code>{}</code>\u{a0}\u{d7}{count}",
                escaped(word)
            ));
        }
        page.raw("</p>\n");
    }
}

fn render_advice(page: &mut Page<'_>, story: &RunStory, summary: &SummaryStory) {
    let errors = summary.counts.get(&Severity::Error).copied();
    let mut advice: Vec<String> = (summary.axes.iter())
        .filter_map(|axis| {
            let name = story.axis_name(axis.axis);
            axis_advice(axis, name).map(|text| format!("{name}{text}"))
        })
        .collect();
    advice.extend(error_advice(errors.unwrap_or_default(), story.ended()).map(str::to_owned));
    if advice.is_empty() {
        if story.remark.is_none() && summary.axes.iter().all(is_home) {
            page.paragraph(NOTHING_TO_DO);
        }
        return;
    }
    page.raw("<div class=\"to-do\"><ul>\n");
    for text in advice {
        page.raw("<li>");
        page.text(&text);
        page.raw("</li>\n");
    }
    page.raw("</ul></div>\n");
}

/// The blocks that a summary names in a cell.
const NAMED_BLOCKS: usize = 8;

fn changed_by(story: &RunStory, blocks: &[ChangedBy], total: u64) -> String {
    if blocks.is_empty() {
        return "\u{2013}".to_owned();
    }
    let mut cell = String::new();
    let mut named: Vec<&ChangedBy> = Vec::new();
    for block in blocks {
        // A block of a loop is named once.
        let same = |known: &&ChangedBy| known.line == block.line && known.file == block.file;
        if named.len() < NAMED_BLOCKS && !named.iter().any(same) {
            named.push(block);
        }
    }
    for (at, block) in named.iter().enumerate() {
        let comma = if at == 0 { "" } else { ", " };
        let name = match block.number {
            Some(number) => format!("N{number} ({}:{})", block.file, block.line),
            None => format!("{}:{}", block.file, block.line),
        };
        let file = story.files.iter().position(|file| file.name == block.file);
        let shown = file.filter(|&file| story.files[file].events.contains_key(&block.line));
        let _ = match shown {
            Some(file) => write!(
                cell,
                "{comma}<a href=\"#{}\">{}</a>",
                line_id((file, block.line)),
                escaped(&name)
            ),
            None => write!(cell, "{comma}{}", escaped(&name)),
        };
    }
    let named = u64::try_from(named.len()).unwrap_or(u64::MAX);
    if total > named {
        let _ = write!(cell, " and {} more", total - named);
    }
    cell
}

fn render_states(page: &mut Page<'_>, story: &RunStory) -> io::Result<()> {
    page.paragraph(
        "Each bar is a state over the executed blocks and links to the line that caused it. Striped \
         bars are away from home, the state after a start of the control.",
    );
    let charted = story
        .programs
        .iter()
        .filter(|program| !program.tracks.is_empty());
    for program in charted {
        let file = &story.files[program.file].name;
        page.raw("<h3>");
        page.text(&format!("Program {}: ", program.number));
        page.raw(&format!(
            "<a href=\"#f{}\">{}</a>",
            program.file,
            escaped(file)
        ));
        if let Some(name) = &program.name {
            page.text(&format!(" %{name}"));
        }
        page.raw("</h3>\n");
        let end = match program.by {
            Some(by) => format!("ended by {}", by.word()),
            None => "did not end".to_owned(),
        };
        page.paragraph(&format!(
            "{}, {end}.",
            counted(program.blocks, "executed block")
        ));
        let name = format!("states{}", program.number);
        page.figure(&chart(story, program).render(Frame::Inside(&name)));
        page.settle()?;
    }
    if story.more_programs > 0 {
        page.paragraph(&format!(
            "{} more have no chart here.",
            counted(u64::from(story.more_programs), "program")
        ));
    }
    Ok(())
}

fn chart(story: &RunStory, program: &ProgramStory) -> BandChart {
    let shown = program.tracks.iter().filter(|track| {
        let listed = story
            .axes
            .get(track.axis.get())
            .is_some_and(|axis| axis.listed);
        listed && (track.kind == Kind::Frict || track.is_configured())
    });
    let rows: Vec<BandRow> = shown.map(|track| row(story, program, track)).collect();
    let told: Vec<String> = rows.iter().map(describe).collect();
    BandChart {
        // The heading above it says what it is.
        title: String::new(),
        description: if told.is_empty() {
            "No axis occurred.".to_owned()
        } else {
            told.join(" ")
        },
        x: Axis::linear("executed block"),
        steps: Some((0.0, block(program.blocks))),
        rows,
    }
}

/// The states of a row in words, at most the first few.
fn describe(row: &BandRow) -> String {
    const TOLD: usize = 6;
    let mut states: Vec<&str> = row.bands.iter().map(|band| band.state.word()).collect();
    let total = states.len();
    states.truncate(TOLD);
    let more = if total > TOLD {
        format!(" and {} more states", total - TOLD)
    } else {
        String::new()
    };
    format!("{}: {}{more}.", row.label, states.join(", then "))
}

fn row(story: &RunStory, program: &ProgramStory, track: &Track) -> BandRow {
    let axis = story.axis_name(track.axis);
    let label = match track.kind {
        Kind::Frict => axis.to_owned(),
        kind => format!("{axis} {}", kind.keyword()),
    };
    // Block n has the room about n, the start that about 0.
    let ends = track.stretches.iter().skip(1).map(|next| next.from);
    let ends = ends.chain([program.blocks + 1]);
    let bands = (track.stretches.iter().zip(ends))
        .map(|(stretch, end)| Band {
            from: block(stretch.from) - 0.5,
            to: block(end) - 0.5,
            state: stretch.state,
            standing: track.standing(stretch.state),
            title: told(story, &label, stretch),
            href: Some(target(story, program, stretch)),
        })
        .collect();
    BandRow { label, bands }
}

/// A bar in words.
fn told(story: &RunStory, label: &str, stretch: &Stretch) -> String {
    let word = stretch.state.word();
    match stretch.spot {
        None => format!("{label} {word} at program start"),
        Some(spot) => {
            let number = spot.number.map(|n| format!("N{n}, ")).unwrap_or_default();
            let file = &story.files[spot.file].name;
            format!(
                "{label} {word} from {number}{file}:{}, executed block {}",
                spot.line, stretch.from
            )
        }
    }
}

/// The line that made it so, if the source shows it by itself, or else its file.
fn target(story: &RunStory, program: &ProgramStory, stretch: &Stretch) -> String {
    match stretch.spot {
        Some(spot) if story.files[spot.file].events.contains_key(&spot.line) => {
            format!("#{}", line_id((spot.file, spot.line)))
        }
        Some(spot) => format!("#f{}", spot.file),
        None => format!("#f{}", program.file),
    }
}

/// A block as a place on the axis of a chart; beyond 2^52 neighbours fall together.
fn block(number: u64) -> f64 {
    let high = u32::try_from(number >> 32).unwrap_or(u32::MAX);
    let low = u32::try_from(number & 0xffff_ffff).unwrap_or(u32::MAX);
    f64::from(high) * 4_294_967_296.0 + f64::from(low)
}
