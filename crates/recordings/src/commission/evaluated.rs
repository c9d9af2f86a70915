//! Results of a commissioning, and what is missing.

use serde::{Deserialize, Serialize};

use super::found::FrictionFound;
use super::plan::Stage;
use super::plan_file::PlanFile;
use super::plant_found::PlantFound;
use super::plants::Plants;
use super::request::MeasuredAxis;
use super::results::{RecordingOutcome, RecordingResult};
use super::round::Round;

/// The content of `results.json`.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Results {
    /// The version of the format of this file.
    pub schema: u32,
    /// A result for each recording.
    pub recordings: Vec<RecordingResult>,
    /// The fitted plants.
    pub plants: Vec<PlantFound>,
}

impl Results {
    /// The version that is written.
    pub const SCHEMA: u32 = 5;
}

/// The list of an axis, or the reasons why it has none.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct AxisVerdict {
    /// Name of the axis.
    pub axis: String,
    /// The file of the provisional list, as it is shown.
    pub list: Option<String>,
    /// The recording that it rests on.
    pub from: Option<String>,
    /// Reasons against a list, and remarks on it.
    pub notes: Vec<String>,
}

/// A file on which the results rest, other than a recording.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct InputFile {
    /// Role: a plan, a plant, the list of an axis.
    pub what: String,
    /// The file, as it is shown.
    pub file: String,
    /// The SHA-256 of its bytes.
    pub sha256: String,
}

/// Report on all results of a commissioning.
#[derive(Debug, Clone)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct ResultsReport {
    /// The plans of both stages, if they exist.
    pub plans: Vec<PlanFile>,
    /// A result for each recording.
    pub results: Vec<RecordingResult>,
    /// The number of results that were kept from an earlier run.
    pub kept: usize,
    /// The files that were read in addition to the recordings.
    pub inputs: Vec<InputFile>,
    /// Statements of the user on which the results rest.
    pub said: Vec<String>,
    /// The lists.
    pub axes: Vec<AxisVerdict>,
    /// The plants that were fitted to the circles.
    pub fitted: Plants,
    /// The rounds of stage 2, first to last.
    pub rounds: Vec<Round>,
}

impl ResultsReport {
    /// Returns the programs of stage 1 and of the last round that have no usable recording.
    pub fn missing(&self) -> Vec<String> {
        let last = self.plans.len().saturating_sub(1);
        let plans = self.plans.iter().enumerate();
        let counted = plans.filter(|(at, it)| *at == last || it.plan.stage == Stage::Off);
        let programs = counted.flat_map(|(_, it)| it.plan.programs.iter());
        let lacks = |number: u16| {
            !self
                .results
                .iter()
                .any(|it| it.program == Some(number) && it.found.is_used())
        };
        let missing = programs.filter(|it| lacks(it.number));
        missing.map(|it| it.file.clone()).collect()
    }

    /// Returns what is on in the program with a number: nothing, or the lists of a round.
    pub fn compensation_of(&self, number: u16) -> String {
        let rounds = self.plans.iter().filter(|it| it.plan.stage == Stage::On);
        let round = (2..).zip(rounds).find(|(_, plan)| plan.has(number));
        round.map_or("off".to_owned(), |(round, _)| format!("on, round {round}"))
    }

    /// Returns whether every program is recorded, every axis has a list, the lists of the last round are accepted, and
    /// no recording rejects the plant.
    pub fn is_complete(&self) -> bool {
        self.missing().is_empty()
            && !self.fitted.is_rejected()
            && self.axes.iter().all(|it| it.list.is_some())
            && self.rounds.last().is_some_and(Round::is_accepted)
    }

    /// Returns the friction from which the list of an axis is made.
    pub fn friction_of(&self, axis: &AxisVerdict) -> Option<&FrictionFound> {
        let from = axis.from.as_ref()?;
        self.results.iter().find_map(|it| match &it.found {
            RecordingOutcome::Friction(found) if it.file == *from => Some(found),
            _ => None,
        })
    }
}

/// Returns the recording from which the list of an axis is made, the last by name; or the reasons against a list.
pub fn source_of<'a>(
    axis: &MeasuredAxis,
    plans: &[PlanFile],
    results: &'a [RecordingResult],
) -> (
    Option<(&'a RecordingResult, &'a FrictionFound)>,
    Vec<String>,
) {
    let frictions = results.iter().filter_map(|it| match &it.found {
        RecordingOutcome::Friction(found)
            if found.axis == axis.name && found.against.is_empty() =>
        {
            Some((it, found))
        }
        _ => None,
    });
    let of_stage = |stage: Stage| {
        let is_so = move |it: &RecordingResult| {
            PlanFile::of(plans, it.program).is_some_and(|it| it.plan.stage == stage)
        };
        frictions.clone().filter(move |(it, _)| is_so(it))
    };
    let Some((last, found)) = of_stage(Stage::Off).next_back() else {
        return (
            None,
            vec!["no recording of its constant speeds can be used".to_owned()],
        );
    };
    let other = of_stage(Stage::Off)
        .chain(of_stage(Stage::On))
        .find(|(_, it)| !found.is_steady_with(it));
    if let Some((other, it)) = other {
        let apart = found.apart_from(it).map_or_else(
            || "have no speed in common".to_owned(),
            |part| format!("differ by {:.0} % of the friction", part * 100.0),
        );
        let note = format!("{} and {} {apart}: repeat both warm", last.file, other.file);
        return (None, vec![note]);
    }
    (Some((last, found)), Vec::new())
}
