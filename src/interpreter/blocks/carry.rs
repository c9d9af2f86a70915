//! The axes that a block moves without axis words (R10.7): those with a command in their bracket,
//! followers of another axis, axes of a rotated or transformed frame.

use std::collections::BTreeMap;

use crate::comp::AxisIndex;
use crate::interpreter::blocks::pace::AxisBracket;
use crate::interpreter::coordinates::moving::MovedAxis;
use crate::interpreter::effects::couple::gear_of;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::values::work_budget::ITEM;
use crate::language::{AxisAction, AxisWords, Certainty, HashCommand, MotionKind, Moves};
use crate::syntax::ast::{BracketArguments, Hash};
use crate::text::Span;

impl Executor {
    /// A command in the bracket of an axis.
    pub(crate) fn move_by_bracket(&mut self, bracket: AxisBracket<'_>, at: &BlockContext<'_>) {
        let Some(axis) = self.axis_named(bracket.name) else {
            return;
        };
        let span = bracket.span;
        if bracket.command.action == AxisAction::EndFollowing {
            self.state.control.couplings.unfollow(&gear_of(axis));
        }
        let Some(row) = bracket.command.motion else {
            return;
        };
        self.see(axis);
        self.state.control.modal.havoc_position(axis);
        if row.moves == Moves::Follower {
            self.gear_in(axis, bracket.arguments, at);
            return;
        }
        self.scratch.also_moved.push(MovedAxis {
            axis,
            span,
            kind: row.kind,
            certainty: row.certainty,
        });
    }

    /// A `#` command that moves axes at once.
    pub(crate) fn command_motion(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let row = hash.command.motion;
        let Some(row) = row.filter(|row| row.moves == Moves::NamedOrAll) else {
            return;
        };
        let named = self.axes_in(&hash.brackets, at.text);
        let axes = if named.is_empty() {
            self.path_axes()
        } else {
            named
        };
        for axis in axes {
            self.scratch.also_moved.push(MovedAxis {
                axis,
                span: hash.span,
                kind: row.kind,
                certainty: row.certainty,
            });
        }
    }

    /// `#ROTATION ON [ANGLE=30]`: whether a motion along one axis of the plane certainly moves the other
    /// one, too.
    pub(crate) fn rotate(&mut self, arguments: &BracketArguments, at: &BlockContext<'_>) {
        let angle = arguments.after("ANGLE", at.text);
        let angle = angle.and_then(|angle| self.argument_number(angle, at));
        self.state.control.modal.skewed = angle.is_some_and(|angle| angle % 90.0 != 0.0);
    }

    /// Notes the axes that move along with those that the block moves.
    #[inline]
    pub(crate) fn carry_along(&mut self, words: AxisWords) {
        let carries = self.state.control.couplings.carry()
            || !self.state.control.modal.transformed.is_empty()
            || self.scratch.word_row.is_some();
        if carries && self.state.control.described.is_none() {
            self.carry(words);
        }
    }

    #[inline(never)]
    fn carry(&mut self, words: AxisWords) {
        let row = self.scratch.word_row;
        if let Some(row) = row.filter(|row| row.certainty == Certainty::Possible) {
            self.leave_to_operator(row.kind, row.moves);
        }
        if matches!(words, AxisWords::Motion | AxisWords::Measuring) {
            self.move_in_frame();
        }
        self.move_followers(words);
    }

    /// In manual mode the operator moves axes.
    fn leave_to_operator(&mut self, kind: MotionKind, moves: Moves) {
        let words: Vec<_> = self
            .scratch
            .moved
            .iter()
            .map(|it| (it.axis, it.span))
            .collect();
        let axes = if words.is_empty() && moves == Moves::WordsOrAll {
            let all = self.path_axes().into_iter();
            all.map(|axis| (axis, Span::default())).collect()
        } else {
            words
        };
        for (axis, span) in axes {
            self.scratch.also_moved.push(MovedAxis {
                axis,
                span,
                kind,
                certainty: Certainty::Possible,
            });
        }
    }

    /// Every axis that words can move.
    fn path_axes(&self) -> Vec<AxisIndex> {
        let axes = self.machine.axes.iter().enumerate();
        let axes = axes.filter(|(_, axis)| !axis.is_spindle());
        axes.map(|(position, _)| AxisIndex::new(position)).collect()
    }

    /// Those of X, Y and Z that the machine has.
    fn main_axes(&self) -> Vec<AxisIndex> {
        let letters = [b'X', b'Y', b'Z'].map(|it| self.letter_axis(it));
        letters.into_iter().flatten().collect()
    }

    /// The axes of the active plane; all main axes where it is not known.
    pub(crate) fn plane_axes(&self) -> Vec<AxisIndex> {
        match [self.main_axis(b'X'), self.main_axis(b'Y')] {
            [Some(first), Some(second)] => vec![first, second],
            _ => self.main_axes(),
        }
    }

    /// The axes of a frame, and whether each certainly moves with another of them.
    fn frame(&self, name: &str) -> Option<(Vec<AxisIndex>, Certainty)> {
        let row = HashCommand::named(name)?.motion?;
        Some(match row.moves {
            Moves::Plane => {
                let axes = self.plane_axes();
                let is_known = [b'X', b'Y'].iter().all(|it| self.main_axis(*it).is_some());
                let is_sure = is_known && self.state.control.is_skewed();
                let certainty = if is_sure {
                    row.certainty
                } else {
                    Certainty::Possible
                };
                (axes, certainty)
            }
            Moves::Main => (self.main_axes(), row.certainty),
            Moves::Channel => (self.path_axes(), row.certainty),
            _ => return None,
        })
    }

    /// A motion word in a rotated or transformed frame moves its other axes, too.
    fn move_in_frame(&mut self) {
        let of_words = self.scratch.moved.iter().map(|it| (it.axis, it.span));
        let moves = |it: &&MovedAxis| it.kind == MotionKind::Unknown;
        let unknown = self.scratch.also_moved.iter().filter(moves);
        let in_motion: Vec<_> = of_words
            .clone()
            .chain(unknown.map(|it| (it.axis, it.span)))
            .collect();
        let words: Vec<AxisIndex> = of_words.map(|(axis, _)| axis).collect();
        let mut found: BTreeMap<AxisIndex, (Certainty, Span)> = BTreeMap::new();
        for name in &self.state.control.modal.transformed {
            let Some((axes, certainty)) = self.frame(name) else {
                continue;
            };
            let Some(&(first, span)) = in_motion.iter().find(|(axis, _)| axes.contains(axis))
            else {
                continue;
            };
            let certainty = if words.contains(&first) {
                certainty
            } else {
                Certainty::Possible
            };
            for axis in axes.into_iter().filter(|axis| !words.contains(axis)) {
                let known = found.entry(axis).or_insert((certainty, span));
                known.0 = known.0.min(certainty);
            }
        }
        let found = found
            .into_iter()
            .map(|(axis, (certainty, span))| MovedAxis {
                axis,
                span,
                kind: MotionKind::Frame,
                certainty,
            });
        self.scratch.also_moved.extend(found);
    }

    /// Axes that follow what the block moves.
    pub(crate) fn move_followers(&mut self, words: AxisWords) {
        if !self.state.control.couplings.carry() {
            return;
        }
        let moves = !matches!(words, AxisWords::Reference | AxisWords::Other);
        let kind = match words {
            AxisWords::Homing => MotionKind::Homing,
            _ => MotionKind::Coupled,
        };
        let of_words = self.scratch.moved.iter().filter(|_| moves);
        let of_words = of_words.map(|word| MovedAxis::of_word(word, kind));
        let in_motion = of_words.chain(self.scratch.also_moved.iter().copied());
        let mut moving: BTreeMap<AxisIndex, MovedAxis> = BTreeMap::new();
        for moved in in_motion {
            let known = moving.entry(moved.axis).or_insert(moved);
            known.certainty = known.certainty.min(moved.certainty);
        }
        if moving.is_empty() {
            return;
        }
        let own = moving.clone();
        let links = self.state.control.couplings.links();
        // R2.60: groups may be many.
        self.state.work.charge(ITEM * links.len());
        // Each round settles an axis more, or is the last.
        for _ in 0..=self.machine.axes.len() {
            let mut grew = false;
            for &(follower, leader, certainty) in &links {
                let leaders = match leader {
                    Some(leader) => moving.get(&leader),
                    None => moving.values().min_by_key(|it| it.certainty),
                };
                let Some(leading) = leaders.copied() else {
                    continue;
                };
                let certainty = certainty.max(leading.certainty);
                let known = moving.get(&follower);
                if known.is_some_and(|known| known.certainty <= certainty) {
                    continue;
                }
                let kind = match leading.kind {
                    MotionKind::Homing => MotionKind::Homing,
                    _ => MotionKind::Coupled,
                };
                let span = leading.span;
                let motion = MovedAxis {
                    axis: follower,
                    span,
                    kind,
                    certainty,
                };
                moving.insert(follower, motion);
                grew = true;
            }
            if !grew {
                break;
            }
        }
        let is_new = |motion: &MovedAxis| {
            let known = own.get(&motion.axis);
            known.is_none_or(|known| known.certainty > motion.certainty)
        };
        let new: Vec<_> = moving.into_values().filter(is_new).collect();
        self.scratch.also_moved.extend(new);
    }
}

impl ControlState {
    fn is_skewed(&self) -> bool {
        let modal = &self.modal;
        modal.skewed && !modal.are_offsets_suspended()
    }
}
