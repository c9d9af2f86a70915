//! Advice to the operator after a session, for every report that gives it.

use std::collections::BTreeSet;

use frictcomp::comp::State;
use frictcomp::diagnostic::Code;
use frictcomp::timeline::{AxisSummary, EndedBy, Summary};

/// Returns the advice on an axis, after its name (R1.27: the state outlives the program).
pub(super) fn axis_advice(axis: &AxisSummary, name: &str) -> Option<String> {
    let untold = axis.end != axis.start_up && !axis.told;
    match axis.end {
        State::Inactive if untold => Some(format!(
            " stays inactive for the next program: switch it on with {name}[COMP ON FRICT]"
        )),
        State::Active if untold => Some(format!(
            " stays active for the next program: switch it off with {name}[COMP OFF FRICT]"
        )),
        State::Ineffective => Some(
            " is selected without effect: it has no accepted value list (explain FC303)".to_owned(),
        ),
        State::Unknown => Some(format!(
            " is not known offline: begin the next program with {name}[COMP ON FRICT] or OFF"
        )),
        State::Active | State::Inactive | State::Unconfigured => None,
    }
}

/// Returns the consequence of errors for the final states, where `errors` were said and the last
/// program ended so.
pub(super) fn error_advice(errors: u64, by: Option<EndedBy>) -> Option<&'static str> {
    match by {
        Some(EndedBy::Error) => {
            Some("Stopped by an error: these are the states at the stop; the rest did not run.")
        }
        Some(EndedBy::Budget) => {
            Some("Stopped by a budget: these are the states at the stop; the rest did not run.")
        }
        _ if errors > 0 => {
            Some("The control stops at the first error: correct it, then check the states again.")
        }
        _ => None,
    }
}

/// Whether an axis is known to be as at the start of the control.
pub(super) fn is_home(axis: &AxisSummary) -> bool {
    !axis.is_undescribed && axis.end == axis.start_up && axis.others_away.is_empty()
}

/// Whether every feed move of the axis had friction compensation, if it is configured (R13.12).
pub(super) fn is_compensated(axis: &AxisSummary) -> bool {
    axis.feed_moves.is_empty()
}

/// Returns the line for a session after which every axis is in its start-up state; it names the codes of
/// what was assumed, if anything was (R1.37). Only without a warning is there nothing to do.
pub(super) fn all_home(axes: &[AxisSummary], assumed: &BTreeSet<Code>, warnings: u64) -> String {
    let home = "very axis is as at the start of the control";
    let codes: Vec<&str> = assumed.iter().map(|code| code.as_str()).collect();
    match listed(&codes) {
        None if warnings == 0 && axes.iter().all(is_compensated) => {
            format!("Nothing to do: e{home}.")
        }
        None => format!("E{home}."),
        Some(codes) => format!("E{home} as far as is known: see {codes}."),
    }
}

/// Returns the last sentence on a session: the axes whose friction compensation it leaves off, or may leave off
/// (R18.1).
pub(super) fn left_off(summary: &Summary<'_>) -> Option<String> {
    let ending = |end| {
        let axes = summary.axes.iter();
        let axes = axes.filter(|axis| axis.end == end && axis.start_up != end);
        let axes = axes.filter(|axis| axis.start_up != State::Unconfigured);
        axes.map(|axis| summary.state.name(axis.axis))
            .collect::<Vec<_>>()
    };
    let certain = ending(State::Inactive);
    let verb = if certain.len() == 1 { "is" } else { "are" };
    let certain = listed(&certain).map(|axes| format!("{axes} {verb} left off"));
    let possible = listed(&ending(State::Unknown)).map(|axes| format!("{axes} may be left off"));
    let said: Vec<String> = certain.into_iter().chain(possible).collect();
    (!said.is_empty()).then(|| said.join("; ") + ".")
}

/// Returns names as they are listed in a sentence.
fn listed(names: &[&str]) -> Option<String> {
    match names {
        [] => None,
        [name] => Some((*name).to_owned()),
        [names @ .., last] => Some(format!("{} and {last}", names.join(", "))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use frictcomp::comp::AxisIndex;

    #[test]
    fn advice_follows_what_is_left() {
        // R1.27
        let advice = |start_up, end| {
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
            };
            axis_advice(&axis, "X").unwrap_or_default()
        };
        assert_eq!(advice(State::Active, State::Active), "");
        assert_eq!(advice(State::Inactive, State::Inactive), "");
        assert_eq!(advice(State::Unconfigured, State::Unconfigured), "");
        assert!(advice(State::Active, State::Inactive).ends_with("X[COMP ON FRICT]"));
        assert!(advice(State::Inactive, State::Active).ends_with("X[COMP OFF FRICT]"));
        assert!(advice(State::Active, State::Unknown).contains("not known offline"));
        assert!(advice(State::Ineffective, State::Ineffective).contains("FC303"));
    }

    #[test]
    fn names_are_listed_as_in_a_sentence() {
        assert_eq!(listed(&[]), None);
        assert_eq!(listed(&["X"]).as_deref(), Some("X"));
        assert_eq!(listed(&["X", "Y", "Z"]).as_deref(), Some("X, Y and Z"));
    }
}
