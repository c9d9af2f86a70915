//! One diagnostic with its source line and carets, in the manner of rustc.

use std::borrow::Cow;
use std::ops::Range;

use annotate_snippets::{Annotation, AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use unicode_width::UnicodeWidthStr;

use frictcomp::diagnostic::{Diagnostic, Label, Severity};
use frictcomp::text::Place;

use super::visible::{is_command, visible, visible_line};

/// The width of text if neither the user nor a terminal nor `COLUMNS` sets one (R9.72).
pub const FALLBACK_WIDTH: usize = 100;

/// The width of agreed timelines, which is the same for every user.
const AGREED_WIDTH: usize = 80;

/// Colours of text output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Paint {
    /// Output without colours.
    #[default]
    Plain,
    /// Output with ANSI sequences.
    Styled,
}

/// Extent of text output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Detail {
    /// The verdict, the findings and the tables.
    #[default]
    Brief,
    /// Conditions, readings, methods and totals, too (R18.20, R18.21).
    Full,
}

impl Detail {
    /// Returns a text that is shown in full detail only.
    pub(crate) fn full<T>(self, text: T) -> Option<T> {
        (self == Self::Full).then_some(text)
    }
}

/// Appearance of text output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Look {
    /// Colours.
    pub paint: Paint,
    /// Columns that may be used.
    pub width: usize,
    /// Extent.
    pub detail: Detail,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            paint: Paint::Plain,
            width: AGREED_WIDTH,
            detail: Detail::Brief,
        }
    }
}

/// Renders a diagnostic, with a line end after its last line.
pub fn render(diagnostic: &Diagnostic, look: Look) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Info => Level::INFO,
    };
    let title = level
        .primary_title(wrap(
            &diagnostic.message,
            look.width,
            title_indent(diagnostic),
        ))
        .id(diagnostic.code.as_str());
    let mut group = Group::with_title(title);
    let (inside, outside): (Vec<_>, Vec<_>) = diagnostic
        .labels
        .iter()
        .partition(|label| shares_lines(&label.place, &diagnostic.place));
    group = element(group, &diagnostic.place, |shown| {
        let mut annotations = vec![AnnotationKind::Primary.span(shown.span(&diagnostic.place))];
        annotations.extend(inside.iter().map(|label| annotate(shown, label)));
        annotations
    });
    for label in outside {
        group = element(group, &label.place, |shown| vec![annotate(shown, label)]);
    }
    if !diagnostic.reached_from.is_empty() {
        let reached = diagnostic.reached_from.to_string();
        group = group.element(Level::NOTE.message(wrap(&reached, look.width, HELP_INDENT)));
    }
    for advice in &diagnostic.advice {
        group =
            group.element(Level::HELP.message(wrap(&advice.to_string(), look.width, HELP_INDENT)));
    }
    let renderer = match look.paint {
        Paint::Plain => Renderer::plain(),
        Paint::Styled => Renderer::styled(),
    };
    let mut text = renderer.term_width(look.width).render(&[group]);
    text.push('\n');
    text
}

/// Columns before the text of a help line, with a line number of up to four digits.
const HELP_INDENT: usize = 13;

/// Columns before the message: `error[P-ERR-70495]: `.
fn title_indent(diagnostic: &Diagnostic) -> usize {
    diagnostic.severity.as_str().len() + diagnostic.code.as_str().len() + 4
}

/// Breaks a text between words so that it fits after an indent; the renderer aligns the lines.
pub fn wrap(text: &str, width: usize, indent: usize) -> String {
    let room = width.saturating_sub(indent).max(12);
    let mut wrapped = String::with_capacity(text.len() + 8);
    let mut column = 0;
    let text = visible_line(text);
    for (count, word) in text.split(' ').enumerate() {
        // A visible character of ASCII is a column.
        let columns = if word.is_ascii() {
            word.len()
        } else {
            word.width()
        };
        if count > 0 && column + 1 + columns > room && !is_command(word) {
            wrapped.push('\n');
            column = 0;
        } else if count > 0 {
            wrapped.push(' ');
            column += 1;
        }
        wrapped.push_str(word);
        column += columns;
    }
    wrapped
}

/// Breaks lines that are wider than a width between words; the continuation is indented.
pub fn fitted(text: &str, width: usize) -> String {
    let mut out = String::with_capacity(text.len() + 64);
    for line in text.split_inclusive('\n') {
        let bare = line.trim_end_matches('\n');
        if bare.width() <= width {
            out.push_str(line);
            continue;
        }
        let indent = bare.len() - bare.trim_start_matches(' ').len();
        let mut column = indent;
        out.push_str(&bare[..indent]);
        for (at, word) in bare[indent..].split(' ').enumerate() {
            let columns = word.width();
            if column + 1 + columns > width && column > indent + 2 && columns > 0 {
                out.truncate(out.trim_end_matches(' ').len());
                out.push('\n');
                out.extend(std::iter::repeat_n(' ', indent + 2));
                column = indent + 2;
            } else if at > 0 {
                out.push(' ');
                column += 1;
            }
            out.push_str(word);
            column += columns;
        }
        out.push_str(&line[bare.len()..]);
    }
    out
}

/// The part of a place's text that is passed to the renderer: all of it, unless a line is so long
/// that only the surroundings of the span make sense. Hidden characters have pictures.
struct ShownText<'a> {
    text: Cow<'a, str>,
    /// The part of the place's text that is shown, without pictures.
    part: &'a str,
    /// Number of bytes left out at the start of the place's text.
    skipped: usize,
    /// Mark in the shown text for the part left out.
    mark: &'static str,
}

impl ShownText<'_> {
    fn span(&self, place: &Place) -> Range<usize> {
        let shift = |offset: u32| {
            let offset = usize::try_from(offset).unwrap_or(usize::MAX);
            let before = floor(self.part, offset.saturating_sub(self.skipped));
            self.mark.len() + visible(&self.part[..before]).len()
        };
        let start = shift(place.span.start);
        start..shift(place.span.end).max(start)
    }
}

/// Number of characters of a long line shown on either side of the span.
const SURROUNDINGS: usize = 160;

fn shown(place: &Place) -> ShownText<'_> {
    let text = &*place.text;
    if text.contains('\n') || text.len() <= 4 * SURROUNDINGS {
        return ShownText {
            text: visible(text),
            part: text,
            skipped: 0,
            mark: "",
        };
    }
    let at = |offset: u32| floor(text, usize::try_from(offset).unwrap_or(usize::MAX));
    let first = at(place.span.start);
    let last = at(place.span.end).min(floor(text, first + SURROUNDINGS));
    let start = floor(text, first.saturating_sub(SURROUNDINGS));
    let end = floor(text, last.max(first) + SURROUNDINGS);
    let before = if start > 0 { "…" } else { "" };
    let after = if end < text.len() { "…" } else { "" };
    let part = &text[start..end];
    ShownText {
        text: Cow::Owned(format!("{before}{}{after}", visible(part))),
        part,
        skipped: start,
        mark: before,
    }
}

/// Returns the nearest character boundary at or before an offset.
fn floor(text: &str, offset: usize) -> usize {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

fn element<'a>(
    group: Group<'a>,
    place: &'a Place,
    annotations: impl FnOnce(&ShownText<'a>) -> Vec<Annotation<'a>>,
) -> Group<'a> {
    if place.text.is_empty() {
        return group.element(Origin::path(visible_line(&place.file)));
    }
    if place.text.trim().is_empty() {
        // There is no text to show, or none that may be shown.
        let start = place.start();
        let at = |number: u32| usize::try_from(number).unwrap_or(usize::MAX);
        let origin = Origin::path(&*place.file).line(at(start.line));
        return group.element(origin.char_column(at(start.column)));
    }
    let shown = shown(place);
    let annotations = annotations(&shown);
    group.element(
        Snippet::source(shown.text)
            .line_start(usize::try_from(place.first_line).unwrap_or(usize::MAX))
            .path(visible_line(&place.file))
            .annotations(annotations),
    )
}

fn annotate<'a>(shown: &ShownText<'_>, label: &'a Label) -> Annotation<'a> {
    AnnotationKind::Context
        .span(shown.span(&label.place))
        .label(visible_line(&label.text))
}

fn shares_lines(one: &Place, other: &Place) -> bool {
    one.file == other.file && one.first_line == other.first_line && one.text == other.text
}

#[cfg(test)]
mod tests {
    use super::*;
    use frictcomp::diagnostic::Code;
    use frictcomp::text::{SourceFile, Span};

    fn at(text: &str, meant: &str) -> Diagnostic {
        let file = SourceFile::new("a.nc", text);
        let start = text.find(meant).expect("the text holds it");
        let place = file.place(Span::new(start, start + meant.len()));
        Diagnostic::new(Code::PErr70495, place, "not configured").with_help("use `--enable X`")
    }

    #[test]
    fn carets_stand_under_what_is_meant() {
        // R9.21
        let text = render(
            &at("G0\nN15 X[COMP ON FRICT] ;on", "X[COMP ON FRICT]"),
            Look::default(),
        );
        assert_eq!(
            text,
            "\
error[P-ERR-70495]: not configured
 --> a.nc:2:5
  |
2 | N15 X[COMP ON FRICT] ;on
  |     ^^^^^^^^^^^^^^^^
  |
  = help: use `--enable X`
"
        );
    }

    #[test]
    fn tabs_and_wide_characters_keep_the_carets_in_place() {
        let text = render(&at("\t(軸) X[COMP ON]", "X[COMP ON]"), Look::default());
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[3], "1 |     (軸) X[COMP ON]");
        assert_eq!(lines[4], "  |          ^^^^^^^^^^");
    }

    #[test]
    fn no_control_character_reaches_the_terminal() {
        let line = "(\u{9b}31m\u{1b}[31m\u{7f}\u{85}) X[COMP ON]";
        let mut diagnostic = at(line, "X[COMP ON]").with_help("\u{9b}31m");
        diagnostic.message = "\u{9b}31m\u{1b}[31m".to_owned();
        for paint in [Paint::Plain, Paint::Styled] {
            let text = render(
                &diagnostic,
                Look {
                    paint,
                    ..Look::default()
                },
            );
            let c1 = text.contains(|letter: char| ('\u{80}'..='\u{9f}').contains(&letter));
            assert!(!c1 && !text.contains("\u{1b}[31m"), "{text:?}");
        }
        let text = render(&diagnostic, Look::default());
        let lines: Vec<&str> = text.lines().collect();
        let column = |line: &str, part: &str| line[..line.find(part).unwrap()].chars().count();
        assert_eq!(column(lines[3], "X["), column(lines[4], "^"), "{text}");
    }

    #[test]
    fn a_long_line_is_trimmed_around_the_span() {
        let line = format!("{}X[COMP ON]{}", "Ü ".repeat(1000), " Y1".repeat(700));
        let text = render(&at(&line, "X[COMP ON]"), Look::default());
        assert!(text.contains("X[COMP ON]"), "{text}");
        assert!(
            text.lines().all(|line| line.chars().count() <= 80),
            "{text}"
        );
        assert!(text.contains("a.nc:1:"), "{text}");
        let lines: Vec<&str> = text.lines().collect();
        let column = |line: &str, part: &str| line[..line.find(part).unwrap()].chars().count();
        assert_eq!(column(lines[3], "X["), column(lines[4], "^"), "{text}");
    }

    #[test]
    fn a_long_span_of_a_long_line_stays_readable() {
        let line = "X1 ".repeat(1300);
        let text = render(&at(&line, &line), Look::default());
        assert!(text.len() < 2000, "{text}");
    }

    #[test]
    fn an_empty_text_and_an_empty_span_are_no_trouble() {
        let mut diagnostic = at("X[COMP", "X[COMP");
        diagnostic.place.span = Span::new(6, 6);
        assert!(render(&diagnostic, Look::default()).contains("1 | X[COMP\n  |       ^"));
        diagnostic.place.text = "".into();
        diagnostic.place.span = Span::new(0, 0);
        assert!(render(&diagnostic, Look::default()).contains("--> a.nc"));
        diagnostic.place.span = Span::new(7, 9);
        assert!(render(&diagnostic, Look::default()).contains("--> a.nc"));
    }

    #[test]
    fn labels_explain_from_their_own_lines() {
        let file = SourceFile::new("a.nc", "N1 X[COMP OFF FRICT]\nN2 M30");
        let near = file.place(Span::new(0, 2));
        let diagnostic =
            at("N1 X[COMP OFF FRICT]\nN2 M30", "M30").with_label(near, "switched off here");
        let text = render(&diagnostic, Look::default());
        assert!(text.contains("-- switched off here"), "{text}");
        assert!(text.contains("2 | N2 M30"), "{text}");
    }
}
