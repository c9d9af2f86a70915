//! The channels of a recorded trace on the command line.

use std::path::Path;

use clap::{Args, ValueEnum};

use super::per_axis::{ByAxis, PerAxis};
use super::quantities;
use crate::output::Failure;
use frictcomp_host::{Disk, FileRegistry, MachineOptions, Machines, channels_of, named_axes};
use frictcomp_physics::current::Switched;
use frictcomp_recordings::identify::{AxisRecording, TorqueKind};
use frictcomp_recordings::trace::{Channel, ChannelQuantity, ChannelSelection, Unit};
use frictcomp_report::visible_line;

/// Options for the channels of the motion of an axis. In each of them `%` stands for the name of the axis.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct MotionChannels {
    /// The channel of the times in a recording: its name, comment or CNC object
    #[arg(long, value_name = "CHANNEL")]
    pub(crate) time: Option<String>,
    /// The channel of the commanded positions; `%` stands for the name of the axis: `%.SetPos`, or `X=CHANNEL`
    #[arg(long, value_name = "CHANNEL")]
    position: Vec<PerAxis>,
    /// The channel of the commanded velocities: `%.SetVelo`
    #[arg(long, value_name = "CHANNEL")]
    velocity: Vec<PerAxis>,
    #[command(flatten)]
    pub(crate) unit: UnitArgs,
    /// The way of the axis in mm in a turn of its motor, where positions and velocities are recorded in turns,
    /// degrees or radians of the motor; by default `lead` of the axis in `frictcomp.toml`
    #[arg(long, value_name = "MM", value_parser = parse_lead)]
    lead: Option<f64>,
}

impl MotionChannels {
    /// Returns the axes that the user's names of channels mean in a recording; `None` where none is named.
    pub(crate) fn axes_in(&self, recording: &Path) -> Result<Option<Vec<String>>, Failure> {
        let given: Vec<&PerAxis> = self.position.iter().chain(&self.velocity).collect();
        if given.is_empty() {
            return Ok(None);
        }
        Ok(Some(axes_meant(
            &channels_of(recording, &Disk::default())?,
            &given,
        )))
    }

    /// Returns the user's selection of the channels of one of some axes.
    pub(crate) fn of_axis(&self, name: &str, axes: &[&str]) -> Result<ChannelSelection, Failure> {
        let of = |option, given| ByAxis::new(option, given, axes).channel(name);
        Ok(ChannelSelection {
            axis: named(name),
            time: self.time.clone(),
            position: of("--position", &self.position)?,
            velocity: of("--velocity", &self.velocity)?,
            units: self.unit.unit.clone(),
            lead_mm: self.lead,
            ..ChannelSelection::default()
        })
    }
}

/// Option for the channel of the torque.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct TorqueChannel {
    /// The channel of the torque or the current, that of `dig_drv.act_torque`: `%.ActTorque`
    #[arg(long, value_name = "CHANNEL")]
    torque: Vec<PerAxis>,
}

impl TorqueChannel {
    /// Returns whether each axis has a channel of its own.
    pub(crate) fn is_of_each(&self) -> bool {
        self.torque.len() > 1 || self.torque.iter().any(PerAxis::is_pattern)
    }

    /// Returns the channel of one of some axes.
    pub(crate) fn of_axis(&self, name: &str, axes: &[&str]) -> Result<Option<String>, Failure> {
        ByAxis::new("--torque", &self.torque, axes).channel(name)
    }
}

/// Options for the channels of the positions that an axis reached.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct FollowedChannels {
    /// The channel of the actual positions, in addition to the commanded ones: `%.ActPos`
    #[arg(long, value_name = "CHANNEL")]
    pub(crate) actual_position: Vec<PerAxis>,
    /// The channel of the following error, commanded less actual position: `%.PosDiff`
    #[arg(long, value_name = "CHANNEL", conflicts_with = "actual_position")]
    following_error: Vec<PerAxis>,
}

impl FollowedChannels {
    /// Adds the channels of one of some axes to its others.
    pub(crate) fn added_to(
        &self,
        others: ChannelSelection,
        (name, axes): (&str, &[&str]),
    ) -> Result<ChannelSelection, Failure> {
        let of = |option, given| ByAxis::new(option, given, axes).channel(name);
        Ok(ChannelSelection {
            actual_position: of("--actual-position", &self.actual_position)?,
            following_error: of("--following-error", &self.following_error)?,
            ..others
        })
    }
}

/// Option for the units of channels.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct UnitArgs {
    /// The unit of a channel, where the file does not name it: `--unit SetVelo=mm/s`
    #[arg(long, value_name = "CHANNEL=UNIT", value_parser = parse_unit)]
    pub(crate) unit: Vec<(String, Unit)>,
}

/// Options for the channels of a recorded circle.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct CircleChannelArgs {
    /// The channel of the actual positions of an axis, its name, comment or CNC object: `X=ActPosX`, or `%.ActPos`
    /// with `%` for the name of the axis
    #[arg(long, value_name = "CHANNEL")]
    position: Vec<PerAxis>,
    /// The channel of the times in a recording
    #[arg(long, value_name = "CHANNEL")]
    time: Option<String>,
    #[command(flatten)]
    unit: UnitArgs,
}

impl CircleChannelArgs {
    /// Refuses channels if there is no recording.
    pub(crate) fn refuse_without_recording(&self) -> Result<(), Failure> {
        let given = [
            ("--position", !self.position.is_empty()),
            ("--time", self.time.is_some()),
            ("--unit", !self.unit.unit.is_empty()),
        ];
        given.iter().find(|it| it.1).map_or(Ok(()), |(option, _)| {
            let message = format!("`{option}` is about a recording, and none is given");
            Err(Failure::new(message).with_help("name it, `frictcomp circle RECORDING`"))
        })
    }

    /// Returns the channels of both axes.
    pub(crate) fn selections(&self) -> Result<[ChannelSelection; 2], Failure> {
        let axes = &["X", "Y"];
        let of = |axis: &str| {
            Ok::<_, Failure>(ChannelSelection {
                axis: Some(axis.to_owned()),
                time: self.time.clone(),
                position: ByAxis::new("--position", &self.position, axes).channel(axis)?,
                units: self.unit.unit.clone(),
                ..ChannelSelection::default()
            })
        };
        Ok([of(axes[0])?, of(axes[1])?])
    }
}

/// Options for the channels of the motion and the torque of axes.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct AxisChannelArgs {
    /// The axes, by their names, or by their numbers in CNC objects; none is needed where the recording has only one
    #[arg(long = "axis", value_name = "AXES", value_delimiter = ',')]
    axes: Vec<String>,
    #[command(flatten)]
    torque: TorqueChannel,
    #[command(flatten)]
    motion: MotionChannels,
}

impl AxisChannelArgs {
    /// Takes the axes that the names of channels mean in a recording, or else those by whose names its channels are
    /// recognised: the ones for which a list is given, or the only one, if no axis is given.
    pub(crate) fn find_axes(&mut self, recording: &Path, lists: &[PerAxis]) -> Result<(), Failure> {
        if self.axes.is_empty() {
            let channels = channels_of(recording, &Disk::default())?;
            let motion = self.motion.position.iter().chain(&self.motion.velocity);
            let given: Vec<&PerAxis> = motion.chain(&self.torque.torque).collect();
            self.axes = axes_meant(&channels, &given);
            let mut named = named_axes(&channels);
            if named.len() > 1 {
                named.retain(|axis| lists.iter().any(|list| list.is_of(axis)));
            }
            if self.axes.is_empty() && (named.len() == 1 || !lists.is_empty()) {
                self.axes.append(&mut named);
            }
        }
        Ok(())
    }

    /// Returns the user's selection of the channels of an axis in a recording. The way in a turn of the motor is that
    /// of the machine to whose folder the recording belongs, if it is not given.
    pub(crate) fn selection(
        &self,
        axis: &str,
        recording: &Path,
        registry: &FileRegistry,
    ) -> Result<ChannelSelection, Failure> {
        let all = &self.axes();
        let selection = self.motion.of_axis(axis, all)?;
        let lead_mm = match selection.lead_mm {
            Some(given) => Some(given),
            None => lead_of_machine(axis, recording, registry)?,
        };
        Ok(ChannelSelection {
            torque: self.torque.of_axis(axis, all)?,
            lead_mm,
            ..selection
        })
    }

    /// Returns the names of the axes; if none is given, the empty name of the only one.
    pub(crate) fn axes(&self) -> Vec<&str> {
        match &self.axes[..] {
            [] => vec![""],
            given => given.iter().map(String::as_str).collect(),
        }
    }

    /// Returns the name of the only axis, empty if none is given.
    pub(crate) fn sole_axis(&self, what: &str) -> Result<&str, Failure> {
        match &self.axes[..] {
            [] => Ok(""),
            [only] => Ok(only),
            several => {
                let axes = visible_line(&several.join(",")).into_owned();
                let message = format!("{what} one axis, and `--axis {axes}` names several");
                Err(Failure::new(message).with_help("name one axis in each call"))
            }
        }
    }
}

/// Returns the axes that names of channels mean in a recording: those for which a pattern names a channel, and those that
/// `X=CHANNEL` gives.
fn axes_meant(channels: &[Channel], given: &[&PerAxis]) -> Vec<String> {
    let mut axes: Vec<String> = Vec::new();
    for channel in channels {
        for axis in given
            .iter()
            .flat_map(|it| [&channel.name, &channel.symbol].map(|name| it.axis_of(name)))
            .flatten()
        {
            if !axes.iter().any(|it| it == axis) {
                axes.push(axis.to_owned());
            }
        }
    }
    axes
}

/// Returns the name of an axis, if one was given.
pub(crate) fn named(axis: &str) -> Option<String> {
    (!axis.is_empty()).then(|| axis.to_owned())
}

/// Refuses recordings of several axes of which two are the same: they have the same channels.
pub(crate) fn refuse_alike<'a, T: PartialEq + 'a>(
    recorded: impl Iterator<Item = (&'a str, &'a T)>,
) -> Result<(), Failure> {
    let mut earlier: Vec<(&str, &T)> = Vec::new();
    for (axis, track) in recorded {
        if let Some((other, _)) = earlier.iter().find(|it| it.1 == track) {
            let [other, axis] = [other, axis].map(visible_line);
            let message = format!("the channels of {axis} are those of {other}");
            return Err(Failure::new(message).with_help(
                "name those of each axis, `AXIS=CHANNEL`, or `%` for the name of the axis",
            ));
        }
        earlier.push((axis, track));
    }
    Ok(())
}

/// Returns the way in a turn of the motor of an axis of a machine, or of its only one, in mm.
fn lead_of_machine(
    axis: &str,
    recording: &Path,
    registry: &FileRegistry,
) -> Result<Option<f64>, Failure> {
    let folder = recording.parent().unwrap_or(Path::new(""));
    let loaded = Machines::new(MachineOptions::default(), registry).for_folder(folder)?;
    let found = match loaded.machine.axes.as_slice() {
        [only] if axis.is_empty() => Some(only),
        described => described.iter().find(|it| it.name == axis),
    };
    Ok(found.and_then(|it| it.motor_lead_mm))
}

/// Option for the kind of recorded torque.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct TorqueKindArgs {
    /// Which torque was recorded: `actual`, as the drive measures it, `command` or `loop`, the output of
    /// the speed controller; by default taken from the name of the channel
    #[arg(long, value_name = "KIND")]
    pub(crate) torque_kind: Option<TorqueKind>,
}

/// What the user knows about the recorded torque.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct TorqueArgs {
    #[command(flatten)]
    pub(crate) kind: TorqueKindArgs,
    /// Whether friction compensation was on while recording; by default taken from a channel `comp`
    #[arg(long, value_name = "STATE")]
    compensation: Option<SwitchState>,
}

/// On or off.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum SwitchState {
    On,
    Off,
}

impl TorqueArgs {
    /// Returns a recording with the properties of the torque that the user gave.
    pub(crate) fn about(&self, recording: AxisRecording) -> AxisRecording {
        recording.stated(self.kind.torque_kind, self.switched())
    }

    /// Returns the state of friction compensation, if it is given.
    pub(crate) fn switched(&self) -> Option<Switched> {
        self.compensation.map(|state| match state {
            SwitchState::On => Switched::On,
            SwitchState::Off => Switched::Off,
        })
    }
}

/// Parses `NAME=UNIT`; a name may contain `=`, a unit does not.
fn parse_unit(text: &str) -> Result<(String, Unit), String> {
    let (name, unit) = text
        .rsplit_once('=')
        .ok_or_else(|| "write `CHANNEL=UNIT`, such as `SetVelo=mm/s`".to_owned())?;
    let unit = Unit::parse(unit)
        .ok_or_else(|| format!("`{unit}` is not a known unit; known are {}", Unit::NAMED))?;
    Ok((name.trim().to_owned(), unit))
}

/// Parses the unit of the times where the other values are shown as the file has them.
pub(crate) fn parse_time_unit(text: &str) -> Result<(String, Unit), String> {
    let given = parse_unit(text)?;
    if given.1.quantity == ChannelQuantity::Time {
        Ok(given)
    } else {
        Err(
            "values are shown as the file has them; only the times need a unit, such as `t=ms`"
                .to_owned(),
        )
    }
}

/// Parses the way in a turn, in mm.
fn parse_lead(text: &str) -> Result<f64, String> {
    let lead = quantities::mm(text)?;
    let lead = Some(lead).filter(|it| *it > 0.0 && *it <= 1e6);
    lead.ok_or_else(|| "write the mm in a turn, such as `10`".to_owned())
}
