//! The blocks of a program as data, compact and owned.
//!
//! Names are spans into the block's text. Expressions stand in one vector per block, each operand
//! in front of its operator, so that they are evaluated with a stack and without recursion.

use serde::{Deserialize, Serialize};

use super::Fault;
use crate::comp::CompCommand;
use crate::text::Span;

/// One block.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Block {
    /// The skip level of a leading slash, 1 to 10 (R2.3).
    pub skip: Option<u8>,
    /// The block number.
    pub number: Option<Number>,
    /// The words in front of everything else; most blocks have nothing else.
    pub words: Vec<Word>,
    /// What follows them, from left to right.
    pub items: Vec<Item>,
    /// The expressions of the block.
    pub nodes: Vec<Node>,
    /// The source of each node.
    pub spans: Vec<Span>,
    /// What is wrong with its text, from left to right.
    pub faults: Vec<Fault>,
}

impl Block {
    /// Whether a `$GOTO` stands in the block; an `$IF` beside it opens no control block.
    pub fn jumps(&self) -> bool {
        self.items
            .iter()
            .any(|item| matches!(item, Item::Flow(Flow::Goto(_), _)))
    }

    /// Appends a word behind what stands in the block.
    #[inline]
    pub(super) fn push_word(&mut self, word: Word) {
        if self.items.is_empty() {
            self.words.push(word);
        } else {
            self.items.push(Item::Word(word));
        }
    }

    /// Empties the block and keeps its memory.
    #[inline]
    pub fn clear(&mut self) {
        self.skip = None;
        self.number = None;
        self.words.clear();
        self.items.clear();
        self.nodes.clear();
        self.spans.clear();
        self.faults.clear();
    }
}

/// `N10`, or the jump label `N10:`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number {
    /// The number, often an expression.
    pub value: Operand,
    /// Whether a colon makes it a jump label.
    pub label: bool,
    /// From the N to the number's or the colon's end.
    pub span: Span,
}

/// A value: a plain number, or an expression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Operand {
    /// A number, sign included.
    Number(f64),
    /// Something to compute.
    Expression(Expression),
}

/// A range of [`Block::nodes`] whose last node is the expression's root.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Expression {
    /// The first node.
    pub start: u32,
    /// One past the last node.
    pub end: u32,
}

/// The address of a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Address {
    /// One letter, in upper case.
    Letter(u8),
    /// A lower-case letter that would name an axis in upper case; axis names are case-sensitive.
    Lower(u8),
    /// `@X` … `@Z`, `@I` … `@K`, `@S` in a cycle: a main axis of the active plane, its centre or the
    /// main spindle.
    Main(u8),
    /// A longer axis or spindle name.
    Name(Span),
}

/// A word: `G1`, `X12.5`, `X1=100`, `M200=1200`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Word {
    /// The address.
    pub address: Address,
    /// The value behind it; some machines take an axis letter alone.
    pub value: Option<Operand>,
    /// The word.
    pub span: Span,
}

/// Something in a block.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// A word behind something else.
    Word(Word),
    /// A COMP command.
    Comp(CompCommand),
    /// A COMP bracket that was not understood; its fault says why.
    BadCommand(Span),
    /// A bracket command of another kind: the axis, its first keyword, the whole.
    Bracket {
        /// The axis or spindle.
        axis: Span,
        /// The first keyword.
        keyword: Span,
        /// The whole command.
        span: Span,
    },
    /// `G800[1, 2, , 4]`.
    GCall(GCall),
    /// A number without an address, `G04 2.5`.
    BareNumber(Operand, Span),
    /// `P1 = 5`.
    Assign(Assignment),
    /// `[NAME]`, a jump label.
    Label(Span),
    /// A `$` statement.
    Flow(Flow, Span),
    /// A `#` command: its words up to the first bracket or number, and what follows.
    Hash(Hash),
    /// A subprogram call.
    Call(Call),
    /// A call of a part of a program, `L SEQUENCE […]`.
    Sequence(Sequence),
    /// `M17 […]`, `M29 […]`.
    Return(Return),
    /// `"NAME" = "code"`, both with their quotes.
    MacroDefinition(Span, Span),
    /// `"NAME"`, with its quotes.
    MacroUse(Span),
    /// Text that has the form of the language and a meaning that is not known here (FC210, R2.70).
    Unread(Effect, Span),
}

/// What text that is not known here could change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Whatever a program could: it may be a call.
    Everything,
    /// Some parameter: it assigns to a place that is not known.
    Parameters,
    /// Nothing that is followed here: it is a word of a spindle.
    Spindle,
}

impl Item {
    /// The source of the item.
    pub fn span(&self) -> Span {
        match self {
            Self::Word(word) => word.span,
            Self::Comp(command) => command.span,
            Self::BadCommand(span)
            | Self::Bracket { span, .. }
            | Self::BareNumber(_, span)
            | Self::Label(span)
            | Self::Flow(_, span)
            | Self::MacroUse(span)
            | Self::Unread(_, span) => *span,
            Self::GCall(call) => call.span,
            Self::Assign(assignment) => assignment.span,
            Self::Hash(hash) => hash.span,
            Self::Call(call) => call.span,
            Self::Sequence(sequence) => sequence.span,
            Self::Return(back) => back.span,
            Self::MacroDefinition(name, code) => name.to(*code),
        }
    }
}

/// An implicit call, `G800[1, 2, , 4]`.
#[derive(Debug, Clone, PartialEq)]
pub struct GCall {
    /// The number of the G function.
    pub number: u32,
    /// The values; one that is left out is `None`.
    pub arguments: Vec<Option<Operand>>,
    /// The whole.
    pub span: Span,
}

/// `target = value`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assignment {
    /// What is written.
    pub target: Target,
    /// The new value.
    pub value: Operand,
    /// The whole.
    pub span: Span,
}

/// A place that an assignment writes: a range of nodes as for reading it, whose last node names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Target {
    /// The nodes; the last one is a parameter or variable.
    pub place: Expression,
    /// Its text.
    pub span: Span,
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
        /// What is added each time, 1 when left out.
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
    Goto(JumpTarget),
}

/// Where `$GOTO` goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum JumpTarget {
    /// `N20`.
    Number(Operand),
    /// `[NAME]`, the name without its brackets.
    Label(Span),
    /// `V.E.NAME`, a variable that holds the name.
    Variable(Expression),
}

/// A `#` command.
#[derive(Debug, Clone, PartialEq)]
pub struct Hash {
    /// Its words in upper case, joined by one blank, with the `#`: `#COMMENT BEGIN`.
    pub name: String,
    /// What follows the words.
    pub rest: Span,
    /// The value of `#TIME`, the targets of `#DELETE`.
    pub arguments: Vec<Operand>,
    /// The declarations of `#VAR`.
    pub declarations: Vec<Declaration>,
    /// The places that the command writes with values that only the machine knows.
    pub written: Vec<Target>,
    /// The whole.
    pub span: Span,
}

/// One declaration in `#VAR` … `#ENDVAR`.
#[derive(Debug, Clone, PartialEq)]
pub struct Declaration {
    /// The variable with its dimensions as subscripts.
    pub target: Target,
    /// The type in upper case, REAL64 when left out.
    pub kind: Option<String>,
    /// The initial values in row order; a scalar has one.
    pub initial: Vec<Operand>,
}

/// How a called program is named.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CallName {
    /// As it stands.
    Literal(Span),
    /// In quotes, a macro's name or the program's; the span holds the quotes.
    Quoted(Span),
    /// A variable that holds the name.
    Variable(Expression),
}

/// Where a called program is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CallScope {
    /// `LL`: in the same file.
    Local,
    /// `L`: in a file.
    Global,
}

/// `L SEQUENCE [NAME=a.nc N10 N20 REPEAT=3 ENDTAG]`: the blocks from one to another.
#[derive(Debug, Clone, PartialEq)]
pub struct Sequence {
    /// The program; the one that is executed where it is left out.
    pub name: Option<CallName>,
    /// The first block.
    pub first: JumpTarget,
    /// The last block.
    pub last: Option<JumpTarget>,
    /// Whether the call itself ends the sequence, too.
    pub end_tag: bool,
    /// How often it is executed; once where it is left out.
    pub passes: Option<Operand>,
    /// The whole.
    pub span: Span,
}

/// `M17 [MAIN [LABEL]]`: where a subprogram returns to.
#[derive(Debug, Clone, PartialEq)]
pub struct Return {
    /// Over how many programs.
    pub levels: Levels,
    /// To which block, where that is not the next one.
    pub target: Option<JumpTarget>,
    /// The whole.
    pub span: Span,
}

/// How far a subprogram returns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Levels {
    /// To its caller.
    One,
    /// To the main program.
    Main,
    /// Over so many programs.
    Number(Operand),
}

/// Whether a call is one of a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum CallForm {
    /// `L file.nc`, `LL NAME`.
    #[default]
    Plain,
    /// `L CYCLE […]`, `LL CYCLE […]`: what the cycle does to G functions and feed ends with it.
    Cycle,
}

/// How a cycle is repeated.
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

/// `LL NAME`, `L file.nc`, `L CYCLE [NAME=… @P1=…]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Call {
    /// Where the program is looked for.
    pub scope: CallScope,
    /// How it is named.
    pub name: CallName,
    /// Whether it is a cycle.
    pub form: CallForm,
    /// Own parameters of the call, `@P1` …: number and value.
    pub arguments: Vec<(u32, Operand)>,
    /// Words of the call, `@X`, `@S` …: the letter in upper case and its value.
    pub words: Vec<(u8, Operand)>,
    /// Whether it is repeated.
    pub repetition: Repetition,
    /// The whole.
    pub span: Span,
}

/// One step of an expression; operands stand in front of their operator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Node {
    /// A number.
    Number(f64),
    /// A text; the node's span holds the quotes.
    Text,
    /// `P10` or `@P10`.
    Parameter {
        /// Whose parameter.
        owner: Owner,
        /// Its number.
        index: u32,
    },
    /// `PP10`, `P100[3]`: the number and the subscripts are popped.
    IndexedParameter {
        /// Whose parameter.
        owner: Owner,
        /// How many subscripts lie above the number.
        subscripts: u8,
    },
    /// `V.P.NAME`, `@X`; the node's span is its text, subscripts are popped.
    Variable {
        /// How many subscripts it has.
        subscripts: u8,
    },
    /// A value, or a place to write, whose text is not known here; what is said about it is a fault
    /// of the block.
    Unread,
    /// The sign is turned.
    Negate,
    /// Two values become one.
    Binary(BinaryOperator),
    /// Arguments become one value.
    Call {
        /// The function.
        function: Function,
        /// How many arguments.
        arguments: u8,
    },
}

/// Whose parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Owner {
    /// `P`, shared with subprograms.
    Program,
    /// `@P`, of this call.
    Call,
}

/// An operator between two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BinaryOperator {
    /// `+`, also between texts.
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `**`
    Power,
    /// `MOD`
    Modulo,
    /// `==`
    Equal,
    /// `!=`
    NotEqual,
    /// `>=`
    GreaterOrEqual,
    /// `<=`
    LessOrEqual,
    /// `<`
    Less,
    /// `>`
    Greater,
    /// `&`
    BitAnd,
    /// `|`
    BitOr,
    /// `^`
    BitXor,
    /// `&&`
    And,
    /// `||`
    Or,
    /// `XOR`
    Xor,
}

/// A function of the language (R2.30, R2.34, R2.35).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Function {
    /// Absolute value.
    Abs,
    /// Square.
    Sqr,
    /// Square root.
    Sqrt,
    /// Exponential.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Power of ten.
    Dexp,
    /// Logarithm to base 10.
    Log,
    /// Sine of degrees.
    Sin,
    /// Cosine of degrees.
    Cos,
    /// Tangent of degrees.
    Tan,
    /// Cotangent of degrees.
    Cot,
    /// Arc sine in degrees.
    Asin,
    /// Arc cosine in degrees.
    Acos,
    /// Arc tangent in degrees.
    Atan,
    /// Arc tangent of y, x in degrees.
    Atan2,
    /// Arc cotangent in degrees.
    Acot,
    /// Integer part.
    Int,
    /// Fractional part.
    Fract,
    /// Next integer above.
    Ceil,
    /// Next integer below.
    Floor,
    /// Nearest integer.
    Round,
    /// The smallest of its arguments.
    Min,
    /// The greatest of its arguments.
    Max,
    /// -1, 0 or 1.
    Sign,
    /// Bitwise inversion.
    Inv,
    /// Logical inversion.
    Not,
    /// Whether a parameter or variable exists.
    Exist,
    /// The number of elements of an array.
    Sizeof,
    /// Whether a value is a text.
    IsString,
    /// Whether a value is a number.
    IsNumber,
    /// The first characters of a text.
    Left,
    /// Characters from the middle of a text: text, count, first position.
    Mid,
    /// The last characters of a text.
    Right,
    /// The length of a text.
    Len,
    /// The position of a text in another, from 1, 0 when absent.
    Find,
    /// The code of a text's character at a position, the first when left out.
    Ord,
    /// A text with another one put in behind a position.
    Insert,
    /// A text without a count of characters from a position.
    Delete,
    /// A text with a count of characters from a position replaced.
    Replace,
    /// A whole number as text.
    IntToStr,
    /// A number as text.
    RealToStr,
    /// A text as whole number.
    StrToInt,
    /// A text as number.
    StrToReal,
}
