//! Learning from recorded circles as text and JSON, and the file that keeps its rounds (R16.4).

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use crate::assumptions::not_modelled_line;
use crate::document::{Document, Headline, Standing, Table};
use crate::wording::{to_pretty, visible_line};
use frictcomp::lists::FrictionList;
use frictcomp_physics::circle::RoundVerdict;
use frictcomp_recordings::commission::ValueListUsed;

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
    #[derive(Serialize)]
    struct LearnRecord<'a> {
        headline: Headline,
        #[serde(flatten)]
        report: &'a LearnReport,
    }
    let headline = report.headline();
    to_pretty(&LearnRecord { headline, report }) + "\n"
}

/// The file of a learning process.
pub fn render_file(file: &LearningFile) -> String {
    let mut text = to_pretty(file);
    text.push('\n');
    text
}

impl LearnReport {
    /// The verdict: the best lists so far, and the next step (R18.20).
    pub fn headline(&self) -> Headline {
        let best = self.axes.iter().filter_map(|axis| {
            let number = axis.best_round?;
            let glitch = axis.rounds.get(number.checked_sub(1)?)?.worst_um;
            Some(format!("{} {glitch:.1} µm with round {number}", axis.axis))
        });
        let best: Vec<String> = best.collect();
        let best = match &*best.join(", ") {
            "" => String::new(),
            best => format!("largest glitch so far: {best}; "),
        };
        match &self.next {
            NextStep::Record { folder, lists } => Headline::new(
                Standing::Open,
                format!(
                    "{best}next: load {} for X and {} for Y, record each circle twice in both directions, at least \
                     six feeds, and put the recordings into {folder}",
                    lists[0], lists[1]
                ),
            ),
            NextStep::Done if self.axes[0].best_round == self.axes[1].best_round => Headline::new(
                Standing::Good,
                format!("{best}two rounds gained nothing more: hand over the best lists"),
            ),
            NextStep::Done => Headline::new(
                Standing::Good,
                format!(
                    "{best}two rounds gained nothing more: hand over the best lists, which are of different rounds, \
                     after recording them together once more"
                ),
            ),
        }
    }
}

/// The rounds, and the best lists.
pub fn document(report: &LearnReport) -> Document<'_> {
    let mut out = Document::new("Learning from recorded circles", report.headline());
    if !report.feeds.is_empty() {
        let feeds: Vec<String> = report.feeds.iter().map(|it| format!("{it:.0}")).collect();
        let _ = writeln!(
            out,
            "\ncircles at {} mm/min, each recorded twice; the plant {} gives the direction\n{}\n",
            feeds.join(", "),
            visible_line(&report.plant),
            not_modelled_line(&report.not_modelled)
        );
        out.table(rounds(report));
    }
    push_best(&mut out, report);
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

/// The best list of each axis, and what the simulation expects of the next ones.
fn push_best(out: &mut Document<'_>, report: &LearnReport) {
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
    let predicted = report.predictions.get(report.axes[0].rounds.len());
    if let Some([Some(x), Some(y)]) = predicted {
        let _ = writeln!(
            out,
            "predicted with the next lists: X {:.1} µm, Y {:.1} µm; the contact is predicted to be {:.2} and {:.2} times \
             as stiff as that of the plant",
            x.glitch_um, y.glitch_um, x.contact, y.contact
        );
    }
}
