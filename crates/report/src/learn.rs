//! Learning from recorded circles as text and JSON, and the file that keeps its rounds (R16.4).

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use super::assumptions::not_modelled_line;
use super::commission::ValueListUsed;
use super::strings::to_pretty;
use super::visible::visible_line;
use crate::table::Table;
use frictcomp::lists::FrictionList;
use frictcomp_physics::circle::RoundVerdict;

/// The content of `learning.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LearningFile {
    /// The version of the format of this file.
    pub schema: u32,
    /// The measured friction of X and Y, which bounds all lists.
    pub friction: [MeasuredFriction; 2],
    /// The rounds, first to last.
    pub rounds: Vec<LearningRound>,
}

/// Measured friction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredFriction {
    /// The file that it was read from, and its SHA-256.
    pub from: ValueListUsed,
    /// The list.
    pub list: FrictionList,
}

/// A round: the lists handed out for it, and the recordings made with them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LearningRound {
    /// The lists of X and Y.
    pub lists: [ValueListUsed; 2],
    /// The predictions of the plant for X and Y.
    pub predictions: [Option<Prediction>; 2],
    /// The recordings on which the next round rests; none before.
    pub recordings: Vec<RecordedFile>,
}

/// The prediction for a list.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Prediction {
    /// The largest glitch.
    #[serde(rename = "predicted_glitch")]
    pub glitch_um: f64,
    /// Stiffness of the contact that fits the recordings, as a multiple of that of the plant.
    #[serde(rename = "predicted_contact")]
    pub contact: f64,
}

/// A recording with its SHA-256.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecordedFile {
    /// The file within the folder of its round.
    pub file: String,
    /// The SHA-256 of its bytes in hexadecimal digits.
    pub sha256: String,
}

impl LearningFile {
    /// The version that is written.
    pub const SCHEMA: u32 = 1;
}

impl Prediction {
    /// Whether the recording misses the prediction by more than max(25 %, 0.5 µm) (R16.9).
    pub fn is_missed_by(&self, recorded_um: f64) -> bool {
        (recorded_um - self.glitch_um).abs() > f64::max(0.25 * self.glitch_um, 0.5)
    }
}

/// The progress of an axis.
#[derive(Debug, Clone, Serialize)]
pub struct LearnedAxis {
    /// The axis.
    pub axis: &'static str,
    /// The judgement of each recorded round.
    pub rounds: Vec<RoundVerdict>,
    /// The number of the best round, from 1 on; `None` before the first is recorded.
    pub best_round: Option<usize>,
    /// The list of that round.
    pub list: Option<String>,
    /// Whether two rounds in succession brought no gain.
    pub is_over: bool,
}

/// The next step of the user.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum NextStep {
    /// Recordings are needed in this folder, with these lists.
    Record {
        /// Path of the folder.
        folder: String,
        /// The lists of X and Y.
        lists: [String; 2],
    },
    /// No further gain is possible.
    Done,
}

/// All that is known of a learning process.
#[derive(Debug, Clone, Serialize)]
pub struct LearnReport {
    /// The version of the format of this record.
    pub schema: u32,
    /// The reference plant.
    pub plant: String,
    /// What its simulation leaves out.
    pub not_modelled: Vec<&'static str>,
    /// Feeds of the circles in mm/min, as recorded.
    pub feeds: Vec<f64>,
    /// X and Y.
    pub axes: [LearnedAxis; 2],
    /// The predictions for the lists of each round, X and Y.
    pub predictions: Vec<[Option<Prediction>; 2]>,
    /// The next step.
    pub next: NextStep,
}

/// The record as JSON.
pub fn render_json(report: &LearnReport) -> String {
    let mut text = to_pretty(report);
    text.push('\n');
    text
}

/// The file of a learning process.
pub fn render_file(file: &LearningFile) -> String {
    let mut text = to_pretty(file);
    text.push('\n');
    text
}

/// The rounds, and the next step, for people.
pub fn render_text(report: &LearnReport) -> String {
    let mut out = String::new();
    if !report.feeds.is_empty() {
        let feeds: Vec<String> = report.feeds.iter().map(|it| format!("{it:.0}")).collect();
        let _ = writeln!(
            out,
            "circles at {} mm/min, each recorded twice; the plant {} gives the direction\n{}\n",
            feeds.join(", "),
            visible_line(&report.plant),
            not_modelled_line(&report.not_modelled)
        );
        let _ = write!(out, "{}", rounds(report));
    }
    next(&mut out, report);
    out
}

/// The rounds of all axes.
fn rounds(report: &LearnReport) -> Table {
    let table = Table::of_numbers(["round"]).left("axis").right("glitch µm");
    let mut table = table.right("spread").right("predicted").left("");
    let rounds = report
        .axes
        .iter()
        .flat_map(|axis| axis.rounds.iter().enumerate().map(move |it| (axis, it)));
    for (axis, (at, round)) in rounds {
        let predicted = report.predictions.get(at);
        let predicted = predicted.and_then(|it| it[usize::from(axis.axis != "X")]);
        let number = predicted.map_or("-".to_owned(), |it| format!("{:.2}", it.glitch_um));
        let verdict = match (at, round.is_accepted) {
            (0, _) => "the first",
            (_, true) => "accepted",
            (_, false) => "no gain: the next round tries half the step from the best list",
        };
        let missed = predicted.is_some_and(|it| it.is_missed_by(round.worst_um));
        let missed = if missed {
            "; the prediction missed it"
        } else {
            ""
        };
        table.row(&[
            &(at + 1),
            &axis.axis,
            &format_args!("{:.2}", round.worst_um),
            &format_args!("{:.2}", round.spread_um),
            &number,
            &format_args!("{verdict}{missed}"),
        ]);
    }
    table
}

/// The next step.
fn next(out: &mut String, report: &LearnReport) {
    for axis in &report.axes {
        if let (Some(number), Some(list)) = (axis.best_round, &axis.list) {
            let _ = writeln!(
                out,
                "{}{}: the best so far is round {number}, {}",
                if axis.axis == "X" { "\n" } else { "" },
                axis.axis,
                visible_line(list)
            );
        }
    }
    if !out.is_empty() {
        out.push('\n');
    }
    match &report.next {
        NextStep::Record { folder, lists } => {
            let _ = writeln!(
                out,
                "next: load {} for X and {} for Y, record each circle twice in both directions, at least six feeds, \
                 and put the recordings into {}",
                visible_line(&lists[0]),
                visible_line(&lists[1]),
                visible_line(folder)
            );
            if let Some(predicted) = report.predictions.get(report.axes[0].rounds.len())
                && let [Some(x), Some(y)] = predicted
            {
                let _ = writeln!(
                    out,
                    "predicted with them: X {:.2} µm, Y {:.2} µm; the contact is predicted to be {:.2} and {:.2} times as \
                     stiff as that of the plant",
                    x.glitch_um, y.glitch_um, x.contact, y.contact
                );
            }
        }
        NextStep::Done => {
            out.push_str("done: two rounds gained nothing; hand over the best lists\n");
            if report.axes[0].best_round != report.axes[1].best_round {
                out.push_str("they are of different rounds: record them together once more\n");
            }
        }
    }
}
