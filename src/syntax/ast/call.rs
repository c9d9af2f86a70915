//! Calls of programs, returns from them, and the flow of a program: `$` statements and where they jump to.

use serde::{Deserialize, Serialize};

use super::expression::{Expression, Operand, Target};
use crate::text::Span;

/// `LL NAME`, `L file.nc`, `L CYCLE [NAME=… @P1=…]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Call {
    /// Search scope of the program.
    pub scope: CallScope,
    /// Name of the program.
    pub name: CallName,
    /// Whether it is a cycle.
    pub form: CallForm,
    /// Own parameters of the call, `@P1` …: number and value.
    pub arguments: Vec<(u32, Operand)>,
    /// Words of the call, `@X`, `@S` …: the letter in upper case and its value.
    pub words: Vec<(u8, Operand)>,
    /// Whether it is repeated.
    pub repetition: Repetition,
    /// Span of its whole text.
    pub span: Span,
}

/// Form of the name of a called program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CallName {
    /// Written as is.
    Literal(Span),
    /// In quotes, a macro's name or the program's; the span holds the quotes.
    Quoted(Span),
    /// A variable that holds the name.
    Variable(Expression),
}

/// Search scope of a called program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CallScope {
    /// `LL`: in the same file.
    Local,
    /// `L`: in a file.
    Global,
}

/// Whether a call is one of a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum CallForm {
    /// `L file.nc`, `LL NAME`.
    #[default]
    Plain,
    /// `L CYCLE […]`, `LL CYCLE […]`: its effect on G functions and feed ends with it.
    Cycle,
}

/// Form of the repetition of a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Repetition {
    /// Not at all.
    #[default]
    Once,
    /// `MODAL_MOVE`: after each block with motion.
    AfterMotion,
    /// `MODAL_BLOCK`: after each block.
    AfterBlock,
}

/// An implicit call, `G800[1, 2, , 4]`.
#[derive(Debug, Clone, PartialEq)]
pub struct GCall {
    /// The number of the G function.
    pub number: u32,
    /// The values; one that is left out is `None`.
    pub arguments: Vec<Option<Operand>>,
    /// Span of its whole text.
    pub span: Span,
}

/// `L SEQUENCE [NAME=a.nc N10 N20 REPEAT=3 ENDTAG]`: the blocks from one to another.
#[derive(Debug, Clone, PartialEq)]
pub struct SequenceCall {
    /// The program; the one that is executed where it is left out.
    pub name: Option<CallName>,
    /// The first block.
    pub first: BlockReference,
    /// The last block.
    pub last: Option<BlockReference>,
    /// Whether the call itself ends the sequence, too.
    pub end_tag: bool,
    /// Number of passes; one where it is left out.
    pub passes: Option<Operand>,
    /// Span of its whole text.
    pub span: Span,
}

/// `M17 [MAIN [LABEL]]`: where a subprogram returns to.
#[derive(Debug, Clone, PartialEq)]
pub struct Return {
    /// Over how many programs.
    pub levels: ReturnLevels,
    /// To which block, where that is not the next one.
    pub target: Option<BlockReference>,
    /// Span of its whole text.
    pub span: Span,
}

/// Number of levels that a subprogram returns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ReturnLevels {
    /// To its caller.
    One,
    /// To the main program.
    Main,
    /// From so many programs.
    Number(Operand),
}

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
