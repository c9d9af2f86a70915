//! The words and commands of a block that shape its motion, and its pace.

use crate::interpreter::axes::AxisLookup;
use crate::interpreter::block::BlockContext;
use crate::interpreter::coupling::gear_of;
use crate::interpreter::executor::Executor;
use crate::interpreter::motion::block::{BlockMotion, MotionSetting};
use crate::interpreter::motion::form::MovedAxis;
use crate::interpreter::motion::pace::{Factors, SlopeSelection};
use crate::interpreter::values::value::rounded;
use crate::interpreter::values::work_budget::ITEM;
use crate::language::{
    AxisAction, AxisCommand, AxisWords, Group, HashAction, Holds, Moves, Simplification,
};
use crate::syntax::ast::{Argument, BracketArguments, Hash, SpindleWord};
use crate::text::Span;

impl Executor {
    /// A command in the bracket of an axis.
    pub(crate) fn move_by_bracket(&mut self, bracket: AxisBracket<'_>, at: &BlockContext<'_>) {
        let Some(axis) = self.axes().named(bracket.name) else {
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
        self.scratch.moves.also_move(MovedAxis {
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
        let named = self.axes().given(&hash.brackets, at.text);
        let axes = if named.is_empty() {
            self.axes().path()
        } else {
            named
        };
        for axis in axes {
            self.scratch.moves.also_move(MovedAxis {
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

    /// How the block moves, and what that depends on.
    fn moves(&mut self) -> (&mut BlockMotion, MotionSetting<'_>) {
        let control = &self.state.control;
        let axes = AxisLookup {
            machine: &self.machine,
            own: &self.names,
            channel: &control.channel_axes,
        };
        let modal = &control.modal;
        (&mut self.scratch.moves, MotionSetting { axes, modal })
    }

    /// Notes the axes that move along with those that the block moves.
    #[inline]
    pub(crate) fn carry_along(&mut self, words: AxisWords) {
        let control = &self.state.control;
        let carries = control.couplings.carry()
            || !control.modal.transformed.is_empty()
            || self.scratch.moves.row().is_some();
        if carries && control.described.is_none() {
            self.carry(words);
        }
    }

    #[inline(never)]
    fn carry(&mut self, words: AxisWords) {
        let (moves, setting) = self.moves();
        moves.move_others(words, setting);
        let couplings = &self.state.control.couplings;
        if couplings.carry() && self.scratch.moves.leads(words) {
            let links = couplings.links();
            // R2.60: groups may be many.
            self.state.work.charge(ITEM * links.len());
            self.scratch.moves.move_followers(words, &links);
        }
    }

    /// I, J, K or R of a circle.
    pub(crate) fn circle_word(&mut self, letter: u8, value: Option<f64>, span: Span) {
        let metric = self.state.control.modal.is_known(Group::Unit);
        let inch = self.state.control.modal.functions.inch;
        let value = value.filter(|_| metric);
        let value = value.map(|value| if inch { value * 25.4 } else { value });
        let geometry = self.scratch.moves.geometry();
        geometry.span.get_or_insert(span);
        match letter {
            b'R' => geometry.radius = Some(value),
            _ => geometry.centre[usize::from(letter.saturating_sub(b'I')).min(2)] = Some(value),
        }
    }

    /// Notes the axes that a circle moves.
    #[inline]
    pub(crate) fn move_around(&mut self, words: AxisWords) {
        let turns = self.state.control.modal.functions.is_arc();
        if (turns || self.scratch.moves.has_geometry()) && words == AxisWords::Motion {
            let (moves, setting) = self.moves();
            let added = moves.move_around(turns, setting);
            added.into_iter().flatten().for_each(|axis| self.see(axis));
        }
    }

    /// `G04 P1`: the parameter holds the seconds (PM/206132747).
    pub(crate) fn dwell_parameter(&mut self, index: Option<f64>) {
        let index = index
            .and_then(rounded)
            .and_then(|index| u32::try_from(index).ok());
        let value = index.and_then(|index| self.state.control.memory.parameter(index));
        let seconds = value.and_then(|value| value.number());
        self.scratch.moves.geometry().dwell = Some(seconds);
    }

    /// Creates the motion of the block, which started at `from`.
    pub(crate) fn take_motion(&mut self, from: Option<Vec<Option<f64>>>, words: AxisWords) {
        if let Some(radius) = self.scratch.moves.radius() {
            // The radius is modal (PM, radius programming).
            self.state.control.modal.radius = radius;
        }
        let is_taken = self.options.takes_motions();
        let (moves, setting) = self.moves();
        moves.travel(from, words, setting, is_taken);
    }
}

/// An override in percent, where it is in the documented range (PM/207625099).
const OVERRIDE: std::ops::RangeInclusive<f64> = 0.1..=200.0;

/// The keywords of an override.
const FEED: &str = "FEED_FACT";
const RAPID: &str = "RAPID_FACT";

/// A command in the bracket of an axis or spindle.
#[derive(Clone, Copy)]
pub(crate) struct AxisBracket<'a> {
    /// The name before the bracket.
    pub(crate) name: &'a str,
    pub(crate) command: AxisCommand,
    pub(crate) arguments: &'a BracketArguments,
    pub(crate) spindle: &'a [SpindleWord],
    /// The whole of it.
    pub(crate) span: Span,
}

impl Executor {
    /// Notes a command that a commanded trace does not follow in full.
    pub(crate) fn simplify(&mut self, what: Simplification, holds: Holds) {
        if holds == Holds::Once {
            let geometry = self.scratch.moves.geometry();
            geometry.simplified = geometry.simplified.union(what.into());
        } else {
            self.state.control.modal.simplify(what, holds);
        }
    }

    /// `G163=50`: the radius of circles, as R (R2.45). Returns whether there is a value.
    pub(crate) fn radius_word(&mut self, span: Span, at: &BlockContext<'_>) -> bool {
        let Some(value) = at.block.second_value(span) else {
            return false;
        };
        let radius = self.operand_number(value, at);
        self.circle_word(b'R', radius, span);
        true
    }

    /// `G129=70` (PM/206578955)
    pub(crate) fn weigh_rapid(&mut self, span: Span, at: &BlockContext<'_>) {
        let value = at.block.second_value(span);
        let percent = value.and_then(|value| self.operand_number(value, at));
        let weight = percent.filter(|it| *it > 0.0).map(|it| it / 100.0);
        self.state.control.modal.pace.weigh_rapid(weight);
    }

    /// Applies a `#` command that changes the velocity of paths.
    pub(crate) fn pace_command(&mut self, hash: &Hash, at: &BlockContext<'_>) {
        let (command, arguments) = (hash.command, &hash.brackets);
        match command.action {
            HashAction::Override => {
                let change = self.factors_in(arguments, at);
                self.state.control.modal.pace.override_path(change);
            }
            HashAction::SelectSpindle => self.state.control.modal.pace.havoc_spindle(),
            HashAction::Round(command) => {
                let before = *self.state.control.modal.contouring_of(command);
                let number = |argument: &Argument| self.argument_number(argument, at);
                let next = command.parameters(before, (arguments, at.text), number);
                *self.state.control.modal.contouring_of(command) = next;
            }
            HashAction::SelectSlope(form) => {
                let number = |argument: &Argument| self.argument_number(argument, at);
                let selected = SlopeSelection::of(form, (arguments, at.text), number);
                if let Some(selected) = selected {
                    self.state.control.modal.select_slope(selected);
                    return;
                }
            }
            _ => {}
        }
        if let Some((what, holds)) = command.simplification() {
            self.simplify(what, holds);
        }
    }

    /// A command in the bracket of an axis or spindle, `X[OVERRIDE FEED_FACT=20]`, `S[REV1200 M3]`.
    pub(crate) fn bracket(&mut self, bracket: AxisBracket<'_>, at: &BlockContext<'_>) {
        let AxisBracket { name, command, .. } = bracket;
        let axis = self.axes().named(name);
        if name.starts_with('S') && axis.is_none() {
            if self.axes().is_main_spindle(name) {
                self.spindle_words(bracket.spindle, at);
            } else if self.machine.channel.main_spindle.is_empty() {
                // It may be the main spindle under its own name.
                self.state.control.modal.pace.havoc_spindle();
            }
            return;
        }
        let Some(axis) = axis else {
            return;
        };
        if command.action == AxisAction::Override {
            let change = self.factors_in(bracket.arguments, at);
            self.state.control.modal.pace.override_axis(axis, change);
        }
        if let Some(what) = command.simplifies {
            self.simplify(what, Holds::On);
        }
    }

    /// The words in the bracket of the main spindle.
    fn spindle_words(&mut self, words: &[SpindleWord], at: &BlockContext<'_>) {
        for word in words {
            match *word {
                SpindleWord::Speed(speed) => {
                    let speed = speed.and_then(|speed| self.operand_number(speed, at));
                    self.state.control.modal.pace.speed(speed);
                }
                SpindleWord::M(number) => self.state.control.modal.pace.m(number),
            }
        }
    }

    /// Returns the factors in the bracket of an override.
    fn factors_in(
        &mut self,
        arguments: &BracketArguments,
        at: &BlockContext<'_>,
    ) -> impl FnOnce(&mut Factors) + use<> {
        let [feed, rapid] = [FEED, RAPID].map(|key| {
            let percent = self.argument_number(arguments.after(key, at.text)?, at);
            let known = percent.filter(|it| OVERRIDE.contains(it));
            Some(known.map(|it| it / 100.0))
        });
        let is_understood = feed.is_some() || rapid.is_some();
        move |factors| {
            factors.feed = feed.unwrap_or(factors.feed.filter(|_| is_understood));
            factors.rapid = rapid.unwrap_or(factors.rapid.filter(|_| is_understood));
        }
    }
}
