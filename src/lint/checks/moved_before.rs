//! FC403: the program moves an axis in a state that an earlier program left (R1.52).

use crate::comp::{AxisIndex, Kind, State};
use crate::diagnostic::{Code, Diagnostic, Fix};
use crate::interpreter::{Certainty, Executed, MotionKind, UntouchedOn};
use crate::lint::history::Maker;
use crate::lint::linter::Linter;
use crate::syntax::code_of;

/// The most characters of a block that a message shows.
const MAX_SHOWN: usize = 60;

pub(super) fn lint(
    linter: &Linter<'_>,
    axis: AxisIndex,
    executed: &Executed<'_>,
) -> Option<Diagnostic> {
    let memory = linter.memory.axis(axis);
    let state = executed.compensation.state(axis, Kind::Frict);
    let found = linter.found(axis);
    let start_up = linter.history.start_up(axis, Kind::Frict);
    if found == start_up {
        return None;
    }
    let name = linter.name(axis);
    let touched = memory.touched.as_ref()?;
    let file = &touched.site.place.file;
    let ways = match executed.found.of(axis, Kind::Frict, file) {
        UntouchedOn::Never => return None,
        UntouchedOn::Always => String::new(),
        UntouchedOn::If(ways) => format!(" {ways}"),
    };
    let may = match touched.certainty {
        Certainty::Possible => "may move",
        Certainty::Certain => "moves",
    };
    let mut possible = executed.possible.iter();
    let possible = possible.find(|it| (it.axis, it.kind) == (axis, Kind::Frict));
    let how = match (found, state, possible) {
        // An earlier program left it so on some ways only (R14.7).
        (State::Unknown, State::Unknown, Some(possible)) if ways.is_empty() => format!(
            "{may} with friction compensation {}",
            possible.in_words(file)
        ),
        (State::Unknown, ..) => format!("{may} in an unknown state of friction compensation"),
        // A region that may or may not be executed could have switched it (R2.51).
        (found, State::Unknown, None) => {
            format!("may move with friction compensation {}", found.as_str())
        }
        (found, ..) => format!("{may} with friction compensation {}", found.as_str()),
    };
    let who = match linter.history.maker(axis, Kind::Frict) {
        Some(maker) => named(maker),
        None => "a program that is not known".to_owned(),
    };
    let place = touched.site.place.clone();
    let commands = ["ON", "OFF"].map(|way| format!("{name}[COMP {way} FRICT]"));
    let [on, off] = &commands;
    let mut diagnostic = Diagnostic::new(
        Code::Fc403,
        place,
        format!(
            "axis `{name}` {how}{}{ways}, left so by {who}",
            way(touched.kind)
        ),
    )
    .with_axis(name)
    .with_help(format!("set it at program start, `{on}` or `{off}`"));
    if let Some(begin) = &linter.begin {
        let fix = |command: &String| Fix::guess(begin.clone(), format!("{command}\n"));
        diagnostic.fixes.extend(commands.iter().map(fix));
    }
    Some(diagnostic)
}

/// Returns the kind of motion in words, for motion without a motion word of the axis.
fn way(kind: MotionKind) -> &'static str {
    match kind {
        MotionKind::Homing => " towards its reference point",
        MotionKind::Independent => " by itself",
        MotionKind::Coupled => " because it follows another axis",
        MotionKind::Frame => " because coordinates are rotated or transformed",
        _ => "",
    }
}

/// Returns program, line and block in words.
fn named(maker: &Maker) -> String {
    let code: Vec<String> = maker.text.lines().map(code_of).collect();
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
