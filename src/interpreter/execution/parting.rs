//! The run parts at a condition that only the machine knows (R14.1).

use crate::comp::KindSet;
use crate::interpreter::programs::finder::Finder;
use crate::interpreter::programs::index::EntryIndex;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::options::Branches;
use crate::interpreter::run::other_paths::OtherPaths;
use crate::interpreter::run::path::{BranchSide, Path};
use crate::interpreter::run::shadow::Meeting;
use crate::interpreter::run::state::RunState;
use crate::interpreter::run::step::ControlStep;

impl OtherPaths {
    /// The ways part after the block that asked.
    #[cold]
    pub(crate) fn take_sides(
        &mut self,
        here: &mut Executor,
        step: Option<&ControlStep>,
        finder: &mut dyn Finder,
    ) {
        let sides = std::mem::take(&mut here.sides);
        let meeting = here.meeting(&sides);
        let base = here.state.leave_path();
        self.let_wait(here, sides, meeting, &base, step, finder);
        if self.waiting.is_empty() {
            // No answer is possible: the ways were merged too far to tell. The run can only continue.
            here.enter_path(base);
        } else {
            self.enter_first(here);
        }
    }

    /// The ways that jump part from the one on which the block itself leads elsewhere, which goes on.
    #[cold]
    pub(crate) fn take_jumps(&mut self, here: &mut Executor, finder: &mut dyn Finder) {
        let sides = std::mem::take(&mut here.sides);
        let meeting = here.meeting(&sides);
        let next = here.state.control.frames.running().map(|it| it.next);
        let (own, jumps): (Vec<_>, Vec<_>) =
            sides.into_iter().partition(|side| Some(side.to) == next);
        let mut base = here.state.leave_path();
        self.let_wait(here, jumps, meeting, &base, None, finder);
        if let Some(own) = own.first() {
            let ways = base.track.reach.and(&own.ways);
            if !ways.is_never() {
                base.track.reach = ways;
            }
        }
        here.enter_path(base);
        let ways = here.state.track.reach.clone();
        here.state.go_on_with(ways);
    }

    /// Sides of a question wait at their blocks.
    fn let_wait(
        &mut self,
        here: &mut Executor,
        sides: Vec<BranchSide>,
        meeting: Option<Meeting>,
        base: &Path,
        step: Option<&ControlStep>,
        finder: &mut dyn Finder,
    ) {
        let next = base.control.frames.running().map_or(0, |it| it.next);
        let mut open: Vec<Path> = Vec::new();
        // The answer of a user is the one way that is followed.
        let is_chosen = here.options.branches == Branches::OneFollowed && meeting.is_none();
        for side in sides {
            let ways = base.track.reach.and(&side.ways);
            if ways.is_never() {
                continue;
            }
            here.charge_copies(&base.control, &base.track.reach);
            here.enter_path(base.clone());
            here.state.track.reach = ways;
            let (to, is_back) = (side.to, side.to < next);
            here.state.apply_side(side);
            if let Some(meeting) = meeting.filter(|meeting| meeting.entry != to) {
                here.state.track.shadow.until.get_or_insert(meeting);
            }
            // Ways that lead back join at the loop's head, as other ways do.
            let goes_on = if is_back && !is_chosen {
                self.come_back(here, to, finder)
            } else {
                ControlStep::Jump(to)
            };
            if let ControlStep::Jump(to) = goes_on {
                here.state.control.set_next(to);
                // A program that the block calls runs on each way.
                if let Some(call @ ControlStep::Call(_)) = step
                    && self.follow(here, call.clone()).is_break()
                {
                    here.scratch.covered = false;
                    continue;
                }
                open.push(here.state.leave_path());
            }
        }
        here.version += 1;
        for path in open {
            self.waiting.push(path);
        }
    }
}

impl Executor {
    /// Whether a user has chosen that the block jumps.
    pub(crate) fn is_jump_chosen(&self) -> bool {
        let next = self.state.control.frames.running().map(|it| it.next);
        self.options.branches == Branches::OneFollowed
            && matches!(self.sides.as_slice(), [only] if Some(only.to) != next)
    }

    /// The block at which the sides of a question meet again, where one way is followed and the others are its shadows.
    fn meeting(&self, sides: &[BranchSide]) -> Option<Meeting> {
        if !self.options.follows_one_way() || sides.len() < 2 {
            return None;
        }
        let frames = &self.state.control.frames;
        let frame = frames.running()?;
        let marked = sides.iter().find_map(|side| side.marked);
        let index = self.programs.index(frame.unit);
        let asked = frames.entry().filter(|asked| index.is_linked(*asked));
        let entry = match (marked, asked) {
            (Some(marked), _) => marked.after,
            (None, Some(asked)) => index.links(asked).end + 1,
            (None, None) => frame.next,
        };
        Some(Meeting {
            depth: frames.depth(),
            unit: frame.unit,
            entry,
        })
    }
}

impl RunState {
    fn apply_side(&mut self, side: BranchSide) {
        let control = &mut self.control;
        if let Some(frame) = control.frames.running_mut() {
            frame.seeking = side.seeking;
        }
        if let Some((axis, kind, state)) = side.state {
            control.history.close(axis, KindSet::of(kind));
            control.compensation.decide(axis, kind, state);
        }
        control
            .history
            .narrow(&self.track.reach, &mut control.compensation);
        for (target, value) in &side.values {
            let track = &mut self.track;
            track
                .assumed
                .assume(&mut control.memory, target, value.clone());
        }
        if side.marked.is_some() {
            self.track.marked = side.marked;
        }
        self.track.labels = side.labels;
    }
}

impl ControlState {
    fn set_next(&mut self, to: EntryIndex) {
        if let Some(frame) = self.frames.running_mut() {
            frame.next = to;
        }
    }
}
