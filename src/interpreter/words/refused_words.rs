//! Words of a block that the control refuses together, each FC328 (R2.114): circles, dwells, and the axes that the operator
//! moves.

use crate::comp::AxisIndex;
use crate::interpreter::block::BlockContext;
use crate::interpreter::executor::Executor;
use crate::interpreter::motion::form::MovedAxis;
use crate::language::{
    AxisWords, Certainty, ChannelState, GAction, GFunction, Group, Mode, MotionKind, OnOff,
};
use crate::syntax::ast::{Address, Block, Hash, Item, Operand};
use crate::text::Span;

impl Executor {
    /// Looks at the words of a block that may not stand together.
    #[inline]
    pub(crate) fn check_words(&mut self, at: &BlockContext<'_>) {
        if self.scratch.moves.has_geometry()
            || self.state.control.modal.modes.limit_circles()
            || self.scratch.moves.dwells()
            || self.scratch.actions.manual.is_some()
        {
            self.check_shape(at);
        }
    }

    #[inline(never)]
    fn check_shape(&mut self, at: &BlockContext<'_>) {
        if self.state.control.described.is_some() || self.is_halted() {
            return;
        }
        if let Some(switch) = self.scratch.actions.manual {
            self.switch_manual(switch, at);
        } else if self.scratch.moves.dwells() {
            self.check_dwell(at);
        } else if self.scratch.actions.axis_words == AxisWords::Motion {
            self.check_circle(at);
        }
    }

    /// A circle with a centre and a radius, without either where the centre is not corrected, or under a B spline (TF5200
    /// Diagnosis, pages 253243787, 250610827, 264515467).
    fn check_circle(&mut self, at: &BlockContext<'_>) {
        let modal = &self.state.control.modal;
        let is_circle = modal.functions.is_arc() && modal.is_known(Group::Motion);
        let first = self.scratch.moves.words().first().map(|word| word.span);
        let geometry = self.scratch.moves.geometry_words();
        let of_words = geometry.and_then(|it| it.span);
        let Some(span) = of_words.or(first).filter(|_| is_circle) else {
            return;
        };
        let centre = geometry.map_or([None; 3], |it| it.centre);
        let is_given = centre.iter().any(Option::is_some);
        let is_zero = centre
            .iter()
            .all(|word| matches!(word, None | Some(Some(0.0))));
        let has_radius = geometry.is_some_and(|it| it.radius.is_some());
        let span = at.in_block(span);
        if is_given && has_radius {
            let what = "a circle has a centre and a radius";
            self.may_refuse_alike(21024, what, span, at);
        } else if modal.modes.has(Mode::FixedCentre)
            && is_zero
            && !has_radius
            && modal.radius.is_none()
        {
            let what = "a circle has neither a centre nor a radius under G164";
            self.may_refuse_alike(20036, what, span, at);
        }
        if self.state.control.is_in(ChannelState::BSpline) {
            let what = "a circle stands under a B spline";
            self.may_refuse_alike(120_254, what, span, at);
        }
    }

    /// G04 with a time and a coordinate, or with the coordinate of another axis than the first one (TF5200 Diagnosis, pages
    /// 250532491, 250536843).
    fn check_dwell(&mut self, at: &BlockContext<'_>) {
        let words = self.scratch.moves.words();
        let Some(first) = words.first().filter(|_| has_function(at.block, DWELL)) else {
            return;
        };
        let has_time = self
            .scratch
            .moves
            .geometry_words()
            .is_some_and(|it| it.dwell.is_some());
        let axes = self.axes();
        let main = [
            axes.letter(b'X'),
            axes.main(b'X', &self.state.control.modal),
        ];
        let is_first =
            |axis: AxisIndex| main.contains(&Some(axis)) || axes.path().first() == Some(&axis);
        let span = at.in_block(first.span);
        if has_time {
            let what = "G04 has a time and the coordinate of an axis";
            self.may_refuse_alike(20013, what, span, at);
        } else if !words.iter().any(|word| is_first(word.axis)) {
            let what = "G04 has the coordinate of another axis than the first main axis";
            self.may_refuse_alike(20014, what, span, at);
        }
    }
}

/// Axes that the operator moves (PM/206633483).
impl Executor {
    /// `#ACHSE [X, Y]`: the axes that G200, G201 or G202 in its block is about (TF5200 Diagnosis, pages 250615179, 251716235).
    pub(crate) fn name_manual_axes(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        self.pass_over(hash.command.words, hash.span, at);
        let mut axes = self.axes().given(&hash.brackets, at.text);
        let count = axes.len();
        axes.sort_unstable();
        axes.dedup();
        if axes.len() < count {
            let what = "`#ACHSE` names an axis twice";
            self.may_refuse_alike(20478, what, hash.span, at);
        }
        if !has_function(at.block, GFunction::is_for_operator) {
            let what = "`#ACHSE` stands without G200, G201 or G202";
            self.may_refuse_alike(20037, what, hash.span, at);
            return;
        }
        if self.scratch.actions.manual != Some(OnOff::Off) {
            for &axis in &axes {
                self.state.control.modal.havoc_position(axis);
                self.scratch.moves.also_move(MovedAxis {
                    axis,
                    span: hash.span,
                    kind: MotionKind::Unknown,
                    certainty: Certainty::Possible,
                });
            }
        }
        self.scratch.actions.manual_axes = axes;
    }

    /// G201 and G202: the operator moves these axes from here on, or does not any more; G202 without axes is about all
    /// (tccncprogramming/15556788363; TF5200 Diagnosis, page 250619531).
    fn switch_manual(&mut self, switch: OnOff, at: &BlockContext<'_>) {
        let mut axes = std::mem::take(&mut self.scratch.actions.manual_axes);
        axes.extend(self.scratch.moves.words().iter().map(|word| word.axis));
        let has_names = at
            .block
            .items
            .iter()
            .any(|item| matches!(item, Item::Hash(_)));
        let manual = &mut self.state.control.modal.manual;
        match switch {
            OnOff::On => manual.extend(&axes),
            OnOff::Off if axes.is_empty() && !has_names => manual.clear(),
            OnOff::Off => manual.retain(|axis| !axes.contains(axis)),
        }
        let lacks = self.scratch.moves.lacks_axes() || has_names;
        if switch == OnOff::On && axes.is_empty() && !lacks {
            let span = Span::new(0, at.text.trim_end().len());
            let what = "G201 names no axis";
            self.may_refuse_alike(20038, what, span, at);
        }
    }
}

/// G04.
const DWELL: fn(&GFunction) -> bool = |row| row.action == GAction::Dwell;

/// Whether a block has a G function of some kind, or may.
fn has_function(block: &Block, is_it: impl Fn(&GFunction) -> bool) -> bool {
    block.all_words().any(|word| {
        let is_one = match word.value {
            Some(Operand::Number(number)) => GFunction::of_value(number).is_some_and(&is_it),
            _ => true,
        };
        word.address == Address::Letter(b'G') && is_one
    })
}
