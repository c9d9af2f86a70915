//! The one table of causes of axis motion (R10.7): words, commands in the bracket of an axis, motion through
//! another axis, frames.
//!
//! PM/n is page n of the TF5200 programming manual.

use serde::Serialize;

use super::axis_words::AxisWord;
use crate::comp::AxisIndex;
use crate::text::Span;

crate::words! {
    /// The way in which an axis is moved.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
    #[serde(rename_all = "lowercase")]
    #[non_exhaustive]
    pub enum MotionKind {
        /// G00.
        Rapid = "rapid",
        /// G01, G02, G03 and everything else that interpolates at the path feed.
        Feed = "feed",
        /// A reference point is approached.
        Homing = "homing",
        /// The axis moves by itself, independently of the path or along with it.
        Independent = "independent",
        /// It follows another axis.
        Coupled = "coupled",
        /// Coordinates are rotated or transformed: the motion word of another axis moves it.
        Frame = "frame",
        /// Not known offline.
        Unknown = "unknown",
    }
}

/// Whether something happens on every way that a program may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Certainty {
    /// It does.
    Certain,
    /// It may: that is not known offline.
    Possible,
}

/// The motion of one axis in a block.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct MovedAxis {
    /// Position of the axis in the machine.
    pub axis: AxisIndex,
    /// The words that move it.
    pub span: Span,
    /// How it moves.
    pub kind: MotionKind,
    /// Whether it certainly moves.
    pub certainty: Certainty,
}

impl MovedAxis {
    /// The motion of an axis word.
    #[inline]
    pub(in crate::interpreter) fn of_word(word: &AxisWord, kind: MotionKind) -> Self {
        Self {
            axis: word.axis,
            span: word.span,
            kind,
            certainty: Certainty::Certain,
        }
    }
}

/// A form that moves axes.
#[derive(Debug, Clone, Copy)]
enum MovingForm {
    /// Axis words with a G function of this number.
    G(u32),
    /// A command in the bracket of an axis that begins with this keyword, and a second word without
    /// which it does not move.
    Bracket(&'static str, Option<&'static str>),
    /// A `#` command in force.
    Command(&'static str),
}

/// The axes that a form moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::interpreter) enum Moves {
    /// Those with a word in the block.
    Words,
    /// Those with a word in the block, or every axis where none has one.
    WordsOrAll,
    /// The axis before the bracket, now.
    Own,
    /// The axis before the bracket or named in it, whenever its master moves.
    Follower,
    /// All that it names, whenever one of them moves.
    Gantry,
    /// The axes that it names, or all.
    NamedOrAll,
    /// The axes of the active plane, with the motion word of one of them.
    Plane,
    /// X, Y and Z, with the motion word of one of them.
    Main,
    /// Every axis of the channel, with any motion word.
    Channel,
}

/// A row of the table.
#[derive(Debug, Clone, Copy)]
pub(in crate::interpreter) struct MovingRow {
    form: MovingForm,
    pub(in crate::interpreter) kind: MotionKind,
    pub(in crate::interpreter) moves: Moves,
    pub(in crate::interpreter) certainty: Certainty,
}

const fn certain(form: MovingForm, kind: MotionKind, moves: Moves) -> MovingRow {
    MovingRow {
        form,
        kind,
        moves,
        certainty: Certainty::Certain,
    }
}

const fn possible(form: MovingForm, kind: MotionKind, moves: Moves) -> MovingRow {
    MovingRow {
        form,
        kind,
        moves,
        certainty: Certainty::Possible,
    }
}

/// Causes of axis motion other than the words of G00 to G03; the first row that fits applies.
const TABLE: [MovingRow; 46] = {
    use MotionKind::{Coupled, Feed, Frame, Homing, Independent, Unknown};
    use Moves::{Channel, Follower, Gantry, Main, NamedOrAll, Own, Plane, Words, WordsOrAll};
    use MovingForm::{Bracket, Command, G};
    [
        certain(G(33), Feed, Words),
        certain(G(63), Feed, Words),
        // PM/206138635
        certain(G(74), Homing, Words),
        // PM/206177803, 206197003, 206213899
        certain(G(100), Feed, Words),
        certain(G(101), Feed, Words),
        certain(G(102), Feed, Words),
        certain(G(106), Feed, Words),
        certain(G(108), Feed, Words),
        certain(G(310), Feed, Words),
        certain(G(301), Feed, Words),
        certain(G(302), Feed, Words),
        certain(G(303), Feed, Words),
        certain(G(331), Feed, Words),
        certain(G(332), Feed, Words),
        // The operator may move them (PM/206639371, 206633483).
        possible(G(200), Unknown, WordsOrAll),
        possible(G(201), Unknown, Words),
        // PM/208612235, 502430091
        certain(Bracket("INDP_", None), Independent, Own),
        // PM/222108427
        certain(Bracket("OSC", Some("ON")), Independent, Own),
        // PM/290203275, 290209035
        certain(Bracket("DIST_CTRL", Some("ON")), Independent, Own),
        // PM/492786315
        certain(Bracket("LIFT_START", None), Independent, Own),
        certain(Bracket("LIFT", None), Independent, Own),
        // PM/208678027
        certain(Bracket("SYNC", Some("IN")), Independent, Own),
        certain(Bracket("SYNC", Some("OUT")), Independent, Own),
        // PM/208688523
        certain(Bracket("POLY", None), Feed, Own),
        // PM/208317067, 208330379, 208379531
        certain(Bracket("MC_HOME", None), Homing, Own),
        certain(Bracket("MC_GEARIN", None), Coupled, Follower),
        certain(Bracket("MC_MOVE", None), Independent, Own),
        certain(Bracket("MC_PHASING", None), Independent, Own),
        possible(Bracket("MC_", None), Unknown, Own),
        // tf5200_gantry_operation/285662475
        certain(Command("#GANTRY"), Coupled, Gantry),
        // PM/546229387
        certain(Command("#GEAR LINK"), Coupled, Follower),
        // PM/207450507
        possible(Command("#CAXTRACK"), Coupled, Follower),
        // 965255691
        possible(Command("#SYNC IN"), Coupled, NamedOrAll),
        possible(Command("#DIST CTRL ON"), Independent, NamedOrAll),
        // PM/207442315, 969743115
        certain(Command("#ROTATION"), Frame, Plane),
        possible(Command("#CS"), Frame, Main),
        possible(Command("#ACS"), Frame, Main),
        possible(Command("#BCS"), Frame, Main),
        possible(Command("#ECS"), Frame, Main),
        possible(Command("#TRACK CS"), Frame, Main),
        possible(Command("#TRAFO"), Frame, Channel),
        possible(Command("#KIN"), Frame, Channel),
        possible(Command("#RTCP"), Frame, Channel),
        possible(Command("#TRANSFORM"), Frame, Channel),
        possible(Command("#CYL"), Frame, Channel),
        possible(Command("#FACE"), Frame, Channel),
    ]
};

/// Commands in brackets that begin like a row of the table and move nothing.
const AT_REST: [&str; 14] = [
    "LIFT_END",
    "MC_ABORTTRIGGER",
    "MC_GEAROUT",
    "MC_HALT",
    "MC_POWER",
    "MC_READ",
    "MC_RESET",
    "MC_SETOVERRIDE",
    "MC_SETPOSITION",
    "MC_STOP",
    "MC_TOUCHPROBE",
    "MC_WRITE",
    "MC_CAMTABLESELECT",
    "MC_CAMOUT",
];

/// Returns the row of a G function for its axis words; `None` where they move as its group says, or
/// not at all.
pub(in crate::interpreter) fn of_g(number: u32) -> Option<MovingRow> {
    let is = |row: &&MovingRow| matches!(row.form, MovingForm::G(it) if it == number);
    TABLE.iter().find(is).copied()
}

/// Returns the row of a command in the bracket of an axis: `keyword` is its first word, `body` the whole
/// text, both in upper case.
pub(in crate::interpreter) fn of_bracket(keyword: &str, body: &str) -> Option<MovingRow> {
    if AT_REST.iter().any(|word| keyword.starts_with(word)) {
        return None;
    }
    let has = |wanted: &str| body.split(is_between).any(|word| word == wanted);
    let is = |row: &&MovingRow| match row.form {
        MovingForm::Bracket(begin, None) => keyword.starts_with(begin),
        MovingForm::Bracket(begin, Some(second)) => keyword.starts_with(begin) && has(second),
        MovingForm::G(_) | MovingForm::Command(_) => false,
    };
    let row = TABLE.iter().find(is)?;
    // An independent motion that is only computed (PM/208612235).
    (!has("DRY_RUN")).then_some(*row)
}

/// Returns the row of a `#` command that moves axes from here on.
pub(in crate::interpreter) fn of_command(name: &str) -> Option<MovingRow> {
    let begins = |words: &str| {
        name.strip_prefix(words)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
    };
    let is = |row: &&MovingRow| matches!(row.form, MovingForm::Command(words) if begins(words));
    TABLE.iter().find(is).copied()
}

/// Returns whether a character separates the words of a bracket.
pub(in crate::interpreter) fn is_between(letter: char) -> bool {
    !(letter.is_ascii_alphanumeric() || letter == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(body: &str) -> Option<MotionKind> {
        let body = body.to_ascii_uppercase();
        let keyword = body.split(is_between).next().unwrap_or_default();
        of_bracket(keyword, &body).map(|row| row.kind)
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

    #[test]
    fn commands_are_found_by_their_words() {
        // R10.7
        let of = |name| of_command(name).map(|row| (row.kind, row.certainty));
        let frame = MotionKind::Frame;
        assert_eq!(of("#ROTATION"), Some((frame, Certainty::Certain)));
        assert_eq!(of("#CS"), Some((frame, Certainty::Possible)));
        assert_eq!(of("#CSX"), None);
        assert_eq!(
            of("#GANTRY ON"),
            Some((MotionKind::Coupled, Certainty::Certain))
        );
        assert_eq!(of("#MSG"), None);
    }
}
