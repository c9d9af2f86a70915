//! Commands in the bracket of an axis, one row each (R10.7, R2.23).
//!
//! Columns that a row leaves out have the values of [`BracketRow::new`]: nothing touches the compensation, nothing moves.
//!
//! PM/n is page n of the TF5200 programming manual.

use super::hash::Plc;
use super::motion::{Certainty, MotionEffect, MotionKind, Moves, Simplification};
use super::state::{ChannelState, RefusedIn};

/// A command by its keyword; one that begins with `MC_` by the start of its keyword.
struct BracketRow {
    keyword: &'static str,
    /// Document that describes it.
    #[allow(dead_code, reason = "it is there to be read")]
    source: &'static str,
    /// Motion of the axis.
    motion: Option<MotionEffect>,
    /// Words of which one is needed for a motion.
    only_with: &'static [&'static str],
    /// Simplification of the commanded trace, where it is another one than that of a motion.
    simplifies: Option<Simplification>,
    action: AxisAction,
    refused: RefusedIn,
    functions: &'static [u32],
}

/// A command in the bracket of an axis or a spindle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AxisCommand {
    /// Motion of the axis.
    pub(crate) motion: Option<MotionEffect>,
    /// Simplification of the commanded trace.
    pub(crate) simplifies: Option<Simplification>,
    /// Any other effect.
    pub(crate) action: AxisAction,
    /// Part of the PLC in it: it acknowledges M and H functions, `S[M3 REV1000]`.
    pub(crate) plc: Plc,
    /// States in which the control refuses it, if the axis takes part in them.
    pub(crate) refused: RefusedIn,
    /// The G functions that it admits in its bracket, where it has any.
    pub(crate) functions: &'static [u32],
}

/// Effect of a command in the bracket of an axis that is not in the other columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum AxisAction {
    None,
    /// Programming of overrides of the axis (PM/208662411).
    Override,
    /// End of the following of another axis.
    EndFollowing,
}

impl BracketRow {
    const fn new(keyword: &'static str, source: &'static str) -> Self {
        Self {
            keyword,
            source,
            motion: None,
            only_with: &[],
            simplifies: None,
            action: AxisAction::None,
            refused: &[],
            functions: &[],
        }
    }

    super::columns! {
        motion(kind: MotionKind, moves: Moves, certainty: Certainty) = Some(MotionEffect { kind, moves, certainty });
        only_with(words: &'static [&'static str]) = words;
        simplifies(what: Simplification) = Some(what);
        action(action: AxisAction) = action;
        refused(states: RefusedIn) = states;
        functions(numbers: &'static [u32]) = numbers;
    }
}

macro_rules! brackets {
    ($($keyword:literal ($source:expr) $($column:ident($($value:expr),+))*;)+) => {
        &[$(BracketRow::new($keyword, $source)$(.$column($($value),+))*),+]
    };
}

/// The blocks of motion control for axes (PM/5252363631026771979).
const MC: &str = "PM/5252363631026771979";

/// Where the control does not move an axis by itself (TF5200 Diagnosis, pages 265468555, 253361291, 254854027).
const INDEPENDENT: RefusedIn = &[
    (ChannelState::Spline, 120_697),
    (ChannelState::Kinematics, 21071),
    (ChannelState::Frame, 21071),
    (ChannelState::Coupling, 21481),
];

/// The G functions of an axis that moves by itself (PM/208612235), and G60, which no page refuses there.
const ALONE: &[u32] = &[0, 1, 60, 90, 91, 100];

/// The commands; the first row that fits applies.
static BRACKETS: &[BracketRow] = {
    use AxisAction::{EndFollowing, Override};
    use Certainty::{Certain, Possible};
    use MotionKind::{Coupled, Feed, Homing, Independent, Unknown};
    use Moves::{Follower, Own};
    use Simplification::AxisDynamics;
    brackets! {
        "INDP_SYN" ("PM/208612235") motion(Independent, Own, Certain) refused(INDEPENDENT) functions(ALONE);
        "INDP_ASYN" ("PM/502430091") motion(Independent, Own, Certain) refused(INDEPENDENT) functions(ALONE);
        "OSC" ("PM/222108427") motion(Independent, Own, Certain) only_with(&["ON"]);
        "DIST_CTRL" ("PM/290203275, 290209035") motion(Independent, Own, Certain) only_with(&["ON"]);
        "OVERRIDE" ("PM/208662411") action(Override);
        "DYNAMIC" (MC) simplifies(AxisDynamics);
        "LIFT" ("PM/492786315") motion(Independent, Own, Certain);
        "LIFT_START" ("PM/492786315") motion(Independent, Own, Certain);
        "LIFT_END" ("PM/492786315");
        "SYNC" ("PM/208678027") motion(Independent, Own, Certain) only_with(&["IN", "OUT"]);
        "POLY" ("PM/208688523") motion(Feed, Own, Certain);
        "MC_ABORTTRIGGER" (MC);
        "MC_CAMOUT" (MC);
        "MC_CAMTABLESELECT" (MC);
        "MC_GEARIN" ("PM/208379531") motion(Coupled, Follower, Certain);
        "MC_GEAROUT" (MC) action(EndFollowing);
        "MC_HALT" (MC);
        "MC_HOME" ("PM/208317067") motion(Homing, Own, Certain);
        "MC_MOVE" ("PM/208330379") motion(Independent, Own, Certain);
        "MC_PHASING" (MC) motion(Independent, Own, Certain);
        "MC_POWER" (MC);
        "MC_READ" (MC);
        "MC_RESET" (MC);
        "MC_SETOVERRIDE" (MC);
        "MC_SETPOSITION" (MC);
        "MC_STOP" (MC) action(EndFollowing);
        "MC_TOUCHPROBE" (MC);
        "MC_WRITE" (MC);
        "MC_" (MC) motion(Unknown, Own, Possible);
    }
};

/// Start of the keywords of motion control.
const MOTION_CONTROL: &str = "MC_";

impl BracketRow {
    fn of(keyword: &str) -> Option<&'static Self> {
        let end = keyword.find(is_between).unwrap_or(keyword.len());
        let is = |row: &&Self| {
            let end = if row.keyword.starts_with(MOTION_CONTROL) {
                row.keyword.len()
            } else {
                end
            };
            let start = keyword.get(..end);
            start.is_some_and(|start| start.eq_ignore_ascii_case(row.keyword))
        };
        BRACKETS.iter().find(is)
    }
}

impl AxisCommand {
    /// Returns the command with a keyword, and all its words with blanks in between. One that no row names does
    /// nothing.
    pub(crate) fn of(keyword: &str, words: &[&str]) -> Self {
        let parts = || words.iter().flat_map(|word| word.split(is_between));
        let has = |wanted: &str| parts().any(|word| word.eq_ignore_ascii_case(wanted));
        let row = BracketRow::of(keyword);
        let motion = row.and_then(|row| {
            let moves = row.only_with.is_empty() || row.only_with.iter().any(|word| has(word));
            // An independent motion that is only computed (PM/208612235).
            row.motion.filter(|_| moves && !has("DRY_RUN"))
        });
        Self {
            motion,
            simplifies: row
                .and_then(|row| row.simplifies)
                .or(motion.map(|_| Simplification::IndependentAxis)),
            action: row.map_or(AxisAction::None, |row| row.action),
            plc: if parts().any(is_function) {
                Plc::Acts
            } else {
                Plc::Absent
            },
            refused: motion.and(row).map_or(&[], |row| row.refused),
            functions: row.map_or(&[], |row| row.functions),
        }
    }

    /// Returns whether a keyword opens a command of an axis: one of the rows, or an M or H function.
    pub(crate) fn is_known(keyword: &str) -> bool {
        let number = keyword.strip_prefix(['M', 'H', 'm', 'h']);
        let is_numbered = number.is_some_and(|it| it.starts_with(|it: char| it.is_ascii_digit()));
        is_numbered || BracketRow::of(keyword).is_some()
    }

    /// Returns the keywords, for "did you mean".
    pub(crate) fn keywords() -> impl Iterator<Item = &'static str> {
        let keywords = BRACKETS.iter().map(|row| row.keyword);
        keywords.filter(|keyword| !keyword.starts_with(MOTION_CONTROL))
    }
}

/// Returns whether a word is an M or H function.
fn is_function(word: &str) -> bool {
    let number = word.strip_prefix(['M', 'H', 'm', 'h']);
    number.is_some_and(|it| !it.is_empty() && it.bytes().all(|it| it.is_ascii_digit()))
}

/// Returns whether a character separates the words of a bracket.
fn is_between(letter: char) -> bool {
    !(letter.is_ascii_alphanumeric() || letter == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(body: &str) -> Option<MotionKind> {
        let words: Vec<&str> = body.split(' ').collect();
        AxisCommand::of(words[0], &words).motion.map(|it| it.kind)
    }

    #[test]
    fn brackets_that_move_are_told_from_those_that_do_not() {
        // R10.7
        for (body, kind) in [
            (
                "INDP_ASYN G90 G01 FEED=10 POS=5",
                Some(MotionKind::Independent),
            ),
            ("indp_syn g91 g00 pos=5", Some(MotionKind::Independent)),
            ("INDP_SYN DRY_RUN POS=5", None),
            (
                "OSC ON 1ST_POS=1 2ND_POS=2 FEED=3",
                Some(MotionKind::Independent),
            ),
            ("OSC OFF", None),
            ("DIST_CTRL ON", Some(MotionKind::Independent)),
            ("DIST_CTRL OFF NO_MOVE", None),
            ("LIFT_START POS_LIMIT=5", Some(MotionKind::Independent)),
            ("LIFT_END", None),
            ("SYNC IN G90 POS=3", Some(MotionKind::Independent)),
            ("POLY A0=1 A1=2", Some(MotionKind::Feed)),
            (
                "MC_MoveAbsolute POS=10 VEL=5",
                Some(MotionKind::Independent),
            ),
            ("MC_MoveVelocity Velocity=1", Some(MotionKind::Independent)),
            ("MC_Home", Some(MotionKind::Homing)),
            ("MC_GearIn Master=2", Some(MotionKind::Coupled)),
            ("MC_GearOut", None),
            ("MC_Stop", None),
            ("MC_Anything", Some(MotionKind::Unknown)),
            ("OVERRIDE FEED_FACT=20", None),
        ] {
            assert_eq!(of(body), kind, "{body}");
        }
    }
}
