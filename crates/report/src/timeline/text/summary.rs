//! The end of the timeline: the changes of each axis and what is left to do.

use anstyle::Style;
use unicode_width::UnicodeWidthStr;

use crate::assumptions::rests_on_text;
use crate::document::{Headline, Standing};
use crate::wording::{
    Detail, FinalStates, Look, feed_moves_text, grouped, last_part, visible_line,
};
use frictcomp::comp::State;
use frictcomp::diagnostic::Severity;
use frictcomp::interpreter::EndedBy;
use frictcomp::timeline::{AxisSummary, ChangedBy, ReadingsInForce, Summary};

use super::line::{BOLD, DIM, Paragraph, TextLine, style};

/// Minimum width of the blocks that changed an axis next to its states; otherwise they go below them.
const CHANGED_BY: usize = 24;

/// Columns of `changed by `.
const CHANGED: usize = 11;

/// Columns of a state in the summary.
const STATE: usize = 14;

/// Appends the summary of a session, with the end of its last program; the verdict is the last line (R18.20).
pub(super) fn append(out: &mut Vec<u8>, summary: &Summary<'_>, by: Option<EndedBy>, look: Look) {
    let is_long = look.detail == Detail::Full;
    if is_long {
        let counts = format!(
            "Summary  {}, {}, {}, {}",
            count(u64::from(summary.programs), "program"),
            count(summary.blocks, "block"),
            count(summary.count(Severity::Error), "error"),
            count(summary.count(Severity::Warning), "warning"),
        );
        Paragraph::new(BOLD, &counts).write(out, look);
    }
    if is_long || (summary.programs > 1 && summary.axes.iter().any(|axis| axis.changes > 0)) {
        table(out, summary, look);
        out.push(b'\n');
    }
    if is_long {
        opaque(out, summary, look);
        for silenced in summary.silenced {
            let text = visible_line(&silenced.to_string()).into_owned();
            Paragraph::new(DIM, &text).write(out, look);
        }
    }
    advice(out, summary, by, look);
}

/// Returns the verdict on a session.
pub fn headline(summary: &Summary<'_>, by: Option<EndedBy>) -> Option<Headline> {
    let machine = summary.state.machine;
    let axes = summary.axes.iter();
    let states = FinalStates {
        axes: axes
            .map(|axis| (summary.state.name(axis.axis), axis))
            .collect(),
        assumed: &summary.assumed,
        errors: summary.count(Severity::Error),
        warnings: summary.count(Severity::Warning),
        by,
        assumption: machine.assumption(),
        is_described: machine.is_described(),
    };
    states.headline()
}

fn table(out: &mut Vec<u8>, summary: &Summary<'_>, look: Look) {
    if summary.axes.is_empty() {
        return;
    }
    if look.detail == Detail::Full {
        out.push(b'\n');
    }
    let name = |axis: &AxisSummary| summary.state.name(axis.axis);
    let names = summary.axes.iter().map(|axis| name(axis).width());
    let first = 4 + names.max().unwrap_or_default().max("axis".len());
    let mut line = TextLine::new(out, look.paint);
    line.go_to(2);
    line.styled(BOLD, "axis");
    let column = first + 2 * STATE;
    let beside = look.width >= column + CHANGED_BY;
    let titles = [(0, "at start"), (1, "at end"), (2, "changed by")];
    for (at, title) in titles.into_iter().take(if beside { 3 } else { 2 }) {
        line.go_to(first + at * STATE);
        line.styled(BOLD, title);
    }
    line.end();
    for axis in &summary.axes {
        let mut line = TextLine::new(out, look.paint);
        line.go_to(2);
        line.plain(name(axis));
        line.go_to(first);
        line.styled(style(axis.start), axis.start.as_str());
        line.go_to(first + STATE);
        line.styled(style(axis.end), axis.end.as_str());
        let room = look.width.saturating_sub(column);
        let text = changed_by(axis, room);
        let fits = beside && text.width() <= room;
        if fits {
            line.go_to(column);
            line.plain(&text);
        }
        line.end();
        if !fits && axis.changes > 0 {
            let room = look.width.saturating_sub(4 + CHANGED);
            let text = format!("changed by {}", changed_by(axis, room));
            Paragraph::new(Style::new(), &text)
                .indented(4)
                .write(out, look);
        }
    }
}

/// The form of a file name.
#[derive(Clone, Copy)]
enum Files {
    /// Name as given by the user.
    Path,
    /// File name without its folders.
    Name,
}

/// Returns the blocks that changed an axis, as many as fit; without the folders of their files if that takes too much
/// room.
fn changed_by(axis: &AxisSummary, room: usize) -> String {
    let whole = named_blocks(axis, room, Files::Path);
    if whole.width() <= room {
        return whole;
    }
    named_blocks(axis, room, Files::Name)
}

fn named_blocks(axis: &AxisSummary, room: usize, files: Files) -> String {
    if axis.changes == 0 {
        return "-".to_owned();
    }
    let mut text = String::new();
    let mut named = 0;
    for block in &axis.changed_by {
        let name = block_name(block, files);
        let separator = if named == 0 { "" } else { ", " };
        let left = axis.changes.saturating_sub(named + 1);
        let more = if left == 0 { 0 } else { more(left).width() };
        let width = text.width() + separator.len() + name.width() + more;
        if named > 0 && width > room {
            break;
        }
        text.push_str(separator);
        text.push_str(&name);
        named += 1;
    }
    let left = axis.changes.saturating_sub(named);
    if left > 0 {
        text.push_str(&more(left));
    }
    text
}

fn more(left: u64) -> String {
    format!(" and {} more", grouped(left))
}

fn block_name(block: &ChangedBy, files: Files) -> String {
    let file = match files {
        Files::Path => block.file.as_str(),
        Files::Name => last_part(&block.file),
    };
    match block.number {
        Some(number) => format!("N{number} ({file}:{})", block.line),
        None => format!("{file}:{}", block.line),
    }
}

fn opaque(out: &mut Vec<u8>, summary: &Summary<'_>, look: Look) {
    if summary.opaque.is_empty() {
        return;
    }
    let lead = "Passed over:";
    let mut line = TextLine::new(out, look.paint);
    line.plain(lead);
    let mut column = lead.width();
    for (at, (word, count)) in summary.opaque.iter().enumerate() {
        let comma = if at + 1 < summary.opaque.len() {
            ","
        } else {
            ""
        };
        let item = format!(" {word} ×{}{comma}", grouped(*count));
        if column + item.width() > look.width {
            line.end();
            line = TextLine::new(out, look.paint);
            line.plain(" ");
            column = 1;
        }
        column += item.width();
        line.plain(&item);
    }
    line.end();
}

fn advice(out: &mut Vec<u8>, summary: &Summary<'_>, by: Option<EndedBy>, look: Look) {
    let rests_on = ReadingsInForce::of(summary.rests_on, summary.state.machine);
    if let Some(text) = look.detail.full(rests_on_text(&rests_on)).flatten() {
        Paragraph::new(DIM, &text).write(out, look);
    }
    for axis in &summary.axes {
        let of = summary.state.machine.axis(axis.axis);
        if let Some(text) = feed_moves_text(&axis.feed_moves, of.axis_type) {
            let text = format!("{}{text}", of.name);
            Paragraph::new(style(State::Inactive), &text).write(out, look);
        }
    }
    if let Some(headline) = headline(summary, by) {
        let style = match headline.standing {
            Standing::Good => style(State::Active),
            Standing::Bad => style(State::Inactive),
            Standing::Open | Standing::Plain => style(State::Unknown),
        };
        Paragraph::new(style, &headline.text).write(out, look);
    }
}

fn count(number: u64, noun: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{} {noun}{plural}", grouped(number))
}

#[cfg(test)]
mod tests {
    use super::*;
    use frictcomp::comp::AxisIndex;

    #[test]
    fn as_many_blocks_are_named_as_have_room() {
        let mut axis = AxisSummary {
            others_away: frictcomp::comp::KindSet::NONE,
            axis: AxisIndex::new(0),
            start: State::Active,
            end: State::Inactive,
            start_up: State::Active,
            told: false,
            changed_by: Vec::new(),
            changes: 0,
            feed_moves: frictcomp::timeline::FeedMoves::default(),
            is_undescribed: false,
            is_rewritten: false,
        };
        assert_eq!(changed_by(&axis, 40), "-");
        for line in 1..=100 {
            axis.changed_by.push(ChangedBy {
                program: 1,
                file: "a.nc".to_owned(),
                line,
                number: (line == 1).then_some(10),
                to: State::Inactive,
            });
        }
        axis.changes = 2300;
        assert_eq!(changed_by(&axis, 40), "N10 (a.nc:1), a.nc:2 and 2 298 more");
        assert_eq!(changed_by(&axis, 0), "N10 (a.nc:1) and 2 299 more");
        axis.changed_by[0].file = "programs/of/a/folder/a.nc".to_owned();
        assert_eq!(changed_by(&axis, 40), "N10 (a.nc:1), a.nc:2 and 2 298 more");
        axis.changed_by[0].file = "a.nc".to_owned();
        axis.changes = 1;
        axis.changed_by.truncate(1);
        assert_eq!(changed_by(&axis, 40), "N10 (a.nc:1)");
    }
}
