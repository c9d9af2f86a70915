//! The budgets of a run (R2.60).

use crate::diagnostic::{Advice, Budget, Code, Diagnostic, Severity};
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::values::cause::Unknown;
use crate::syntax::Fault;
use crate::text::Span;

impl Executor {
    /// FC910 when the next block may not be executed any more.
    #[inline]
    pub(crate) fn over_budget(&self, at: &BlockContext<'_>) -> Option<Diagnostic> {
        let limits = &self.options.limits;
        if self.state.blocks >= limits.blocks {
            return Some(too_many_blocks(limits.blocks, at));
        }
        let is_over = self.state.work.repeated() > limits.repeats;
        is_over.then(|| too_many_repeats(self.state.blocks, at))
    }

    /// FC919, FC908 or FC918 when the block exceeded a budget. Whatever else it could have changed is then unknown:
    /// the run did not reach its end.
    pub(crate) fn used_up(&mut self, at: &BlockContext<'_>) -> Option<Diagnostic> {
        let wrote = std::mem::take(&mut self.scratch.wrote);
        if self.is_past_all_ways() {
            self.havoc_all(&Unknown::Work);
            return Some(too_much_to_follow(at));
        }
        if self.state.work.level() > self.options.limits.work && self.is_exhausted() {
            self.havoc_all(&Unknown::Work);
            return Some(self.too_much_work(at));
        }
        let limit = usize::try_from(self.options.limits.values).unwrap_or(usize::MAX);
        let held = || {
            self.state
                .control
                .memory
                .weight()
                .saturating_add(self.state.control.couplings.len())
        };
        if wrote && held() > limit {
            return Some(too_many_values(limit, at));
        }
        None
    }

    #[cold]
    fn too_much_work(&self, at: &BlockContext<'_>) -> Diagnostic {
        let budget = self.options.limits.work;
        let fault = Fault::new(
            Code::Fc919,
            Span::new(0, at.text.len()),
            format!("this block made more than {budget} units of work beyond its own text"),
        )
        .with_help(Advice::RaiseBudget(Budget::Work));
        let diagnostic = at.diagnostic(fault);
        match self.state.control.frames.running() {
            Some(frame) => self.with_loop(diagnostic, frame.unit, frame.next.saturating_sub(1)),
            None => diagnostic,
        }
    }

    /// The budget's message with the loop that used it up.
    pub(crate) fn with_loop(
        &self,
        diagnostic: Diagnostic,
        unit: usize,
        entry: EntryIndex,
    ) -> Diagnostic {
        let index = self.programs.index(unit);
        match index.innermost_loop(entry) {
            Some(opener) => {
                let place = index.block_place(opener);
                let passes = match self.state.track.passes(unit, opener) {
                    Some(passes) => format!("in this loop, after {passes} passes"),
                    None => "in this loop".to_owned(),
                };
                diagnostic.with_label(place, passes)
            }
            None => diagnostic,
        }
    }
}

/// FC910 at the budget of blocks.
#[cold]
fn too_many_blocks(budget: u64, at: &BlockContext<'_>) -> Diagnostic {
    cut_off(
        format!("more than {budget} blocks were executed; the dry run ends here"),
        at,
    )
}

/// FC910 at the budget of repeated work.
#[cold]
fn too_many_repeats(blocks: u64, at: &BlockContext<'_>) -> Diagnostic {
    cut_off(
        format!("loops and calls go on after {blocks} executed blocks; the dry run ends here"),
        at,
    )
}

/// FC910 of a program that may end: its remaining course is not known, so it is an error (R9.91).
fn cut_off(message: String, at: &BlockContext<'_>) -> Diagnostic {
    let fault = Fault::new(Code::Fc910, Span::new(0, at.text.len()), message)
        .with_help(Advice::RaiseBudget(Budget::Blocks));
    at.diagnostic(fault).raised(Severity::Error)
}

/// FC908 where even what the ways could change takes too long to find.
#[cold]
fn too_much_to_follow(at: &BlockContext<'_>) -> Diagnostic {
    let message = "what the blocks from here on could change takes too much work to find; the dry run ends here, \
                   and everything that a program can change is unknown";
    let fault = Fault::new(Code::Fc908, Span::new(0, at.text.len()), message)
        .with_help(Advice::RaiseBudget(Budget::Ways));
    at.diagnostic(fault)
}

/// FC918.
#[cold]
fn too_many_values(limit: usize, at: &BlockContext<'_>) -> Diagnostic {
    at.diagnostic(
        Fault::new(
            Code::Fc918,
            Span::new(0, at.text.len()),
            format!("the program holds more than {limit} values; a string counts once more for every 32 bytes"),
        )
        .with_help(Advice::RaiseBudget(Budget::Values)),
    )
}
