//! `#WAIT FOR`: the program waits until a condition holds (R2.99; PM/207058059).

use crate::diagnostic::Code;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::event::EndedBy;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::outcome::BlockOutcome;
use crate::interpreter::run::step::ControlStep;
use crate::interpreter::values::location::Location;
use crate::interpreter::values::plain::{Truth, conclusions, is_written_by_machine};
use crate::syntax::Fault;
use crate::syntax::ast::{Hash, Operand};

impl Executor {
    /// The condition holds after the block, and its plain conclusions are held as values that the program set.
    pub(crate) fn wait_for(
        &mut self,
        hash: &Hash,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) -> Result<(), Box<Fault>> {
        self.pass_over(hash.command.words, hash.span, at);
        // The PLC acts while the program waits, not after it.
        self.let_plc_act();
        self.scratch.plc_acts = false;
        let Some(&condition) = hash.arguments.first() else {
            return Ok(());
        };
        let value = self.value(condition, at)?;
        let Operand::Expression(expression) = condition else {
            if value.truth() == Some(false) {
                self.wait_for_ever(hash, at, outcome);
            }
            return Ok(());
        };
        if value.truth() == Some(false)
            && !is_written_by_machine(at.block, at.text, expression, &self.externals)
        {
            self.wait_for_ever(hash, at, outcome);
            return Ok(());
        }
        if value.truth() != Some(true) {
            for (target, value) in conclusions(at.block, at.text, expression, Truth::Holds) {
                if let Location::Variable(name) = &target
                    && self.externals.may_change(name)
                {
                    self.write(&target, value);
                    self.state.control.memory.hold(name, at.as_setter());
                }
            }
        }
        Ok(())
    }

    /// FC909: nothing that the condition reads can change while the program waits.
    fn wait_for_ever(&mut self, hash: &Hash, at: &BlockContext<'_>, outcome: &mut BlockOutcome) {
        let condition = hash.code(at.text);
        let condition = condition.trim();
        let message = format!(
            "this wait never ends: `{condition}` does not hold, and only the program could change that"
        );
        let fault = Fault::new(Code::Fc909, hash.span, message)
            .with_help("wait for a value that the machine writes, `#WAIT FOR V.E.READY == 1`");
        self.scratch.diagnostics.push(at.diagnostic(fault));
        self.scratch.endless = true;
        outcome.step = Some(ControlStep::End(EndedBy::Budget));
    }
}
