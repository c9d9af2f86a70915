//! One line of text output: columns by position, colours, no blanks at its end.

use std::fmt::Write as _;

use anstyle::{AnsiColor, Style};
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use crate::wording::{Look, Paint, is_command, visible, visible_line};
use frictcomp::comp::State;

/// Columns of the line number with the gap after it.
pub(super) const GUTTER: usize = 8;

/// The mark after a state that the block changed.
pub(super) const MARK: char = '◄';

pub(super) const BOLD: Style = Style::new().bold();
pub(super) const DIM: Style = Style::new().dimmed();

/// A line that is being written.
pub(super) struct TextLine<'a> {
    out: &'a mut Vec<u8>,
    paint: Paint,
    column: usize,
}

impl<'a> TextLine<'a> {
    pub(super) fn new(out: &'a mut Vec<u8>, paint: Paint) -> Self {
        Self {
            out,
            paint,
            column: 0,
        }
    }

    /// Fills with blanks up to a column; with at least one if the text has passed it.
    pub(super) fn go_to(&mut self, column: usize) {
        let blanks = column.checked_sub(self.column).unwrap_or(1);
        self.out.resize(self.out.len() + blanks, b' ');
        self.column += blanks;
    }

    /// Returns the column of the next text.
    pub(super) fn column(&self) -> usize {
        self.column
    }

    /// Continues on a new line, after an indent.
    pub(super) fn next(&mut self, indent: usize) {
        self.trim();
        self.out.push(b'\n');
        self.column = 0;
        self.go_to(indent);
    }

    /// Appends text without a style.
    pub(super) fn plain(&mut self, text: &str) {
        let text = &*visible_line(text);
        self.out.extend_from_slice(text.as_bytes());
        self.column += text.width();
    }

    /// Appends text with a style.
    pub(super) fn styled(&mut self, style: Style, text: &str) {
        let text = &*visible_line(text);
        match self.paint {
            Paint::Plain => self.out.extend_from_slice(text.as_bytes()),
            Paint::Styled => {
                let mut painted = String::new();
                let _ = write!(painted, "{style}{text}{style:#}");
                self.out.extend_from_slice(painted.as_bytes());
            }
        }
        self.column += text.width();
    }

    /// Appends a source text on one line, cut to a width.
    pub(super) fn source(&mut self, text: &str, width: usize) {
        let mut left = width;
        let mut cut = Cut {
            length: self.out.len(),
            column: self.column,
        };
        let mut buffer = [0; 4];
        let mut blank = false;
        for letter in visible(text.trim_end()).chars() {
            let shown = match letter {
                '\n' | '\r' | '\t' | ' ' if blank && letter != ' ' => continue,
                '\n' | '\r' | '\t' => ' ',
                letter => letter,
            };
            blank = shown == ' ';
            let columns = shown.width().unwrap_or(0);
            if columns > left {
                self.out.truncate(cut.length);
                self.column = cut.column;
                self.plain("…");
                return;
            }
            self.out
                .extend_from_slice(shown.encode_utf8(&mut buffer).as_bytes());
            self.column += columns;
            left -= columns;
            if left >= 1 {
                cut = Cut {
                    length: self.out.len(),
                    column: self.column,
                };
            }
        }
    }

    /// Ends the line.
    pub(super) fn end(mut self) {
        self.trim();
        self.out.push(b'\n');
    }

    fn trim(&mut self) {
        while self.out.last() == Some(&b' ') {
            self.out.pop();
        }
    }
}

/// The last place of a line that leaves room for `…`.
struct Cut {
    length: usize,
    column: usize,
}

/// A text that takes as many lines as it needs within a width, all after an indent.
pub(super) struct Paragraph<'a> {
    indent: usize,
    style: Style,
    text: &'a str,
}

impl<'a> Paragraph<'a> {
    /// Returns a text in a style, without an indent.
    pub(super) fn new(style: Style, text: &'a str) -> Self {
        Self {
            indent: 0,
            style,
            text,
        }
    }

    /// Sets an indent.
    pub(super) fn indented(self, indent: usize) -> Self {
        Self { indent, ..self }
    }

    /// Writes the lines.
    pub(super) fn write(&self, out: &mut Vec<u8>, look: Look) {
        let room = look.width.saturating_sub(self.indent).max(1);
        let mut line = String::new();
        let mut lines = Vec::new();
        for word in visible_line(self.text).split(' ') {
            if !line.is_empty() && line.width() + 1 + word.width() > room && !is_command(word) {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        lines.push(line);
        for text in lines {
            let mut line = TextLine::new(out, look.paint);
            if self.indent > 0 {
                line.go_to(self.indent);
            }
            line.styled(self.style, &text);
            line.end();
        }
    }
}

/// Returns the colour of a state.
pub(super) fn style(state: State) -> Style {
    match state {
        State::Active => AnsiColor::Green.on_default(),
        State::Inactive => AnsiColor::Yellow.on_default(),
        State::Ineffective => AnsiColor::Magenta.on_default(),
        State::Unknown => AnsiColor::Cyan.on_default(),
        State::Unconfigured => DIM,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str, width: usize) -> String {
        let mut out = Vec::new();
        TextLine::new(&mut out, Paint::Plain).source(text, width);
        String::from_utf8(out).expect("whole characters")
    }

    #[test]
    fn a_text_is_cut_to_its_width() {
        assert_eq!(source("N10 X1", 6), "N10 X1");
        assert_eq!(source("N10 X12", 6), "N10 X…");
        assert_eq!(source("軸軸軸", 5), "軸軸…");
        assert_eq!(source("軸軸軸", 6), "軸軸軸");
        assert_eq!(source("軸軸軸", 4), "軸…");
        assert_eq!(
            source("X[COMP ON \\\n  FRICT]", 30),
            "X[COMP ON \\   FRICT]"
        );
        assert_eq!(source("A\tB\u{7}", 30), "A B\u{2407}");
        assert_eq!(source("A\u{9b}B", 30), "A\u{27e8}U+009B\u{27e9}B");
    }
}
