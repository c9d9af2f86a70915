//! The place in `frictcomp.toml` for one more axis.

use super::section::Section;
use crate::diagnostic::NamedFix;
use crate::text::Span;

/// A replacement in the file, with the text around the name of the axis.
struct Replacement {
    span: Span,
    before: String,
    after: &'static str,
}

/// Returns the change that adds an axis to the file, in the form in which the file lists the others. `None` if it lists
/// none: the first listed axis would end the assumption made without a list (R2.20).
pub(super) fn one_more_axis(root: &Section<'_>) -> Option<NamedFix> {
    let (source, last) = (root.source(), root.extent_of_last("axis")?);
    let text = source.text();
    let change = if last.of(text).starts_with('{') {
        let array = root.given("axis")?;
        in_array(text, last, array.span())
    } else {
        after_table(text, last)
    };
    Some(NamedFix {
        place: source.place(change.span),
        before: change.before,
        after: change.after.to_owned(),
    })
}

/// Places a table `[[axis]]` after the last one and after the comments that close it: those followed by an empty line
/// or the end of the file.
fn after_table(text: &str, last: Span) -> Replacement {
    let line_end = |from: usize| from + text[from..].lines().next().unwrap_or_default().len();
    let table_end = line_end(last.end as usize);
    let (mut end, mut comments_end) = (table_end, table_end);
    loop {
        let Some(below) = text[comments_end..].find('\n') else {
            end = comments_end;
            break;
        };
        let start = comments_end + below + 1;
        let line = text[start..line_end(start)].trim();
        if line.is_empty() {
            end = comments_end;
        }
        if !line.starts_with('#') {
            break;
        }
        comments_end = line_end(start);
    }
    Replacement {
        span: Span::new(end, end),
        before: "\n\n[[axis]]\nname = \"".to_owned(),
        after: "\"",
    }
}

/// Places an entry `{ name = "X" }` after the last one of an array: on the same line, or below it if the array spans
/// lines.
fn in_array(text: &str, last: Span, array: Span) -> Replacement {
    let (start, end) = (last.start as usize, last.end as usize);
    let gap = &text[end..array.end as usize - 1];
    let Some(line_end) = gap.find('\n') else {
        return Replacement {
            span: Span::new(end, end),
            before: ", { name = \"".to_owned(),
            after: "\" }",
        };
    };
    let rest = gap[..line_end].trim_end_matches('\r');
    let (comma, after) = if rest.trim_start().starts_with(',') {
        ("", "\" },")
    } else {
        (",", "\" }")
    };
    let line = &text[text[..start].rfind('\n').map_or(0, |at| at + 1)..start];
    let indent = &line[..line.len() - line.trim_start().len()];
    Replacement {
        span: Span::new(end, end + rest.len()),
        before: format!("{comma}{rest}\n{indent}{{ name = \""),
        after,
    }
}
