//! `$` statements.

use pest::iterators::Pair;

use super::{Lowering, span_of};
use crate::codes::Code;
use crate::diagnostic::did_you_mean;
use crate::source::Span;
use crate::syntax::Fault;
use crate::syntax::ast::{Flow, Item, JumpTarget, Operand};
use crate::syntax::expression;
use crate::syntax::grammar::Rule;

/// The `$` statements.
const FLOW_WORDS: [&str; 20] = [
    "$IF",
    "$ELSEIF",
    "$ELSE",
    "$ENDIF",
    "$SWITCH",
    "$CASE",
    "$DEFAULT",
    "$ENDSWITCH",
    "$FOR",
    "$ENDFOR",
    "$WHILE",
    "$ENDWHILE",
    "$DO",
    "$ENDDO",
    "$REPEAT",
    "$UNTIL",
    "$BREAK",
    "$CONTINUE",
    "$GOTO",
    "$",
];

impl Lowering<'_> {
    pub(super) fn flow(&mut self, pair: Pair<'_, Rule>, span: Span) {
        let Some(statement) = pair.into_inner().next() else {
            return;
        };
        let word = span.of(self.code);
        let length = word[1..]
            .find(|c: char| !c.is_ascii_alphabetic())
            .map_or(word.len(), |at| at + 1);
        self.note_case(Span::new(span.start as usize, span.start as usize + length));
        if statement.as_rule() == Rule::flow_unknown {
            self.refuse(unknown_flow(span, &word[..length]), span);
            return;
        }
        let flow = self.flow_statement(statement);
        self.block.items.push(Item::Flow(flow, span));
    }

    fn flow_statement(&mut self, pair: Pair<'_, Rule>) -> Flow {
        let rule = pair.as_rule();
        let mut targets = Vec::new();
        let mut values = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::target => targets.push(self.target(part)),
                Rule::expression => values.push(expression::lower(part, 0, self.block)),
                Rule::goto_number => {
                    let value = part.into_inner().next();
                    let value = value.map(|value| expression::lower(value, 0, self.block));
                    return Flow::Goto(JumpTarget::Number(value.unwrap_or(Operand::Number(0.0))));
                }
                Rule::goto_label => {
                    let name = part.into_inner().next().map(|name| span_of(&name));
                    return Flow::Goto(JumpTarget::Label(name.unwrap_or_default()));
                }
                Rule::variable => {
                    let place = expression::place(part, 0, self.block);
                    return Flow::Goto(JumpTarget::Variable(place));
                }
                _ => {}
            }
        }
        let first = values.first().copied();
        let condition = first.unwrap_or(Operand::Number(0.0));
        match rule {
            Rule::flow_if => Flow::If(condition),
            Rule::flow_elseif => Flow::ElseIf(condition),
            Rule::flow_else => Flow::Else,
            Rule::flow_endif => Flow::EndIf,
            Rule::flow_switch => Flow::Switch(targets.first().copied(), condition),
            Rule::flow_case => Flow::Case(condition),
            Rule::flow_default => Flow::Default,
            Rule::flow_endswitch => Flow::EndSwitch,
            Rule::flow_for => match targets.first() {
                Some(&counter) => Flow::For {
                    counter,
                    start: condition,
                    end: values.get(1).copied().unwrap_or(condition),
                    step: values.get(2).copied().unwrap_or(Operand::Number(1.0)),
                },
                None => Flow::EndFor,
            },
            Rule::flow_endfor => Flow::EndFor,
            Rule::flow_while => Flow::While(condition),
            Rule::flow_endwhile => Flow::EndWhile,
            Rule::flow_do => Flow::Do(first),
            Rule::flow_enddo => Flow::EndDo(first),
            Rule::flow_repeat => Flow::Repeat,
            Rule::flow_until => Flow::Until(condition),
            Rule::flow_continue => Flow::Continue,
            _ => Flow::Break,
        }
    }
}

fn unknown_flow(span: Span, word: &str) -> Fault {
    let upper = word.to_ascii_uppercase();
    if FLOW_WORDS.contains(&upper.as_str()) {
        let fault = Fault::new(
            Code::Fc207,
            span,
            format!("`{word}` is incomplete or not understood"),
        );
        return match upper.as_str() {
            "$FOR" => fault.with_help("write `$FOR P1 = start, end, step`"),
            "$GOTO" => fault.with_help("write `$GOTO N100` or `$GOTO [NAME]`"),
            _ => fault,
        };
    }
    let fault = Fault::new(Code::Fc207, span, format!("unknown statement `{word}`"));
    match did_you_mean(word, FLOW_WORDS) {
        Some(near) => fault.with_help(format!("did you mean `{near}`?")),
        None => fault,
    }
}
