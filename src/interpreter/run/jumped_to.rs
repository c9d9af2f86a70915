//! Whether a jump may go to a block, so that the block before it need not come first.

use super::block_context::BlockContext;
use super::interpreter::Interpreter;
use crate::syntax::ast::Item;

impl Interpreter {
    /// Whether a jump of the running program may go to the block.
    pub(in crate::interpreter) fn may_be_jumped_to(&self, at: &BlockContext<'_>) -> bool {
        let Some(frame) = self.state.control.frames.running() else {
            return true;
        };
        let labels = at.block.items.iter();
        let has_label = labels.clone().any(|item| matches!(item, Item::Label(_)));
        let text = self.programs.index(frame.unit).source.text();
        (has_label || at.block.number.is_some()) && names_target(text, at.text)
    }
}

/// Whether a jump in a text may go to a block: it names the number or the label with which the block
/// begins, or computes its target.
fn names_target(text: &str, block: &str) -> bool {
    let own = block.trim_start().to_ascii_uppercase();
    let own = own.trim_start_matches(['N', '[']);
    let end = own.find(|it: char| !(it.is_ascii_alphanumeric() || it == '_'));
    let own = &own[..end.unwrap_or(own.len())];
    let digits = own.trim_start_matches('0');
    let upper = text.to_ascii_uppercase();
    upper.split("GOTO").skip(1).any(|rest| {
        let target = rest
            .trim_start()
            .trim_start_matches(['[', 'N'])
            .trim_start();
        let end = target.find(|it: char| !(it.is_ascii_alphanumeric() || it == '_'));
        let target = &target[..end.unwrap_or(target.len())];
        target == own
            || target.trim_start_matches('0') == digits
            || target.is_empty()
            || target.starts_with(['P', 'V'])
    })
}
