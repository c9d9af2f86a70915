//! The blocks of a program as data, compact and owned.
//!
//! Names are spans into the block's text. One vector per block holds its expressions, each operand
//! before its operator, so that they are evaluated with a stack and without recursion.

mod arguments;
mod block;
mod call;
mod expression;

#[cfg_attr(not(feature = "unstable"), allow(unused_imports))]
pub use crate::language::AxisCommand;
pub use crate::language::BlockSharing;
pub use arguments::{Argument, BracketArguments};
pub use block::{
    Address, Assignment, Block, BlockNumber, Declaration, Effect, Hash, Item, SpindleWord, Word,
};
pub use call::{
    BlockReference, Call, CallForm, CallName, CallScope, Flow, GCall, Repetition, Return,
    ReturnLevels, SequenceCall,
};
pub use expression::{BinaryOperator, Expression, Function, Node, Operand, Owner, Target};
