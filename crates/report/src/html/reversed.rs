//! The source of a contour with the reversals of each line; lines without reversals are folded.

use std::collections::BTreeMap;
use std::io;

use maud::{Markup, html};

use super::page::Page;
use super::parts::line_id;
use super::source::{SourceText, Sources};
use crate::wording::counted;
use frictcomp::comp::State;
use frictcomp_physics::contour::{ContourReversal, GlitchFigure};
use frictcomp_physics::motion::Movement;

/// Lines without a reversal that a page holds at most, in all files together.
const MAX_QUIET: usize = 50_000;

/// Least number of lines of a fold: one of fewer lines is not worth the click.
const MIN_FOLD: usize = 4;

/// The reversals of an axis in a line.
#[derive(Debug, Default)]
struct OfAxis {
    rapid: u64,
    cutting: u64,
    uncompensated: u64,
    /// The largest glitches in µm: as programmed, all on, all off; `None` if none is measured.
    glitch_um: Option<[f64; 3]>,
}

/// The reversals of each line of a file, by axis.
type LineReversals<'a> = BTreeMap<u32, BTreeMap<&'a str, OfAxis>>;

/// The files with reversals, in the order of their first reversals.
#[derive(Debug, Default)]
pub(super) struct ReversedFiles<'a>(Vec<(&'a str, LineReversals<'a>)>);

impl<'a> ReversedFiles<'a> {
    pub(super) fn of(reversals: &'a [ContourReversal]) -> Self {
        let mut files: Vec<(&str, LineReversals<'_>)> = Vec::new();
        for reversal in reversals {
            let at = files.iter().position(|(name, _)| *name == &*reversal.file);
            let at = at.unwrap_or_else(|| {
                files.push((&reversal.file, LineReversals::new()));
                files.len() - 1
            });
            let axes = files[at].1.entry(reversal.line).or_default();
            axes.entry(&reversal.axis).or_default().push(reversal);
        }
        Self(files)
    }

    /// Returns the link to a line with reversals.
    pub(super) fn link(&self, file: &str, line: u32) -> Option<String> {
        let at = self.0.iter().position(|(name, _)| *name == file)?;
        let is_shown = self.0[at].1.contains_key(&line);
        is_shown.then(|| format!("#{}", line_id(at, line)))
    }

    pub(super) fn render(&self, page: &mut Page<'_>, sources: &mut dyn Sources) -> io::Result<()> {
        let mut room = MAX_QUIET;
        for (at, (name, lines)) in self.0.iter().enumerate() {
            page.push(&html! { h3 { (name) } "\n" })?;
            let label = html! { "Source " (name) }.0;
            page.raw(&format!(
                "<div class=\"source\" role=\"group\" aria-label=\"{label}\" tabindex=\"0\">\n"
            ));
            render_file(page, (at, lines), (sources.open(name), &mut room))?;
            page.raw("</div>\n");
        }
        Ok(())
    }
}

type Source<'s> = Option<Box<dyn frictcomp::text::LineSource + 's>>;

fn render_file(
    page: &mut Page<'_>,
    (file, lines): (usize, &LineReversals<'_>),
    (source, room): (Source<'_>, &mut usize),
) -> io::Result<()> {
    let mut rest = lines.iter().peekable();
    let mut quiet: Vec<(u32, String)> = Vec::new();
    let mut number = 0_u32;
    let mut left_out = 0_u64;
    if let Some(mut source) = source {
        while source.advance() {
            number = number.saturating_add(1);
            let text = source.line().text;
            if let Some((_, axes)) = rest.next_if(|(line, _)| **line == number) {
                let text = text.to_owned();
                fold(page, &mut quiet)?;
                page.push(&reversed(file, (number, &text), axes))?;
            } else if *room > 0 {
                *room -= 1;
                quiet.push((number, text.to_owned()));
            } else {
                left_out += 1;
            }
        }
        fold(page, &mut quiet)?;
    }
    // A source that cannot be read again, or that has become shorter since the run.
    for (line, axes) in rest {
        page.push(&reversed(file, (*line, ""), axes))?;
    }
    if left_out > 0 {
        page.push(&html! { p { (left_out) " more lines without a reversal are left out." } })?;
    }
    Ok(())
}

/// Writes the waiting lines without a reversal.
fn fold(page: &mut Page<'_>, quiet: &mut Vec<(u32, String)>) -> io::Result<()> {
    let (Some((first, _)), Some((last, _))) = (quiet.first(), quiet.last()) else {
        return Ok(());
    };
    let shown = html! { pre { @for (number, text) in &*quiet { (line(*number, text)) "\n" } } };
    let count = quiet.len();
    page.push(&html! {
        @if count < MIN_FOLD {
            (shown)
        } @else {
            details {
                summary { "lines " (first) " to " (last) ": " (count) " without a reversal" }
                (shown)
            }
        }
        "\n"
    })?;
    quiet.clear();
    Ok(())
}

fn line(number: u32, text: &str) -> Markup {
    html! { (format!("{number:>6}  ")) (SourceText(text)) }
}

fn reversed(file: usize, (number, text): (u32, &str), axes: &BTreeMap<&str, OfAxis>) -> Markup {
    html! {
        div.ev id=(line_id(file, number)) tabindex="-1" {
            pre { (line(number, text)) "\n" }
            ul { @for (axis, of) in axes { li { (of.words(axis)) } "\n" } }
        }
        "\n"
    }
}

impl OfAxis {
    fn push(&mut self, reversal: &ContourReversal) {
        if reversal.movement == Movement::Rapid {
            self.rapid += 1;
            return;
        }
        self.cutting += 1;
        self.uncompensated += u64::from(reversal.state != State::Active);
        if reversal.figure != GlitchFigure::Measured {
            return;
        }
        let glitch = &reversal.glitch_um;
        let each = [glitch.programmed, glitch.all_on, glitch.all_off];
        let largest = self.glitch_um.get_or_insert_default();
        for (largest, glitch) in largest.iter_mut().zip(each) {
            *largest = largest.max(glitch);
        }
    }

    /// Returns text such as "X: 3 reversals, 2 without compensation, at most 23.8 µm (all on 1.5, all off 23.8)".
    fn words(&self, axis: &str) -> Markup {
        html! {
            (axis) ": "
            @if self.cutting > 0 {
                (counted(self.cutting, "reversal"))
                @if self.uncompensated > 0 {
                    ", " span.state.away { (self.uncompensated) " without compensation" }
                }
                @match self.glitch_um {
                    Some([programmed, on, off]) => {
                        (format!(", at most {programmed:.1} µm (all on {on:.1}, all off {off:.1})"))
                    }
                    None => { ", along the path or too near to a stop or a corner for a figure" }
                }
                @if self.rapid > 0 { "; " }
            }
            @if self.rapid > 0 { (counted(self.rapid, "reversal")) " in rapid" }
        }
    }
}
