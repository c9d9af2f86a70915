//! Comparison of the recorded changes of an axis with those of the dry run.

use std::sync::Arc;

use super::course::{AxisCourse, AxisSwitch, Course, CourseStep};
use frictcomp_recordings::replay::{
    Disagreement, MatchedChange, RecordedAxis, RecordedChange, ReplayPlace, ReplayedAxis,
    ReplayedBy,
};

/// Number of blocks that may pass between two samples.
const MAX_BETWEEN: usize = 1000;

/// Number of blocks of the dry run at which a recording may begin that are tried.
const MAX_BEGINS: usize = 100;

/// Criteria for the comparison.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measure {
    /// Whether blocks are identified by block numbers instead of lines.
    pub(super) by_number: bool,
    /// Tolerance of positions, in mm or degrees.
    pub(super) tolerance: f64,
    /// The rules of the open questions on which the state at the start depends.
    pub(super) of_start: &'static [&'static str],
}

/// Compares an axis of the recording with the dry run.
pub(super) fn replayed_axis(
    recorded: &RecordedAxis,
    course: &Course,
    measure: Measure,
) -> ReplayedAxis {
    let mut axis = ReplayedAxis {
        name: recorded.name.clone(),
        changes: Vec::new(),
        disagreement: None,
    };
    let dry_run = course.axes.iter().find(|it| it.name == recorded.name);
    axis.disagreement = match dry_run {
        None => Some(Disagreement {
            at: None,
            t_s: 0.0,
            recorded: word(Some(recorded.start)),
            dry_run: word(None),
            why: "neither the programs nor the machine name the axis".to_owned(),
            rests_on: Vec::new(),
            unknown: Vec::new(),
        }),
        Some(dry_run) => {
            let pair = AxisBeside {
                recorded,
                dry_run,
                course,
                measure,
            };
            pair.compare(&mut axis.changes)
        }
    };
    axis
}

/// A sample at an end of the recording.
#[derive(Debug, Clone, Copy)]
enum StateSample {
    First,
    Last,
}

struct AxisBeside<'a> {
    recorded: &'a RecordedAxis,
    dry_run: &'a AxisCourse,
    course: &'a Course,
    measure: Measure,
}

impl AxisBeside<'_> {
    /// Returns the first disagreement. Of several blocks of the dry run at which the recording may begin, the one
    /// with which it agrees longest counts.
    fn compare(&self, matched: &mut Vec<MatchedChange>) -> Option<Disagreement> {
        let mut nearest = None;
        for passed in self.begins() {
            let mut agreed = Vec::new();
            let found = self.compare_after(passed, &mut agreed);
            let is_over = found.is_none();
            if is_over || nearest.is_none() || agreed.len() > matched.len() {
                (nearest, *matched) = (Some(found), agreed);
            }
            if is_over {
                break;
            }
        }
        nearest.unwrap_or_else(|| Some(self.other_start()))
    }

    /// Numbers of switches of the dry run that may come before the first sample: none, or those before a block that
    /// the sample names, with its own or without (R15.20).
    fn begins(&self) -> Vec<usize> {
        let steps =
            (0..self.course.steps.len()).filter(|at| self.is_sampled(*at, StateSample::First));
        let passed = steps.flat_map(|at| [self.passed(at), self.passed(at + 1)]);
        let mut begins: Vec<usize> = Vec::new();
        for passed in std::iter::once(0).chain(passed) {
            let is_new = begins.last() != Some(&passed);
            if is_new && self.state_after(passed) == Some(self.recorded.start) {
                begins.push(passed);
            }
            if begins.len() >= MAX_BEGINS {
                break;
            }
        }
        begins
    }

    /// Returns the number of switches before a step.
    fn passed(&self, step: usize) -> usize {
        self.dry_run.switches.partition_point(|it| it.at < step)
    }

    /// Returns the state of the dry run after some of its switches.
    fn state_after(&self, passed: usize) -> Option<bool> {
        match passed.checked_sub(1) {
            Some(last) => self.dry_run.switches.get(last)?.to,
            None => self.dry_run.start,
        }
    }

    /// Returns whether a step is the block of the first or the last sample.
    fn is_sampled(&self, at: usize, sample: StateSample) -> bool {
        let of = |pair: [i64; 2]| match sample {
            StateSample::First => pair[0],
            StateSample::Last => pair[1],
        };
        let (Some(step), Some(blocks)) = (self.course.steps.get(at), self.recorded.blocks) else {
            return false;
        };
        let program = i64::from(step.program);
        let is_of_program = self.recorded.programs.is_none_or(|it| of(it) == program);
        is_of_program && self.key(step) == Some(of(blocks))
    }

    fn other_start(&self) -> Disagreement {
        let steps = 0..self.course.steps.len();
        let first = steps
            .clone()
            .find(|at| self.is_sampled(*at, StateSample::First));
        let first = first.filter(|at| self.passed(at + 1) > 0);
        let passed = first.map_or(0, |at| self.passed(at + 1));
        let step = first.and_then(|at| self.course.steps.get(at));
        let of_step = step.map_or(&[][..], |step| &step.rests_on);
        let of_start = if step.is_none() {
            self.measure.of_start
        } else {
            of_step
        };
        Disagreement {
            at: first.and_then(|at| self.place(at)),
            t_s: self.recorded.start_s,
            recorded: word(Some(self.recorded.start)),
            dry_run: word(self.state_after(passed)),
            why: "they begin in different states".to_owned(),
            rests_on: of_start.to_vec(),
            unknown: Vec::new(),
        }
    }

    /// Compares the changes after those that the recording does not contain.
    fn compare_after(
        &self,
        passed: usize,
        matched: &mut Vec<MatchedChange>,
    ) -> Option<Disagreement> {
        let switches = self.dry_run.switches.get(passed..).unwrap_or_default();
        let mut from = match passed.checked_sub(1) {
            Some(last) => self.dry_run.switches.get(last)?.at + 1,
            None => 0,
        };
        let most = self.recorded.changes.len().max(switches.len());
        for at in 0..most {
            let change = self.recorded.changes.get(at);
            let switch = switches.get(at);
            let reason = match (change, switch) {
                (Some(change), Some(switch)) => self.reason(change, switch),
                (Some(_), None) => Some("the dry run has no further change".to_owned()),
                // The last sample may be taken before its block acts.
                (None, Some(switch)) if self.is_sampled(switch.at, StateSample::Last) => None,
                (None, _) => Some("the recording has no further change".to_owned()),
            };
            if let Some(why) = reason {
                return Some(self.disagreement(change, switch, from, why));
            }
            if let (Some(change), Some(switch)) = (change, switch) {
                from = switch.at + 1;
                matched.extend(self.place(switch.at).map(|at| MatchedChange {
                    at,
                    t_s: change.t_s,
                    active: change.active,
                    by: self.compared_by(change, switch),
                }));
            }
        }
        None
    }

    fn compared_by(&self, change: &RecordedChange, switch: &AxisSwitch) -> ReplayedBy {
        match (change.blocks, change.positions.zip(switch.positions)) {
            (Some(_), _) if self.measure.by_number => ReplayedBy::Block,
            (Some(_), _) => ReplayedBy::Line,
            (None, Some(_)) => ReplayedBy::Position,
            (None, None) => ReplayedBy::Order,
        }
    }

    /// Returns why a change of the recording does not match that of the dry run.
    fn reason(&self, change: &RecordedChange, switch: &AxisSwitch) -> Option<String> {
        let Some(to) = switch.to else {
            return Some("the state in the dry run is unknown".to_owned());
        };
        if to != change.active {
            return Some("they change to different states".to_owned());
        }
        let step = self.course.steps.get(switch.at)?;
        let program = i64::from(step.program);
        if change.programs.is_some_and(|it| !it.contains(&program)) {
            return Some("the machine changes in another program".to_owned());
        }
        if let Some([before, after]) = change.blocks {
            let kind = if self.measure.by_number {
                "block"
            } else {
                "line"
            };
            return (!self.passes(switch.at, [before, after])).then(|| {
                let numbers = if self.are_numbers([before, after]) {
                    "; the program has no such lines, but has such block numbers"
                } else {
                    ""
                };
                if before == after {
                    format!("the machine changes at {kind} {after}{numbers}")
                } else {
                    format!(
                        "the machine changes between {kind} {before} and {kind} {after}{numbers}"
                    )
                }
            });
        }
        let (one, other) = (change.positions?, switch.positions?);
        let low = |pair: [f64; 2]| pair[0].min(pair[1]) - self.measure.tolerance / 2.0;
        let high = |pair: [f64; 2]| pair[0].max(pair[1]) + self.measure.tolerance / 2.0;
        let meet = low(one) <= high(other) && low(other) <= high(one);
        (!meet).then(|| {
            format!(
                "the machine changes at {} = {:.3}, the dry run between {:.3} and {:.3}",
                self.recorded.name, one[1], other[0], other[1]
            )
        })
    }

    /// Returns whether what was recorded as lines can only be block numbers.
    fn are_numbers(&self, recorded: [i64; 2]) -> bool {
        let steps = &self.course.steps;
        let is_line = |it: &i64| steps.iter().any(|step| i64::from(step.line) == *it);
        let is_number = |it: &i64| steps.iter().any(|step| step.number == Some(*it));
        !self.measure.by_number && recorded.iter().all(is_number) && !recorded.iter().all(is_line)
    }

    fn key(&self, step: &CourseStep) -> Option<i64> {
        if self.measure.by_number {
            step.number
        } else {
            Some(i64::from(step.line))
        }
    }

    /// Returns whether a step of the dry run lies between the blocks of two samples.
    fn passes(&self, at: usize, [before, after]: [i64; 2]) -> bool {
        let steps = &self.course.steps;
        let key = |at: &usize| steps.get(*at).and_then(|step| self.key(step));
        let own = key(&at);
        if own == Some(before) || own == Some(after) {
            return true;
        }
        let ends_with = |mut keys: Box<dyn Iterator<Item = i64> + '_>, end: i64, never: i64| {
            let met = keys.find(|it| *it == end || *it == never);
            end != never && met == Some(end)
        };
        let later = (at + 1..steps.len()).take(MAX_BETWEEN);
        let earlier = (0..at).rev().take(MAX_BETWEEN);
        ends_with(Box::new(later.filter_map(|it| key(&it))), after, before)
            && ends_with(Box::new(earlier.filter_map(|it| key(&it))), before, after)
    }

    fn place(&self, at: usize) -> Option<ReplayPlace> {
        let step = self.course.steps.get(at)?;
        Some(ReplayPlace {
            file: Arc::clone(&step.file),
            line: step.line,
        })
    }

    /// Returns the disagreement at the earlier one of two changes that do not match.
    fn disagreement(
        &self,
        change: Option<&RecordedChange>,
        switch: Option<&AxisSwitch>,
        from: usize,
        why: String,
    ) -> Disagreement {
        let of_machine = change.and_then(|it| self.step_of(it, from));
        let of_dry_run = switch.map(|it| it.at);
        let is_machine_first = match (of_machine, of_dry_run) {
            (Some(machine), Some(dry_run)) => machine < dry_run,
            (_, dry_run) => dry_run.is_none(),
        };
        let before = match from.checked_sub(1) {
            Some(_) => self.state_before(from),
            None => self.dry_run.start,
        };
        let (at, recorded, dry_run) = if is_machine_first {
            (of_machine, change.map(|it| it.active), before)
        } else {
            (of_dry_run, before, switch.and_then(|it| it.to))
        };
        let both = [of_machine, of_dry_run].into_iter().flatten();
        let steps = both.filter_map(|at| self.course.steps.get(at));
        let mut rests_on: Vec<_> = steps.flat_map(|it| it.rests_on.iter().copied()).collect();
        rests_on.sort_unstable();
        rests_on.dedup();
        Disagreement {
            at: at.and_then(|at| self.place(at)),
            t_s: change.map_or(self.recorded.end_s, |it| it.t_s),
            recorded: word(recorded),
            dry_run: word(dry_run),
            why,
            rests_on,
            unknown: switch
                .and_then(|it| it.unknown.clone())
                .into_iter()
                .collect(),
        }
    }

    /// Returns the state of both up to a step.
    fn state_before(&self, step: usize) -> Option<bool> {
        let mut switches = self.dry_run.switches.iter().rev();
        switches.find(|it| it.at < step)?.to
    }

    /// Returns the step at which a change was recorded.
    fn step_of(&self, change: &RecordedChange, from: usize) -> Option<usize> {
        let [_, after] = change.blocks?;
        let mut steps = self.course.steps.iter().enumerate().skip(from);
        let found = steps.find(|(_, step)| {
            let program = i64::from(step.program);
            let fits = change.programs.is_none_or(|it| it.contains(&program));
            fits && self.key(step) == Some(after)
        });
        found.map(|(at, _)| at)
    }
}

fn word(active: Option<bool>) -> &'static str {
    match active {
        Some(true) => "active",
        Some(false) => "inactive",
        None => "unknown",
    }
}
