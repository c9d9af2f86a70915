//! The recordings of a commissioning: their channels, the program of each by its signature, and the result of it.

use std::path::{Path, PathBuf};

use serde::Serialize;
use thiserror::Error;

use crate::disk::Disk;
use crate::error::HostError;
use crate::recordings::{
    SignedAt, read_circles, read_motion, read_turns, signatures_of, switches_of,
};
use frictcomp_physics::circle::{Circle, CommandedCircle, PathCentre, RecordedCircle};
use frictcomp_physics::current::Switched;
use frictcomp_recordings::commission::{
    CirclesFound, FollowedPosition, MeasuredAxis, Measurement, MeasuringProgram, NotFollowed, Plan,
    RecordedStrokes, RecordingOutcome, Stage, StrokesFound,
};
use frictcomp_recordings::identify::{AxisRecording, IdentifyError, TorqueKind, TraceFinding};
use frictcomp_recordings::trace::ChannelSelection;

/// Reads the recordings of a commissioning.
#[derive(Debug, Clone, Copy)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct CommissionReader<'a> {
    /// The channels.
    pub channels: &'a CommissionChannels,
    /// The words of a front end for what is not used, kept with the results.
    pub words: fn(&UnusedRecording) -> String,
}

impl CommissionReader<'_> {
    /// Returns the number of the program and what its recording shows. A failure to read it is a result, too; the
    /// other recordings are read nevertheless.
    pub(super) fn read(&self, path: &Path, plans: &[&Plan]) -> (Option<u16>, RecordingOutcome) {
        let recorded = match self.recognise(path, plans) {
            Ok(recorded) => recorded,
            Err(unused) => return (None, RecordingOutcome::Refused((self.words)(&unused))),
        };
        let axis = |at: usize| {
            let axis = recorded.plan.axes.get(at);
            axis.ok_or(UnusedRecording::NoAxis)
        };
        let found = match &recorded.program.role {
            Measurement::Friction { axis: at, speeds } => axis(*at)
                .and_then(|axis| self.friction(path, recorded, axis, speeds))
                .map(RecordingOutcome::Friction),
            Measurement::Circles { feed, radius } => {
                self.circles(path, recorded.plan, *feed, *radius)
            }
            Measurement::Strokes { axis: at, feeds } => {
                axis(*at).and_then(|axis| self.strokes(path, recorded, axis, feeds))
            }
        };
        let mut found =
            found.unwrap_or_else(|unused| RecordingOutcome::Refused((self.words)(&unused)));
        if let Err(error) = self.compare_states(path, recorded, &mut found) {
            found.refuse((self.words)(&error.into()));
        }
        (Some(recorded.program.number), found)
    }

    /// Checks that the recorded state of the compensation, if there is one, matches that of the program, from the
    /// end of its signature to shortly before its own end: outside this range the earlier state is in effect.
    fn compare_states(
        &self,
        path: &Path,
        recorded: RecordedProgram<'_>,
        found: &mut RecordingOutcome,
    ) -> Result<(), HostError> {
        const MEASURED: f64 = 0.9;
        let wanted = recorded.wanted();
        let state = if wanted == Switched::On { "on" } else { "off" };
        let driven = found.driven_part().unwrap_or(1.0).max(1.0);
        let to_s = recorded.from_s + MEASURED * recorded.program.time_after_signature_s() / driven;
        let axes = match &recorded.program.role {
            Measurement::Friction { axis, .. } | Measurement::Strokes { axis, .. } => {
                recorded.plan.axes.get(*axis..=*axis).unwrap_or_default()
            }
            Measurement::Circles { .. } => &recorded.plan.axes[..],
        };
        let cycle = self.channels.cycle_s;
        for axis in axes {
            let switches = switches_of(path, &self.channels.selection(&axis.name), cycle)?;
            let within = switches
                .iter()
                .filter(|it| it.0 > recorded.from_s && it.0 < to_s);
            let begin = switches.iter().rfind(|it| it.0 <= recorded.from_s);
            if let Some(other) = begin.into_iter().chain(within).find(|it| it.1 != wanted) {
                found.refuse(format!(
                    "its program has compensation of {} {state}, and the recording says otherwise at {:.3} s",
                    axis.name,
                    other.0.max(recorded.from_s)
                ));
                return Ok(());
            }
            if begin.is_some() {
                if let Some(shown) = found.compensation_mut() {
                    shown.switched.push(axis.name.clone());
                }
                found.note(format!(
                    "compensation of {} is recorded, and {state}",
                    axis.name
                ));
            }
        }
        Ok(())
    }

    /// Identifies the program of a recording, by its signature or by the user's statement.
    fn recognise<'a>(
        &self,
        path: &Path,
        plans: &[&'a Plan],
    ) -> Result<RecordedProgram<'a>, UnusedRecording> {
        let name = path
            .file_name()
            .map(|it| it.to_string_lossy().into_owned())
            .unwrap_or_default();
        let program = |number: u16| {
            let mut programs = plans
                .iter()
                .flat_map(|plan| plan.programs.iter().map(move |it| (it, *plan)));
            let found = programs.find(|(it, _)| it.number == number);
            found.ok_or(UnusedRecording::NoProgram(number))
        };
        let said = self.channels.roles.iter().find(|(file, _)| *file == name);
        let said = said.map(|(_, number)| *number);
        let cycle = self.channels.cycle_s;
        let mut signed: Vec<(&str, SignedAt)> = Vec::new();
        let mut failed = None;
        for axis in plans.iter().flat_map(|plan| &plan.axes) {
            match signatures_of(path, &self.channels.selection(&axis.name), cycle) {
                Ok(found) => signed.extend(found.into_iter().map(|it| (axis.name.as_str(), it))),
                Err(error) => failed = Some(error),
            }
        }
        let Some((_, first)) = signed.first().copied() else {
            if let Some(number) = said {
                let (program, plan) = program(number)?;
                return Ok(RecordedProgram {
                    program,
                    plan,
                    from_s: 0.0,
                });
            }
            return Err(failed.map_or(
                UnusedRecording::NoSignature { file: name },
                UnusedRecording::from,
            ));
        };
        let number = first.signature.number();
        if let Some(said) = said.filter(|it| *it != number) {
            return Err(UnusedRecording::OtherProgram {
                found: number,
                said,
            });
        }
        if signed
            .iter()
            .any(|(_, it)| it.signature != first.signature || it.end_s > first.end_s)
        {
            let numbers = signed.iter().map(|it| it.1.signature.number());
            return Err(UnusedRecording::Several(numbers.collect()));
        }
        let (program, plan) = program(number)?;
        let moved = plan
            .axes
            .get(program.signed_axis())
            .map_or("", |it| it.name.as_str());
        if !signed.iter().any(|(axis, _)| *axis == moved) {
            return Err(UnusedRecording::Swapped(moved.to_owned()));
        }
        Ok(RecordedProgram {
            program,
            plan,
            from_s: first.end_s,
        })
    }

    /// Returns the following error of a single axis in a recorded program of strokes.
    fn strokes(
        &self,
        path: &Path,
        recorded: RecordedProgram<'_>,
        axis: &MeasuredAxis,
        feeds: &[f64],
    ) -> Result<RecordingOutcome, UnusedRecording> {
        let cycle = self.channels.cycle_s;
        let recording = read_motion(path, &self.channels.followed(&axis.name), cycle)?;
        let followed = FollowedPosition::of(&recording, recorded.from_s);
        let step_s = recording.track.step_s;
        let AxisRecording {
            track,
            following_errors,
            ..
        } = recording;
        let before = track
            .times_s
            .partition_point(|it| *it < recorded.from_s)
            .min(following_errors.len());
        let strokes = RecordedStrokes {
            track: &track.since(recorded.from_s),
            following_errors: &following_errors[before..],
        };
        let mut found = StrokesFound::of((&axis.name, axis.unit()), strokes, feeds)?;
        found.followed = followed;
        if recorded.plan.stage == Stage::Off && found.against.is_empty() && !found.is_seen() {
            found.against.push(
                "no reversal shows in the following error: it is that of another axis, or compensation is on"
                    .to_owned(),
            );
        }
        if found.against.is_empty() {
            let copied = followed.and_then(|it| it.is_commanded(step_s));
            let held = followed.and_then(|it| it.is_held());
            found.against.extend(copied.or(held));
        }
        Ok(RecordingOutcome::Strokes(found))
    }

    /// Returns the turns of a recorded program of circles, in the units of their plan.
    ///
    /// # Errors
    /// The file cannot be read, or is not a recorded circle.
    pub fn turns(
        &self,
        path: &Path,
        plan: &Plan,
        radius: f64,
    ) -> Result<Vec<RecordedCircle>, HostError> {
        let channels = self.channels.of_circles(plan);
        let (turns, _) = read_turns(path, &channels, Some(radius), &Disk::default())?;
        Ok(turns)
    }

    /// Returns the circles of a recorded program.
    fn circles(
        &self,
        path: &Path,
        plan: &Plan,
        feed: f64,
        radius: f64,
    ) -> Result<RecordingOutcome, UnusedRecording> {
        let channels = self.channels.of_circles(plan);
        let commanded = CommandedCircle {
            radius_mm: Some(radius),
            feed_mm_per_min: None,
        };
        let path = PathBuf::from(path);
        let (recording, _) = read_circles(&[path], &channels, commanded, PathCentre::Common)?;
        Ok(RecordingOutcome::Circles(CirclesFound::of(
            &recording, feed, radius,
        )))
    }
}

/// A recorded program with its plan.
#[derive(Debug, Clone, Copy)]
pub(super) struct RecordedProgram<'a> {
    pub(super) program: &'a MeasuringProgram,
    pub(super) plan: &'a Plan,
    /// The end of its signature in s.
    pub(super) from_s: f64,
}

impl RecordedProgram<'_> {
    /// Returns the state to which the program switches compensation.
    pub(super) fn wanted(self) -> Switched {
        match self.plan.stage {
            Stage::Off => Switched::Off,
            Stage::On => Switched::On,
        }
    }
}

/// Reason why a recording of a commissioning is not used: one sentence in lower case.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum UnusedRecording {
    /// The recording cannot be read, or lacks channels.
    #[error(transparent)]
    Host(#[from] HostError),
    /// No friction was found in the recording.
    #[error("{error}")]
    Friction {
        /// The reason.
        error: IdentifyError,
        /// Findings about its channels.
        findings: Vec<TraceFinding>,
    },
    /// The axis does not follow its commands, or the following error is missing.
    #[error(transparent)]
    NotFollowed(#[from] NotFollowed),
    /// A motor of a gantry, with the reason.
    #[error("{motor}: {reason}")]
    Motor {
        /// Name of the motor.
        motor: String,
        /// The reason.
        reason: Box<UnusedRecording>,
    },
    /// The torque of the other motors of a gantry has no channels of their own.
    #[error("their torque is not read")]
    NoTorques,
    /// A motor of a gantry that was recorded at other times than the first one.
    #[error("that of {motor} has other samples than that of {axis}")]
    OtherSamples {
        /// Name of the motor.
        motor: String,
        /// Name of the first one.
        axis: String,
    },
    /// The program moves an axis that the plan does not have.
    #[error("its axis is not in the plan")]
    NoAxis,
    /// A number that belongs to no program.
    #[error("it carries the number {0}, which no plan in this folder has")]
    NoProgram(u16),
    /// The recording has no signature, and its program is not named.
    #[error("it has no signature")]
    NoSignature {
        /// Name of the file.
        file: String,
    },
    /// Strokes of another program than the one that is named.
    #[error("its strokes give the number {found}, but it is said to be {said}")]
    OtherProgram {
        /// The number of its strokes.
        found: u16,
        /// The number that is given.
        said: u16,
    },
    /// Several programs in one recording.
    #[error("it holds several programs, {}: record each alone", numbers(.0))]
    Several(Vec<u16>),
    /// The channels of two axes are exchanged.
    #[error(
        "the strokes at its start are not those of `{0}`: the channels of two axes are swapped"
    )]
    Swapped(String),
}

fn numbers(numbers: &[u16]) -> String {
    let numbers: Vec<String> = numbers.iter().map(u16::to_string).collect();
    numbers.join(", ")
}

/// The channels of the recordings of a commissioning, and what the user says about them.
#[derive(Debug, Clone, Default, Serialize)]
#[cfg_attr(not(feature = "unstable"), non_exhaustive)]
pub struct CommissionChannels {
    /// The channels of each axis and of each other motor of a gantry.
    pub axes: Vec<(String, ChannelSelection)>,
    /// Whether the torque of each motor has a channel of its own.
    pub has_each_torque: bool,
    /// The CNC cycle in s, if it is known.
    pub cycle_s: Option<f64>,
    /// The kind of the recorded torque, if it is known.
    pub torque_kind: Option<TorqueKind>,
    /// Recordings without a signature, with the numbers of their programs.
    pub roles: Vec<(String, u16)>,
}

impl CommissionChannels {
    /// Returns the channels of an axis with its actual position or its following error.
    pub(super) fn followed(&self, axis: &str) -> ChannelSelection {
        let own = self.axes.iter().find(|it| it.0 == axis);
        own.map_or_else(
            || ChannelSelection {
                axis: Some(axis.to_owned()),
                ..ChannelSelection::default()
            },
            |it| it.1.clone(),
        )
    }

    /// Returns the channels of an axis.
    pub(super) fn selection(&self, axis: &str) -> ChannelSelection {
        ChannelSelection {
            actual_position: None,
            following_error: None,
            ..self.followed(axis)
        }
    }

    /// Returns the channels of circles, whose positions are the actual ones.
    pub fn of_circles(&self, plan: &Plan) -> [ChannelSelection; 2] {
        [0, 1].map(|at| {
            let Some(axis) = plan.axes.get(at) else {
                return ChannelSelection::default();
            };
            let followed = self.followed(&axis.name);
            ChannelSelection {
                position: followed.actual_position,
                actual_position: None,
                ..followed
            }
        })
    }

    /// Returns the CNC cycle in s.
    pub fn cycle_time_s(&self) -> f64 {
        self.cycle_s.unwrap_or(Circle::default().cycle_time_s)
    }
}
