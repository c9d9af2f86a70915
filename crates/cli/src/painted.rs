//! Colour for text that is printed as a whole.

use std::fmt::Write;

use anstyle::{AnsiColor, Style};

use frictcomp_report::{Look, Paint};

/// A text whose lines have the styles that `style` gives them.
pub(super) fn painted(text: &str, look: Look, style: fn(&str) -> Style) -> String {
    if look.paint == Paint::Plain {
        return text.to_owned();
    }
    let mut painted = String::with_capacity(text.len() * 2);
    for line in text.lines() {
        let style = style(line);
        let _ = writeln!(painted, "{style}{line}{style:#}");
    }
    painted
}

/// Returns the style of a line of a difference: added, removed, or its place.
pub(super) fn difference(line: &str) -> Style {
    match line.as_bytes().first() {
        Some(b'+') => AnsiColor::Green.on_default(),
        Some(b'-') => AnsiColor::Red.on_default(),
        Some(b'@') => AnsiColor::Cyan.on_default(),
        _ => Style::new(),
    }
}

/// Titles of a page.
pub(super) fn page(line: &str) -> Style {
    if line.starts_with('#') {
        Style::new().bold()
    } else {
        Style::new()
    }
}

/// Lines that begin a part: those without an indent.
pub(super) fn parts(line: &str) -> Style {
    if line.starts_with(' ') || line.is_empty() {
        Style::new()
    } else {
        Style::new().bold()
    }
}

/// Severities in a table.
pub(super) fn severities(line: &str) -> Style {
    let holds = |word: &str| line.split_whitespace().any(|it| it == word);
    if holds("error") {
        AnsiColor::Red.on_default()
    } else if holds("warning") {
        AnsiColor::Yellow.on_default()
    } else {
        Style::new()
    }
}
