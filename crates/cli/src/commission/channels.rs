//! The channels of recordings, as named on the command line.

use std::path::PathBuf;

use clap::Args;

use crate::channels::{TorqueKindArgs, parse_unit};
use crate::cycle::CycleArgs;
use crate::failure::Failure;
use frictcomp_host::CircleChannels;
use frictcomp_physics::circle::Circle;
use frictcomp_recordings::commission::Plan;
use frictcomp_recordings::trace::{ChannelSelection, Unit};
use frictcomp_report::visible_line;

/// Channels of the recordings; `%` stands for the axis name.
#[derive(Debug, Clone, Args)]
pub(super) struct ReadingArgs {
    /// The channel of the times in a recording
    #[arg(long, value_name = "CHANNEL")]
    time: Option<String>,
    /// The channel of the commanded positions; `%` stands for the axis name: `%.SetPos`
    #[arg(long, value_name = "CHANNEL")]
    position: Option<String>,
    /// The channel of the commanded velocities: `%.SetVelo`
    #[arg(long, value_name = "CHANNEL")]
    velocity: Option<String>,
    /// The channel of the torque: `%.ActTorque`
    #[arg(long, value_name = "CHANNEL")]
    pub(super) torque: Option<String>,
    /// The channel of the actual positions, of which circles are made: `%.ActPos`; by default `x` and `y`, in
    /// strokes `x_act`
    #[arg(long, value_name = "CHANNEL")]
    actual_position: Option<String>,
    /// The channel of the following error in strokes, in place of the actual positions: `%.PosDiff`; by default `e`
    #[arg(long, value_name = "CHANNEL")]
    following_error: Option<String>,
    /// The unit of a channel, where the file does not name it: `--unit SetVelo=mm/s`
    #[arg(long, value_name = "CHANNEL=UNIT", value_parser = parse_unit)]
    unit: Vec<(String, Unit)>,
    #[command(flatten)]
    pub(super) cycle: CycleArgs,
    #[command(flatten)]
    pub(super) kind: TorqueKindArgs,
    /// The program of a recording without a signature, by its number: `friction.csv=1`
    #[arg(long, value_name = "FILE=NUMBER", value_parser = parse_role)]
    pub(super) role: Vec<(String, u16)>,
}

impl ReadingArgs {
    /// Returns everything that affects how a recording is read.
    pub(super) fn key(&self) -> String {
        format!("{self:?}")
    }

    /// Returns everything that affects how recorded circles are read.
    pub(super) fn circles_key(&self) -> String {
        let (time, places) = (&self.time, &self.actual_position);
        format!("{time:?} {places:?} {:?} {:?}", self.unit, self.cycle)
    }

    /// Returns the user's statements about the recordings.
    pub(super) fn said(&self) -> Vec<String> {
        let roles = self.role.iter();
        let mut said: Vec<String> = roles
            .map(|(file, number)| format!("{file} is the recording of program {number}"))
            .collect();
        let units = self.unit.iter();
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
    pub(super) fn circle_channels(&self, plan: &Plan) -> CircleChannels {
        let of_axis = |at: usize| {
            let name = plan.axes.get(at).map(|it| it.name.as_str())?;
            let named = self
                .actual_position
                .as_deref()
                .map(|it| it.replace('%', name));
            named.or_else(|| (!["X", "Y"].contains(&name)).then(|| name.to_owned()))
        };
        CircleChannels {
            names: [of_axis(0), of_axis(1)],
            selection: ChannelSelection {
                time: self.time.clone(),
                units: self.unit.clone(),
                ..ChannelSelection::default()
            },
        }
    }

    /// Returns the channels of an axis with its actual position or its following error.
    pub(super) fn followed(&self, axis: &str) -> ChannelSelection {
        let named = |channel: &Option<String>| channel.as_ref().map(|it| it.replace('%', axis));
        ChannelSelection {
            actual_position: named(&self.actual_position),
            following_error: named(&self.following_error),
            ..self.selection(axis)
        }
    }

    /// Returns the channels of an axis.
    pub(super) fn selection(&self, axis: &str) -> ChannelSelection {
        let named = |channel: &Option<String>| channel.as_ref().map(|it| it.replace('%', axis));
        ChannelSelection {
            axis: Some(axis.to_owned()),
            time: self.time.clone(),
            position: named(&self.position),
            velocity: named(&self.velocity),
            torque: named(&self.torque),
            units: self.unit.clone(),
            ..ChannelSelection::default()
        }
    }
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
