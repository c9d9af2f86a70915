//! The source with its changes and messages at their lines; long stretches without are folded.

use std::fmt::Write as _;
use std::io;

use super::machine::change_words;
use super::messages::{line_id, push_item};
use super::page::Page;
use super::story::{FileStory, LineStory, RunStory};
use crate::comp::Kind;
use crate::report::markup::{push_escaped, push_source_line};
use crate::text::LineSource;

/// Gives the lines of a program once more, after it has run.
pub trait Sources {
    /// The lines of the file that the records name so; `None` when it cannot be read again.
    fn open(&mut self, name: &str) -> Option<Box<dyn LineSource + '_>>;
}

/// Lines without anything to say that are shown, in all files together.
const MAX_LINES: usize = 300_000;

/// Lines around one with something to say that are never folded.
const CONTEXT: usize = 3;

/// A fold of fewer lines is not worth the click.
const MIN_FOLD: usize = 6;

/// Lines of one fold.
const FOLD: usize = 1000;

/// Lines on their way to the page.
pub(super) struct Listing<'a, 'p> {
    page: &'a mut Page<'p>,
    story: &'a RunStory,
    file: usize,
    /// Lines without anything to say that wait for what follows.
    quiet: Vec<(u32, String)>,
    /// Whether a line with something to say stands above the waiting ones.
    below_event: bool,
    /// How many more quiet lines may be written.
    room: &'a mut usize,
    left_out: u64,
}

/// Writes every file whose blocks were executed.
pub(super) fn render(
    page: &mut Page<'_>,
    story: &RunStory,
    sources: &mut dyn Sources,
) -> io::Result<()> {
    page.paragraph(
        "The first number is the line, the second how often the line was executed. Lines that \
         changed a state or have a message are shown; unfold the others to see them.",
    );
    let mut room = MAX_LINES;
    for (number, file) in story.files.iter().enumerate() {
        page.raw(&format!("<h3 id=\"f{number}\">"));
        page.text(&file.name);
        page.raw("</h3>\n");
        let listing = Listing {
            page,
            story,
            file: number,
            quiet: Vec::new(),
            below_event: false,
            room: &mut room,
            left_out: 0,
        };
        listing.file(file, sources)?;
    }
    if story.more_events > 0 {
        page.paragraph(&format!(
            "{} more changes and messages are not marked at their lines: there are too many.",
            story.more_events
        ));
    }
    Ok(())
}

impl Listing<'_, '_> {
    fn file(mut self, file: &FileStory, sources: &mut dyn Sources) -> io::Result<()> {
        let again = sources.open(&file.name);
        if again.is_none() {
            self.page.paragraph(
                "The file cannot be read a second time: only the lines with something to report \
                 are shown.",
            );
        }
        self.page
            .raw("<div class=\"source\" role=\"group\" aria-label=\"Source ");
        self.page.text(&file.name);
        self.page
            .raw("\" tabindex=\"0\">\n<pre class=\"head\">  line    runs  source</pre>\n");
        match again {
            Some(mut lines) => self.lines(file, lines.as_mut())?,
            None => {
                for (&line, story) in &file.events {
                    self.event(line, &story.text, story)?;
                }
            }
        }
        self.page.raw("</div>\n");
        if self.left_out > 0 {
            let left_out = self.left_out;
            self.page.paragraph(&format!(
                "{left_out} more lines with nothing to report are left out; a report holds \
                 {MAX_LINES} of them."
            ));
        }
        self.page.settle()
    }

    fn lines(&mut self, file: &FileStory, lines: &mut dyn LineSource) -> io::Result<()> {
        let mut events = file.events.iter().peekable();
        let mut number = 0_u32;
        while lines.advance() {
            number = number.saturating_add(1);
            let text = lines.line().text;
            if let Some((_, story)) = events.next_if(|(line, _)| **line == number) {
                let text = text.to_owned();
                self.release(Below::Event)?;
                self.event(number, &text, story)?;
                self.below_event = true;
            } else if *self.room > 0 {
                *self.room -= 1;
                let mut row = String::new();
                push_gutter(&mut row, number, file.runs_of(number));
                push_source_line(&mut row, text);
                row.push('\n');
                self.quiet.push((number, row));
                if self.quiet.len() >= FOLD + CONTEXT {
                    self.release_some(FOLD)?;
                }
            } else {
                self.left_out += 1;
            }
        }
        self.release(Below::End)?;
        // A source that became shorter since it ran.
        for (&line, story) in events {
            self.event(line, &story.text, story)?;
        }
        Ok(())
    }

    /// Writes the lines that wait.
    fn release(&mut self, below: Below) -> io::Result<()> {
        let keep = match below {
            Below::Event => CONTEXT,
            Below::End => 0,
        };
        let fold = self.quiet.len().saturating_sub(keep);
        self.release_some(fold)?;
        self.open_lines(self.quiet.len());
        self.page.settle()
    }

    /// Folds the first of the lines that wait.
    fn release_some(&mut self, count: usize) -> io::Result<()> {
        let context = if self.below_event { CONTEXT } else { 0 };
        if count < context + MIN_FOLD {
            self.open_lines(count);
            return Ok(());
        }
        self.open_lines(context);
        self.below_event = false;
        let folded: Vec<_> = self.quiet.drain(..count - context).collect();
        let (Some((first, _)), Some((last, _))) = (folded.first(), folded.last()) else {
            return Ok(());
        };
        let lines = folded.len();
        self.page.raw(&format!(
            "<details><summary>lines {first} to {last}: {lines} without a change</summary><pre>"
        ));
        for (_, row) in &folded {
            self.page.raw(row);
        }
        self.page.raw("</pre></details>\n");
        self.page.settle()
    }

    fn open_lines(&mut self, count: usize) {
        if count == 0 {
            return;
        }
        self.page.raw("<pre>");
        for (_, row) in self.quiet.drain(..count) {
            self.page.raw(&row);
        }
        self.page.raw("</pre>\n");
    }

    fn event(&mut self, line: u32, text: &str, event: &LineStory) -> io::Result<()> {
        let story = self.story;
        let runs = story.files[self.file].runs_of(line);
        let id = line_id((self.file, line));
        let out = self.page.buffer();
        let _ = write!(out, "<div class=\"ev\" id=\"{id}\" tabindex=\"-1\"><pre>");
        push_gutter(out, line, runs);
        self.marked(line, text, event);
        let out = self.page.buffer();
        out.push_str("</pre><ul>\n");
        for (change, times) in &event.changes {
            let _ = write!(out, "<li><strong>");
            push_escaped(out, story.axis_name(change.axis));
            if change.kind != Kind::Frict {
                let _ = write!(out, " {}", change.kind.keyword());
            }
            let words = change_words(story, *change);
            let _ = write!(out, "</strong> {words}");
            if *times > 1 {
                let _ = write!(out, " <span class=\"quiet\">({times} times)</span>");
            }
            out.push_str("</li>\n");
        }
        if event.more_changes > 0 {
            let _ = writeln!(out, "<li>and {} more changes</li>", event.more_changes);
        }
        for &message in &event.messages {
            push_item(out, &story.messages[message]);
        }
        out.push_str("</ul></div>\n");
        self.page.settle()
    }

    /// The line with what its messages mean underlined.
    fn marked(&mut self, line: u32, text: &str, event: &LineStory) {
        let mut spans: Vec<(usize, usize)> = (event.messages.iter())
            .filter_map(|&message| {
                let place = &self.story.messages[message].diagnostic.place;
                let (start, end) = (place.start(), place.end());
                let end = if end.line == start.line {
                    end.column
                } else {
                    u32::MAX
                };
                let columns = |column: u32| usize::try_from(column).unwrap_or(usize::MAX) - 1;
                (start.line == line).then(|| (columns(start.column), columns(end)))
            })
            .collect();
        spans.sort_unstable();
        let byte = |column: usize| {
            let at = text.char_indices().nth(column);
            at.map_or(text.len(), |(byte, _)| byte)
        };
        let out = self.page.buffer();
        let mut done = 0;
        for (start, end) in spans {
            let (start, end) = (byte(start).max(done), byte(end));
            if start < end && end <= MARKED_BYTES {
                push_escaped(out, &text[done..start]);
                out.push_str("<mark>");
                push_escaped(out, &text[start..end]);
                out.push_str("</mark>");
                done = end;
            }
        }
        push_source_line(out, &text[done..]);
        out.push('\n');
    }
}

/// Further right nothing is marked.
const MARKED_BYTES: usize = 400;

/// What stands below the lines that wait.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Below {
    /// A line with something to say.
    Event,
    /// Nothing any more.
    End,
}

/// The number of a line and how often it was executed, empty for never.
fn push_gutter(out: &mut String, line: u32, runs: u32) {
    let runs = if runs == 0 {
        String::new()
    } else {
        format!("{runs}\u{d7}")
    };
    let _ = write!(out, "{line:>6} {runs:>7}  ");
}
