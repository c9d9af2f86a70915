//! The friction of an axis in a recorded program; for a gantry, of all its motors (R16.2, R16.8).

use std::path::Path;

use super::channels::ReadingArgs;
use super::recorded::RecordedProgram;
use crate::failure::Failure;
use crate::identify::refusal;
use frictcomp_host::{Disk, read_axis};
use frictcomp_recordings::commission::{FrictionFound, MeasuredAxis, Plan, actual_elsewhere};
use frictcomp_recordings::identify::{
    AxisRecording, IdentifyOptions, Measured, RequestedPoints, Track, identify,
};

impl ReadingArgs {
    /// Returns the friction of an axis at these speeds; for a gantry, the mean of its motors.
    pub(super) fn friction(
        &self,
        path: &Path,
        recorded: RecordedProgram<'_>,
        axis: &MeasuredAxis,
        speeds: &[f64],
    ) -> Result<FrictionFound, Failure> {
        let judge =
            |motor: &str, recording: &AxisRecording| self.judge(recorded, recording, motor, speeds);
        let mut mean = self.motor(path, recorded.plan, [&axis.name; 2])?;
        if axis.followers.is_empty() {
            return judge(&axis.name, &mean);
        }
        let recordings = match self.followers(path, recorded.plan, (axis, &mean)) {
            Ok(recordings) => recordings,
            Err(reason) => {
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
            let found = judge(motor, recording)
                .map_err(|failure| Failure::new(format!("{motor}: {}", failure.sentence())))?;
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
        plan: &Plan,
        (axis, master): (&MeasuredAxis, &AxisRecording),
    ) -> Result<Vec<AxisRecording>, String> {
        if !self.torque.is_of_each() {
            return Err(
                "their torque is not read: name the channels of all motors, `--torque %.ActTorque`"
                    .to_owned(),
            );
        }
        let followers = axis.followers.iter();
        let read = followers.map(|motor| {
            let recording = self
                .motor(path, plan, [&axis.name, motor])
                .map_err(|failure| failure.sentence())?;
            if recording.track.times_s != master.track.times_s {
                return Err(format!(
                    "that of {motor} has other samples than that of {}",
                    axis.name
                ));
            }
            Ok(recording)
        });
        read.collect()
    }

    /// Returns the motion of an axis with the torque of one motor.
    fn motor(
        &self,
        path: &Path,
        plan: &Plan,
        [axis, motor]: [&str; 2],
    ) -> Result<AxisRecording, Failure> {
        let cycle = self.cycle.seconds()?;
        let torque = self.selection(motor, plan)?.torque;
        let torque = torque.map(|it| it.replace('%', motor));
        let mut with = self.followed(axis, plan)?;
        with.torque.clone_from(&torque);
        let mut without = self.selection(axis, plan)?;
        without.torque = torque;
        // An actual position in addition to the commanded one is only a check, and may be missing here.
        let read = |selection| read_axis(path, selection, cycle, &Disk::default());
        Ok(read(&with).or_else(|_| read(&without))?)
    }

    /// Identifies the friction in the torque of one motor.
    fn judge(
        &self,
        recorded: RecordedProgram<'_>,
        recording: &AxisRecording,
        motor: &str,
        speeds: &[f64],
    ) -> Result<FrictionFound, Failure> {
        let options = IdentifyOptions {
            measured: Measured {
                // The program itself switches compensation.
                compensation: Some(recorded.wanted()),
                ..recording.measured.stated(self.kind.torque_kind, None)
            },
            wanted: RequestedPoints::Points(12),
            ..IdentifyOptions::default()
        };
        let elsewhere = actual_elsewhere(&recording.track, &recording.following_errors);
        let track = recording.track.clone().since(recorded.from_s);
        let found =
            identify(&track, &options).map_err(|error| refusal(error, &recording.findings))?;
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
