//! Values: numbers, expressions, and the places that assignments write.

use serde::{Deserialize, Serialize};

use crate::text::Span;

/// A value: a plain number, or an expression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Operand {
    /// A number, sign included.
    Number(f64),
    /// Something to compute.
    Expression(Expression),
}

/// A range of [`Block::nodes`](super::Block::nodes) whose last node is the expression's root.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Expression {
    /// The first node.
    pub start: u32,
    /// One past the last node.
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
        /// Its number.
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
    /// The sign is turned.
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
