//! Descriptions of geometry, whose blocks do not move (R2.81).

use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::description::Description;
use crate::syntax::ast::Hash;

impl ControlState {
    /// The blocks up to the end describe geometry.
    pub(crate) fn describe(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        if self.described.is_none() {
            self.described = Some(Box::new(Description {
                opener: hash.command.row(),
                place: at.place(hash.span),
                before: self.modal.clone(),
            }));
        }
    }

    /// A command ends the description that it belongs to, where that is open. Returns whether it does.
    pub(crate) fn end_description(&mut self, end: &str) -> bool {
        let open = self
            .described
            .take_if(|open| open.opener.until == Some(end));
        if let Some(open) = &open {
            self.modal.end_description(&open.before);
        }
        open.is_some()
    }

    /// FC208: the program ends inside a description.
    pub(crate) fn open_description(&mut self) -> Option<Diagnostic> {
        let open = self.described.take()?;
        let end = open.opener.until?;
        let message = format!("`{}` has no `{end}`", open.opener.words);
        let help = format!("write `{end}` in a separate block");
        Some(Diagnostic::new(Code::Fc208, open.place, message).with_help(help))
    }
}
