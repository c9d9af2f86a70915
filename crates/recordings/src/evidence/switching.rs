//! Position in a motion at which a COMP command acts (R1.9), and whether it stops the path (R1.57).

use super::answer::Conclusion;
use super::recorded::EvidenceRecording;
use super::stroke::{StrokeOut, StrokeSwitch};
use frictcomp::readings::{Alternative, Question};

/// The blocks in which the program of R1.9 moves, as parts of its stroke: the command off precedes them,
/// and each of the others has one of the commands on, off, on.
pub const WITH_MOTION_PARTS: [f64; 4] = [0.3, 0.2, 0.3, 0.2];

/// The blocks in which the program of R1.57 moves: between them off, on, nothing, off; on follows the last.
pub const LOOK_AHEAD_PARTS: [f64; 5] = [0.3, 0.2, 0.15, 0.15, 0.2];

/// Part of the stroke within which a switch of the state lies from where it is expected.
const NEAR: f64 = 0.05;

/// Part of the usual speed below which the path stops.
const STOPS: f64 = 0.05;

/// Part of the usual speed above which it continues.
const RUNS_ON: f64 = 0.5;

/// Judges from a recording of its program whether a command acts before the motion of its block.
pub fn judge_with_motion(recorded: &EvidenceRecording) -> Conclusion {
    Conclusion::of(Question::WithMotion, with_motion(recorded))
}

fn with_motion(recorded: &EvidenceRecording) -> Result<(Alternative, String), String> {
    let stroke = StrokeOut::of(recorded)?;
    let mut switches = stroke.switches.as_slice();
    if stroke.begins_on {
        let [first, rest @ ..] = switches else {
            return Err(not_of_program(Question::WithMotion, switches));
        };
        if first.is_on || first.part > NEAR {
            return Err(not_of_program(Question::WithMotion, switches));
        }
        switches = rest;
    }
    let [a, b, c, d] = WITH_MOTION_PARTS;
    let before = [(true, a), (false, a + b), (true, a + b + c)];
    let after = [(true, a + b), (false, a + b + c), (true, a + b + c + d)];
    let found = shown(switches);
    if are_at(switches, &before) {
        return Ok((
            Alternative::First,
            format!("{found}: where their blocks begin"),
        ));
    }
    if are_at(switches, &after) {
        return Ok((
            Alternative::Second,
            format!("{found}: where their blocks end"),
        ));
    }
    Err(not_of_program(Question::WithMotion, switches))
}

/// Judges from a recording of its program whether a command stops the path.
pub fn judge_look_ahead(recorded: &EvidenceRecording) -> Conclusion {
    Conclusion::of(Question::LookAhead, look_ahead(recorded))
}

fn look_ahead(recorded: &EvidenceRecording) -> Result<(Alternative, String), String> {
    let stroke = StrokeOut::of(recorded)?;
    let [first, second, third, fourth, last] = LOOK_AHEAD_PARTS;
    let at_plain = first + second + third;
    let at_commands = [first, first + second, at_plain + fourth];
    let all = [
        (false, at_commands[0]),
        (true, at_commands[1]),
        (false, at_commands[2]),
        (true, at_commands[2] + last),
    ];
    if !stroke.begins_on || !are_at(&stroke.switches, &all) {
        return Err(not_of_program(Question::LookAhead, &stroke.switches));
    }
    let plain = stroke.slowest_at(at_plain);
    if plain < RUNS_ON {
        return Err(format!(
            "the path falls to {} at a block border without a command, too",
            percent(plain)
        ));
    }
    let slowest = at_commands.map(|part| stroke.slowest_at(part));
    let words = format!(
        "at the three commands the speed is {}, {} and {} of the usual one, and {} at a border without a command",
        percent(slowest[0]),
        percent(slowest[1]),
        percent(slowest[2]),
        percent(plain)
    );
    if slowest.iter().all(|it| *it >= RUNS_ON) {
        return Ok((Alternative::First, words));
    }
    if slowest.iter().all(|it| *it <= STOPS) {
        return Ok((Alternative::Second, words));
    }
    Err(format!(
        "{words}: it neither stops nor continues at all of them"
    ))
}

/// Returns whether the switches are those of a program, at their places.
fn are_at(switches: &[StrokeSwitch], expected: &[(bool, f64)]) -> bool {
    let mut pairs = switches.iter().zip(expected);
    let fits = pairs.all(|(switch, (is_on, part))| {
        switch.is_on == *is_on && (switch.part - part).abs() <= NEAR
    });
    fits && switches.len() == expected.len()
}

fn not_of_program(question: Question, switches: &[StrokeSwitch]) -> String {
    let rule = question.facts().rule;
    let found = if switches.is_empty() {
        "it never switches".to_owned()
    } else {
        shown(switches)
    };
    format!("the recording is not that of `ask-{rule}.nc`: {found}")
}

fn shown(switches: &[StrokeSwitch]) -> String {
    let each = switches.iter().map(|switch| {
        let word = if switch.is_on { "on" } else { "off" };
        format!("{word} after {}", percent(switch.part))
    });
    let each: Vec<String> = each.collect();
    format!("it switches {} of the stroke", each.join(", "))
}

fn percent(part: f64) -> String {
    format!("{:.0} %", part * 100.0)
}
