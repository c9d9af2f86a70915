//! Ways that leave the one of the dry run (R2.51, R2.52).

use std::ops::RangeInclusive;

use crate::comp::AxisIndex;
use crate::interpreter::programs::index::{EntryIndex, ProgramId};
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::interpreter::Interpreter;
use crate::interpreter::run::options::StopPolicy;
use crate::interpreter::run::region::{Exit, Region};
use crate::interpreter::run::state::State;
use crate::interpreter::run::ways::{AxisKinds, Branch, JumpTarget, WayEnd};
use crate::interpreter::values::cause::Unknown;
use crate::interpreter::values::work_budget::ITEM;
use crate::text::Span;

impl Interpreter {
    /// The ways that leave a region of the running program.
    pub(crate) fn note_exits(
        &mut self,
        region: &Region,
        passed: RangeInclusive<EntryIndex>,
        cause: &Unknown,
        say: Option<Span>,
    ) {
        let Some(place) = self.state.control.frames.program() else {
            return;
        };
        self.state.note_ends(region, cause);
        self.note_refusal(region, cause);
        for exit in &region.exits {
            let labels = self.aims(exit, place);
            for to in labels {
                if !matches!(to, JumpTarget::Block(target) if passed.contains(&target)) {
                    self.note_leaving(to, *passed.end());
                    self.departing.push(Branch {
                        to,
                        cause: cause.clone(),
                        here: *passed.end(),
                        say,
                    });
                }
            }
        }
    }

    /// The way that a refused command of a region ends; what is refused is reported at its block.
    fn note_refusal(&mut self, region: &Region, cause: &Unknown) {
        let is_coupled = self.state.control.couplings.len() > 0 || region.couples();
        if region.is_refused || (is_coupled && region.switches()) {
            self.note_stop(cause);
        }
    }

    /// A way that an error ends somewhere in what may be executed.
    pub(crate) fn note_stop(&mut self, cause: &Unknown) {
        if self.options.stop != StopPolicy::KeepGoing {
            self.departing.push(Branch {
                to: JumpTarget::End,
                cause: cause.clone(),
                here: 0,
                say: None,
            });
        }
    }

    /// The ways that leave a called program and do not come back to its caller.
    pub(crate) fn note_far_exits(&mut self, region: &Region, cause: &Unknown) {
        self.state.note_ends(region, cause);
        self.note_refusal(region, cause);
        for exit in &region.exits {
            let to = match exit {
                Exit::End => JumpTarget::End,
                Exit::Far => JumpTarget::Far,
                Exit::Label(_) | Exit::AnyLabel | Exit::Block(_) | Exit::Return => continue,
            };
            self.note_leaving(to, 0);
            self.departing.push(Branch {
                to,
                cause: cause.clone(),
                here: 0,
                say: Some(Span::default()),
            });
        }
    }

    /// Notes a jump that may be taken. Returns whether anything differs if it is.
    pub(crate) fn note_jump(&mut self, exit: &Exit, cause: &Unknown) -> bool {
        let Some(frame) = self.state.control.frames.running() else {
            return false;
        };
        let here = frame.next;
        // A missing label stops the control.
        let mut differs = matches!(exit, Exit::AnyLabel);
        for to in self.aims(exit, frame.program()) {
            if to != JumpTarget::Block(here) {
                differs = differs || self.differs(to, here);
                self.departing.push(Branch {
                    to,
                    cause: cause.clone(),
                    here,
                    say: None,
                });
            }
        }
        differs
    }

    pub(crate) fn aims(&self, exit: &Exit, program: ProgramId) -> Vec<JumpTarget> {
        let ProgramId { unit, section } = program;
        let index = self.programs.index(unit);
        match exit {
            Exit::Label(name) => index
                .label(section, name.clone())
                .map(JumpTarget::Block)
                .into_iter()
                .collect(),
            Exit::AnyLabel => {
                let labels: Vec<JumpTarget> =
                    index.labels(section).map(JumpTarget::Block).collect();
                self.state.work.charge_region(ITEM * labels.len());
                labels
            }
            Exit::Block(target) => vec![JumpTarget::Block(*target)],
            Exit::Return => vec![JumpTarget::Return],
            Exit::Far => vec![JumpTarget::Far],
            Exit::End => vec![JumpTarget::End],
        }
    }
}

impl State {
    /// The program ends of a region, which may be reached with the current state (R1.58).
    fn note_ends(&mut self, region: &Region, cause: &Unknown) {
        if region.ends.is_empty() {
            return;
        }
        let kinds = self.control.all_kinds();
        for &(place, by) in &region.ends {
            self.track.ways.note_end(WayEnd {
                place,
                by,
                cause: cause.clone(),
                kinds: kinds.clone(),
            });
        }
    }
}

impl ControlState {
    /// Returns the selected and unknown kinds of each axis.
    pub(crate) fn all_kinds(&self) -> Vec<AxisKinds> {
        let compensation = &self.compensation;
        let axes = (0..compensation.len()).map(AxisIndex::new);
        let kinds = axes.map(|axis| AxisKinds {
            selected: compensation.selected(axis),
            unknown: compensation.unknown(axis),
        });
        kinds.collect()
    }
}
