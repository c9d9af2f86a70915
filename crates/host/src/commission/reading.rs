//! A recording, identified by its signature, and the result of its program.

use std::path::{Path, PathBuf};

use super::channels::CommissionChannels;
use super::recorded::RecordedProgram;
use super::unused::UnusedRecording;
use crate::disk::Disk;
use crate::error::HostError;
use crate::recordings::{
    SignedAt, read_circles, read_motion, read_turns, signatures_of, switches_of,
};
use frictcomp_physics::circle::{CommandedCircle, PathCentre, RecordedCircle};
use frictcomp_physics::current::Switched;
use frictcomp_recordings::commission::{
    CirclesFound, FollowedPosition, MeasuredAxis, Measurement, Plan, RecordedStrokes,
    RecordingOutcome, Stage, StrokesFound,
};
use frictcomp_recordings::identify::AxisRecording;

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
        read_turns(path, &channels, Some(radius), &Disk::default())
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
        let recording = read_circles(&[path], &channels, commanded, PathCentre::Common)?;
        Ok(RecordingOutcome::Circles(CirclesFound::of(
            &recording, feed, radius,
        )))
    }
}
