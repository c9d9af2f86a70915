//! Commands in the brackets of an axis or spindle, and words of a spindle.

use pest::iterators::Pair;

use super::lowering::{BlockLowering, not_closed, span_of, trimmed};
use crate::diagnostic::{Code, Fix, did_you_mean, nearest};
use crate::language::AxisCommand;
use crate::syntax::ast::{Address, Effect, Item, Word};
use crate::syntax::keywords::{is_spindle_command, is_spindle_word};
use crate::syntax::{
    comp::{CompWords, end_of_command},
    expression,
    fault::Fault,
    grammar::Rule,
    pieces::is_blank,
};
use crate::text::Span;

impl BlockLowering<'_> {
    pub(super) fn axis_bracket(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut axis = span;
        let mut body = None;
        let mut closed = false;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::axis_name => axis = trimmed(span_of(&part), self.code),
                Rule::bracket_body => body = Some(span_of(&part)),
                Rule::bracket_end => closed = true,
                _ => {}
            }
        }
        let body = body.unwrap_or(span);
        if !closed {
            let open = self.code[axis.end as usize..].find('[').unwrap_or_default();
            self.unclosed = None;
            let open = axis.end as usize + open;
            let mut fault = not_closed(open);
            if let Some(end) = end_of_command(self.code, open + 1) {
                fault = fault.with_fix(Fix::guess(Span::new(end, end), "]"));
            }
            self.refuse(fault, span);
            return;
        }
        let words = words(self.code, body);
        if words.iter().any(|word| word.of(self.code).contains('"')) {
            // The code of a macro may be any part of the command.
            self.unread(Effect::Everything, span);
            return;
        }
        let keyword = words.first().copied();
        let first = keyword.map_or("", |word| word.of(self.code));
        if first.eq_ignore_ascii_case("COMP") {
            let command = CompWords {
                text: self.code,
                axis,
                whole: span,
                words: &words,
            }
            .lower(&mut self.block.faults);
            self.block.items.push(match command {
                Some(command) => Item::Comp(command),
                None => Item::BadCommand(span),
            });
        } else if let Some(keyword) = keyword {
            let spindle = axis.of(self.code).starts_with(['S', 's']) && !near_comp(first);
            let known = if spindle {
                is_spindle_command(first)
            } else {
                AxisCommand::is_known(first)
            };
            if known {
                let words: Vec<&str> = words.iter().map(|word| word.of(self.code)).collect();
                let command = AxisCommand::of(first, &words);
                let arguments = self.arguments_in(body);
                let spindle = if spindle {
                    self.spindle_words(&arguments)
                } else {
                    Vec::new()
                };
                self.block.items.push(Item::Bracket {
                    axis,
                    keyword,
                    command,
                    arguments,
                    spindle,
                    span,
                });
            } else if spindle {
                self.unread(Effect::Spindle, span);
            } else {
                self.refuse(invalid_keyword(keyword, first), span);
            }
        } else {
            self.refuse(
                Fault::new(
                    Code::PErr21301,
                    span,
                    "the bracket of the axis contains no keyword",
                )
                .with_help("write `X[COMP ON FRICT]`, or an expression for a position"),
                span,
            );
        }
    }

    /// `S.POS180`
    pub(super) fn spindle_word(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let mut name = span;
        let mut value = None;
        let mut bracketed = false;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::spindle_name => name = trimmed(span_of(&part), self.code),
                Rule::expression => value = Some(expression::lower(part, 0, self.block)),
                _ => bracketed = true,
            }
        }
        let word = name.of(self.code).split('.').nth(1).unwrap_or_default();
        if bracketed || !is_spindle_word(word) {
            self.unread(Effect::Spindle, span);
            return;
        }
        self.block.push_word(Word {
            address: Address::Name(name),
            value,
            span,
        });
    }
}

/// The words of a bracket, separated by blanks.
fn words(code: &str, body: Span) -> Vec<Span> {
    let text = body.of(code);
    let mut words = Vec::new();
    let mut start = None;
    for (at, c) in text.char_indices().chain([(text.len(), ' ')]) {
        match (is_blank(c), start) {
            (false, None) => start = Some(at),
            (true, Some(from)) => {
                words.push(Span::new(from, at).shifted(body.start));
                start = None;
            }
            _ => {}
        }
    }
    words
}

fn near_comp(word: &str) -> bool {
    did_you_mean(word, ["COMP"]).is_some()
}

fn invalid_keyword(span: Span, word: &str) -> Fault {
    let known = AxisCommand::keywords().chain(["COMP"]);
    let fault = Fault::new(
        Code::PErr21301,
        span,
        format!("invalid first keyword `{word}` in an axis bracket"),
    );
    let near = nearest(word, known);
    if near.is_empty() {
        return fault.with_help("friction compensation is switched with `COMP ON FRICT`");
    }
    fault.with_near(span, &near)
}
