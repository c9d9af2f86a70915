//! Advice to the operator after a session, for every report that gives it.

use crate::document::{Headline, Standing};
use std::collections::BTreeSet;

use frictcomp::comp::State;
use frictcomp::diagnostic::Code;
use frictcomp::interpreter::EndedBy;
use frictcomp::text::in_a_row;
use frictcomp::timeline::AxisSummary;

/// Returns the consequence of errors for the final states, where `errors` were said and the last
/// program ended so.
fn error_advice(errors: u64, by: Option<EndedBy>) -> Option<&'static str> {
    match by {
        Some(EndedBy::Error) => {
            Some("stopped by an error: these are the states at the stop, and the rest did not run")
        }
        Some(EndedBy::Budget) => {
            Some("stopped by a budget: these are the states at the stop, and the rest did not run")
        }
        _ if errors > 0 => {
            Some("the control stops at the first error: correct it, then check the states again")
        }
        _ => None,
    }
}

/// Final states of a session, from which its verdict follows.
pub(crate) struct FinalStates<'a> {
    /// The axes, each with its name.
    pub(crate) axes: Vec<(&'a str, &'a AxisSummary)>,
    /// Codes of what was assumed.
    pub(crate) assumed: &'a BTreeSet<Code>,
    /// Number of errors.
    pub(crate) errors: u64,
    /// Number of warnings.
    pub(crate) warnings: u64,
    /// The end of the last program.
    pub(crate) by: Option<EndedBy>,
    /// The axes that are only assumed to be compensated.
    pub(crate) assumption: Option<String>,
    /// Whether a description of the machine exists.
    pub(crate) is_described: bool,
}

impl FinalStates<'_> {
    fn names(&self, of: impl Fn(&AxisSummary) -> bool) -> Vec<&str> {
        let axes = self.axes.iter().filter(|(_, axis)| of(axis));
        axes.map(|(name, _)| *name).collect()
    }

    /// Returns the verdict: what is left away from the start-up state, and the cure (R1.27, R18.1, R18.20).
    pub(crate) fn headline(&self) -> Option<Headline> {
        if self.axes.is_empty() {
            return None;
        }
        let left = |end| {
            self.names(|axis| {
                axis.end == end && axis.start_up != end && axis.start_up != State::Unconfigured
            })
        };
        // A message has said the cure of an axis that is told.
        let away = |end, word, command| {
            let names = left(end);
            let verb = if names.len() == 1 { "is" } else { "are" };
            let left = format!("{} {verb} left {word}", listed(&names)?);
            let untold = self
                .axes
                .iter()
                .filter(|(name, axis)| !axis.told && names.contains(name));
            let blocks: Vec<String> = untold
                .map(|(name, _)| format!("{name}[COMP {command} FRICT]"))
                .collect();
            let blocks: Vec<&str> = blocks.iter().map(String::as_str).collect();
            let cure = listed(&blocks).map(|blocks| format!(": write {blocks}"));
            Some(left + &cure.unwrap_or_default())
        };
        let ineffective = self.names(|axis| axis.end == State::Ineffective);
        let [are, they] = match ineffective.len() {
            1 => ["is", "it has"],
            _ => ["are", "they have"],
        };
        let is_rewritten = |axis: &AxisSummary| axis.is_rewritten;
        let (rewritten, open): (Vec<&str>, Vec<&str>) = left(State::Unknown)
            .into_iter()
            .partition(|name| self.names(is_rewritten).contains(name));
        let bad = [
            error_advice(self.errors, self.by).map(str::to_owned),
            away(State::Inactive, "off", "ON"),
            away(State::Active, "on", "OFF"),
            listed(&ineffective).map(|axes| {
                format!("{axes} {are} selected without effect: {they} no accepted value list (see FC303)")
            }),
        ];
        let mut parts: Vec<String> = bad.into_iter().flatten().collect();
        let mut standing = if parts.is_empty() {
            Standing::Open
        } else {
            Standing::Bad
        };
        parts.extend(listed(&open).map(|axes| {
            format!("{axes} may be left off: begin the next program with a command for each")
        }));
        parts.extend(listed(&rewritten).map(|axes| {
            format!("{axes} may be left off: run with a configuration that has the machine data which the program wrote")
        }));
        if parts.is_empty() {
            if !self.is_described || !self.axes.iter().all(|(_, axis)| is_home(axis)) {
                return None;
            }
            let is_good = self.warnings == 0 && self.assumed.is_empty();
            standing = if is_good {
                Standing::Good
            } else {
                Standing::Open
            };
            parts.push(all_home(&self.axes, self.assumed, self.warnings));
        }
        let headline = Headline::new(standing, parts.join("; "));
        Some(headline.assuming(self.assumption.clone()))
    }
}

/// Returns whether an axis is known to be as at the start of the control.
fn is_home(axis: &AxisSummary) -> bool {
    !axis.is_undescribed && axis.end == axis.start_up && axis.others_away.is_empty()
}

/// Returns whether every feed move of the axis had friction compensation, if it is configured (R13.12).
fn is_compensated(axis: &AxisSummary) -> bool {
    axis.feed_moves.is_empty()
}

/// Returns the line for a session after which every axis is in its start-up state; it names the codes of
/// what was assumed, if anything was (R1.37). Only without a warning is there nothing to do.
fn all_home(axes: &[(&str, &AxisSummary)], assumed: &BTreeSet<Code>, warnings: u64) -> String {
    let home = "every axis is as at the start of the control";
    let codes: Vec<&str> = assumed.iter().map(|code| code.as_str()).collect();
    match listed(&codes) {
        None if warnings == 0 && axes.iter().all(|(_, axis)| is_compensated(axis)) => {
            format!("nothing to do: {home}")
        }
        None => home.to_owned(),
        Some(codes) => format!("{home} as far as is known: see {codes}"),
    }
}

/// Returns names as they are listed in a sentence.
pub(crate) fn listed(names: &[&str]) -> Option<String> {
    (!names.is_empty()).then(|| in_a_row(names))
}

#[cfg(test)]
mod tests {
    use super::*;
    use frictcomp::comp::AxisIndex;

    #[test]
    fn the_verdict_follows_what_is_left() {
        // R1.27, R18.20
        let said = |start_up, end| {
            let axis = AxisSummary {
                others_away: frictcomp::comp::KindSet::NONE,
                axis: AxisIndex::new(0),
                start: start_up,
                end,
                start_up,
                told: false,
                changed_by: Vec::new(),
                changes: 0,
                feed_moves: frictcomp::timeline::FeedMoves::default(),
                is_undescribed: false,
                is_rewritten: false,
            };
            let states = FinalStates {
                axes: vec![("X", &axis)],
                assumed: &BTreeSet::new(),
                errors: 0,
                warnings: 0,
                by: Some(EndedBy::M30),
                assumption: None,
                is_described: true,
            };
            states.headline().expect("a verdict").text
        };
        let home = "nothing to do: every axis is as at the start of the control";
        assert_eq!(said(State::Active, State::Active), home);
        assert_eq!(said(State::Inactive, State::Inactive), home);
        assert_eq!(
            said(State::Active, State::Inactive),
            "X is left off: write X[COMP ON FRICT]"
        );
        assert!(said(State::Inactive, State::Active).contains("X[COMP OFF FRICT]"));
        assert!(said(State::Active, State::Unknown).starts_with("X may be left off"));
        assert!(said(State::Ineffective, State::Ineffective).contains("FC303"));
    }

    #[test]
    fn names_are_listed_as_in_a_sentence() {
        assert_eq!(listed(&[]), None);
        assert_eq!(listed(&["X"]).as_deref(), Some("X"));
        assert_eq!(listed(&["X", "Y", "Z"]).as_deref(), Some("X, Y and Z"));
    }
}
