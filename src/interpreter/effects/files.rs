//! `#FILE RENAME`, `#FILE DELETE`, `#FILE EXIST` and what they do to the programs that are called (R2.108;
//! PM/207511947, PM/207518603, PM/207524491).

use crate::interpreter::programs::finder::Finder;
use crate::interpreter::programs::store::Caller;
use crate::interpreter::programs::wanted::WantedCall;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::outcome::{BlockOutcome, LookedFor};
use crate::interpreter::values::cause::{MissingProgram, Unknown};
use crate::interpreter::values::value::Value;
use crate::language::FileAction;
use crate::syntax::VariableName;
use crate::syntax::ast::{CallScope, Hash};
use crate::text::Span;

/// The variable with the result of `#FILE EXIST`.
const RESULT: &str = "V.G.FILE_EXIST";

impl Executor {
    /// Executes a command on a file.
    pub(crate) fn file_command(
        &mut self,
        action: FileAction,
        hash: &Hash,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) {
        self.pass_over(hash.command.words, hash.span, at);
        let named = |key| hash.brackets.after(key, at.text);
        let name = |key| named(key).and_then(|argument| argument.quoted(at.text));
        let files = &mut self.state.control.files;
        match action {
            FileAction::Rename => {
                files.change(name("PATHOLD"));
                files.change(name("PATHNEW"));
            }
            FileAction::Delete => files.change(name("PATH")),
            FileAction::Message => files.write_message(),
            FileAction::LookFor => {
                outcome.looks_for = Some(match name("PATH") {
                    Some(name) => LookedFor::Named(name.to_owned()),
                    None => LookedFor::Computed,
                });
            }
        }
    }

    /// The result of `#FILE EXIST`: 1 for a file that is here. One that is not here may be on the machine.
    #[cold]
    pub(crate) fn look_for_file(
        &mut self,
        file: LookedFor,
        at: &BlockContext<'_>,
        finder: &mut dyn Finder,
    ) {
        let name = match file {
            LookedFor::Named(name) => Some(name),
            LookedFor::Computed => None,
        };
        let unit = self.state.control.frames.running().map_or(0, |it| it.unit);
        let caller = Caller {
            unit,
            file: at.file,
        };
        let is_changed = |name: &String| self.state.control.files.has(name);
        let wanted = name.clone().filter(|name| !is_changed(name));
        let wanted = wanted
            .map(|name| WantedCall::program(CallScope::Global, name, Span::new(0, at.text.len())));
        let found = wanted.and_then(|wanted| {
            let found = self
                .programs
                .find(&wanted, caller, finder, &self.state.work);
            found.ok().flatten()
        });
        let value = match (&found, &name) {
            (Some(_), _) => Value::Number(1.0),
            (None, Some(name)) => Value::Unknown(Unknown::Program(MissingProgram::Named(
                name.as_str().into(),
            ))),
            (None, None) => Value::Unknown(Unknown::text(RESULT)),
        };
        let result = VariableName::read(RESULT);
        self.state.control.memory.set_variable(&result, value);
        self.scratch.wrote = true;
        let files = &mut self.state.control.files;
        match found {
            Some(_) => files.find(),
            None => files.miss(name.as_deref()),
        }
    }
}
