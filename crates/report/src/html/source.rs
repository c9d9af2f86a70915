//! The source with its changes and messages at their lines; long stretches without any are folded.

use std::fmt::Write as _;
use std::ops::Range;
use std::{io, iter};

use maud::{Escaper, Markup, Render, html};

use super::digest::{FileDigest, JoinedStates, LINE_ROOM, LineDigest, RunDigest};
use super::messages::item;
use super::page::Page;
use super::parts::{line_id, state_word, times};
use crate::svg::StartUpRelation;
use frictcomp::comp::{AxisIndex, Change, Kind, State};
use frictcomp::text::LineSource;

/// Gives the lines of a program once more, after its run.
pub trait Sources {
    /// Returns the lines of the file with this name in the records; `None` if it cannot be read again.
    fn open(&mut self, name: &str) -> Option<Box<dyn LineSource + '_>>;
}

/// Lines without an event that are shown, in all files together.
const MAX_LINES: usize = 300_000;

/// Lines around one with an event that are never folded.
const CONTEXT: usize = 3;

/// Least number of lines of a fold: one of fewer lines is not worth the click.
const MIN_FOLD: usize = 6;

/// Lines of one fold.
const FOLD: usize = 1000;

/// Bytes of a line after which nothing is marked.
const MARKED_BYTES: usize = 400;

/// Lines on their way to the page.
struct SourceLines<'a, 'p> {
    page: &'a mut Page<'p>,
    digest: &'a RunDigest,
    file: usize,
    /// Lines without an event that wait for the next line.
    quiet: Vec<QuietLine>,
    /// Whether a line with an event is above the waiting ones.
    below_event: bool,
    /// Number of further quiet lines that may be written.
    room: &'a mut usize,
    left_out: u64,
}

/// A line without an event.
struct QuietLine {
    number: u32,
    runs: u32,
    text: String,
}

/// Line below the waiting ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LineBelow {
    /// A line with an event.
    Event,
    /// The end of the file.
    End,
}

/// Writes every file whose blocks were executed.
pub(super) fn render(
    page: &mut Page<'_>,
    digest: &RunDigest,
    sources: &mut dyn Sources,
) -> io::Result<()> {
    page.push(&html! {
        p {
            "The first number is the line, the second how often the line was executed. Lines that \
             changed a state or have a message are shown; unfold the others to see them."
        }
        "\n"
    })?;
    let mut room = MAX_LINES;
    for (number, file) in digest.files.iter().enumerate() {
        page.push(&html! { h3 id={ "f" (number) } { (file.name) } "\n" })?;
        let listing = SourceLines {
            page,
            digest,
            file: number,
            quiet: Vec::new(),
            below_event: false,
            room: &mut room,
            left_out: 0,
        };
        listing.render(file, sources)?;
    }
    if digest.more_events > 0 {
        page.push(&html! {
            p {
                (digest.more_events)
                " more changes and messages are not marked at their lines: there are too many."
            }
        })?;
    }
    Ok(())
}

impl SourceLines<'_, '_> {
    fn render(mut self, file: &FileDigest, sources: &mut dyn Sources) -> io::Result<()> {
        let mut again = sources.open(&file.name);
        if again.is_none() {
            self.page.push(&html! {
                p {
                    "The file cannot be read a second time: only the lines with something to \
                     report are shown."
                }
            })?;
        }
        let label = html! { "Source " (file.name) }.0;
        self.page.raw(&format!(
            "<div class=\"source\" role=\"group\" aria-label=\"{label}\" tabindex=\"0\">\n"
        ));
        self.page
            .push(&html! { pre.head { "  line    runs  source" } "\n" })?;
        self.lines(file, again.as_deref_mut())?;
        self.page.raw("</div>\n");
        if self.left_out > 0 {
            self.page.push(&html! {
                p {
                    (self.left_out) " more lines with nothing to report are left out; a report \
                     holds " (MAX_LINES) " of them."
                }
            })?;
        }
        Ok(())
    }

    fn lines(
        &mut self,
        file: &FileDigest,
        lines: Option<&mut (dyn LineSource + '_)>,
    ) -> io::Result<()> {
        let mut events = file.events.iter().peekable();
        let mut number = 0_u32;
        if let Some(lines) = lines {
            while lines.advance() {
                number = number.saturating_add(1);
                let text = lines.line().text;
                if let Some((_, event)) = events.next_if(|(line, _)| **line == number) {
                    let text = text.to_owned();
                    self.release(LineBelow::Event)?;
                    self.event(number, &text, event)?;
                    self.below_event = true;
                } else if *self.room > 0 {
                    *self.room -= 1;
                    self.quiet.push(QuietLine {
                        number,
                        runs: file.runs_of(number),
                        text: text.to_owned(),
                    });
                    if self.quiet.len() >= FOLD + CONTEXT {
                        self.release_some(FOLD)?;
                    }
                } else {
                    self.left_out += 1;
                }
            }
            self.release(LineBelow::End)?;
        }
        // A source that cannot be read again, or that has become shorter since the run.
        for (&line, event) in events {
            self.event(line, &event.text, event)?;
        }
        Ok(())
    }

    /// Writes the waiting lines.
    fn release(&mut self, below: LineBelow) -> io::Result<()> {
        let keep = match below {
            LineBelow::Event => CONTEXT,
            LineBelow::End => 0,
        };
        let fold = self.quiet.len().saturating_sub(keep);
        self.release_some(fold)?;
        self.open_lines(self.quiet.len())
    }

    /// Folds the first of the waiting lines.
    fn release_some(&mut self, count: usize) -> io::Result<()> {
        let context = if self.below_event { CONTEXT } else { 0 };
        if count < context + MIN_FOLD {
            return self.open_lines(count);
        }
        self.open_lines(context)?;
        self.below_event = false;
        let folded = &self.quiet[..count - context];
        let (Some(first), Some(last)) = (folded.first(), folded.last()) else {
            return Ok(());
        };
        self.page.push(&html! {
            details {
                summary {
                    "lines " (first.number) " to " (last.number) ": " (folded.len())
                    " without a change"
                }
                pre { @for line in folded { (line) } }
            }
            "\n"
        })?;
        self.quiet.drain(..count - context);
        Ok(())
    }

    fn open_lines(&mut self, count: usize) -> io::Result<()> {
        if count == 0 {
            return Ok(());
        }
        let shown = &self.quiet[..count];
        self.page
            .push(&html! { pre { @for line in shown { (line) } } "\n" })?;
        self.quiet.drain(..count);
        Ok(())
    }

    fn event(&mut self, line: u32, text: &str, event: &LineDigest) -> io::Result<()> {
        let gutter = Gutter {
            line,
            runs: self.digest.files[self.file].runs_of(line),
        };
        self.page.push(&html! {
            div.ev id=(line_id(self.file, line)) tabindex="-1" {
                pre { (gutter) (self.marked(line, text, event)) "\n" }
                ul {
                    @for &met in &event.met {
                        li { (self.met(met)) }
                        "\n"
                    }
                    @for (change, count) in &event.changes {
                        li { (self.change(*change)) (times(*count)) }
                        "\n"
                    }
                    @if event.more_changes > 0 {
                        li { "and " (event.more_changes) " more changes" }
                    }
                    @for &message in &event.messages {
                        (item(&self.digest.messages[message]))
                    }
                }
            }
            "\n"
        })
    }

    fn change(&self, change: Change) -> Markup {
        let relation = |state| self.digest.relation(change.axis, change.kind, state);
        let word = |state| state_word(state, relation(state));
        html! {
            (self.named(change.axis, change.kind)) " " (word(change.from)) " \u{2192} " (word(change.to))
        }
    }

    /// Renders the possible states where ways join before the line (R14.2).
    fn met(&self, met: JoinedStates) -> Markup {
        html! {
            (self.named(met.axis, met.kind)) " " (state_word(State::Unknown, StartUpRelation::StartUp)) ": "
            (self.digest.ways.text(met.ways))
        }
    }

    fn named(&self, axis: AxisIndex, kind: Kind) -> Markup {
        html! {
            strong {
                (self.digest.axis_name(axis))
                @if kind != Kind::Frict { " " (kind.as_str()) }
            }
        }
    }

    /// Returns the line with the spans of its messages underlined.
    fn marked(&self, line: u32, text: &str, event: &LineDigest) -> Markup {
        let spans = self.spans(line, text, event);
        let begins = iter::once(0).chain(spans.iter().map(|span| span.end));
        let rest = spans.last().map_or(0, |span| span.end);
        html! {
            @for (begin, span) in begins.zip(&spans) {
                (text[begin..span.start]) mark { (text[span.clone()]) }
            }
            (SourceText(&text[rest..]))
        }
    }

    /// Returns the spans of the messages on a line, in bytes of it, one after the other.
    fn spans(&self, line: u32, text: &str, event: &LineDigest) -> Vec<Range<usize>> {
        let byte = |column: u32| {
            let column = usize::try_from(column).unwrap_or(usize::MAX) - 1;
            let at = text.char_indices().nth(column);
            at.map_or(text.len(), |(byte, _)| byte)
        };
        let places = event.messages.iter();
        let mut spans: Vec<Range<usize>> = places
            .map(|&message| &self.digest.messages[message].diagnostic.place)
            .filter(|place| place.start().line == line)
            .map(|place| {
                let (start, end) = (place.start(), place.end());
                let end = if end.line == start.line {
                    byte(end.column)
                } else {
                    text.len()
                };
                byte(start.column)..end
            })
            .collect();
        spans.sort_unstable_by_key(|span| (span.start, span.end));
        let mut done = 0;
        for span in &mut spans {
            span.start = span.start.max(done);
            if span.start < span.end && span.end <= MARKED_BYTES {
                done = span.end;
            } else {
                *span = 0..0;
            }
        }
        spans.retain(|span| !span.is_empty());
        spans
    }
}

impl Render for QuietLine {
    fn render_to(&self, out: &mut String) {
        let Self { number, runs, .. } = *self;
        Gutter { line: number, runs }.render_to(out);
        SourceText(&self.text).render_to(out);
        out.push('\n');
    }
}

/// The number of a line and its number of executions, empty for none.
struct Gutter {
    line: u32,
    runs: u32,
}

impl Render for Gutter {
    fn render_to(&self, out: &mut String) {
        let Self { line, runs } = self;
        let _ = match runs {
            0 => write!(out, "{line:>6}          "),
            _ => write!(out, "{line:>6} {runs:>6}\u{d7}  "),
        };
    }
}

/// A source line, cut if it is unreasonably long.
pub(super) struct SourceText<'a>(pub(super) &'a str);

impl Render for SourceText<'_> {
    fn render_to(&self, out: &mut String) {
        let end = self.0.char_indices().nth(LINE_ROOM);
        let (shown, rest) = self.0.split_at(end.map_or(self.0.len(), |(end, _)| end));
        let _ = Escaper::new(out).write_str(shown);
        if !rest.is_empty() {
            let left = rest.chars().count();
            let _ = write!(out, " \u{2026} and {left} more characters");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_cut() {
        // R9.52
        let text = "ü".repeat(LINE_ROOM + 7);
        let out = SourceText(&text).render().0;
        assert!(out.ends_with("ü … and 7 more characters"), "{out}");
    }

    #[test]
    fn the_gutter_has_a_fixed_width() {
        // R9.50
        let of = |line, runs| Gutter { line, runs }.render().0;
        assert_eq!(of(7, 0), "     7          ");
        assert_eq!(of(7, 12), "     7     12×  ");
    }
}
