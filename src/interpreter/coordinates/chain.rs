//! The chain of coordinates: commands and functions that separate positions from those of the machine, and
//! those that are known not to (R2.47, R2.82).
//!
//! PM/n is page n of the TF5200 programming manual.

use super::group::Group;
use super::modal::PositionFrame;

/// Effect of a `#` command on positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::interpreter) enum ChainStep {
    /// It switches to other coordinates, and back.
    Coordinates,
    /// It switches all offsets off, and on again (PM/208517515).
    Machine,
    /// It leaves the programmed points as they are and the path to them open (PM/207256971).
    Path,
    /// It moves the origin, by the machine's own values or for one block.
    Origin,
}

/// The `#` commands that touch the chain, by their first words.
const COMMANDS: [(&str, ChainStep); 29] = [
    ("#TRAFO", ChainStep::Coordinates),
    ("#CS", ChainStep::Coordinates),
    ("#ACS", ChainStep::Coordinates),
    ("#BCS", ChainStep::Coordinates),
    ("#ECS", ChainStep::Coordinates),
    ("#ROTATION", ChainStep::Coordinates),
    ("#SCALE", ChainStep::Coordinates),
    ("#KIN", ChainStep::Coordinates),
    ("#MIRROR", ChainStep::Coordinates),
    ("#RTCP", ChainStep::Coordinates),
    ("#TLC", ChainStep::Coordinates),
    ("#CYL", ChainStep::Coordinates),
    ("#FACE", ChainStep::Coordinates),
    ("#TRANSFORM", ChainStep::Coordinates),
    ("#TRACK CS", ChainStep::Coordinates),
    ("#SYNC", ChainStep::Coordinates),
    ("#MCS", ChainStep::Machine),
    ("#SPLINE", ChainStep::Path),
    ("#SET SPLINE", ChainStep::Path),
    ("#PSET", ChainStep::Origin),
    ("#PRESET", ChainStep::Origin),
    ("#SHIFT", ChainStep::Origin),
    ("#SET OFFSET", ChainStep::Origin),
    ("#SUPPRESS OFFSETS", ChainStep::Origin),
    ("#SET IPO SOLLPOS", ChainStep::Origin),
    ("#CALL AX", ChainStep::Origin),
    ("#SET AX", ChainStep::Origin),
    ("#AX REQUEST", ChainStep::Origin),
    ("#AX DEF", ChainStep::Origin),
];

/// Whether a name denotes a transformation between the coordinates of the program and those of the
/// axes. `#KIN` only chooses one (R1.42).
pub(in crate::interpreter) fn is_transformation(name: &str) -> bool {
    let is_one =
        |(words, step): &(&str, ChainStep)| *words == name && *step == ChainStep::Coordinates;
    name != "#KIN" && COMMANDS.iter().any(is_one)
}

/// Commands that begin like those and touch nothing.
const APART: [&str; 5] = [
    // It returns the tool centre, and switches nothing.
    "#KIN TCP",
    "#MCS TO WCS",
    "#SET AX LINK",
    "#SCALE FACTOR",
    "#SET SPLINETYPE",
];

/// Returns the words of the command that is meant, its effect, and whether it switches that off.
pub(in crate::interpreter) fn command(name: &str) -> Option<(&'static str, ChainStep, bool)> {
    let begins = |words: &str| {
        name.strip_prefix(words)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
    };
    if APART.iter().any(|words| begins(words)) {
        return None;
    }
    let &(words, step) = COMMANDS.iter().find(|(words, _)| begins(words))?;
    let mut further = name[words.len()..].split(' ');
    let off = further.any(|word| matches!(word, "OFF" | "DEL" | "OUT"));
    // The older name of one command.
    let words = if words == "#SET SPLINE" {
        "#SPLINE"
    } else {
        words
    };
    Some((words, step, off))
}

/// What the command or function of a name makes of positions (R11.30): an M, T or D function that may move the
/// origin leaves paths as they are; one whose number is not known may call any program.
pub(super) fn frame(name: &str) -> PositionFrame {
    if name == "G41" {
        return PositionFrame::Contour;
    }
    let is_function = name.starts_with(['M', 'T', 'D']) && name[1..].parse::<u64>().is_ok();
    match command(name) {
        Some((_, ChainStep::Origin | ChainStep::Machine, _)) => PositionFrame::Shifted,
        None if is_function => PositionFrame::Shifted,
        _ => PositionFrame::Programmed,
    }
}

/// M functions that are known not to move an origin: those of DIN 66025-2 and of the manual's overview
/// (tccncprogramming/15557312651).
pub(in crate::interpreter) fn is_named_m(number: i64) -> bool {
    matches!(number, 0..=17 | 19 | 29..=31 | 40..=49 | 60)
}

/// G functions that are known to leave coordinates alone, in addition to those of the groups: block ends,
/// feedforward, gain, weights of dynamics, insertion of chamfers and roundings, override, contouring
/// modes, threads, measuring, software limits (PM/206089483 and its neighbours).
pub(in crate::interpreter) fn is_named_g(number: u32) -> bool {
    matches!(
        number,
        4 | 5 | 8..=13
            | 25 | 26
            | 28
            | 33
            | 60 | 61 | 63
            | 74
            | 92
            | 96..=102
            | 106..=109
            | 112
            | 115..=117
            | 120..=122
            | 127..=141
            | 160 | 163..=167
            | 180
            | 193 | 196 | 197
            | 230 | 231 | 233
            | 236..=239
            | 260 | 261
            | 293 | 296
            | 301..=303
            | 310
            | 331..=334
            | 338 | 339
            | 900 | 901
    )
}

/// G functions that are known by name (R2.94): those that leave coordinates alone, and mirroring, weights,
/// splines, diameters, the operator's hand wheel (vscode-isg-cnc, descriptions of commands; examples of the manual).
pub(in crate::interpreter) fn is_known_g(number: u32) -> bool {
    is_named_g(number)
        || is_implicit_call(number)
        || Group::of(number).is_some()
        || matches!(
            number,
            20..=23
                | 43
                | 44
                | 51
                | 52
                | 66
                | 68
                | 69
                | 150
                | 151
                | 200..=202
                | 234
                | 270
                | 271
                | 280
                | 294
                | 350
                | 351
                | 393
                | 905
        )
}

/// Implicit calls: G80 to G89, G800 to G839 (PM/206278923, P-CHAN-00187).
pub(in crate::interpreter) fn is_implicit_call(number: u32) -> bool {
    matches!(number, 80..=89 | 800..=899)
}

/// Measuring motions, which end where the probe triggers.
pub(in crate::interpreter) fn is_measuring(number: u32) -> bool {
    matches!(number, 100..=102 | 106 | 108 | 310)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_told_apart_by_their_words() {
        // R2.47 R2.82
        let of = |name| command(name).map(|(words, _, off)| (words, off));
        assert_eq!(of("#MCS ON"), Some(("#MCS", false)));
        assert_eq!(of("#MCS ON EX TOOL"), Some(("#MCS", false)));
        assert_eq!(of("#MCS OFF"), Some(("#MCS", true)));
        assert_eq!(of("#MCS TO WCS"), None);
        assert_eq!(of("#CS DEL ALL"), Some(("#CS", true)));
        assert_eq!(of("#CSX ON"), None);
        assert_eq!(of("#SPLINE OFF X10"), Some(("#SPLINE", true)));
        assert_eq!(of("#SET SPLINETYPE AKIMA"), None);
        assert_eq!(of("#SET AX LINK"), None);
        assert_eq!(of("#MSG"), None);
        assert_eq!(of("#SYNC IN"), Some(("#SYNC", false)));
        assert_eq!(of("#SYNC OUT"), Some(("#SYNC", true)));
        assert_eq!(of("#KIN TCP DEF"), None);
    }
}
