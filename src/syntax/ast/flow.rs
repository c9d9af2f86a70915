//! The flow of a program: `$` statements and where they jump to.

use super::expression::{Expression, Operand, Target};
use crate::text::Span;

/// A `$` statement.
#[derive(Debug, Clone, PartialEq)]
pub enum Flow {
    /// `$IF c`.
    If(Operand),
    /// `$ELSEIF c`.
    ElseIf(Operand),
    /// `$ELSE`.
    Else,
    /// `$ENDIF`.
    EndIf,
    /// `$SWITCH e`, also `$SWITCH P1 = e`.
    Switch(Option<Target>, Operand),
    /// `$CASE v`.
    Case(Operand),
    /// `$DEFAULT`.
    Default,
    /// `$ENDSWITCH`.
    EndSwitch,
    /// `$FOR P1 = start, end, step`.
    For {
        /// The counter.
        counter: Target,
        /// Its first value.
        start: Operand,
        /// The value that ends the loop when it is passed.
        end: Operand,
        /// Increment of each pass, 1 when left out.
        step: Operand,
    },
    /// `$ENDFOR`.
    EndFor,
    /// `$WHILE c`.
    While(Operand),
    /// `$ENDWHILE`.
    EndWhile,
    /// `$DO`, with a condition or without.
    Do(Option<Operand>),
    /// `$ENDDO`, with a condition or without.
    EndDo(Option<Operand>),
    /// `$REPEAT`.
    Repeat,
    /// `$UNTIL c`.
    Until(Operand),
    /// `$BREAK`.
    Break,
    /// `$CONTINUE`.
    Continue,
    /// `$GOTO`.
    Goto(BlockReference),
}

/// Reference to a block: by its number, its label, or a variable that holds the label.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BlockReference {
    /// `N20`.
    Number(Operand),
    /// `[NAME]`, the name without its brackets.
    Label(Span),
    /// `V.E.NAME`, a variable that holds the name.
    Variable(Expression),
}
