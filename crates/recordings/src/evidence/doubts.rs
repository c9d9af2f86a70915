//! Reasons why a recording cannot decide a question.

use super::recorded::{CycleMotion, EvidenceRecording};
use frictcomp::diagnostic::ReadableNumber;
use frictcomp::lists::FrictionList;
use frictcomp::readings::Question;
use frictcomp_physics::current::{CommandedRow, Switched};

/// Returns the reason why the readings of a question give the same current with a value list, whatever the motion.
pub(super) fn no_difference(question: Question, list: &FrictionList) -> Option<String> {
    let first = list.table.first();
    let is_silent = list.scaling_factor == 0 || list.table.iter().all(|it| it.output == 0.0);
    if is_silent {
        return Some("the value list gives no current".to_owned());
    }
    let from_zero = first.is_some_and(|it| it.input == 0.0);
    let starts_silent = first.is_some_and(|it| it.output == 0.0);
    let reason = match question {
        Question::Standstill if starts_silent => {
            "the value list gives no current at standstill: the current of its first point is 0"
        }
        Question::Below if from_zero => {
            "the first point of the value list is at 0: nothing is below it"
        }
        Question::Below if starts_silent => {
            "the current of the first point is 0: below it no reading gives a current"
        }
        Question::Delay if list.delay_cycles <= 0 => "`delay_cycles` is 0: nothing is delayed",
        Question::Start if list.position_delay <= 0 => {
            "`position_delay` is 0: there is no build-up"
        }
        Question::Decay if list.reversal_lookahead < 2 => {
            "`reversal_lookahead` is below 2: there are no cycles to decay in"
        }
        _ => return None,
    };
    Some(reason.to_owned())
}

/// Returns the reason why no sample counts.
pub(super) fn unseen(recorded: &EvidenceRecording, motion: &CycleMotion) -> &'static str {
    let mut rows = motion.rows.iter();
    let state = recorded.state.as_ref();
    if state.is_some_and(|it| it.values.iter().all(|value| *value == 0.0)) {
        "friction compensation is off throughout"
    } else if rows.all(|row| row.velocity == 0.0) {
        "the axis does not move while it is recorded"
    } else {
        "the axis does not move far enough with friction compensation on"
    }
}

/// Returns the motion that a question needs and the recording lacks.
pub(super) fn not_moved(
    question: Question,
    list: &FrictionList,
    motion: &CycleMotion,
) -> Option<String> {
    let rows: Vec<&CommandedRow> = motion.rows.iter().collect();
    let is_on = |row: &CommandedRow| row.switched == Switched::On;
    let first = list.table.first().map_or(0.0, |it| it.input);
    let is_there = match question {
        Question::Below => rows
            .iter()
            .any(|row| is_on(row) && row.velocity != 0.0 && row.velocity.abs() < first),
        Question::Standstill => stops(&rows).next().is_some(),
        Question::Start => {
            stops(&rows).any(|(before, after)| after.is_some_and(|it| it * before > 0.0))
        }
        Question::Decay => reverses(&rows),
        _ => rows
            .windows(2)
            .any(|pair| (pair[0].velocity - pair[1].velocity).abs() > 0.0),
    };
    let lacking = match question {
        _ if is_there => return None,
        Question::Below => {
            return Some(format!(
                "the axis never moves slower than the first point, {} µm/s",
                ReadableNumber(first)
            ));
        }
        Question::Standstill => "the axis is never at standstill after a motion",
        Question::Start => "the axis never starts again in the direction in which it stopped",
        Question::Decay => "the axis never reverses",
        _ => "the axis never changes its velocity",
    };
    Some(lacking.to_owned())
}

/// Returns the standstills after a motion, by the velocities before and after each.
fn stops<'a>(rows: &'a [&'a CommandedRow]) -> impl Iterator<Item = (f64, Option<f64>)> + 'a {
    let pairs = rows.windows(2).enumerate();
    let begins = pairs.filter(|(_, pair)| pair[0].velocity != 0.0 && pair[1].velocity == 0.0);
    begins.map(|(at, pair)| {
        let later = rows[at + 1..].iter().find(|row| row.velocity != 0.0);
        (pair[0].velocity, later.map(|row| row.velocity))
    })
}

fn reverses(rows: &[&CommandedRow]) -> bool {
    let mut moving = rows.iter().map(|row| row.velocity).filter(|it| *it != 0.0);
    let Some(first) = moving.next() else {
        return false;
    };
    moving.any(|velocity| velocity * first < 0.0)
}
