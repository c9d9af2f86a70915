//! The programs of a plan.

use serde::{Deserialize, Serialize};

use super::error::PlanError;
use super::program::MeasuringProgram;
use super::request::{Installed, MeasuredAxis, PlanRequest};
use super::runs::Room;
use super::runs::{RoomPrograms, circle_radius};
use super::signature::Signature;
use frictcomp::lists::AxisType;

/// The fewest and the most feeds of a plan.
const FEEDS: std::ops::RangeInclusive<usize> = 4..=12;

/// The first number of the first round of stage 2, which is round 2, and of numbers in each round.
const SECOND_ROUND: u16 = 64;
const NUMBERS: u16 = 16;

/// The last round whose numbers fit a signature.
const LAST_ROUND: u16 = 61;

/// Compensation while the programs of a plan run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub enum Stage {
    /// Off: the friction and the machine as it is.
    Off,
    /// Compensation on, with a known list.
    On,
}

/// Measuring programs for one or two axes (R16.1, R16.8).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Plan {
    /// Compensation while they run.
    pub stage: Stage,
    /// The measured axes.
    pub axes: Vec<MeasuredAxis>,
    /// The feed of all motions that are not measured, in mm/min or °/min.
    pub approach: f64,
    /// The programs in the order in which they run.
    pub programs: Vec<MeasuringProgram>,
}

impl Plan {
    /// Returns the programs of a stage.
    ///
    /// # Errors
    /// The axes cannot be measured together, or a motion does not fit into the travel or the dynamics of an
    /// axis (R16.8).
    pub fn new(request: &PlanRequest, stage: Stage) -> Result<Self, PlanError> {
        if request.round > LAST_ROUND {
            return Err(PlanError::Rounds(request.round));
        }
        check(request, stage)?;
        let feeds = feeds(request)?;
        let rooms = request.axes.iter().map(Room::of);
        let rooms = rooms.collect::<Result<Vec<Room<'_>>, _>>()?;
        for room in &rooms {
            room.reaches(request.approach.max(Signature::FEED))?;
            feeds.iter().try_for_each(|feed| room.reaches(*feed))?;
        }
        let radius = match &rooms[..] {
            [first, second] => Some(circle_radius([first, second], &feeds, request.radius)?),
            _ => None,
        };
        let runs = RoomPrograms {
            rooms: &rooms,
            radius,
        };
        let mut programs = Vec::new();
        let fastest = feeds.last().copied().unwrap_or_default();
        if request.slowest >= fastest / 60.0 {
            return Err(PlanError::Slowest {
                slowest: request.slowest,
                fastest: fastest / 60.0,
            });
        }
        for axis in 0..rooms.len() {
            let speeds = match stage {
                Stage::Off => speeds(request.slowest, fastest / 60.0),
                Stage::On => repeated(request.slowest, fastest / 60.0),
            };
            programs.push(runs.friction(axis, speeds)?);
        }
        if radius.is_some() {
            programs.extend(feeds.iter().map(|&feed| runs.circles(feed)));
        } else {
            programs.push(runs.strokes(0, &feeds)?);
        }
        for (number, program) in (first_number(request.round)..).zip(&mut programs) {
            program.begin_with(number);
        }
        Ok(Self {
            stage,
            axes: request.axes.clone(),
            approach: request.approach,
            programs,
        })
    }

    /// Returns the time of all programs in s at 100 % override.
    pub fn time_s(&self) -> f64 {
        self.programs.iter().map(|it| it.time_s).sum()
    }
}

/// Returns the number of the first program of a round.
fn first_number(round: u16) -> u16 {
    match round.checked_sub(2) {
        None => 1,
        Some(earlier) => SECOND_ROUND + NUMBERS * earlier,
    }
}

/// Checks that the axes can be measured together, and that the values are numbers above 0.
fn check(request: &PlanRequest, stage: Stage) -> Result<(), PlanError> {
    let axes = &request.axes[..];
    if let [first, second] = axes {
        if first.name == second.name {
            return Err(PlanError::Twice(first.name.clone()));
        }
        if let Some(rotary) = axes.iter().find(|it| it.axis_type != AxisType::Linear) {
            let rotary = rotary.name.clone();
            return Err(PlanError::Mixed { rotary });
        }
        if plane(&first.name, &second.name).is_none() {
            let [first, second] = [first, second].map(|it| it.name.clone());
            return Err(PlanError::Plane { first, second });
        }
    } else if axes.len() != 1 {
        return Err(PlanError::Axes(axes.len()));
    }
    let off = axes
        .iter()
        .find(|it| it.installed == Installed::Unconfigured);
    if let Some(axis) = off.filter(|_| stage == Stage::On) {
        return Err(PlanError::Unconfigured(axis.name.clone()));
    }
    let pitches = axes.iter().filter_map(|it| it.pitch);
    let values = [
        ("an approach", Some(request.approach)),
        ("a radius", request.radius),
        ("a slowest speed", Some(request.slowest)),
    ];
    let values = values
        .into_iter()
        .filter_map(|(what, value)| Some((what, value?)));
    let values = values.chain(pitches.map(|it| ("a pitch", it)));
    let values = values.chain(request.feeds.iter().map(|&it| ("a feed", it)));
    for (what, value) in values {
        if !(value.is_finite() && value > 0.0) {
            return Err(PlanError::NotPositive { what, value });
        }
    }
    Ok(())
}

/// Returns the G function of the plane of two axes.
fn plane(first: &str, second: &str) -> Option<u8> {
    match (first, second) {
        ("X", "Y") => Some(17),
        ("Z", "X") => Some(18),
        ("Y", "Z") => Some(19),
        _ => None,
    }
}

/// Returns the feeds, slowest first, each once.
fn feeds(request: &PlanRequest) -> Result<Vec<f64>, PlanError> {
    let mut feeds = request.feeds.clone();
    feeds.sort_by(f64::total_cmp);
    feeds.dedup();
    if FEEDS.contains(&feeds.len()) {
        Ok(feeds)
    } else {
        Err(PlanError::Feeds(feeds.len()))
    }
}

/// Returns at least ten speeds from the slowest to the fastest, each at most twice the one before.
fn speeds(slowest: f64, fastest: f64) -> Vec<f64> {
    const LEAST: u32 = 10;
    let fastest = fastest.max(slowest);
    let mut steps = LEAST - 1;
    while fastest / slowest > 2.0_f64.powi(steps.cast_signed()) && steps < 30 {
        steps += 1;
    }
    let step = (fastest / slowest).powf(1.0 / f64::from(steps));
    (0..=steps)
        .map(|at| slowest * step.powi(at.cast_signed()))
        .collect()
}

/// Returns two of the speeds of stage 1: a slow one and a fast one.
fn repeated(slowest: f64, fastest: f64) -> Vec<f64> {
    let all = speeds(slowest, fastest);
    [all.len() / 3, all.len() * 2 / 3]
        .into_iter()
        .filter_map(|at| all.get(at).copied())
        .collect()
}
