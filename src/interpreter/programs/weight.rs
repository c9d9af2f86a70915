//! The work of executing a block again, so that loops end after about the same time whatever they
//! repeat (R9.91). A unit is about a nanosecond of a processor of this decade.

use crate::syntax::allow::MARK;
use crate::syntax::ast::{Block, Item};

/// A block, whatever it contains.
const BLOCK: usize = 100;

/// A word with a number.
const WORD: usize = 30;

/// An operand or an operator.
const NODE: usize = 10;

/// A command, a statement, an assignment, a call.
const COMMAND: usize = 300;

/// A character of a `#` command, whose words are looked at each time.
const HASH_BYTE: usize = 60;

/// A macro, whose code is parsed each time.
const MACRO: usize = 4000;

/// A comment that is addressed to this tool.
const REMARK: usize = 1000;

/// Characters of the text, which is looked through for such comments, that make a unit.
const BYTES: usize = 16;

/// Units of repeated work that a block with its text needs.
pub(crate) fn weight(block: &Block, text: &str) -> u64 {
    let items = block.items.iter().map(|item| match item {
        Item::Word(_) => WORD,
        Item::MacroUse(_) => MACRO,
        Item::Hash(hash) => COMMAND + HASH_BYTE * hash.span.range().len(),
        _ => COMMAND,
    });
    let words = WORD * block.words.len() + NODE * block.nodes.len();
    let remark = if text.contains(MARK) { REMARK } else { 0 };
    let units = BLOCK + words + items.sum::<usize>() + text.len() / BYTES + remark;
    u64::try_from(units).unwrap_or(u64::MAX)
}
