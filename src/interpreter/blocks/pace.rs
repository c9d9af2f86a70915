//! The velocity of paths, apart from F: overrides, weights, the main spindle, and commands that a commanded
//! trace does not follow in full (R5.1).

use crate::interpreter::coordinates::pace::Factors;
use crate::interpreter::coordinates::slope::SlopeSelection;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::executor::Executor;
use crate::language::{AxisAction, AxisCommand, HashAction, Holds, Simplification};
use crate::syntax::ast::{Argument, BracketArguments, Hash, SpindleWord};
use crate::text::Span;

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
            let geometry = self.scratch.geometry();
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
        let axis = self.axis_named(name);
        if name.starts_with('S') && axis.is_none() {
            if self.is_main_spindle(name) {
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
