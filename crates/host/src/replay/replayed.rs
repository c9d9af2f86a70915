//! Comparison of a recording with the dry run of its programs.

use super::beside::{Measure, replayed_axis};
use super::conditions::{AssumedAnswers, MAX_WAYS};
use super::course::{Course, is_open};
use crate::disk::Input;
use crate::error::HostError;
use crate::machines::LoadedMachine;
use frictcomp::readings::Question;
use frictcomp::session::SessionOptions;
use frictcomp_recordings::replay::{Replayed, StateRecording, TriedCondition};

/// Programs to compare with a recording.
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Replay<'a> {
    /// The programs, one after the other.
    pub inputs: &'a [Input],
    /// Machine of the programs.
    pub loaded: &'a LoadedMachine,
    /// Options of their run.
    pub options: SessionOptions,
    /// Tolerance of positions, in mm or degrees.
    pub tolerance: f64,
}

impl Replay<'_> {
    /// The usual tolerance of positions, in mm or degrees.
    pub const TOLERANCE: f64 = 0.1;

    /// Compares a recording with the dry run, trying every answer to the conditions that only the machine
    /// can decide if these are few (R15.21).
    ///
    /// # Errors
    /// A program cannot be read.
    pub fn compare(&self, recording: &StateRecording) -> Result<Replayed, HostError> {
        let course = Course::of(self.inputs, self.loaded, self.options.clone())?;
        let conditions: Vec<_> = course.conditions.iter().cloned().collect();
        let undecided = self.beside(recording, &course);
        if conditions.is_empty() {
            return Ok(undecided);
        }
        drop(course);
        let all = match AssumedAnswers::all(&conditions) {
            Ok(all) => all,
            Err(count) => {
                let untried = format!(
                    "its conditions have {count} combinations of answers, more than {MAX_WAYS}: decide some \
                     of them beforehand"
                );
                return Ok(Replayed {
                    untried: Some(untried),
                    ..undecided
                });
            }
        };
        let mut best: Option<(usize, Replayed)> = None;
        let mut fitting: Vec<Vec<TriedCondition>> = Vec::new();
        for answers in &all {
            let options = answers.options(&self.options);
            let mut tried = self.beside(recording, &Course::of(self.inputs, self.loaded, options)?);
            rest_on(&mut tried, &answers.to(&conditions));
            let score = if tried.agrees() {
                fitting.push(answers.to(&conditions));
                usize::MAX
            } else {
                tried.changes()
            };
            if best.as_ref().is_none_or(|(most, _)| score > *most) {
                best = Some((score, tried));
            }
        }
        let replayed = best.map_or(undecided, |(_, replayed)| replayed);
        Ok(Replayed {
            decided: if fitting.len() < all.len() {
                common(&fitting)
            } else {
                Vec::new()
            },
            ways: [all.len(), fitting.len()],
            ..replayed
        })
    }

    fn beside(&self, recording: &StateRecording, course: &Course) -> Replayed {
        let of_start: &[&str] = if is_open(Question::Restart, self.loaded) {
            &["R1.28", "R1.29"]
        } else {
            &[]
        };
        let measure = Measure {
            by_number: recording.by_number,
            tolerance: self.tolerance,
            of_start,
        };
        let axes = recording.axes.iter();
        Replayed {
            axes: axes
                .map(|axis| replayed_axis(axis, course, measure))
                .collect(),
            decided: Vec::new(),
            ways: [1, 1],
            stopped: course.stopped.clone(),
            untried: None,
            unrecorded: course.switched_beside(&recording.axes),
            gap: recording.gap,
        }
    }
}

/// Returns the answers that are the same in all combinations.
fn common(fitting: &[Vec<TriedCondition>]) -> Vec<TriedCondition> {
    let Some((first, others)) = fitting.split_first() else {
        return Vec::new();
    };
    let in_all = |tried: &&TriedCondition| others.iter().all(|it| it.contains(tried));
    first.iter().filter(in_all).cloned().collect()
}

/// Notes the answers on which the disagreements depend.
fn rest_on(replayed: &mut Replayed, tried: &[TriedCondition]) {
    let axes = replayed.axes.iter_mut();
    for found in axes.filter_map(|it| it.disagreement.as_mut()) {
        let words = tried.iter().map(|it| {
            let answer = if it.holds { "" } else { "not " };
            format!(
                "{}:{}: taken here: {answer}{}",
                it.file, it.line, it.condition
            )
        });
        found.unknown.extend(words);
    }
}
