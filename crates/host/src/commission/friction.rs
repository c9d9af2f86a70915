//! The friction of an axis in a recorded program; for a gantry, of all its motors (R16.2, R16.8).

use std::path::Path;

use super::reading::CommissionReader;
use super::reading::RecordedProgram;
use super::reading::UnusedRecording;
use crate::disk::Disk;
use crate::error::HostError;
use crate::recordings::read_axis;
use frictcomp_recordings::commission::{FrictionFound, MeasuredAxis, actual_elsewhere};
use frictcomp_recordings::identify::{
    AxisRecording, IdentifyOptions, Measured, RequestedPoints, Track, identify,
};

impl CommissionReader<'_> {
    /// Returns the friction of an axis at these speeds; for a gantry, the mean of its motors.
    pub(super) fn friction(
        &self,
        path: &Path,
        recorded: RecordedProgram<'_>,
        axis: &MeasuredAxis,
        speeds: &[f64],
    ) -> Result<FrictionFound, UnusedRecording> {
        let judge =
            |motor: &str, recording: &AxisRecording| self.judge(recorded, recording, motor, speeds);
        let mut mean = self.motor(path, [&axis.name; 2])?;
        if axis.followers.is_empty() {
            return judge(&axis.name, &mean);
        }
        let recordings = match self.followers(path, axis, &mean) {
            Ok(recordings) => recordings,
            Err(reason) => {
                let reason = (self.words)(&reason);
                let mut found = judge(&axis.name, &mean)?;
                found.against.push(format!(
                    "a gantry: the motors of {} share the friction, and {reason}",
                    axis.followers.join(", ")
                ));
                return Ok(found);
            }
        };
        let mut motors = vec![judge(&axis.name, &mean)?];
        for (motor, recording) in axis.followers.iter().zip(&recordings) {
            let found = judge(motor, recording).map_err(|reason| UnusedRecording::Motor {
                motor: motor.clone(),
                reason: Box::new(reason),
            })?;
            motors.push(found);
        }
        let others: Vec<&Track> = recordings.iter().map(|it| &it.track).collect();
        mean.track.average_torque(&others);
        let mut found = judge(&axis.name, &mean)?;
        found.share(&motors);
        Ok(found)
    }

    /// Returns the recordings of the motors that follow an axis, with its own samples; or why there are none.
    fn followers(
        &self,
        path: &Path,
        axis: &MeasuredAxis,
        master: &AxisRecording,
    ) -> Result<Vec<AxisRecording>, UnusedRecording> {
        if !self.channels.has_each_torque {
            return Err(UnusedRecording::NoTorques);
        }
        let followers = axis.followers.iter();
        let read = followers.map(|motor| {
            let recording = self.motor(path, [&axis.name, motor])?;
            if recording.track.times_s != master.track.times_s {
                return Err(UnusedRecording::OtherSamples {
                    motor: motor.clone(),
                    axis: axis.name.clone(),
                });
            }
            Ok(recording)
        });
        read.collect()
    }

    /// Returns the motion of an axis with the torque of one motor.
    fn motor(&self, path: &Path, [axis, motor]: [&str; 2]) -> Result<AxisRecording, HostError> {
        let torque = self.channels.selection(motor).torque;
        let torque = torque.map(|it| it.replace('%', motor));
        let mut with = self.channels.followed(axis);
        with.torque.clone_from(&torque);
        let mut without = self.channels.selection(axis);
        without.torque = torque;
        // An actual position in addition to the commanded one is only a check, and may be missing here.
        let read = |selection| read_axis(path, selection, self.channels.cycle_s, &Disk::default());
        read(&with).or_else(|_| read(&without))
    }

    /// Identifies the friction in the torque of one motor.
    fn judge(
        &self,
        recorded: RecordedProgram<'_>,
        recording: &AxisRecording,
        motor: &str,
        speeds: &[f64],
    ) -> Result<FrictionFound, UnusedRecording> {
        let options = IdentifyOptions {
            measured: Measured {
                // The program itself switches compensation.
                compensation: Some(recorded.wanted()),
                ..recording.measured.stated(self.channels.torque_kind, None)
            },
            wanted: RequestedPoints::Points(12),
            ..IdentifyOptions::default()
        };
        let elsewhere = actual_elsewhere(&recording.track, &recording.following_errors);
        let track = recording.track.clone().since(recorded.from_s);
        let found = identify(&track, &options).map_err(|error| UnusedRecording::Friction {
            error,
            findings: recording.findings.clone(),
        })?;
        let mut friction = FrictionFound::of(motor, &found, speeds);
        let has_signature = recorded.from_s > 0.0;
        friction.check_length(
            &track,
            has_signature.then(|| recorded.program.time_after_signature_s()),
        );
        friction.against.extend(elsewhere.map(|it| it.to_string()));
        friction.notes.extend(
            recording
                .findings
                .iter()
                .map(|it| format!("{}: {}", it.code, it.message)),
        );
        if let Some(unit) = &recording.torque_unit {
            friction.against.push(format!(
                "its torque is in {unit}, and a list has drive units"
            ));
        }
        Ok(friction)
    }
}
