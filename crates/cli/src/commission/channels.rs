//! The channels of recordings, as named on the command line.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use crate::channels::{FollowedChannels, MotionChannels, TorqueChannel, TorqueKindArgs};
use crate::cycle::CycleArgs;
use crate::failure::Failure;
use frictcomp_physics::circle::Circle;
use frictcomp_recordings::commission::{MeasuredAxis, Plan};
use frictcomp_recordings::trace::ChannelSelection;
use frictcomp_report::visible_line;

/// Channels of the recordings.
#[derive(Debug, Clone, Args, Serialize)]
pub(super) struct ReadingArgs {
    #[command(flatten)]
    motion: MotionChannels,
    #[command(flatten)]
    pub(super) torque: TorqueChannel,
    #[command(flatten)]
    followed: FollowedChannels,
    #[command(flatten)]
    pub(super) cycle: CycleArgs,
    #[command(flatten)]
    pub(super) kind: TorqueKindArgs,
    /// The program of a recording without a signature, by its number: `friction.csv=1`
    #[arg(long, value_name = "FILE=NUMBER", value_parser = parse_role)]
    pub(super) role: Vec<(String, u16)>,
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

    /// Returns the CNC cycle in s.
    pub(super) fn cycle_time_s(&self) -> Result<f64, Failure> {
        let given = self.cycle.seconds()?;
        Ok(given.unwrap_or(Circle::default().cycle_time_s))
    }

    /// Returns the channels of circles.
    pub(super) fn circle_channels(&self, plan: &Plan) -> Result<[ChannelSelection; 2], Failure> {
        let of_axis = |at: usize| {
            let Some(MeasuredAxis { name, .. }) = plan.axes.get(at) else {
                return Ok::<_, Failure>(ChannelSelection::default());
            };
            let followed = self.followed(name, plan)?;
            Ok(ChannelSelection {
                position: followed.actual_position,
                actual_position: None,
                ..followed
            })
        };
        Ok([of_axis(0)?, of_axis(1)?])
    }

    /// Returns the channels of an axis with its actual position or its following error.
    pub(super) fn followed(&self, axis: &str, plan: &Plan) -> Result<ChannelSelection, Failure> {
        let selection = self.selection(axis, plan)?;
        self.followed.added_to(selection, (axis, &axes_of(plan)))
    }

    /// Returns the channels of an axis.
    pub(super) fn selection(&self, name: &str, plan: &Plan) -> Result<ChannelSelection, Failure> {
        let axes = axes_of(plan);
        Ok(ChannelSelection {
            torque: self.torque.of_axis(name, &axes)?,
            ..self.motion.of_axis(name, &axes)?
        })
    }
}

/// Returns the axes of a plan, each with the other motors of its gantry.
pub(super) fn axes_of(plan: &Plan) -> Vec<&str> {
    let axes = plan.axes.iter();
    let motors = axes.flat_map(|it| [&it.name].into_iter().chain(&it.followers));
    motors.map(String::as_str).collect()
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
