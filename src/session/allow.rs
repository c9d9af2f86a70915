//! The comment that allows a message where it is reported (R9.24, R12.5).

use crate::diagnostic::{Code, Diagnostic, Fix};
use crate::syntax::{MAX_LINE, allow, goes_on};
use crate::text::{SourceFile, Span};

/// The change of a program that silences a message of it: a comment in its block, or above a block
/// of several lines or one that would have more than 4000 characters. `None` for what cannot be silenced, the numbers of the control, budgets,
/// messages about such comments, about `%` lines, about files as a whole and about comments that hide what follows them,
/// and for a message whose lines are not those of the file.
pub fn allow_here(said: &Diagnostic, program: &SourceFile) -> Option<Fix> {
    let is_comment = matches!(said.code, Code::Fc414 | Code::Fc490 | Code::Fc491);
    let is_of_file = matches!(said.code, Code::Fc103 | Code::Fc104 | Code::Fc105);
    if said.code.is_controller() || said.code.is_budget() || is_comment || is_of_file {
        return None;
    }
    let (text, lines) = (program.text(), program.lines());
    let meant = program.find(&said.place)?;
    let of = |line: u32| lines.line_span(text, line);
    let goes_on = |line: u32| goes_on(of(line).of(text));
    let last = lines
        .first()
        .saturating_add(u32::try_from(lines.lines()).ok()?)
        - 1;
    let (mut first, mut end) = (lines.line(meant.start), lines.line(meant.end));
    while first > lines.first() && goes_on(first - 1) {
        first -= 1;
    }
    while end < last && goes_on(end) {
        end += 1;
    }
    if of(first).of(text).trim_start().starts_with('%') {
        return None;
    }
    let block = of(first).of(text);
    let inside = (first == end).then(|| allow::insertion(block, said.code));
    let inside = inside.filter(|(_, comment)| block.len() + comment.len() <= MAX_LINE);
    let (offset, comment) = inside.unwrap_or_else(|| (0, allow::line_above(said.code)));
    let at = of(first).start as usize + offset;
    Some(Fix::safe(program.place(Span::new(at, at)), comment))
}
