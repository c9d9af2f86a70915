//! FC403: the program moves an axis in a state that an earlier program left (R1.52, R18.4).

use crate::comp::{AxisIndex, Kind, State};
use crate::diagnostic::{Code, Diagnostic, Fix, Severity};
use crate::interpreter::{Certainty, Executed, MotionKind, MovedAxis, UntouchedOn};
use crate::lint::linter::Linter;
use crate::lint::memory::{Held, Maker, Touch, is_of_a_kind};
use crate::syntax::code_of;
use crate::text::lines_of;

/// The most characters of a block that a message shows.
const MAX_SHOWN: usize = 60;

/// Returns FC403 as soon as it is certain that a program moves an axis at feed in a state that was left before it: the
/// part is then cut without compensation. An info about another motion is held back until the end (R18.4).
pub(super) fn lint(
    linter: &mut Linter<'_>,
    (motion, is_first): (&MovedAxis, bool),
    executed: &Executed<'_>,
) -> Option<Diagnostic> {
    let axis = motion.axis;
    if linter.memory.axis(axis).inherited.is_settled {
        return None;
    }
    let has_found = executed.found.has(axis, Kind::Frict);
    let found = linter.found(axis);
    let pace = executed.moves().feeds(motion);
    let is_known =
        found != State::Unknown && executed.compensation.state(axis, Kind::Frict) == found;
    let inherited = linter.memory.inherited(axis);
    if !has_found {
        inherited.is_settled = executed.branch.is_none();
        return None;
    }
    if pace == Some(Certainty::Certain)
        && is_known
        && let Some(touch) = inherited.cut(motion, executed)
    {
        inherited.is_settled = true;
        inherited.held = None;
        let how = format!("moves with friction compensation {}", found.as_str());
        return Some(said(linter, (axis, &touch), &how, ""));
    }
    let is_feed = pace.is_some() && is_of_a_kind(motion);
    let outweighs = match &inherited.held {
        Some(held) => is_feed && !held.is_feed,
        None => is_first,
    };
    if outweighs {
        let touch = Touch::new(motion, executed);
        let mut said = perhaps(linter, (axis, &touch), executed)?;
        said.lower(Severity::Info);
        let inherited = linter.memory.inherited(axis);
        inherited.is_settled = is_feed && found == State::Unknown;
        inherited.held = Some(Held {
            seq: executed.seq,
            said,
            is_feed,
        });
    }
    None
}

/// Returns FC403 about a motion in rapid, or one of which something is not certain, with its condition.
fn perhaps(
    linter: &Linter<'_>,
    (axis, touch): (AxisIndex, &Touch),
    executed: &Executed<'_>,
) -> Option<Diagnostic> {
    let file = &touch.site.place.file;
    let found = linter.found(axis);
    let ways = match executed.found.of(axis, Kind::Frict, file) {
        UntouchedOn::Never => return None,
        UntouchedOn::Always => String::new(),
        UntouchedOn::If(ways) => format!(" {ways}"),
    };
    let may = match touch.certainty {
        Certainty::Possible => "may move",
        Certainty::Certain => "moves",
    };
    let state = executed.compensation.state(axis, Kind::Frict);
    let how = match (found, state, executed.possible_of(axis, Kind::Frict)) {
        // An earlier program left it so on some ways only (R14.7).
        (State::Unknown, State::Unknown, Some(possible)) if ways.is_empty() => format!(
            "{may} with friction compensation {}",
            possible.in_words(file)
        ),
        (State::Unknown, ..) => format!("{may} in an unknown state of friction compensation"),
        // Blocks that are passed over could have switched it (R2.51).
        (found, State::Unknown, None) => {
            format!("may move with friction compensation {}", found.as_str())
        }
        (found, ..) => format!("{may} with friction compensation {}", found.as_str()),
    };
    Some(said(linter, (axis, touch), &how, &ways))
}

fn said(
    linter: &Linter<'_>,
    (axis, touch): (AxisIndex, &Touch),
    how: &str,
    ways: &str,
) -> Diagnostic {
    let name = linter.name(axis);
    let who = match linter.states.maker(axis, Kind::Frict) {
        Some(maker) => named(maker),
        None => "a program that is not known".to_owned(),
    };
    let commands = ["ON", "OFF"].map(|way| format!("{name}[COMP {way} FRICT]"));
    let [on, off] = &commands;
    let mut diagnostic = Diagnostic::new(
        Code::Fc403,
        touch.site.place.clone(),
        format!(
            "axis `{name}` {how}{}{ways}, left so by {who}",
            way(touch.kind)
        ),
    )
    .with_axis(name)
    .with_help(format!("set it at program start, `{on}` or `{off}`"));
    if let Some(begin) = &linter.begin {
        let fix = |command: &String| Fix::block(begin.clone(), command);
        diagnostic.fixes.extend(commands.iter().map(fix));
    }
    diagnostic
}

/// Returns the kind of motion in words, for motion without a motion word of the axis.
fn way(kind: MotionKind) -> &'static str {
    match kind {
        MotionKind::Homing => " towards its reference point",
        MotionKind::Independent => " by itself",
        MotionKind::Coupled => " because it follows another axis",
        MotionKind::Frame => {
            " because coordinates are rotated, transformed or offset by a tool radius"
        }
        _ => "",
    }
}

/// Returns program, line and block in words.
fn named(maker: &Maker) -> String {
    let code: Vec<String> = lines_of(&maker.text).map(code_of).collect();
    let code = code.join(" ");
    let words: Vec<&str> = code.split_whitespace().collect();
    let text = words.join(" ");
    let mut shown: String = text.chars().take(MAX_SHOWN).collect();
    if shown.len() < text.len() {
        shown.push('…');
    }
    let (file, line) = (&maker.file, maker.line);
    if maker.program == *file {
        format!("`{shown}` at {file}:{line}")
    } else {
        format!("`{shown}` at {file}:{line} of program `{}`", maker.program)
    }
}
