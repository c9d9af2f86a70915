//! Blocks with a skip mark whose level is not known to be on or off (R2.90).

use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::cycles::RepeatedCall;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::outcome::BlockOutcome;
use crate::interpreter::run::region::Region;
use crate::interpreter::values::cause::Unknown;
use crate::syntax::ast::{Block, Flow, Item};
use crate::text::Span;

impl Interpreter {
    /// Passes over a block that the control may execute or skip: whatever it could change becomes
    /// unknown, and it may lead elsewhere.
    #[cold]
    pub(crate) fn perhaps_execute(
        &mut self,
        level: u8,
        at: &BlockContext<'_>,
        outcome: &mut BlockOutcome,
    ) {
        let cause = Unknown::SkipLevel(level);
        self.note_unknown(&cause, at);
        self.perhaps_refused(&cause, at);
        if let Some((flow, span)) = structure(at.block) {
            outcome.step = self.undecided(flow, &cause, span, at);
            return;
        }
        self.open_undecided(&cause, Span::new(0, at.text.trim_end().len()), at);
        let region = self.havoc_block(at, &cause);
        self.perhaps_repeat_cycles(&region, &cause);
        let next = self
            .state
            .control
            .frames
            .running()
            .map_or(0, |frame| frame.next);
        self.note_exits(&region, next.saturating_sub(1)..=next, &cause, None);
    }

    /// A modal cycle is repeated after the block if the control executes it.
    fn perhaps_repeat_cycles(&mut self, region: &Region, cause: &Unknown) {
        for cycle in self.state.control.cycles.known().to_vec() {
            if cycle.after_motion_only && !region.moves() {
                continue;
            }
            match cycle.call {
                RepeatedCall::Program(found) | RepeatedCall::Perhaps(found) => {
                    let section = self.programs.section(found);
                    let blocks = section.start..section.end;
                    self.havoc_region(found.unit, blocks, cause);
                }
                RepeatedCall::External(program) => self.leave_to_machine(&program),
            }
        }
    }
}

/// The statement of a block that opens, divides or closes a control block.
fn structure(block: &Block) -> Option<(&Flow, Span)> {
    let parts = block.items.iter().filter_map(|item| match item {
        Item::Flow(flow, span) => Some((flow, *span)),
        _ => None,
    });
    let mut parts = parts.filter(|_| !block.jumps);
    parts.find(|(flow, _)| !matches!(flow, Flow::Break | Flow::Continue | Flow::Goto(_)))
}
