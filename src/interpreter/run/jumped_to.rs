//! Whether a jump may go to a block, so that the block before it need not come first.

use super::block_context::BlockContext;
use super::executor::Executor;
use crate::interpreter::programs::index::LabelName;
use crate::syntax::ast::{Item, Operand};

impl Executor {
    /// Whether a jump of the running program may go to the block: it names the number or the label of the block, or
    /// computes its target.
    pub(crate) fn may_be_jumped_to(&self, at: &BlockContext<'_>) -> bool {
        let Some(frame) = self.state.control.frames.running() else {
            return true;
        };
        let targets = &self.programs.index(frame.unit).targets;
        let number = at.block.number.map(|number| match number.value {
            Operand::Number(number) => Some(LabelName::numbered(number)),
            Operand::Expression(_) => None,
        });
        let labels = at.block.items.iter().filter_map(|item| match item {
            Item::Label(name) => Some(Some(LabelName::Text(name.of(at.text).to_owned()))),
            _ => None,
        });
        let mut names = number.into_iter().chain(labels);
        names.any(|name| name.is_none_or(|name| targets.may_be(&name)))
    }
}
