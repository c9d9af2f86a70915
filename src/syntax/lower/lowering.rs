//! A block being lowered from pairs to its tree, and what its parts have in common.

use pest::iterators::Pair;

use crate::diagnostic::Code;
use crate::syntax::ast::{Assignment, Block, Effect, Item, Target};
use crate::syntax::fault::Fault;
use crate::syntax::grammar::Rule;
use crate::syntax::pieces::is_blank;
use crate::syntax::upper_case::in_upper_case;
use crate::syntax::{expression, unread::not_known};
use crate::text::Span;

/// A block that is being lowered.
pub(super) struct BlockLowering<'a> {
    pub(super) code: &'a str,
    /// The code as the parser reads it.
    pub(super) read: &'a str,
    pub(super) block: &'a mut Block,
    /// The first `[` that is never closed.
    pub(super) unclosed: Option<usize>,
    /// Tokens that no rule understood, so far.
    pub(super) unknown: Option<Span>,
    /// The addresses and keywords in lower case.
    pub(super) lower_case: Vec<Span>,
}

impl BlockLowering<'_> {
    /// A label comes before everything else; a bracket after words is not a label (R2.70).
    pub(super) fn label(&mut self, name: Span, span: Span) {
        if self.block.words.is_empty() && self.block.items.is_empty() {
            self.block.items.push(Item::Label(name));
        } else {
            self.unread(Effect::Everything, span);
        }
    }

    /// Text with the form of the language, but no known meaning (R2.70).
    pub(super) fn unread(&mut self, effect: Effect, span: Span) {
        self.block.faults.push(not_known(span.of(self.code), span));
        self.block.items.push(Item::Unread(effect, span));
    }

    pub(super) fn finish(&mut self) {
        self.flush_unknown();
        self.refuse_after_call();
        let words = &self.lower_case;
        if let (Some(span), Some(fix)) = (words.first(), in_upper_case(self.code, words)) {
            let word = span.of(self.code);
            self.block.faults.push(
                Fault::new(Code::Fc404, *span, format!("`{word}` is not in upper case"))
                    .with_help(format!("write `{}`", word.to_ascii_uppercase()))
                    .with_fix(fix),
            );
        }
    }

    /// Nothing follows a call in its block (TF5200 Diagnosis, error 21542).
    fn refuse_after_call(&mut self) {
        let mut items = self.block.items.iter();
        let Some(Item::Call(call)) = items.find(|item| matches!(item, Item::Call(_))) else {
            return;
        };
        let is_after = |item: &&Item| item.span().start > call.span.start;
        let follows = items.find(is_after);
        let Some(item) = follows.filter(|item| !matches!(item, Item::BadCommand(_))) else {
            return;
        };
        let (shown, call) = (item.span().of(self.code), call.span.of(self.code));
        let message = format!(
            "`{}` follows the call `{}` in its block, where the control accepts nothing",
            shown.trim(),
            call.trim()
        );
        let fault = Fault::new(Code::Fc207, item.span(), message)
            .with_help("write it before the call, or in the next block");
        self.block.faults.push(fault);
    }

    pub(super) fn flush_unknown(&mut self) {
        let Some(span) = self.unknown.take() else {
            return;
        };
        let fault = match self.unclosed.take() {
            Some(at) => not_closed(at),
            None => not_understood(span, self.code),
        };
        self.block.items.push(Item::BadCommand(span));
        self.block.faults.push(fault);
    }

    pub(super) fn note_case(&mut self, span: Span) {
        let lower = span
            .of(self.code)
            .bytes()
            .any(|byte| byte.is_ascii_lowercase());
        if lower {
            self.lower_case.push(span);
        }
    }

    pub(super) fn assignment(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut inner = pair.into_inner();
        if let (Some(place), Some(sign), Some(value)) = (inner.next(), inner.next(), inner.next()) {
            let target = self.target(place.clone());
            let operator = expression::operator(sign.as_str().trim_end_matches('='));
            let value = match operator {
                Some(operator) => expression::compound(place, operator, value, self.block),
                None => expression::lower(value, 0, self.block),
            };
            self.block.items.push(Item::Assign(Assignment {
                target,
                value,
                span,
            }));
        }
    }

    pub(super) fn target(&mut self, pair: Pair<'_, Rule>) -> Target {
        let span = trimmed(span_of(&pair), self.code);
        let place = expression::place(pair, 0, self.block);
        Target { place, span }
    }

    pub(super) fn refuse(&mut self, fault: Fault, span: Span) {
        self.block.faults.push(fault);
        self.block.items.push(Item::BadCommand(span));
    }
}

pub(super) fn span_of(pair: &Pair<'_, Rule>) -> Span {
    let span = pair.as_span();
    Span::new(span.start(), span.end())
}

/// The span without the blanks that pest leaves at its end.
pub(super) fn trimmed(span: Span, code: &str) -> Span {
    let text = span.of(code);
    let length = text.trim_end_matches(is_blank).len();
    Span::new(span.start as usize, span.start as usize + length)
}

pub(super) fn not_understood(span: Span, code: &str) -> Fault {
    let found = span.of(code).trim();
    let shown: String = found.chars().take(40).collect();
    let fault = Fault::new(
        Code::Fc207,
        span,
        format!("`{shown}` is not understood here"),
    );
    let before = code.get(..span.start as usize).unwrap_or_default();
    if found == "O" && before.ends_with(|letter: char| letter.is_ascii_digit()) {
        return fault.with_help("write the digit `0` in place of the letter `O`");
    }
    fault
}

pub(super) fn not_closed(at: usize) -> Fault {
    Fault::new(
        Code::Fc205,
        Span::new(at, at + 1),
        "this bracket is not closed",
    )
    .with_help("close it with `]`, or continue the command on the next line with `\\`")
}
