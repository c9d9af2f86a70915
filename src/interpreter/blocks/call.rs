//! Calls: which program is meant (R2.13 to R2.16).

use std::collections::BTreeMap;

use crate::diagnostic::Code;
use crate::interpreter::programs::wanted::WantedCall;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::cycles::after_motion_only;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::values::expression::unquoted;
use crate::interpreter::values::value::Value;
use crate::syntax::Fault;
use crate::syntax::ast::{Call, CallName, CallScope, Operand};
use crate::text::Span;

impl Executor {
    /// Returns the program that a call statement names; `None` where the name is not known offline (R2.52).
    pub(crate) fn wanted(
        &mut self,
        call: &Call,
        at: &BlockContext<'_>,
    ) -> Result<Option<WantedCall>, Box<Fault>> {
        let name = self.called_name(call.name, at)?;
        let mut own = BTreeMap::new();
        for (index, operand) in &call.arguments {
            own.insert(*index, self.value(*operand, at)?);
        }
        for (_, operand) in &call.words {
            self.value(*operand, at)?;
        }
        match name {
            Value::Text(name) => Ok(Some(WantedCall {
                scope: call.scope,
                name: name.trim().to_owned(),
                own,
                span: at.in_block(call.span),
                named: named(call.name, at),
                form: call.form,
                repeat: after_motion_only(call),
                part: None,
                word: None,
            })),
            Value::Unknown(cause) => {
                self.havoc_by_call(&cause);
                if call.scope == CallScope::Local {
                    self.pass_over_locals(&cause);
                }
                if self.scratch.unread.get() {
                    return Ok(None);
                }
                let what = "which program is called";
                self.tell_unknown(what, "the call is passed over", &cause, call.span, at);
                Ok(None)
            }
            Value::Number(_) => Err(Box::new(Fault::new(
                Code::Fc312,
                call.span,
                "a number is not a program name",
            ))),
        }
    }

    /// The name of a called program.
    pub(crate) fn called_name(
        &mut self,
        name: CallName,
        at: &BlockContext<'_>,
    ) -> Result<Value, Box<Fault>> {
        Ok(match name {
            CallName::Literal(span) => Value::Text(span.of(at.text).into()),
            CallName::Quoted(span) => {
                let name = unquoted(span.of(at.text));
                self.state.control.memory.macro_or_text(name)
            }
            CallName::Variable(place) => self.value(Operand::Expression(place), at)?,
        })
    }
}

/// Returns the span of a program's name in its block, without quotes.
fn named(name: CallName, at: &BlockContext<'_>) -> Option<Span> {
    let span = match name {
        CallName::Literal(span) | CallName::Quoted(span) => span,
        CallName::Variable(_) => return None,
    };
    let name = unquoted(span.of(at.text)).trim();
    let start = span.start as usize + span.of(at.text).find(name)?;
    at.used
        .is_none()
        .then(|| Span::new(start, start + name.len()))
}
