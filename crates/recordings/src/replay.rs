//! A recording of the states of friction compensation, and its comparison with the dry run of the programs (R15.20).

use std::sync::Arc;

/// Recording of all axes.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct StateRecording {
    /// Each axis whose state was recorded.
    pub axes: Vec<RecordedAxis>,
    /// The longest stretch without samples, if there is one.
    pub gap: Option<RecordedGap>,
    /// Whether blocks were recorded by block numbers instead of lines.
    pub by_number: bool,
}

/// A stretch of a recording in which samples are missing.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct RecordedGap {
    /// The time of the last sample before it, in seconds.
    pub at_s: f64,
    /// Length in seconds.
    pub length_s: f64,
}

/// Recording of an axis.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct RecordedAxis {
    /// Name.
    pub name: String,
    /// Whether friction compensation was active at the first sample.
    pub start: bool,
    /// The time of the first sample in seconds.
    pub start_s: f64,
    /// Changes in their order.
    pub changes: Vec<RecordedChange>,
    /// The time of the last sample in seconds.
    pub end_s: f64,
    /// The lines, or block numbers, of the first and the last sample.
    pub blocks: Option<[i64; 2]>,
    /// The running numbers of the program at the first and the last sample.
    pub programs: Option<[i64; 2]>,
}

/// A recorded change of a state, with values from the sample before it and its own.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct RecordedChange {
    /// The time of its first sample in seconds.
    pub t_s: f64,
    /// Whether friction compensation is active from then on.
    pub active: bool,
    /// The lines, or block numbers.
    pub blocks: Option<[i64; 2]>,
    /// The running numbers of the program.
    pub programs: Option<[i64; 2]>,
    /// The positions of the axis in mm or degrees.
    pub positions: Option<[f64; 2]>,
}

/// A block, identified by its place.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ReplayPlace {
    /// Path of the file.
    pub file: Arc<str>,
    /// The line, from 1.
    pub line: u32,
}

frictcomp::words! {
    /// Evidence that a change of the machine matches that of the dry run.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[cfg_attr(not(feature = "unstable"), non_exhaustive)]
    pub enum ReplayedBy {
        /// The line of the program.
        Line = "line",
        /// The block number.
        Block = "block",
        /// The position of the axis.
        Position = "position",
        /// The order of the changes alone.
        Order = "order",
    }
}

/// A change on which machine and dry run agree.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct MatchedChange {
    /// The block of the dry run.
    pub at: ReplayPlace,
    /// The time of the recording in seconds.
    pub t_s: f64,
    /// Whether friction compensation is active from then on.
    pub active: bool,
    /// Evidence that both match.
    pub by: ReplayedBy,
}

/// The first place where machine and dry run disagree.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Disagreement {
    /// The block; `None` before the first one.
    pub at: Option<ReplayPlace>,
    /// The time of the recording in seconds.
    pub t_s: f64,
    /// Recorded state: `active` or `inactive`.
    pub recorded: &'static str,
    /// State of the dry run: `active`, `inactive` or `unknown`.
    pub dry_run: &'static str,
    /// The reason in words.
    pub why: String,
    /// The rules of the open questions on which the block depends.
    pub rests_on: Vec<&'static str>,
    /// Unknown values on which the state of the dry run depends.
    pub unknown: Vec<String>,
}

/// An axis of the recording.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ReplayedAxis {
    /// Name.
    pub name: String,
    /// The changes on which both agree, before the first disagreement if there is one.
    pub changes: Vec<MatchedChange>,
    /// The first disagreement.
    pub disagreement: Option<Disagreement>,
}

/// A condition with the answer that was tried.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct TriedCondition {
    /// Path of the file.
    pub file: Arc<str>,
    /// The line, from 1.
    pub line: u32,
    /// The condition as written, or `skip level 1 is off`.
    pub condition: String,
    /// Whether the condition holds.
    pub holds: bool,
}

/// Result of the comparison.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Replayed {
    /// Each axis of the recording.
    pub axes: Vec<ReplayedAxis>,
    /// The conditions decided by the recording.
    pub decided: Vec<TriedCondition>,
    /// Number of combinations of answers to the conditions of the programs that were tried, and of
    /// those that agree with the recording.
    pub ways: [usize; 2],
    /// Reason why the dry run does not reach the end of the programs.
    pub stopped: Option<String>,
    /// Reason why no answers were tried although there are conditions.
    pub untried: Option<String>,
    /// The axes that the programs switch and whose states were not recorded.
    pub unrecorded: Vec<String>,
    /// The longest stretch without samples: a change that is undone within it is not seen.
    pub gap: Option<RecordedGap>,
}

impl Replayed {
    /// Returns whether the recording and the dry run agree on every axis and to the end.
    pub fn agrees(&self) -> bool {
        self.stopped.is_none() && self.axes.iter().all(|it| it.disagreement.is_none())
    }

    /// Returns whether they agree only with some answers to the conditions of the programs.
    pub fn is_conditional(&self) -> bool {
        let [tried, fitting] = self.ways;
        self.agrees() && fitting < tried
    }

    /// Returns the number of changes on which they agree.
    pub fn changes(&self) -> usize {
        self.axes.iter().map(|it| it.changes.len()).sum()
    }
}
