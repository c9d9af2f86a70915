//! The position of a block, and the places in it that messages are about.

use std::cell::RefCell;
use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::interpreter::programs::unit::Parsed;
use crate::interpreter::values::externals::SetAt;
use crate::syntax::ast::Block;
use crate::syntax::{Comments, Fault, RawBlock, Remark};
use crate::text::{MAX_WHOLE, Place, Span};

/// The place of a block, and what is known about it apart from its tree.
pub(crate) struct BlockContext<'a> {
    pub(crate) block: &'a Block,
    pub(crate) file: &'a Arc<str>,
    pub(crate) text: &'a str,
    pub(crate) line: u32,
    pub(crate) comments: Comments,
    pub(crate) remark: Option<&'a Remark>,
    pub(crate) level: u32,
    pub(crate) called_from: Option<&'a Place>,
    /// Number of macros around the code.
    pub(crate) macro_depth: u32,
    /// Span of the use of the outermost of them in the block.
    pub(crate) used: Option<Span>,
    /// The lines of the text that messages showed last.
    pub(crate) shown: &'a ShownBlockLines,
}

/// The code of a macro in place of words.
pub(crate) struct MacroCode<'a> {
    pub(crate) text: &'a str,
    pub(crate) block: &'a Block,
    /// Number of macros around it, its own included.
    pub(crate) depth: u32,
}

/// The lines of a block that a message showed last. The next one often shows the same, and then
/// they are held once; a block of many lines is gone through once for all its messages (R2.85).
#[derive(Debug, Default)]
pub(crate) struct ShownBlockLines(RefCell<Option<LineSpan>>);

#[derive(Debug)]
struct LineSpan {
    /// Offset of their start in the block's text.
    from: usize,
    to: usize,
    /// The number of the first of them.
    number: u32,
    text: Arc<str>,
    /// The offsets of the first and the last line end between them.
    breaks: Option<(usize, usize)>,
}

impl ShownBlockLines {
    /// The place of a span: only the lines of the block that it touches.
    fn place(&self, at: &BlockContext<'_>, span: Span) -> Place {
        let text = at.text;
        let clamped = |offset: u32| {
            let offset = usize::try_from(offset).unwrap_or(usize::MAX);
            offset.min(text.len())
        };
        let (start, end) = (clamped(span.start), clamped(span.end.max(span.start)));
        let mut last = self.0.borrow_mut();
        let held = last.as_ref().filter(|lines| lines.show(start, end));
        let lines = if let Some(held) = held {
            held
        } else {
            let bytes = text.as_bytes();
            let from = memchr::memrchr(b'\n', &bytes[..start]).map_or(0, |at| at + 1);
            let to = memchr::memchr(b'\n', &bytes[end..]).map_or(text.len(), |at| end + at);
            // Messages mostly come from left to right: what was counted is not counted again.
            let (counted, number) = match last.as_ref() {
                Some(lines) if lines.from <= from => (lines.from, lines.number),
                _ => (0, at.line),
            };
            let breaks = memchr::memchr_iter(b'\n', &bytes[counted..from]).count();
            last.insert(LineSpan {
                from,
                to,
                number: number.saturating_add(u32::try_from(breaks).unwrap_or(u32::MAX)),
                text: text.get(from..to).unwrap_or(text).into(),
                breaks: memchr::memchr(b'\n', &bytes[from..to])
                    .zip(memchr::memrchr(b'\n', &bytes[from..to]))
                    .map(|(first, last)| (from + first, from + last)),
            })
        };
        Place {
            file: at.file.clone(),
            text: lines.text.clone(),
            first_line: lines.number,
            span: Span::new(start - lines.from, end - lines.from),
        }
    }
}

impl LineSpan {
    /// Whether the text between two offsets is shown with these lines.
    fn show(&self, start: usize, end: usize) -> bool {
        let is_within = self.from <= start && start <= self.to && end <= self.to;
        let touches_all = || {
            self.breaks
                .is_none_or(|(first, last)| start <= first && last < end)
        };
        is_within && (self.text.len() <= MAX_WHOLE || touches_all())
    }
}

impl<'a> BlockContext<'a> {
    /// The block as one that sets a variable.
    pub(crate) fn as_setter(&self) -> SetAt {
        SetAt {
            file: self.file.clone(),
            line: self.line,
        }
    }

    /// A block of the main program, or one that is inspected, not executed.
    #[inline]
    pub(crate) fn of_raw(
        file: &'a Arc<str>,
        raw: &RawBlock<'a>,
        block: &'a Block,
        shown: &'a ShownBlockLines,
    ) -> Self {
        Self {
            block,
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

    /// A block of the program that runs on a level of the call stack.
    pub(crate) fn of_parsed(parsed: &'a Parsed, level: u32, shown: &'a ShownBlockLines) -> Self {
        Self {
            block: &parsed.block,
            file: &parsed.file,
            text: &parsed.text,
            line: parsed.line,
            comments: parsed.comments,
            remark: parsed.remark.as_ref(),
            level,
            called_from: None,
            macro_depth: 0,
            used: None,
            shown,
        }
    }

    /// The same block of a program that was called from a place.
    pub(crate) fn with_caller(self, called_from: Option<&'a Place>) -> Self {
        Self {
            called_from,
            ..self
        }
    }

    /// Another block of the same program.
    pub(crate) fn other(&self, parsed: &'a Parsed, shown: &'a ShownBlockLines) -> Self {
        Self {
            block: &parsed.block,
            text: &parsed.text,
            line: parsed.line,
            shown,
            ..*self
        }
    }

    /// The code of a macro that is used at a span of this block or macro.
    pub(crate) fn in_macro(
        &self,
        code: &MacroCode<'a>,
        used: Span,
        shown: &'a ShownBlockLines,
    ) -> Self {
        Self {
            block: code.block,
            text: code.text,
            macro_depth: code.depth,
            used: self.used.or(Some(used)),
            shown,
            ..*self
        }
    }
}

impl BlockContext<'_> {
    /// The span in the block of a span here, for messages once the whole block is known.
    pub(crate) fn in_block(&self, span: Span) -> Span {
        self.used.unwrap_or(span)
    }

    pub(crate) fn place(&self, span: Span) -> Place {
        self.shown.place(self, span)
    }

    pub(crate) fn diagnostic(&self, fault: Fault) -> Diagnostic {
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
    use crate::syntax::{BlockReader, FastPath};
    use crate::text::TextLines;

    #[test]
    fn a_place_holds_the_lines_it_touches_and_shares_them() {
        // R2.85
        let (file, shown) = (Arc::from("a.nc"), ShownBlockLines::default());
        let text = "V.P.T[3] = [1,\\\n2, x,\\\n3, y]";
        let mut block = Block::default();
        let mut reader = BlockReader::new(TextLines::new(text), 7, FastPath::On);
        let raw = reader.next(&mut block).expect("a block");
        let at = BlockContext::of_raw(&file, &raw, &block, &shown);
        let place = |start, end| at.place(Span::new(start, end));
        let (first, second, third) = (place(19, 20), place(16, 17), place(26, 27));
        assert_eq!((&*first.text, first.first_line), ("2, x,\\", 8));
        assert_eq!(first.start().to_string(), "8:4");
        assert!(Arc::ptr_eq(&first.text, &second.text));
        assert_eq!((&*third.text, third.start().line), ("3, y]", 9));
        let back = place(0, 20);
        assert_eq!((back.first_line, &*back.text), (7, &text[..22]));
    }
}
