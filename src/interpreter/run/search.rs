//! The block at which a program is started, and the states before the search for it (R2.96).

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::block_context::BlockContext;
use crate::comp::Compensation;
use crate::interpreter::ways::history::History;
use crate::syntax::ast::Operand;

/// The block of the main program at which a block search ends (R2.96).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SearchedBlock {
    /// The first executed block with this block number.
    Number(u64),
    /// The first executed block that begins in this line, from 1.
    Line(u32),
}

/// A text that names no block.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is neither a block number such as `N100` nor a line such as `12`")]
pub struct NoSearchedBlock(pub String);

impl FromStr for SearchedBlock {
    type Err = NoSearchedBlock;

    /// Reads `N100` or `12`.
    fn from_str(text: &str) -> Result<Self, NoSearchedBlock> {
        let block = match text.strip_prefix(['N', 'n']) {
            Some(number) => number.parse().ok().map(Self::Number),
            None => text.parse().ok().filter(|line| *line > 0).map(Self::Line),
        };
        block.ok_or_else(|| NoSearchedBlock(text.to_owned()))
    }
}

impl fmt::Display for SearchedBlock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "N{number}"),
            Self::Line(line) => write!(f, "line {line}"),
        }
    }
}

impl SearchedBlock {
    #[expect(
        clippy::cast_precision_loss,
        reason = "block numbers are far below 2^53"
    )]
    /// Returns whether a block is the searched one.
    pub(crate) fn is(self, at: &BlockContext<'_>) -> bool {
        if at.level > 0 {
            return false;
        }
        match self {
            Self::Line(line) => at.line == line,
            Self::Number(wanted) => at.block.number.as_ref().is_some_and(
                |number| matches!(number.value, Operand::Number(it) if it.total_cmp(&(wanted as f64)).is_eq()),
            ),
        }
    }
}

/// The states at an earlier block, which apply where the machine did not execute what follows it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct EarlierStates {
    pub(crate) compensation: Compensation,
    pub(crate) history: History,
}
