//! Where a block stands, and the places in it that messages are about.

use std::cell::RefCell;
use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::syntax::{Comments, Fault, RawBlock, Remark};
use crate::text::{Place, Span};

/// The place of a block, and what is known about it besides its tree.
pub(super) struct At<'a> {
    pub(super) file: &'a Arc<str>,
    pub(super) text: &'a str,
    pub(super) line: u32,
    pub(super) comments: Comments,
    pub(super) remark: Option<&'a Remark>,
    pub(super) level: u32,
    pub(super) called_from: Option<&'a Place>,
    /// How many macros lie around the code.
    pub(super) macro_depth: u32,
    /// Where the outermost of them is used in the block.
    pub(super) used: Option<Span>,
    /// The lines of the text that messages showed last.
    pub(super) shown: &'a Shown,
}

/// The lines of a block that a message showed last. The next one often shows the same, and then
/// they are held once; a block of many lines is gone through once for all its messages (R2.85).
#[derive(Debug, Default)]
pub(super) struct Shown(RefCell<Option<Lines>>);

#[derive(Debug)]
struct Lines {
    /// Where they start in the block's text.
    from: usize,
    to: usize,
    /// The number of the first of them.
    number: u32,
    text: Arc<str>,
}

impl Shown {
    /// The place of a span: the lines that it touches, no more of the block.
    fn place(&self, file: &Arc<str>, (text, first_line): (&str, u32), span: Span) -> Place {
        let clamped = |offset: u32| {
            let offset = usize::try_from(offset).unwrap_or(usize::MAX);
            offset.min(text.len())
        };
        let (start, end) = (clamped(span.start), clamped(span.end.max(span.start)));
        let mut last = self.0.borrow_mut();
        let held = last
            .as_ref()
            .filter(|lines| lines.from <= start && start <= lines.to && end <= lines.to);
        let lines = if let Some(held) = held {
            held
        } else {
            let bytes = text.as_bytes();
            let from = memchr::memrchr(b'\n', &bytes[..start]).map_or(0, |at| at + 1);
            let to = memchr::memchr(b'\n', &bytes[end..]).map_or(text.len(), |at| end + at);
            // Messages mostly come from left to right: what was counted is not counted again.
            let (counted, number) = match last.as_ref() {
                Some(lines) if lines.from <= from => (lines.from, lines.number),
                _ => (0, first_line),
            };
            let breaks = memchr::memchr_iter(b'\n', &bytes[counted..from]).count();
            last.insert(Lines {
                from,
                to,
                number: number.saturating_add(u32::try_from(breaks).unwrap_or(u32::MAX)),
                text: text.get(from..to).unwrap_or(text).into(),
            })
        };
        Place {
            file: file.clone(),
            text: lines.text.clone(),
            first_line: lines.number,
            span: Span::new(start - lines.from, end - lines.from),
        }
    }
}

impl<'a> At<'a> {
    /// A block that is looked at and not executed.
    pub(super) fn of_text(
        file: &'a Arc<str>,
        (text, line): (&'a str, u32),
        shown: &'a Shown,
    ) -> Self {
        Self {
            file,
            text,
            line,
            comments: Comments::Possible,
            remark: None,
            level: 0,
            called_from: None,
            macro_depth: 0,
            used: None,
            shown,
        }
    }

    /// A block of the main program.
    #[inline]
    pub(super) fn in_main_program(
        file: &'a Arc<str>,
        raw: &RawBlock<'a>,
        shown: &'a Shown,
    ) -> Self {
        Self {
            file,
            text: raw.text,
            line: raw.line,
            comments: raw.comments,
            remark: raw.remark,
            level: 0,
            called_from: None,
            macro_depth: 0,
            used: None,
            shown,
        }
    }
}

impl At<'_> {
    /// The span in the block of what stands here, for what is said when the whole block is known.
    pub(super) fn in_block(&self, span: Span) -> Span {
        self.used.unwrap_or(span)
    }

    pub(super) fn place(&self, span: Span) -> Place {
        self.shown.place(self.file, (self.text, self.line), span)
    }

    pub(super) fn diagnostic(&self, fault: Fault) -> Diagnostic {
        let place = self.place(fault.span);
        // The code of a macro is not the text of the program.
        let in_text = |span| self.used.is_none().then(|| self.place(span));
        let mut diagnostic = fault.into_diagnostic(place, in_text);
        if let Some(caller) = self.called_from {
            diagnostic = diagnostic.with_label(caller.clone(), "called from here");
        }
        diagnostic
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_holds_the_lines_it_touches_and_shares_them() {
        // R2.85
        let (file, shown) = (Arc::from("a.nc"), Shown::default());
        let text = "V.P.T[3] = [1,\\\n2, x,\\\n3, y]";
        let place = |start, end| shown.place(&file, (text, 7), Span::new(start, end));
        let (first, second, third) = (place(19, 20), place(16, 17), place(26, 27));
        assert_eq!((&*first.text, first.first_line), ("2, x,\\", 8));
        assert_eq!(first.start().to_string(), "8:4");
        assert!(Arc::ptr_eq(&first.text, &second.text));
        assert_eq!((&*third.text, third.start().line), ("3, y]", 9));
        let back = place(0, 20);
        assert_eq!((back.first_line, &*back.text), (7, &text[..22]));
    }
}
