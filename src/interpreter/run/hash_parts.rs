//! Parts of `#` commands that determine what the command changes.

use super::block_context::BlockContext;
use crate::interpreter::values::variable::canonical;
use crate::syntax::ast::Declaration;

/// The name that a declaration declares, without its dimensions.
pub(in crate::interpreter) fn declared_name(
    declaration: &Declaration,
    at: &BlockContext<'_>,
) -> String {
    let text = declaration.target.span.of(at.text);
    let name = text.split('[').next().unwrap_or_default();
    canonical(name).into_owned()
}
