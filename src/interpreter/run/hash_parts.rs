//! Parts of `#` commands that say what the command changes.

use super::block_context::BlockContext;
use crate::interpreter::coordinates::chain;
use crate::interpreter::values::variable::canonical;
use crate::syntax::ast::{Block, Declaration, Hash};

/// The name that a declaration declares, without its dimensions.
pub(in crate::interpreter) fn declared_name(
    declaration: &Declaration,
    at: &BlockContext<'_>,
) -> String {
    let text = declaration.target.span.of(at.text);
    let name = text.split('[').next().unwrap_or_default();
    canonical(name).into_owned()
}

/// The words that may stand after a command that switches a path, `#SPLINE ON X10 Y20`, as a block
/// whose spans are those of the whole.
pub(in crate::interpreter) fn point_after(hash: &Hash, at: &BlockContext<'_>) -> Option<Block> {
    let (_, step, _) = chain::command(&hash.name)?;
    if !matches!(step, chain::ChainStep::Path | chain::ChainStep::Machine) {
        return None;
    }
    let text = hash.span.of(at.text);
    let is_switch = |word: &&str| {
        let word = word.trim();
        word.eq_ignore_ascii_case("ON") || word.eq_ignore_ascii_case("OFF")
    };
    let mut length = 0;
    let mut words = text.split_inclusive([' ', '\t']);
    for word in words.by_ref() {
        length += word.len();
        if is_switch(&word) {
            break;
        }
    }
    let words = &text[length..];
    let first = words.split_whitespace().next()?;
    if first.starts_with('[') || first.eq_ignore_ascii_case("EX") {
        return None;
    }
    let code = " ".repeat(hash.span.start as usize + length) + words;
    Some(crate::syntax::parse_block(&code))
}
