//! Colour for text that is printed as a whole.

use std::fmt::Write;

use anstyle::{AnsiColor, Style};

use frictcomp_report::{Look, Paint};

/// Returns a text whose lines have the styles that `style` returns.
pub(crate) fn painted(text: &str, look: Look, style: fn(&str) -> Style) -> String {
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

/// Returns the style of a line of a difference: added, removed, or a position.
pub(crate) fn difference(line: &str) -> Style {
    match line.as_bytes().first() {
        Some(b'+') => AnsiColor::Green.on_default(),
        Some(b'-') => AnsiColor::Red.on_default(),
        Some(b'@') => AnsiColor::Cyan.on_default(),
        _ => Style::new(),
    }
}

/// Returns the style of a line of a page: titles stand out.
pub(crate) fn page(line: &str) -> Style {
    if line.starts_with('#') {
        Style::new().bold()
    } else {
        Style::new()
    }
}

/// Returns the style of a line that begins a section: one without an indent.
pub(crate) fn parts(line: &str) -> Style {
    if line.starts_with(' ') || line.is_empty() {
        Style::new()
    } else {
        Style::new().bold()
    }
}

/// Returns the style of severities in a table.
pub(crate) fn severities(line: &str) -> Style {
    let holds = |word: &str| line.split_whitespace().any(|it| it == word);
    if holds("error") {
        AnsiColor::Red.on_default()
    } else if holds("warning") {
        AnsiColor::Yellow.on_default()
    } else {
        Style::new()
    }
}
