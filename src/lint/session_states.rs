//! Memory across programs: the block that made each state other than the start-up state (R1.52, R9.32).

use serde::{Deserialize, Serialize};

use super::memory::command_to;
use crate::comp::{AxisIndex, Compensation, Kind, KindSet, State};
use crate::interpreter::{BlockSite, Ended};

/// The most characters of a block's text that are kept.
const MAX_TEXT: usize = 400;

/// The block that caused a state.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Maker {
    /// The name of the main program after `%`, else its file.
    pub program: String,
    /// The file that contains the block, as the user named it.
    pub file: String,
    /// The line of the block.
    pub line: u32,
    /// The text of the block.
    pub text: String,
}

impl Maker {
    fn new(program: &str, site: &BlockSite) -> Self {
        let place = &site.place;
        Self {
            program: program.to_owned(),
            file: place.file.to_string(),
            line: place.first_line,
            text: place.text.chars().take(MAX_TEXT).collect(),
        }
    }
}

/// Whether a state left away from its start-up state was reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum LeftAwayNotice {
    /// It was not reported.
    #[default]
    No,
    /// FC401 or FC407 was reported for a program of this session.
    Said,
    /// The user silenced it.
    Silenced,
}

/// A state that may be away from its start-up state.
#[derive(Debug, Clone, Default)]
struct Away {
    maker: Option<Maker>,
    notice: LeftAwayNotice,
}

/// States left by the programs of a session, and the states at the start of the control.
#[derive(Debug, Clone)]
pub(crate) struct SessionStates {
    pub(super) start_up: Compensation,
    axes: Vec<[Away; Kind::ALL.len()]>,
    /// The kinds of each axis that nothing has switched since the start of the control.
    unswitched: Vec<KindSet>,
}

impl SessionStates {
    pub(crate) fn new(start_up: Compensation) -> Self {
        Self {
            axes: vec![Default::default(); start_up.len()],
            unswitched: vec![KindSet::ALL; start_up.len()],
            start_up,
        }
    }

    /// Returns the state at the start of the control (R1.22).
    pub(crate) fn start_up(&self, axis: AxisIndex, kind: Kind) -> State {
        self.start_up.state(axis, kind)
    }

    /// Returns the block that made a state; `None` if that is unknown.
    pub(crate) fn maker(&self, axis: AxisIndex, kind: Kind) -> Option<&Maker> {
        self.axes[axis.get()][kind as usize].maker.as_ref()
    }

    pub(crate) fn notice(&self, axis: AxisIndex, kind: Kind) -> LeftAwayNotice {
        self.axes[axis.get()][kind as usize].notice
    }

    pub(crate) fn set_notice(&mut self, axis: AxisIndex, kind: Kind, notice: LeftAwayNotice) {
        self.axes[axis.get()][kind as usize].notice = notice;
    }

    /// Returns the kinds of an axis that nothing has switched since the start of the control.
    pub(super) fn unswitched(&self, axis: AxisIndex) -> KindSet {
        self.unswitched[axis.get()]
    }

    /// Marks the states of an axis as left by an earlier session.
    pub(crate) fn inherit(&mut self, axis: AxisIndex) {
        self.unswitched[axis.get()] = KindSet::NONE;
    }

    /// Takes over the block that an earlier session recorded.
    pub(crate) fn restore(&mut self, axis: AxisIndex, kind: Kind, maker: Maker) {
        self.axes[axis.get()][kind as usize].maker = Some(maker);
    }

    /// Records the effects of an ended program on the states that it leaves.
    pub(super) fn program_ended(&mut self, program: &str, ended: &Ended<'_>) {
        let left = ended.compensation;
        for (position, kinds) in self.axes.iter_mut().enumerate() {
            let axis = AxisIndex::new(position);
            for (kind, away) in Kind::ALL.into_iter().zip(kinds) {
                let last = ended.found.history.last(axis, kind);
                if last.is_some() {
                    self.unswitched[position].remove(kind);
                }
                if left.state(axis, kind) == self.start_up.state(axis, kind) {
                    *away = Away::default();
                    continue;
                }
                let command = command_to(ended, (axis, kind), &self.start_up);
                if let Some(site) = command.or(last.map(|(_, site)| site)) {
                    *away = Away {
                        maker: Some(Maker::new(program, site)),
                        notice: LeftAwayNotice::No,
                    };
                }
            }
        }
    }
}
