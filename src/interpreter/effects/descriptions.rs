//! Descriptions of geometry, whose blocks do not move (R2.81).

use crate::diagnostic::{Code, Diagnostic};
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::description::Description;
use crate::syntax::ast::Hash;

/// The commands between which blocks describe geometry and do not move: the contour for a cycle
/// (tf5293, 717505035), a stroke, the limits of an area (tccncprogramming, 15557317259).
pub(in crate::interpreter) const DESCRIPTIONS: [(&str, &str); 3] = [
    ("#CONTOUR BEGIN", "#CONTOUR END"),
    ("#STROKE DEF BEGIN", "#STROKE DEF END"),
    ("#CONTROL AREA BEGIN", "#CONTROL AREA END"),
];

/// Returns the command that ends the description which a command opens.
pub(in crate::interpreter) fn description_end(opener: &str) -> Option<&'static str> {
    let row = DESCRIPTIONS.iter().find(|(begin, _)| *begin == opener);
    row.map(|(_, end)| *end)
}

impl ControlState {
    /// The blocks up to the end describe geometry.
    pub(in crate::interpreter) fn describe(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        if self.described.is_none() {
            self.described = Some(Box::new(Description {
                opener: hash.name.clone(),
                place: at.place(hash.span),
                before: self.modal.clone(),
            }));
        }
    }

    /// Whether a command ends the description that is open.
    pub(in crate::interpreter) fn ends_description(&self, name: &str) -> bool {
        let open = self.described.as_ref();
        open.is_some_and(|open| description_end(&open.opener) == Some(name))
    }

    /// FC208: the program ends inside a description.
    pub(in crate::interpreter) fn open_description(&mut self) -> Option<Diagnostic> {
        let open = self.described.take()?;
        let end = description_end(&open.opener)?;
        let message = format!("`{}` has no `{end}`", open.opener);
        let help = format!("write `{end}` in a separate block");
        Some(Diagnostic::new(Code::Fc208, open.place, message).with_help(help))
    }
}
