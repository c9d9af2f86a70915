//! Parts of `#` commands that determine what the command changes.

use super::block_context::BlockContext;
use crate::syntax::VariableName;
use crate::syntax::ast::Declaration;

/// The name that a declaration declares, without its dimensions.
pub(crate) fn declared_name(declaration: &Declaration, at: &BlockContext<'_>) -> VariableName {
    VariableName::array_of(declaration.target.span.of(at.text))
}
