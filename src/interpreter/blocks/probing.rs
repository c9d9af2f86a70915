//! Blocks whose jump waits for the signal of a probe (R2.91).

use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::outcome::BlockOutcome;
use crate::language::GFunction;
use crate::syntax::ast::{Address, Item};

impl Executor {
    /// Whether the jump of a block waits for the signal of a probe (R2.91).
    pub(crate) fn jump_is_probed(&mut self, outcome: &BlockOutcome, at: &BlockContext<'_>) -> bool {
        if outcome.probes {
            return true;
        }
        let words = at.block.items.iter().filter_map(|item| match item {
            Item::Word(word) => Some(word),
            _ => None,
        });
        let mut numbers = words
            .filter(|word| word.address == Address::Letter(b'G'))
            .filter_map(|word| word.value);
        numbers.any(|number| {
            let number = self.value(number, at);
            number.is_ok_and(|number| number.number().is_none_or(measures))
        })
    }
}

/// G310 measures, and `$GOTO` in its block is taken if the probe answers (TF5200 Programming manual,
/// 206197003). Its effect with the other measuring functions is not documented; they wait for the probe, too.
fn measures(number: f64) -> bool {
    GFunction::of_value(number).is_some_and(GFunction::is_measuring)
}
