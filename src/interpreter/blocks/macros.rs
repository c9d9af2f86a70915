//! Macros whose code limits what shares the block with them, or is not known (R2.35).

use crate::diagnostic::Code;
use crate::interpreter::run::block_context::{BlockContext, MacroCode};
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::lone_part::LonePart;
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::expression::unquoted;
use crate::syntax::Fault;
use crate::text::Span;

impl Executor {
    /// Reports what shares the block with a macro and must not, or perhaps not.
    pub(crate) fn check_sharing(
        &mut self,
        code: &MacroCode<'_>,
        span: Span,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        let inner = self.scratch.lone.take();
        let Some(lone) = LonePart::of(code).or(inner) else {
            return Ok(());
        };
        let Some(conflict) = lone.conflict(at.block, span) else {
            // The macro may be part of another one.
            self.scratch.lone = Some(lone).filter(|_| at.macro_depth > 0);
            return Ok(());
        };
        let name = unquoted(span.of(at.text));
        let shown = conflict.of(at.text).trim();
        let fault = if lone.leaves_rest_open() {
            self.havoc_by_call(&Unknown::text(shown));
            let what = lone.as_str();
            let message = format!(
                "`{shown}` is in the same block as {what} in the code of macro `{name}`; whether the control executes \
                 it is not known, and whatever it could change is unknown from here on"
            );
            Fault::new(Code::Fc210, conflict, message).with_help("write it in a separate block")
        } else {
            let message = format!(
                "`{shown}` follows a call in the code of macro `{name}`, where the control accepts nothing"
            );
            Fault::new(Code::Fc207, conflict, message)
                .with_help("write it before the macro, or in the next block")
        };
        Err(Box::new(fault))
    }

    /// A macro with unknown code, which may do anything (R2.51).
    pub(crate) fn lost_macro(
        &mut self,
        span: Span,
        name: &str,
        cause: &Unknown,
        at: &BlockContext<'_>,
    ) -> Box<Fault> {
        self.havoc_by_call(cause);
        let what = cause.seen_from(at.file);
        let message = format!(
            "what macro `{name}` does depends on {what}; whatever it could change is unknown from here on"
        );
        let fault = Fault::new(Code::Fc901, span, message);
        Box::new(fault.with_help(cause.advice()))
    }
}
