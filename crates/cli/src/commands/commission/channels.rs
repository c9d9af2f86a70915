//! The channels of recordings, as named on the command line.

use std::path::PathBuf;

use clap::Args;

use crate::args::{CycleArgs, FollowedChannels, MotionChannels, TorqueChannel, TorqueKindArgs};
use crate::commands::identify::refusal;
use crate::output::Failure;
use frictcomp_host::commission::{CommissionChannels, UnusedRecording, motors_of};
use frictcomp_recordings::commission::{NotFollowed, PlanFile};
use frictcomp_recordings::trace::ChannelSelection;
use frictcomp_report::visible_line;

/// Channels of the recordings.
#[derive(Debug, Clone, Args)]
pub(super) struct ReadingArgs {
    #[command(flatten)]
    motion: MotionChannels,
    #[command(flatten)]
    torque: TorqueChannel,
    #[command(flatten)]
    followed: FollowedChannels,
    #[command(flatten)]
    cycle: CycleArgs,
    #[command(flatten)]
    kind: TorqueKindArgs,
    /// The program of a recording without a signature, by its number: `friction.csv=1`
    #[arg(long, value_name = "FILE=NUMBER", value_parser = parse_role)]
    role: Vec<(String, u16)>,
}

impl ReadingArgs {
    /// Returns the user's statements about the recordings.
    pub(super) fn said(&self) -> Vec<String> {
        let roles = self.role.iter();
        let mut said: Vec<String> = roles
            .map(|(file, number)| format!("{file} is the recording of program {number}"))
            .collect();
        let units = self.motion.unit.unit.iter();
        said.extend(units.map(|(channel, unit)| {
            let own = unit.quantity.own_unit();
            format!(
                "one unit of `{}` is {} {own}",
                visible_line(channel),
                unit.factor
            )
        }));
        if let Some(kind) = self.kind.torque_kind {
            said.push(format!("the recorded torque is the {} one", kind.as_str()));
        }
        said
    }

    /// Checks that the recordings whose programs are given exist.
    pub(super) fn check_roles(&self, paths: &[PathBuf]) -> Result<(), Failure> {
        let is_there = |file: &str| paths.iter().any(|it| it.ends_with(file));
        let absent = self.role.iter().find(|(file, _)| !is_there(file));
        absent.map_or(Ok(()), |(file, _)| {
            let message = format!(
                "`--role` names `{}`, and there is no such recording",
                visible_line(file)
            );
            Err(Failure::new(message).with_help("give the name of the file without its folder"))
        })
    }

    /// Returns the channels of every axis of plans, and of the other motors of gantries.
    pub(super) fn channels(&self, plans: &[PlanFile]) -> Result<CommissionChannels, Failure> {
        let axes = motors_of(plans);
        let of_axis = |name: &&str| {
            let selection = ChannelSelection {
                torque: self.torque.of_axis(name, &axes)?,
                is_for_several: true,
                ..self.motion.of_axis(name, &axes)?
            };
            let followed = self.followed.added_to(selection, (name, &axes))?;
            Ok(((*name).to_owned(), followed))
        };
        Ok(CommissionChannels {
            axes: axes.iter().map(of_axis).collect::<Result<_, Failure>>()?,
            has_each_torque: self.torque.is_of_each(),
            cycle_s: self.cycle.seconds()?,
            torque_kind: self.kind.torque_kind,
            roles: self.role.clone(),
        })
    }
}

/// Returns why a recording is not used, with the option that helps.
pub(super) fn words(unused: &UnusedRecording) -> String {
    let help = match unused {
        UnusedRecording::Host(error) => return Failure::from(error).sentence(),
        UnusedRecording::Friction { error, findings } => {
            return refusal(error.clone(), findings).sentence();
        }
        UnusedRecording::Motor { motor, reason } => return format!("{motor}: {}", words(reason)),
        UnusedRecording::OtherProgram { found, said } => {
            return format!("its strokes give the number {found}, but `--role` says {said}");
        }
        UnusedRecording::NoTorques => {
            return format!("{unused}: name the channels of all motors, `--torque %.ActTorque`");
        }
        UnusedRecording::NoSignature { file } => {
            format!("say `--role {file}=NUMBER` if you know its program")
        }
        UnusedRecording::NotFollowed(NotFollowed::Absent) => {
            "name them with `--following-error`, or `--actual-position` and `--position`".to_owned()
        }
        _ => return unused.to_string(),
    };
    format!("{unused}; {help}")
}

/// Parses `FILE=NUMBER`.
fn parse_role(text: &str) -> Result<(String, u16), String> {
    let parsed = text.rsplit_once('=').and_then(|(file, number)| {
        let number = number
            .trim()
            .parse()
            .ok()
            .filter(|it| (1..1024).contains(it))?;
        (!file.is_empty()).then(|| (file.to_owned(), number))
    });
    parsed
        .ok_or_else(|| "write the file and the number of its program, `friction.csv=1`".to_owned())
}
