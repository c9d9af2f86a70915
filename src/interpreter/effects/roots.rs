//! Origins of unknown values, and the messages on them (R2.95).

use crate::diagnostic::Diagnostic;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::mentioned::MentionedUnknowns;
use crate::interpreter::values::cause::Unknown;
use crate::syntax::Fault;
use crate::text::Span;

impl Executor {
    /// Adds a message about an unknown value once per program (FC902); again only where `what` differs.
    pub(crate) fn tell_once(
        &mut self,
        cause: &Unknown,
        what: &str,
        fault: Fault,
        at: &BlockContext<'_>,
    ) {
        let span = fault.span;
        let said = at.diagnostic(fault);
        let said = self.state.mentioned.with_origin(said, cause, at);
        self.state.mentioned.enter_root(cause, span, at);
        if self
            .state
            .mentioned
            .is_new(cause, [what.to_owned()], &said.place)
        {
            self.scratch.diagnostics.push(said);
        } else {
            self.scratch.aside.withheld.push(said);
        }
    }
}

impl MentionedUnknowns {
    /// Remembers where an unknown value first occurred.
    pub(crate) fn enter_root(&mut self, cause: &Unknown, span: Span, at: &BlockContext<'_>) {
        self.enter(cause, || at.place(at.in_block(span)));
    }

    /// Adds to the message the block where the value first occurred, unless its own block shows it.
    pub(crate) fn with_origin(
        &self,
        said: Diagnostic,
        cause: &Unknown,
        at: &BlockContext<'_>,
    ) -> Diagnostic {
        let is_shown = cause.is_shown_in(at.text) || at.block.skip.is_some();
        let origin = self.origin(cause).filter(|_| !is_shown);
        match origin {
            Some(origin) if (&origin.file, origin.first_line) != (at.file, at.line) => {
                said.with_label(origin.clone(), "the unknown value comes from here")
            }
            _ => said,
        }
    }
}
