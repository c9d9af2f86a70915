//! FC326: a program that is plainly one of another control (R2.97).

use crate::diagnostic::{Code, Diagnostic};
use crate::syntax::{Foreign, foreign};
use crate::text::{Place, Span, lines_of};

/// Number of messages about such a file: this one and 20 others.
pub(super) const MAX_SAID: usize = 21;

/// Looks at the head of a program.
pub(super) fn look(file: &str, head: &str) -> Option<Diagnostic> {
    let found = foreign(head)?;
    let mut lines = lines_of(head).zip(1..);
    let (line, number) = lines.find(|(line, _)| !line.trim().is_empty())?;
    let place = Place {
        file: file.into(),
        text: line.trim_end().into(),
        first_line: number,
        span: Span::new(0, line.trim_end().len()),
    };
    let Foreign {
        dialect,
        words,
        blocks,
        of,
    } = found;
    let words = words.join("`, `");
    let message = format!(
        "this is a program for {dialect}, not for an ISG control: {blocks} of the first {of} blocks have words such as `{words}`"
    );
    let help = "its other messages are meaningless; leave the program out, or translate it";
    Some(Diagnostic::new(Code::Fc326, place, message).with_help(help))
}
