//! Questions of a host to a run that has stopped between two blocks.

use std::sync::Arc;

use crate::interpreter::run::block_context::{BlockContext, ShownBlockLines};
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::step::ControlStep;
use crate::interpreter::values::value::Value;
use crate::syntax::ast::Block;
use crate::syntax::{Comments, RawBlock, Stretch, parse_expression};

impl Interpreter {
    /// Returns a copy positioned in the program whose block comes next. A run that was stopped after a
    /// call is still in the caller, which does not see the parameters of the called program.
    #[must_use]
    pub fn settled(&self) -> Self {
        let mut copy = self.clone();
        match copy.here.state.parked.take() {
            Some(
                step @ (ControlStep::Call(_) | ControlStep::Return | ControlStep::ReturnTo(_)),
            ) => {
                // A return of the main program ends it; then nothing comes next.
                let _ = copy.others.follow(&mut copy.here, step);
            }
            other => copy.here.state.parked = other,
        }
        copy
    }

    /// Computes an expression with the values that the next block would read.
    ///
    /// # Errors
    /// The text is not an expression, or it has no value here: the reason in words.
    pub fn evaluate(&self, text: &str) -> Result<Value, String> {
        let text = text.trim();
        let mut block = Block::default();
        let operand = parse_expression(text, &mut block)
            .ok_or_else(|| format!("`{text}` is not an expression"))?;
        let mut copy = self.settled();
        let (file, shown) = (Arc::from(""), ShownBlockLines::default());
        let raw = RawBlock {
            stretch: Stretch::Block,
            text,
            line: 1,
            offset: 0,
            comments: Comments::Absent,
            plain: false,
            remark: None,
        };
        let at = BlockContext::of_raw(&file, &raw, &block, &shown);
        copy.here.value(operand, &at).map_err(|fault| fault.message)
    }
}
