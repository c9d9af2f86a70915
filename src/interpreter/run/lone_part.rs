//! Parts of a macro that limit what else may be in the block.

use super::block_context::MacroCode;
use crate::syntax::ast::{Block, BlockSharing, Item};
use crate::syntax::code_of;
use crate::text::Span;

/// A part of a macro with which words of the same block cannot be, or perhaps not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LonePart {
    /// A call, after which the control accepts nothing (R2.13).
    Call,
    /// A `#` command (R2.47).
    Command(BlockSharing),
    /// A comment up to the end, perhaps of the whole block.
    Comment,
}

impl LonePart {
    pub(crate) fn of(code: &MacroCode<'_>) -> Option<Self> {
        let mut items = code.block.items.iter();
        let lone = items.find_map(|item| match item {
            Item::Call(_) => Some(Self::Call),
            Item::Hash(hash) if hash.sharing == BlockSharing::Words => None,
            Item::Hash(hash) => Some(Self::Command(hash.sharing)),
            _ => None,
        });
        lone.or_else(|| ends_in_comment(code.text).then_some(Self::Comment))
    }

    pub(crate) fn as_str(self) -> &'static str {
        match self {
            Self::Call => "a call",
            Self::Command(_) => "a `#` command",
            Self::Comment => "a comment",
        }
    }

    /// Whether the control may or may not execute what shares the block with it.
    pub(crate) fn leaves_rest_open(self) -> bool {
        self != Self::Call
    }

    /// The first part of a block that should not be in it together with a macro.
    pub(crate) fn conflict(self, block: &Block, used: Span) -> Option<Span> {
        let from = block
            .items
            .partition_point(|item| item.span().start <= used.start);
        let after = block.items[from..].iter().find(|item| is_part(item));
        let is_alone = self == Self::Command(BlockSharing::None);
        let before = parts(block)
            .next()
            .filter(|part| is_alone && part.start < used.start);
        before.or(after.map(Item::span))
    }
}

fn parts(block: &Block) -> impl Iterator<Item = Span> + '_ {
    let words = block.words.iter().map(|word| word.span);
    let items = block.items.iter().filter(|item| is_part(item));
    words.chain(items.map(Item::span))
}

fn is_part(item: &Item) -> bool {
    !matches!(item, Item::Label(_) | Item::BadCommand(_))
}

/// Whether the code ends in a comment: a word after it would not be read.
fn ends_in_comment(code: &str) -> bool {
    code.contains([';', '(']) && !code_of(&format!("{code} X")).ends_with('X')
}
