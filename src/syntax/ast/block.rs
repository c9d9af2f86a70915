//! A block and its contents.

use std::borrow::Cow;

use super::arguments::BracketArguments;
use super::call::{Call, Flow, GCall, Return, SequenceCall};
use super::expression::{Node, Operand, Target};
use crate::comp::CompCommand;
use crate::language::{AxisCommand, BlockSharing, HashWords};
use crate::readings::Question;
use crate::syntax::fault::Fault;
use crate::syntax::mask::code_of_part;
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
    /// Whether a `$GOTO` is among them; an `$IF` in its block opens no control block.
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

    /// All its words, from left to right.
    pub fn all_words(&self) -> impl Iterator<Item = &Word> {
        let later = self.items.iter().filter_map(|item| match item {
            Item::Word(word) => Some(word),
            _ => None,
        });
        self.words.iter().chain(later)
    }

    /// The value after the number of a word, `G163=50`.
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
    /// Whether a colon makes it a jump label.
    pub label: bool,
    /// From the N to the number's or the colon's end.
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
        /// All words and values in the bracket.
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

/// Possible effect of text of unknown meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Anything that a program could do: it may be a call.
    Everything,
    /// Some parameter: it assigns to an unknown place.
    Parameters,
    /// Nothing that is followed here: it is a word of a spindle.
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
    /// Its row in the table of the language, and its further words.
    pub(crate) command: HashWords,
    /// Its words in upper case, joined by one blank, with the `#`: `#COMMENT BEGIN`.
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
    /// What may share its block.
    pub sharing: BlockSharing,
    /// Span of its whole text.
    pub span: Span,
}

impl Hash {
    /// The open question on which its effect rests.
    pub fn basis(&self) -> Option<Question> {
        self.command.basis
    }

    /// Whether it names all variables that the program shares with the PLC, `V.E.` (PM/207988747).
    pub(crate) fn names_all_externals(&self, text: &str) -> bool {
        let code = self.code(text);
        code.split(',')
            .any(|name| name.trim().eq_ignore_ascii_case("V.E."))
    }

    /// The text after its words as the parser sees it, without comments.
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
