//! Memory of the running program: its commands and its first motions; and across programs: the block that made each state other
//! than the start-up state (R1.52, R9.32).

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::comp::{AxisIndex, Compensation, Kind, KindSet, State};
use crate::diagnostic::Diagnostic;
use crate::interpreter::{
    BlockMotion, BlockSite, Certainty, Ended, Executed, FoundOn, KindEffect, MotionKind, MovedAxis,
    Outcome, WayCondition,
};
use crate::text::{Place, Span};

/// Returns the place of words of an executed block.
pub(super) fn place(executed: &Executed<'_>, span: Span) -> Place {
    Place::in_block(executed.file, executed.text, executed.line, span)
}

/// A motion in the state that the program found.
#[derive(Debug, Clone)]
pub(super) struct MovedBefore {
    pub(super) site: Arc<BlockSite>,
    /// The ways on which this or a later motion finds that state.
    on: FoundOn,
    /// The ways as data; empty if the motion happens on all ways.
    pub(super) ways: Vec<Vec<WayCondition>>,
}

/// Effects of the program on one kind of one axis.
#[derive(Debug, Clone, Default)]
pub(super) struct KindMemory {
    /// Whether the program contained a command for the kind.
    pub(super) is_commanded: bool,
    /// The first block that certainly moved the axis, other than by homing, while the kind was, or may have been, as
    /// the program found it.
    pub(super) moved_before: Option<MovedBefore>,
    /// Whether the control refused to move the axis while the kind was as the program found it (R1.36).
    pub(super) refused: bool,
}

impl KindMemory {
    fn move_found(
        &mut self,
        site: &Arc<BlockSite>,
        of: (AxisIndex, Kind),
        executed: &Executed<'_>,
    ) {
        if !executed.found.has(of.0, of.1) {
            return;
        }
        let on = executed.found.on(of.0, of.1);
        let before = self.moved_before.get_or_insert_with(|| MovedBefore {
            site: Arc::clone(site),
            on: on.clone(),
            ways: Vec::new(),
        });
        before.on.or(&on);
        before.ways = executed.found.ways_of(&before.on);
    }
}

/// A motion of an axis of any kind.
#[derive(Debug, Clone)]
pub(super) struct Touch {
    pub(super) site: BlockSite,
    pub(super) kind: MotionKind,
    pub(super) certainty: Certainty,
}

impl Touch {
    pub(super) fn new(motion: &MovedAxis, executed: &Executed<'_>) -> Self {
        let whole = Span::new(0, executed.text.len());
        let has_words = motion.span.end > motion.span.start;
        Self {
            site: BlockSite {
                seq: executed.seq,
                place: place(executed, if has_words { motion.span } else { whole }),
            },
            kind: motion.kind,
            certainty: motion.certainty,
        }
    }
}

/// A message about the state in which a program moves an axis, held back until its end (R18.4).
#[derive(Debug, Clone)]
pub(super) struct Held {
    /// The executed block that it is about.
    pub(super) seq: u64,
    pub(super) said: Diagnostic,
    /// Whether the motion is, or may be, at feed.
    pub(super) is_feed: bool,
}

/// Motions of an axis in a state that something before the program left away from the start-up state (R18.4).
#[derive(Debug, Clone, Default)]
pub(super) struct Inherited {
    /// The first feed move that is certain, and the ways on which such a move comes before any command.
    cut: Option<(Touch, FoundOn)>,
    /// The message about the other motions.
    pub(super) held: Option<Held>,
    /// Whether no further motion changes the message.
    pub(super) is_settled: bool,
}

impl Inherited {
    /// Records a certain feed move. Returns it if it comes before any command on all ways, or the first of several of
    /// which one does so on each way.
    pub(super) fn cut(&mut self, motion: &MovedAxis, executed: &Executed<'_>) -> Option<Touch> {
        let on = executed.found.on(motion.axis, Kind::Frict);
        let touch = || Touch::new(motion, executed);
        if on.is_always() {
            return Some(touch());
        }
        let (first, ways) = self.cut.get_or_insert_with(|| (touch(), on.clone()));
        ways.or(&on);
        ways.is_always().then(|| first.clone())
    }
}

/// A command that changed friction compensation after a feed move of the axis.
#[derive(Debug, Clone)]
pub(super) struct SwitchAfterMove {
    pub(super) axis: AxisIndex,
    /// Whether the axis moved to larger coordinates.
    pub(super) rises: bool,
    /// The state before the command.
    pub(super) before: State,
    pub(super) place: Place,
}

/// Effects of the program on one axis.
#[derive(Debug, Clone, Default)]
pub(super) struct AxisMemory {
    kinds: [KindMemory; Kind::ALL.len()],
    /// The ways that lead to its last counting motion.
    moved_on: Option<FoundOn>,
    /// Whether a command of the program named the axis.
    pub(super) commanded: bool,
    /// Evidence that the axis has moved on all ways that lead to its last motion: in any way, and with certainty.
    settled: Settled,
    /// Motions in a state that was left by something before the program.
    pub(super) inherited: Inherited,
}

/// Settled questions about the first motion of an axis, which may differ between the ways of the program (R14.5).
#[derive(Debug, Clone, Copy, Default)]
struct Settled {
    /// About motions of any kind.
    any: bool,
    /// About certain motions.
    sure: bool,
}

impl AxisMemory {
    pub(super) fn kind(&self, kind: Kind) -> &KindMemory {
        &self.kinds[kind as usize]
    }
}

/// Returns the latest command among those that are last on some way and lead to the state at the end, or away from the
/// start-up state if ways differ (R14.5).
pub(super) fn command_to<'a>(
    ended: &Ended<'a>,
    (axis, kind): (AxisIndex, Kind),
    start_up: &Compensation,
) -> Option<&'a BlockSite> {
    let is_off = match ended.compensation.state(axis, kind) {
        State::Unknown => {
            let mut possible = ended.possible.iter();
            possible.find(|it| (it.axis, it.kind) == (axis, kind))?;
            start_up.state(axis, kind) != State::Inactive
        }
        state => state == State::Inactive,
    };
    let effect = if is_off {
        KindEffect::Off
    } else {
        KindEffect::On
    };
    ended.found.history.latest(axis, kind, effect)
}

/// Returns whether a motion counts for the second run (R1.53, R10.7).
fn counts(motion: &MovedAxis) -> bool {
    motion.certainty == Certainty::Certain && motion.kind != MotionKind::Homing
}

/// Returns whether a form of R10.7 moves, or may move, the axis; not if nothing about the motion is known.
pub(super) fn is_of_a_kind(motion: &MovedAxis) -> bool {
    motion.certainty == Certainty::Certain || motion.kind != MotionKind::Unknown
}

/// Effects of the program.
#[derive(Debug, Clone)]
pub(super) struct ProgramEffects {
    axes: Vec<AxisMemory>,
    /// The axes that have moved, one bit each by their positions modulo 64.
    moved: u64,
    /// Whether no two axes share a bit.
    is_alone: bool,
}

impl ProgramEffects {
    pub(super) fn new(axes: usize) -> Self {
        Self {
            axes: vec![AxisMemory::default(); axes],
            moved: 0,
            is_alone: axes <= 64,
        }
    }

    pub(super) fn axis(&self, axis: AxisIndex) -> &AxisMemory {
        &self.axes[axis.get()]
    }

    /// Records a command that the control accepted.
    pub(super) fn command(&mut self, axis: AxisIndex, outcome: &Outcome) {
        let memory = &mut self.axes[axis.get()];
        memory.commanded = true;
        for kind in outcome.command.selection.kinds().iter() {
            memory.kinds[kind as usize].is_commanded = true;
        }
    }

    /// Returns whether an axis word of the block may be the first to move its axis.
    #[inline]
    pub(super) fn has_new(&self, moves: &BlockMotion) -> bool {
        moves.named() & !self.moved != 0
    }

    /// Returns whether none of these motions is new.
    pub(super) fn knows_all(&self, motions: &[MovedAxis]) -> bool {
        let is_known = |motion: &MovedAxis| {
            let memory = &self.axes[motion.axis.get()];
            (memory.settled.any || !is_of_a_kind(motion))
                && (memory.settled.sure || !counts(motion))
                && memory.inherited.is_settled
        };
        motions.iter().all(is_known)
    }

    /// Records a motion. Returns whether it is the first of its axis on any way.
    pub(super) fn moved(&mut self, motion: &MovedAxis, executed: &Executed<'_>) -> bool {
        let memory = &mut self.axes[motion.axis.get()];
        let is_on_all_ways = executed.branch.is_none();
        // On the same ways, a later motion finds no state that the earlier one did not find.
        let is_known = memory
            .moved_on
            .as_ref()
            .is_some_and(|on| on.is_all_of(executed.found));
        if counts(motion) && !memory.settled.sure && !is_known {
            memory.moved_on = Some(executed.found.on_all());
            let site = Arc::new(Touch::new(motion, executed).site);
            for (kind, memory) in Kind::ALL.into_iter().zip(&mut memory.kinds) {
                memory.move_found(&site, (motion.axis, kind), executed);
            }
            memory.settled.sure = is_on_all_ways;
        }
        if self.is_alone && memory.settled.sure && memory.inherited.is_settled {
            self.moved |= 1 << (motion.axis.get() % 64);
        }
        let is_new = !memory.settled.any && is_of_a_kind(motion);
        if is_new {
            memory.settled.any = is_on_all_ways;
        }
        is_new
    }

    /// Records a motion that the control refuses because a required kind is missing (R1.36).
    pub(super) fn refused(&mut self, axis: AxisIndex, required: KindSet, executed: &Executed<'_>) {
        for kind in required.iter() {
            let memory = &mut self.axes[axis.get()].kinds[kind as usize];
            memory.refused |= executed.found.has(axis, kind);
        }
    }

    /// Returns the motions of an axis in the state that the program found.
    pub(super) fn inherited(&mut self, axis: AxisIndex) -> &mut Inherited {
        &mut self.axes[axis.get()].inherited
    }

    /// Returns the messages held back until the end.
    pub(super) fn held(&mut self) -> impl Iterator<Item = Held> {
        let axes = self.axes.iter_mut();
        axes.filter_map(|axis| axis.inherited.held.take())
    }
}

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

/// Report of a state left away from its start-up state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum LeftAwayNotice {
    /// Not reported.
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
