//! The rounds of stage 2, each judged by its recordings (R16.9).

use serde::Serialize;

use super::actual;
use super::compared::{BeforeAfter, before_after};
use super::judged::{JudgedRound, feeds_against};
use super::plan::{Plan, Stage};
use super::plan_file::{PlanFile, ValueListUsed};
use super::plants::Plants;
use super::program::MeasuringProgram;
use super::results::{RecordingOutcome, RecordingResult};
use super::switched::{CompensationShown, Shows, StagesOfAxis, SwitchedAs};
use frictcomp::lists::AxisType;

/// A set of lists that was recorded in stage 2.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct Round {
    /// The number of the round and of its plan, from 2 on.
    pub number: usize,
    /// The lists.
    pub lists: Vec<ValueListUsed>,
    /// Signal in which friction shows.
    pub shows: Shows,
    /// The unit of the glitches.
    pub unit: &'static str,
    /// The feeds with compensation off and with these lists on.
    pub recorded: Vec<BeforeAfter>,
    /// Reasons why the lists are not accepted; `None` before a feed is recorded off and on.
    pub against: Option<Vec<String>>,
    /// Requirements for which evidence is missing, so that the lists are not accepted either (R16.13).
    pub not_shown: Vec<String>,
}

/// Returns the unit of the glitches of a plan.
fn glitch_unit(plan: &Plan) -> &'static str {
    match plan.axes.first() {
        Some(axis) if axis.axis_type != AxisType::Linear => "0.001°",
        _ => "µm",
    }
}

impl Round {
    /// Returns whether there are no reasons against the lists, and everything that they rest on is shown.
    pub fn is_accepted(&self) -> bool {
        self.not_shown.is_empty() && self.against.as_ref().is_some_and(Vec::is_empty)
    }
}

/// A round with its plan, and all recordings.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct RecordedRound<'a> {
    /// The number of the round and of its plan, from 2 on.
    pub number: usize,
    /// The plan of the round.
    pub plan: &'a PlanFile,
    /// The plans of all rounds.
    pub plans: &'a [PlanFile],
    /// A result for each recording.
    pub results: &'a [RecordingResult],
}

impl<'a> RecordedRound<'a> {
    /// Returns the round with its verdict. `files` gives what the files of its lists say against them, and what is
    /// said against the plants on which they were tuned; it is asked where a feed is recorded off and on.
    ///
    /// # Errors
    /// The errors of `files`.
    pub fn judged<E>(
        &self,
        earlier: &[Round],
        fitted: &Plants,
        files: impl FnOnce() -> Result<[Vec<String>; 2], E>,
    ) -> Result<Round, E> {
        let is_off = |number: u16| {
            PlanFile::of(self.plans, Some(number)).is_some_and(|it| it.plan.stage == Stage::Off)
        };
        let is_on = |number: u16| self.plan.has(number);
        let recorded = before_after(self.results, &self.plan.plan.axes, (is_off, is_on));
        let (mut against, mut not_shown) = (None, Vec::new());
        if !recorded.is_empty() {
            let [lists, plants] = files()?;
            let [otherwise, lacking] = self.switched(fitted);
            let feeds = self.against_feeds(&recorded, earlier);
            against = Some([feeds, lists, self.recorded_otherwise(), otherwise, plants].concat());
            not_shown = lacking;
        }
        Ok(Round {
            number: self.number,
            lists: self.plan.lists.clone(),
            shows: Shows::of(&self.plan.plan),
            unit: glitch_unit(&self.plan.plan),
            recorded,
            against,
            not_shown,
        })
    }

    /// Returns what the recorded feeds say against the lists of a round.
    fn against_feeds(&self, recorded: &[BeforeAfter], earlier: &[Round]) -> Vec<String> {
        let programs = self.plan.plan.programs.iter();
        let feeds: Vec<f64> = programs
            .flat_map(MeasuringProgram::reversal_feeds)
            .copied()
            .collect();
        let accepted = earlier.iter().rev().find(|it| it.is_accepted());
        feeds_against(&JudgedRound {
            feeds: &feeds,
            recorded,
            accepted: accepted.map(|it| (it.number, &it.recorded[..])),
            unit: glitch_unit(&self.plan.plan),
        })
    }

    /// Returns how the recordings of a round were made otherwise than those of stage 1.
    fn recorded_otherwise(&self) -> Vec<String> {
        let off: Vec<&RecordingOutcome> = self.used_off().collect();
        let on: Vec<&RecordingOutcome> = used_in(self.plan, self.results).collect();
        let axes = self.plan.plan.axes.iter().map(|it| it.name.as_str());
        actual::recorded_otherwise(&axes.collect::<Vec<_>>(), &off, &on)
    }

    /// Returns what recordings of each axis say about its compensation, that the list was on in the round and none in
    /// stage 1: what speaks against it, and what nothing shows (R16.13).
    fn switched(&self, fitted: &Plants) -> [Vec<String>; 2] {
        let off = self.used_off();
        let off: Vec<&CompensationShown> = off.filter_map(RecordingOutcome::compensation).collect();
        let on = used_in(self.plan, self.results).filter_map(RecordingOutcome::compensation);
        let on: Vec<&CompensationShown> = on.collect();
        let found = fitted
            .verdicts
            .iter()
            .find(|it| it.found.round == self.number);
        let [mut against, mut not_shown] = [Vec::new(), Vec::new()];
        for used in &self.plan.lists {
            let stages = StagesOfAxis {
                axis: &used.axis,
                list: &used.sha256,
                off: &off,
                on: &on,
                shows: Shows::of(&self.plan.plan),
                plant: found.and_then(|it| it.found.axes.iter().find(|it| it.axis == used.axis)),
            };
            for state in [stages.was_on(), stages.was_off()] {
                match state {
                    SwitchedAs::Shown => {}
                    SwitchedAs::Otherwise(words) => against.push(words),
                    SwitchedAs::NotShown(words) => not_shown.push(words),
                }
            }
        }
        [against, not_shown]
    }

    /// Returns what the usable recordings of stage 1 show.
    fn used_off(&self) -> impl Iterator<Item = &'a RecordingOutcome> {
        let results = self.results;
        let first = self.plans.iter().filter(|it| it.plan.stage == Stage::Off);
        first.flat_map(move |it| used_in(it, results))
    }
}

/// Returns what the usable recordings of a plan show.
fn used_in<'a>(
    plan: &'a PlanFile,
    results: &'a [RecordingResult],
) -> impl Iterator<Item = &'a RecordingOutcome> {
    let is_own = |number: u16| plan.has(number);
    let own = results
        .iter()
        .filter(move |it| it.found.is_used() && it.program.is_some_and(is_own));
    own.map(|it| &it.found)
}
