//! A range of bytes, the line and column that people read, and a place in a file that shows itself.

use std::cmp::Ordering;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

/// A place in a file, together with the lines that show it.
///
/// It carries its lines itself, so that a program of any length can be streamed and forgotten.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Place {
    /// The file as the user named it.
    pub file: Arc<str>,
    /// The source lines to show, joined by `\n`.
    pub text: Arc<str>,
    /// The 1-based number of the first line of `text`.
    pub first_line: u32,
    /// The bytes of `text` that are meant.
    pub span: Span,
}

/// Bytes of a block beyond which a place in it shows no other lines than those that it touches.
pub(crate) const MAX_WHOLE: usize = 4096;

impl Place {
    /// Returns the start of a file, of which no text is shown.
    pub(crate) fn head_of(file: &Arc<str>) -> Self {
        Self {
            file: Arc::clone(file),
            text: "".into(),
            first_line: 1,
            span: Span::default(),
        }
    }

    /// Returns a place in a block, which shows itself whole unless it is long.
    pub(crate) fn in_block(
        file: &Arc<str>,
        text: impl AsRef<str> + Into<Arc<str>>,
        first_line: u32,
        span: Span,
    ) -> Self {
        let block = text.as_ref();
        if block.len() <= MAX_WHOLE {
            return Self {
                file: Arc::clone(file),
                text: text.into(),
                first_line,
                span,
            };
        }
        let bytes = block.as_bytes();
        let end = (span.end as usize).min(block.len());
        let start = (span.start as usize).min(end);
        let from = memchr::memrchr(b'\n', &bytes[..start]).map_or(0, |at| at + 1);
        let to = memchr::memchr(b'\n', &bytes[end..]).map_or(block.len(), |at| end + at);
        let before = memchr::memchr_iter(b'\n', &bytes[..from]).count();
        let shown = block[from..to].into();
        let from = u32::try_from(from).unwrap_or(u32::MAX);
        Self {
            file: Arc::clone(file),
            text: shown,
            first_line: first_line.saturating_add(u32::try_from(before).unwrap_or(u32::MAX)),
            span: Span {
                start: span.start.saturating_sub(from),
                end: span.end.saturating_sub(from),
            },
        }
    }

    /// Returns the first character that is meant.
    pub fn start(&self) -> Position {
        self.position(self.span.start)
    }

    /// Returns the position after the last character of the place.
    pub fn end(&self) -> Position {
        self.position(self.span.end)
    }

    /// Compares where two places begin. In the same lines, the offsets decide.
    pub(crate) fn cmp_start(&self, other: &Self) -> Ordering {
        if self.shows_lines_of(other) {
            self.span.start.cmp(&other.span.start)
        } else {
            self.start().cmp(&other.start())
        }
    }

    /// Returns whether both places share the lines that they show.
    fn shows_lines_of(&self, other: &Self) -> bool {
        self.first_line == other.first_line && Arc::ptr_eq(&self.text, &other.text)
    }

    fn position(&self, offset: u32) -> Position {
        let start = Position {
            line: self.first_line,
            column: 1,
        };
        start.after(self.text.get(..offset as usize).unwrap_or(&self.text))
    }
}

/// Starts of places in ascending order: lines counted once are not counted again while places show
/// the same lines.
#[derive(Debug, Default)]
pub(crate) struct StartsInOrder {
    last: Option<(Place, Position)>,
}

impl StartsInOrder {
    /// Returns [`Place::start`] of a place.
    pub(crate) fn start(&mut self, place: &Place) -> Position {
        let near = self.last.as_ref().and_then(|(last, position)| {
            let between = (last.span.start as usize)..(place.span.start as usize);
            let text = place.text.get(between)?;
            last.shows_lines_of(place).then(|| position.after(text))
        });
        let position = near.unwrap_or_else(|| place.start());
        self.last = Some((place.clone(), position));
        position
    }
}

/// Returns the name of a file in messages and records: on every system with `/` between its parts, as git writes them,
/// so that a report or an agreed result does not depend on where it was made.
pub fn shown_path(path: &Path) -> String {
    let written = path.to_string_lossy();
    if cfg!(windows) {
        slashed(&written)
    } else {
        written.into_owned()
    }
}

/// Returns a path of Windows with `/` between its parts and without `\\?\`, which lifts limits of the system and was
/// not written by the user.
fn slashed(path: &str) -> String {
    let plain = match path.strip_prefix(r"\\?\UNC\") {
        Some(share) => format!("//{share}"),
        None => path.strip_prefix(r"\\?\").unwrap_or(path).to_owned(),
    };
    plain.replace('\\', "/")
}

/// A range of bytes in a text, `start..end`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Span {
    /// Offset of the first byte.
    pub start: u32,
    /// Offset after the last byte.
    pub end: u32,
}

impl Span {
    /// Returns a span from byte offsets. Offsets beyond 4 GiB are clamped, no text of that size is kept.
    #[inline]
    pub fn new(start: usize, end: usize) -> Self {
        let clamp = |offset: usize| u32::try_from(offset).unwrap_or(u32::MAX);
        Self {
            start: clamp(start),
            end: clamp(end.max(start)),
        }
    }

    /// Returns the part of `text` that the span covers, empty when it lies outside.
    pub fn of(self, text: &str) -> &str {
        text.get(self.range()).unwrap_or_default()
    }

    /// Returns the span as a range of indices.
    pub fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }

    /// Returns the smallest span that covers both.
    pub fn to(self, other: Self) -> Self {
        Self {
            start: self.start.min(other.start),
            end: self.end.max(other.end),
        }
    }

    /// Returns the span moved towards the end of the text by `offset` bytes.
    pub fn shifted(self, offset: u32) -> Self {
        Self {
            start: self.start.saturating_add(offset),
            end: self.end.saturating_add(offset),
        }
    }
}

/// A line and a column for people: both count from 1, columns count characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Position {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
}

impl Position {
    /// Returns the position after a text that begins here.
    pub(super) fn after(self, text: &str) -> Self {
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        // Many messages are about one long block.
        let breaks = count(memchr::memchr_iter(b'\n', text.as_bytes()).count());
        let line = memchr::memrchr(b'\n', text.as_bytes()).map_or(text, |at| &text[at + 1..]);
        let before = if breaks == 0 { self.column } else { 1 };
        Self {
            line: self.line.saturating_add(breaks),
            column: before.saturating_add(count(line.chars().count())),
        }
    }
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

/// Returns names as a sentence lists them: with commas, and `and` before the last one.
pub fn in_a_row<S: AsRef<str>>(names: &[S]) -> String {
    let mut row = String::new();
    for (at, name) in names.iter().enumerate() {
        let between = match at {
            0 => "",
            at if at + 1 == names.len() => " and ",
            _ => ", ",
        };
        row.push_str(between);
        row.push_str(name.as_ref());
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::Span;

    #[test]
    fn a_place_at_the_end_of_all_numbers_shows_itself() {
        let place = Place {
            file: "a.nc".into(),
            text: "a\nb\nc".into(),
            first_line: u32::MAX - 1,
            span: Span::new(4, 5),
        };
        assert_eq!(place.start().line, u32::MAX);
        assert_eq!(place.end().to_string(), format!("{}:2", u32::MAX));
    }

    #[test]
    fn starts_in_any_order_are_those_of_the_places() {
        let place = |text: &Arc<str>, start: usize| Place {
            file: "a.nc".into(),
            text: Arc::clone(text),
            first_line: 3,
            span: Span::new(start, start + 1),
        };
        let (text, other): (Arc<str>, Arc<str>) = ("Ä b\nc d\n\ne".into(), "X Y Z".into());
        let offsets = [0, 2, 2, 4, 5, 9, 5, 0, 99, 3];
        let places = offsets.map(|start| place(&text, start));
        let mixed = offsets
            .iter()
            .flat_map(|&start| [place(&text, start), place(&other, start)]);
        for places in [places.to_vec(), mixed.collect()] {
            let mut starts = StartsInOrder::default();
            for (place, next) in places.iter().zip(places.iter().skip(1)) {
                assert_eq!(starts.start(place), place.start());
                if next.span.start < 10 {
                    assert_eq!(place.cmp_start(next), place.start().cmp(&next.start()));
                }
            }
        }
    }

    #[test]
    fn paths_of_windows_have_one_kind_of_slash() {
        // R13.1
        for (path, shown) in [
            (r"programs\mill/a.nc", "programs/mill/a.nc"),
            (r"C:\CNC\a.nc", "C:/CNC/a.nc"),
            (r"\\server\share\a.nc", "//server/share/a.nc"),
            (r"\\?\C:\CNC\a.nc", "C:/CNC/a.nc"),
            (r"\\?\UNC\server\share\a.nc", "//server/share/a.nc"),
            ("a.nc", "a.nc"),
        ] {
            assert_eq!(slashed(path), shown);
        }
    }

    #[test]
    fn a_backslash_is_a_letter_where_it_does_not_part() {
        // R13.1
        let shown = if cfg!(windows) { "a/b.nc" } else { r"a\b.nc" };
        assert_eq!(shown_path(Path::new(r"a\b.nc")), shown);
    }
}
