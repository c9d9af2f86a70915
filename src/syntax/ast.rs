//! The blocks of a program as data, compact and owned.
//!
//! Names are spans into the block's text. One vector per block holds its expressions, each operand
//! before its operator, so that they are evaluated with a stack and without recursion.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::comp::CompCommand;
use crate::language::HashWords;
#[cfg_attr(not(feature = "unstable"), allow(unused_imports))]
pub use crate::language::{AxisCommand, BlockSharing};
use crate::readings::Question;
use crate::syntax::parse::Fault;
use crate::syntax::pieces::code_of_part;
use crate::text::Span;

/// One block.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Block {
    /// The skip level of a leading slash, 1 to 10 (R2.3).
    pub skip: Option<u8>,
    /// The block number.
    pub number: Option<BlockNumber>,
    /// The words before everything else; most blocks have nothing else.
    pub words: Vec<Word>,
    /// Items after them, from left to right.
    pub items: Vec<Item>,
    /// Whether a `$GOTO` is among the items; an `$IF` in its block opens no control block.
    pub jumps: bool,
    /// The values after the numbers of words, `G163=50`, each with its word.
    pub second_values: Vec<(Span, Operand)>,
    /// The expressions of the block.
    pub nodes: Vec<Node>,
    /// The source of each node.
    pub spans: Vec<Span>,
    /// Faults of its text, from left to right.
    pub faults: Vec<Fault>,
}

impl Block {
    /// Appends a word to the block.
    #[inline]
    pub(crate) fn push_word(&mut self, word: Word) {
        if self.items.is_empty() {
            self.words.push(word);
        } else {
            self.items.push(Item::Word(word));
        }
    }

    /// Returns all its words, from left to right.
    pub fn all_words(&self) -> impl Iterator<Item = &Word> {
        let later = self.items.iter().filter_map(|item| match item {
            Item::Word(word) => Some(word),
            _ => None,
        });
        self.words.iter().chain(later)
    }

    /// Returns the value after the number of a word, `G163=50`.
    pub(crate) fn second_value(&self, word: Span) -> Option<Operand> {
        let mut values = self.second_values.iter();
        values.find(|(of, _)| *of == word).map(|(_, value)| *value)
    }

    /// Empties the block and keeps its memory.
    #[inline]
    pub fn clear(&mut self) {
        self.skip = None;
        self.number = None;
        self.words.clear();
        self.items.clear();
        self.jumps = false;
        self.second_values.clear();
        self.nodes.clear();
        self.spans.clear();
        self.faults.clear();
    }
}

/// `N10`, or the jump label `N10:`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockNumber {
    /// The number, often an expression.
    pub value: Operand,
    /// Whether a colon makes the number a jump label.
    pub label: bool,
    /// Span from the N to the end of the number or the colon.
    pub span: Span,
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
    /// The value after it; some machines take an axis letter alone.
    pub value: Option<Operand>,
    /// The word.
    pub span: Span,
}

/// Something in a block.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// A word after something else.
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
        /// The command that it opens.
        command: AxisCommand,
        /// Words and values in the bracket.
        arguments: BracketArguments,
        /// The words of a spindle that are followed.
        spindle: Vec<SpindleWord>,
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
    Sequence(SequenceCall),
    /// `M17 […]`, `M29 […]`.
    Return(Return),
    /// `"NAME" = "code"`, both with their quotes.
    MacroDefinition(Span, Span),
    /// `"NAME"`, with its quotes.
    MacroUse(Span),
    /// Text that has the form of the language, but no known meaning (FC210, R2.70).
    Unread(Effect, Span),
}

/// A word in the bracket of a spindle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SpindleWord {
    /// The speed, `REV1000`, where it is understood.
    Speed(Option<Operand>),
    /// An M function, `M3`.
    M(i64),
}

impl Item {
    /// Returns the source of the item.
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

/// Possible effect of text of unknown meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Any effect that a program can have: the text may be a call.
    Everything,
    /// Some parameter: it assigns to an unknown place.
    Parameters,
    /// No effect that is followed here: a word of a spindle.
    Spindle,
}

/// `target = value`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assignment {
    /// Target of the assignment.
    pub target: Target,
    /// The new value.
    pub value: Operand,
    /// Span of its whole text.
    pub span: Span,
}

/// A `#` command.
#[derive(Debug, Clone, PartialEq)]
pub struct Hash {
    /// Row in the table of the language, and its further words.
    pub(crate) command: HashWords,
    /// Words in upper case, joined by one blank, with the `#`: `#COMMENT BEGIN`.
    pub name: String,
    /// Text after the words.
    pub rest: Span,
    /// The arguments in its brackets, where a dry run follows them.
    pub brackets: BracketArguments,
    /// The value of `#TIME`, the targets of `#DELETE`, the remedy class of `#ERROR`.
    pub arguments: Vec<Operand>,
    /// The declarations of `#VAR`.
    pub declarations: Vec<Declaration>,
    /// The places that the command writes with values that only the machine knows.
    pub written: Vec<Target>,
    /// Content that may share its block.
    pub sharing: BlockSharing,
    /// Span of its whole text.
    pub span: Span,
}

impl Hash {
    /// Returns the open question on which its effect rests.
    pub fn basis(&self) -> Option<Question> {
        self.command.basis
    }

    /// Returns whether it names all variables that the program shares with the PLC, `V.E.` (PM/207988747).
    pub(crate) fn names_all_externals(&self, text: &str) -> bool {
        let code = self.code(text);
        code.split(',')
            .any(|name| name.trim().eq_ignore_ascii_case("V.E."))
    }

    /// Returns the text after its words as the parser sees it, without comments.
    pub(crate) fn code<'a>(&self, text: &'a str) -> Cow<'a, str> {
        code_of_part(self.rest.of(text))
    }
}

/// One declaration in `#VAR` … `#ENDVAR`.
#[derive(Debug, Clone, PartialEq)]
pub struct Declaration {
    /// The variable with its dimensions as subscripts.
    pub target: Target,
    /// The type in upper case, REAL64 when left out.
    pub kind: Option<String>,
    /// The number in the bracket of the type, the most characters of a STRING.
    pub length: Option<Operand>,
    /// The initial values in row order; a scalar has one.
    pub initial: Vec<Operand>,
}

/// The arguments in the brackets of a command, from left to right.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BracketArguments(pub(crate) Vec<Argument>);

/// A word or value in a bracket, with the key before it where there is one: `ON`, `5`, `AX=X`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Argument {
    /// The bracket that holds it, from one on; zero outside of brackets.
    pub(crate) group: u32,
    /// Number of commas before it.
    pub(crate) item: u32,
    /// The word before the equals sign.
    pub(crate) key: Option<Span>,
    /// The word or value.
    pub(crate) span: Span,
    /// The value, where it is one.
    pub(crate) value: Option<Operand>,
}

impl Argument {
    /// Returns the logical number of an axis, where it is one.
    pub(crate) fn logical_number(&self, text: &str) -> Option<u32> {
        self.span.of(text).parse().ok()
    }

    /// Returns the text of a value in quotes, without them.
    pub(crate) fn quoted<'a>(&self, text: &'a str) -> Option<&'a str> {
        self.span.of(text).strip_prefix('"')?.strip_suffix('"')
    }
}

impl BracketArguments {
    /// Returns all of them.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Argument> {
        self.0.iter()
    }

    /// Returns what is in the same brackets without commas in between, `NAME=X NR=1` of `[NAME=X NR=1, 2]`.
    pub(crate) fn items(&self) -> impl Iterator<Item = &[Argument]> {
        let together =
            |one: &Argument, other: &Argument| (one.group, one.item) == (other.group, other.item);
        self.0.chunk_by(together)
    }

    /// Returns what is in each bracket.
    pub(crate) fn groups(&self) -> impl Iterator<Item = &[Argument]> {
        self.0.chunk_by(|one, other| one.group == other.group)
    }

    /// Returns whether a word is among them, in upper or lower case.
    pub(crate) fn has(&self, word: &str, text: &str) -> bool {
        let words = |it: &Argument| it.key.into_iter().chain([it.span]);
        let mut words = self.0.iter().flat_map(words);
        words.any(|span| span.of(text).eq_ignore_ascii_case(word))
    }

    /// Returns the argument after a key, with an equals sign or without.
    pub(crate) fn after<'a>(&'a self, key: &'a str, text: &'a str) -> Option<&'a Argument> {
        let mut found = self.after_each(|word| word.eq_ignore_ascii_case(key), text);
        found.next()
    }

    /// Returns the arguments after keys that begin with some letters, `AX1=X AX2=Y`.
    pub(crate) fn after_beginning<'a>(
        &'a self,
        letters: &'a str,
        text: &'a str,
    ) -> impl Iterator<Item = &'a Argument> {
        let begins = |word: &str| {
            let start = word.get(..letters.len());
            start.is_some_and(|start| start.eq_ignore_ascii_case(letters))
        };
        self.after_each(begins, text)
    }

    fn after_each<'a>(
        &'a self,
        is_key: impl Fn(&str) -> bool + 'a,
        text: &'a str,
    ) -> impl Iterator<Item = &'a Argument> {
        let places = self.0.iter().enumerate();
        places.filter_map(move |(at, argument)| match argument.key {
            Some(key) => is_key(key.of(text)).then_some(argument),
            None if argument.value.is_none() && is_key(argument.span.of(text)) => self
                .0
                .get(at + 1)
                .filter(|next| next.group == argument.group),
            None => None,
        })
    }

    /// Returns whether a word or value contains some letters, in upper or lower case.
    pub(crate) fn mention(&self, letters: &str, text: &str) -> bool {
        let mut words = self.words(text).map(str::to_ascii_lowercase);
        words.any(|word| word.contains(letters))
    }

    /// Returns the keys with their values, `8` and `2` of `[1, 8 = 2]`.
    pub(crate) fn pairs<'a>(&'a self, text: &'a str) -> impl Iterator<Item = [&'a str; 2]> {
        let pairs = self.0.iter();
        pairs.filter_map(move |it| Some([it.key?.of(text), it.span.of(text)]))
    }

    /// Returns their words, keys and values alike.
    pub(crate) fn words<'a>(&'a self, text: &'a str) -> impl Iterator<Item = &'a str> {
        let spans = self
            .0
            .iter()
            .flat_map(|it| it.key.into_iter().chain([it.span]));
        spans.map(move |span| span.of(text))
    }
}

/// `LL NAME`, `L file.nc`, `L CYCLE [NAME=… @P1=…]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Call {
    /// Search scope of the program.
    pub scope: CallScope,
    /// Name of the program.
    pub name: CallName,
    /// Form of the call: that of a cycle or of a program.
    pub form: CallForm,
    /// Own parameters of the call, `@P1` …: number and value.
    pub arguments: Vec<(u32, Operand)>,
    /// Words of the call, `@X`, `@S` …: the letter in upper case and its value.
    pub words: Vec<(u8, Operand)>,
    /// Repetition of the call.
    pub repetition: Repetition,
    /// Span of its whole text.
    pub span: Span,
}

/// Form of the name of a called program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CallName {
    /// Written as is.
    Literal(Span),
    /// Name in quotes, a macro's or the program's; the span holds the quotes.
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

/// Form of a call: that of a cycle or of a program.
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
    /// No repetition.
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
    /// Block to return to, where that is not the next one.
    pub target: Option<BlockReference>,
    /// Span of its whole text.
    pub span: Span,
}

/// Number of levels that a subprogram returns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ReturnLevels {
    /// Return to the caller.
    One,
    /// Return to the main program.
    Main,
    /// Return from the given number of programs.
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
        /// First value.
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

/// A value: a plain number, or an expression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Operand {
    /// A number, sign included.
    Number(f64),
    /// Expression to compute.
    Expression(Expression),
}

/// A range of [`Block::nodes`] whose last node is the expression's root.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Expression {
    /// The first node.
    pub start: u32,
    /// End of the range, one past the last node.
    pub end: u32,
}

/// A place that an assignment writes: a range of nodes as for reading it, whose last node names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Target {
    /// The nodes; the last one is a parameter or variable.
    pub place: Expression,
    /// Span of its text.
    pub span: Span,
}

/// One step of an expression; operands come before their operator.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Node {
    /// A number.
    Number(f64),
    /// A text; the node's span holds the quotes.
    Text,
    /// `P10` or `@P10`.
    Parameter {
        /// Owner of the parameter.
        owner: Owner,
        /// Number.
        index: u32,
    },
    /// `PP10`, `P100[3]`: the number and the subscripts are popped.
    IndexedParameter {
        /// Owner of the parameter.
        owner: Owner,
        /// Number of subscripts above the number on the stack.
        subscripts: u8,
    },
    /// `V.P.NAME`, `@X`; the node's span is its text, subscripts are popped.
    Variable {
        /// Number of subscripts.
        subscripts: u8,
    },
    /// A value, or a place to write, whose text is not known; the message about it is a fault of the
    /// block.
    Unread,
    /// Change of sign.
    Negate,
    /// Two values become one.
    Binary(BinaryOperator),
    /// Arguments become one value.
    Call {
        /// The function.
        function: Function,
        /// Number of arguments.
        arguments: u8,
    },
}

/// Owner of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Owner {
    /// `P`, shared with subprograms.
    Program,
    /// `@P`, of this call.
    Call,
}

/// An operator between two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
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
    /// `EXIST`: a parameter or variable exists.
    Exist,
    /// The number of elements of an array.
    Sizeof,
    /// `IS_STRING`: a value is a text.
    IsString,
    /// `IS_NUMBER`: a value is a number.
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
    /// A text with another one put in after a position.
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
