//! The states of each axis over the executed blocks.

use std::io;

use maud::html;

use super::digest::{ProgramDigest, RunDigest};
use super::page::Page;
use super::parts::{figure, line_id};
use super::track::{StateSpan, StateTrack};
use crate::svg::{Band, BandChart, BandRow, ChartAxis, Frame};
use crate::wording::counted;
use frictcomp::comp::Kind;

/// Writes a chart for each program.
pub(super) fn render(page: &mut Page<'_>, digest: &RunDigest) -> io::Result<()> {
    page.push(&html! {
        p {
            "Each bar is a state over the executed blocks and links to the line that caused it. \
             Striped bars differ from the start-up state, the state after a start of the control."
        }
        "\n"
    })?;
    let programs = digest.programs.iter();
    for program in programs.filter(|program| !program.tracks.is_empty()) {
        let end = match program.by {
            Some(by) => format!("ended by {}", by.as_str()),
            None => "did not end".to_owned(),
        };
        let name = format!("states{}", program.number);
        page.push(&html! {
            h3 {
                "Program " (program.number) ": "
                a href={ "#f" (program.file) } { (digest.files[program.file].name) }
                @if let Some(name) = &program.name { " %" (name) }
            }
            p { (counted(program.blocks, "executed block")) ", " (end) "." }
            (figure(chart(digest, program).render(Frame::Inside(&name))))
        })?;
    }
    if digest.more_programs > 0 {
        let more = counted(u64::from(digest.more_programs), "program");
        page.push(&html! { p { (more) " more have no chart here." } })?;
    }
    Ok(())
}

fn chart(digest: &RunDigest, program: &ProgramDigest) -> BandChart {
    let shown = program.tracks.iter().filter(|track| {
        let listed = digest
            .axes
            .get(track.axis.get())
            .is_some_and(|axis| axis.listed);
        listed && (track.kind == Kind::Frict || track.is_configured())
    });
    let rows: Vec<BandRow> = shown.map(|track| row(digest, program, track)).collect();
    let told: Vec<String> = rows.iter().map(describe).collect();
    BandChart {
        // The heading above it names it.
        title: String::new(),
        description: if told.is_empty() {
            "No axis occurred.".to_owned()
        } else {
            told.join(" ")
        },
        x: ChartAxis::linear("executed block"),
        steps: Some((0.0, block(program.blocks))),
        rows,
    }
}

/// Returns the states of a row in words, at most the first few.
fn describe(row: &BandRow) -> String {
    const TOLD: usize = 6;
    let mut states: Vec<&str> = row.bands.iter().map(|band| band.state.as_str()).collect();
    let total = states.len();
    states.truncate(TOLD);
    let more = if total > TOLD {
        format!(" and {} more states", total - TOLD)
    } else {
        String::new()
    };
    format!("{}: {}{more}.", row.label, states.join(", then "))
}

fn row(digest: &RunDigest, program: &ProgramDigest, track: &StateTrack) -> BandRow {
    let axis = digest.axis_name(track.axis);
    let label = match track.kind {
        Kind::Frict => axis.to_owned(),
        kind => format!("{axis} {}", kind.as_str()),
    };
    // Block n has the room around n, the start the room around 0.
    let ends = track.stretches.iter().skip(1).map(|next| next.from);
    let ends = ends.chain([program.blocks + 1]);
    let bands = (track.stretches.iter().zip(ends))
        .map(|(stretch, end)| Band {
            from: block(stretch.from) - 0.5,
            to: block(end) - 0.5,
            state: stretch.state,
            relation: track.relation(stretch.state),
            title: told(digest, &label, stretch),
            href: Some(target(digest, program, stretch)),
        })
        .collect();
    BandRow { label, bands }
}

/// Describes a bar in words.
fn told(digest: &RunDigest, label: &str, stretch: &StateSpan) -> String {
    let word = stretch.state.as_str();
    let ways = stretch
        .ways
        .map(|ways| format!(": {}", digest.ways.text(ways)));
    let ways = ways.unwrap_or_default();
    match stretch.spot {
        None => format!("{label} {word} at program start{ways}"),
        Some(spot) => {
            let number = spot.number.map(|n| format!("N{n}, ")).unwrap_or_default();
            let file = &digest.files[spot.file].name;
            format!(
                "{label} {word} from {number}{file}:{}, executed block {}{ways}",
                spot.line, stretch.from
            )
        }
    }
}

/// Returns the line that caused it if the source shows it separately, otherwise its file.
fn target(digest: &RunDigest, program: &ProgramDigest, stretch: &StateSpan) -> String {
    match stretch.spot {
        Some(spot) if digest.files[spot.file].events.contains_key(&spot.line) => {
            format!("#{}", line_id(spot.file, spot.line))
        }
        Some(spot) => format!("#f{}", spot.file),
        None => format!("#f{}", program.file),
    }
}

/// Returns a block as a place on the axis of a chart; beyond 2^52, neighbours coincide.
fn block(number: u64) -> f64 {
    let high = u32::try_from(number >> 32).unwrap_or(u32::MAX);
    let low = u32::try_from(number & 0xffff_ffff).unwrap_or(u32::MAX);
    f64::from(high) * 4_294_967_296.0 + f64::from(low)
}
