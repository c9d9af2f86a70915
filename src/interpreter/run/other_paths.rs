//! The paths of a run beside the one that is executed.

use serde::{Deserialize, Serialize};

use super::call_effects::CallEffects;
use super::control::ControlState;
use super::executor::Executor;
use super::loop_heads::LoopHeads;
use super::path::Path;
use super::waiting_paths::WaitingPaths;
use crate::diagnostic::Diagnostic;

/// The paths of a run beside the one that is executed: those that wait at their blocks, and the states in which others
/// were at the heads of loops and in calls.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct OtherPaths {
    pub(crate) waiting: WaitingPaths,
    /// The loops that are joined at their heads.
    pub(crate) loop_heads: LoopHeads,
    /// The effects of programs that were called on other ways.
    pub(crate) call_effects: CallEffects,
    /// How often the program has used up its budget of ways.
    pub(crate) widened: u64,
    /// Messages on paths that joined before the current block.
    #[serde(skip)]
    pub(crate) joined: Vec<Diagnostic>,
    /// Such messages that are withheld, because they were reported before or nothing differs.
    #[serde(skip)]
    pub(crate) joined_withheld: Vec<Diagnostic>,
}

impl OtherPaths {
    /// The paths on which the run goes on elsewhere than after a block that it passes over wait there.
    pub(crate) fn let_leave(&mut self, here: &mut Executor) {
        for path in here.scratch.left.drain(..) {
            self.waiting.push(path);
        }
    }

    /// The states that are kept of loops and calls.
    pub(crate) fn kept(&self) -> impl Iterator<Item = &Path> {
        self.loop_heads.states().chain(self.call_effects.states())
    }

    /// The states of the control on all of them.
    pub(crate) fn controls_mut(&mut self) -> impl Iterator<Item = &mut ControlState> {
        let kept = self.loop_heads.states_mut();
        let kept = kept.chain(self.call_effects.states_mut());
        let paths = self.waiting.iter_mut().chain(kept);
        paths.map(|path| &mut path.control)
    }
}
