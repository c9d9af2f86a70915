//! The velocity of paths, apart from F: overrides, weights, the main spindle, and commands that a commanded
//! trace does not follow in full (R5.1).

use crate::interpreter::coordinates::contouring::ContouringCommand;
use crate::interpreter::coordinates::pace::Factors;
use crate::interpreter::coordinates::simplified::{self, Holds, Simplification};
use crate::interpreter::coordinates::slope::SlopeSelection;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::interpreter::Interpreter;
use crate::text::Span;

/// An override in percent, where it is in the documented range (PM/207625099).
const OVERRIDE: std::ops::RangeInclusive<f64> = 0.1..=200.0;

/// The keywords of an override.
const FEED: &str = "FEED_FACT";
const RAPID: &str = "RAPID_FACT";

/// A command in the bracket of an axis or spindle.
#[derive(Clone, Copy)]
pub(in crate::interpreter) struct AxisBracket<'a> {
    /// The name before the bracket.
    pub(in crate::interpreter) name: &'a str,
    /// The first word in it.
    pub(in crate::interpreter) keyword: &'a str,
    /// The whole of it.
    pub(in crate::interpreter) span: Span,
}

impl Interpreter {
    /// Notes a command that a commanded trace does not follow in full.
    pub(in crate::interpreter) fn simplify(&mut self, what: Simplification, holds: Holds) {
        if holds == Holds::Once {
            let geometry = self.scratch.geometry();
            geometry.simplified = geometry.simplified.union(what.into());
        } else {
            self.state.control.modal.simplify(what, holds);
        }
    }

    /// `G163=50`: the radius of circles, as R (R2.45). Returns whether there is a value.
    pub(in crate::interpreter) fn radius_word(
        &mut self,
        span: Span,
        at: &BlockContext<'_>,
    ) -> bool {
        let Some((_, value)) = span.of(at.text).split_once('=') else {
            return false;
        };
        let radius = self.number_in(value.trim(), at);
        self.circle_word(b'R', radius, span);
        true
    }

    /// `G129=70` (PM/206578955)
    pub(in crate::interpreter) fn weigh_rapid(&mut self, span: Span, at: &BlockContext<'_>) {
        let value = span.of(at.text).split_once('=').map(|(_, value)| value);
        let percent = value.and_then(|value| self.number_in(value.trim(), at));
        let weight = percent.filter(|it| *it > 0.0).map(|it| it / 100.0);
        self.state.control.modal.pace.weigh_rapid(weight);
    }

    /// Applies a `#` command that changes the velocity of paths.
    pub(in crate::interpreter) fn pace_command(
        &mut self,
        name: &str,
        rest: &str,
        at: &BlockContext<'_>,
    ) {
        match name {
            "#OVERRIDE" => {
                let change = self.factors_in(rest, at);
                self.state.control.modal.pace.override_path(change);
            }
            "#MAIN SPINDLE" => self.state.control.modal.pace.havoc_spindle(),
            _ => {
                if let Some(command) = ContouringCommand::of(name) {
                    let before = *self.state.control.modal.contouring_of(command);
                    let next = command.parameters(before, rest, |value| self.number_in(value, at));
                    *self.state.control.modal.contouring_of(command) = next;
                }
                if let Some(selected) =
                    SlopeSelection::of(name, rest, |value| self.number_in(value, at))
                {
                    self.state.control.modal.select_slope(selected);
                } else if let Some((what, holds)) = simplified::of_command(name) {
                    self.simplify(what, holds);
                }
            }
        }
    }

    /// A command in the bracket of an axis or spindle, `X[OVERRIDE FEED_FACT=20]`, `S[REV1200 M3]`.
    pub(in crate::interpreter) fn bracket(
        &mut self,
        bracket: AxisBracket<'_>,
        at: &BlockContext<'_>,
    ) {
        let AxisBracket {
            name,
            keyword,
            span,
        } = bracket;
        let body = span.of(at.text).split_once('[');
        let body = body.map_or("", |(_, body)| body.trim_end().trim_end_matches(']'));
        let keyword = keyword.to_ascii_uppercase();
        let axis = self.axis_named(name);
        if name.starts_with('S') && axis.is_none() {
            if self.is_main_spindle(name) {
                self.spindle_words(body, at);
            } else if self.machine.channel.main_spindle.is_empty() {
                // It may be the main spindle under its own name.
                self.state.control.modal.pace.havoc_spindle();
            }
            return;
        }
        let Some(axis) = axis else {
            return;
        };
        if keyword.starts_with("OVERRIDE") {
            let change = self.factors_in(body, at);
            self.state.control.modal.pace.override_axis(axis, change);
        }
        let body = body.to_ascii_uppercase();
        if let Some(what) = simplified::of_bracket(&keyword, &body) {
            self.simplify(what, Holds::On);
        }
    }

    /// The words in the bracket of the main spindle.
    fn spindle_words(&mut self, body: &str, at: &BlockContext<'_>) {
        for word in body.split_ascii_whitespace() {
            let upper = word.to_ascii_uppercase();
            if upper.starts_with("REV") {
                let speed = self.number_in(word[3..].trim_start_matches('='), at);
                self.state.control.modal.pace.speed(speed);
            } else if let Some(number) = upper.strip_prefix('M')
                && let Ok(number) = number.parse()
            {
                self.state.control.modal.pace.m(number);
            }
        }
    }

    /// Returns the factors in the text of an override.
    fn factors_in(
        &mut self,
        text: &str,
        at: &BlockContext<'_>,
    ) -> impl FnOnce(&mut Factors) + use<> {
        let [feed, rapid] = [FEED, RAPID].map(|key| {
            let value = value_after(key, text)?;
            let percent = self.number_in(value, at);
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

/// Returns the text after a keyword, up to the next keyword.
fn value_after<'a>(key: &str, text: &'a str) -> Option<&'a str> {
    let upper = text.to_ascii_uppercase();
    let start = upper.find(key)? + key.len();
    let end = [FEED, RAPID]
        .iter()
        .filter_map(|next| upper[start..].find(next))
        .min();
    let value = &text[start..end.map_or(text.len(), |end| start + end)];
    Some(
        value
            .trim()
            .trim_start_matches('=')
            .trim_end_matches(']')
            .trim(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_stand_after_their_keywords() {
        // R5.1
        let text = " FEED_FACT=120 rapid_fact = 75 ]";
        assert_eq!(value_after(FEED, text), Some("120"));
        assert_eq!(value_after(RAPID, text), Some("75"));
        assert_eq!(value_after(RAPID, "FEED_FACT=1"), None);
    }
}
