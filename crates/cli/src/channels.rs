//! The channels of a recorded trace on the command line.

use std::path::Path;

use clap::{Args, ValueEnum};

use super::failure::Failure;
use super::quantities;
use frictcomp_host::{FileRegistry, MachineOptions, Machines};
use frictcomp_physics::current::Switched;
use frictcomp_recordings::identify::{Measured, TorqueKind};
use frictcomp_recordings::trace::{ChannelSelection, Unit};

/// Options for the channels of an axis's motion.
#[derive(Debug, Clone, Default, Args)]
pub(super) struct MotionChannels {
    /// The channel of the times in a trace: its name, comment or CNC object
    #[arg(long, value_name = "CHANNEL")]
    time: Option<String>,
    /// The channel of the positions
    #[arg(long, value_name = "CHANNEL")]
    position: Option<String>,
    /// The channel of the velocities
    #[arg(long, value_name = "CHANNEL")]
    velocity: Option<String>,
    /// The unit of a channel, where the file does not name it: `--unit SetVelo=mm/s`
    #[arg(long, value_name = "CHANNEL=UNIT", value_parser = parse_unit)]
    unit: Vec<(String, Unit)>,
    /// The way of the axis in mm in a turn of its motor, where positions and velocities are recorded in turns,
    /// degrees or radians of the motor; by default `lead` of the axis in `frictcomp.toml`
    #[arg(long, value_name = "MM", value_parser = parse_lead)]
    lead: Option<f64>,
}

impl MotionChannels {
    /// Returns the user's selection of channels.
    pub(super) fn selection(&self) -> ChannelSelection {
        ChannelSelection {
            time: self.time.clone(),
            position: self.position.clone(),
            velocity: self.velocity.clone(),
            units: self.unit.clone(),
            lead_mm: self.lead,
            ..ChannelSelection::default()
        }
    }
}

/// Options for the channels of an axis's motion and torque.
#[derive(Debug, Clone, Default, Args)]
pub(super) struct AxisChannelArgs {
    /// The axis, by its name, or by its number in CNC objects
    #[arg(long, value_name = "AXIS")]
    pub(super) axis: Option<String>,
    /// The channel of the torque or the current, that of `dig_drv.act_torque`
    #[arg(long, value_name = "CHANNEL")]
    torque: Option<String>,
    #[command(flatten)]
    motion: MotionChannels,
}

impl AxisChannelArgs {
    /// Returns the user's selection of the channels of a recording. The way in a turn of the motor is that of the
    /// machine to whose folder the recording belongs, if it is not given.
    pub(super) fn selection(
        &self,
        recording: &Path,
        registry: &FileRegistry,
    ) -> Result<ChannelSelection, Failure> {
        let selection = self.motion.selection();
        let lead_mm = match selection.lead_mm {
            Some(given) => Some(given),
            None => self.lead_of_machine(recording, registry)?,
        };
        Ok(ChannelSelection {
            axis: self.axis.clone(),
            torque: self.torque.clone(),
            lead_mm,
            ..selection
        })
    }

    /// Returns the way in a turn of the motor of the axis, or of the machine's only one, in mm.
    fn lead_of_machine(
        &self,
        recording: &Path,
        registry: &FileRegistry,
    ) -> Result<Option<f64>, Failure> {
        let folder = recording.parent().unwrap_or(Path::new(""));
        let loaded = Machines::new(MachineOptions::default(), registry).for_folder(folder)?;
        let described = loaded.machine.axes.as_slice();
        let axis = match (&self.axis, described) {
            (Some(name), _) => described.iter().find(|it| it.name == *name),
            (None, [only]) => Some(only),
            (None, _) => None,
        };
        Ok(axis.and_then(|it| it.motor_lead_mm))
    }
}

/// Option for the kind of recorded torque.
#[derive(Debug, Clone, Default, Args)]
pub(super) struct TorqueKindArgs {
    /// Which torque was recorded: `actual`, as the drive measures it, `command` or `loop`, the output of
    /// the speed controller; by default taken from the name of the channel
    #[arg(long, value_name = "KIND")]
    pub(super) torque_kind: Option<TorqueKind>,
}

/// What the user knows about the recorded torque.
#[derive(Debug, Clone, Default, Args)]
pub(super) struct TorqueArgs {
    #[command(flatten)]
    kind: TorqueKindArgs,
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
    /// Returns the known properties of the torque, with those given by the user.
    pub(super) fn measured(&self, recorded: Measured) -> Measured {
        let said = self.compensation.map(|state| match state {
            SwitchState::On => Switched::On,
            SwitchState::Off => Switched::Off,
        });
        recorded.stated(self.kind.torque_kind, said)
    }
}

/// Parses `NAME=UNIT`; a name may contain `=`, a unit does not.
pub(super) fn parse_unit(text: &str) -> Result<(String, Unit), String> {
    let (name, unit) = text
        .rsplit_once('=')
        .ok_or_else(|| "write `CHANNEL=UNIT`, such as `SetVelo=mm/s`".to_owned())?;
    let unit = Unit::parse(unit)
        .ok_or_else(|| format!("`{unit}` is not a known unit; known are {}", Unit::NAMED))?;
    Ok((name.trim().to_owned(), unit))
}

/// Parses the way in a turn, in mm.
fn parse_lead(text: &str) -> Result<f64, String> {
    let lead = quantities::mm(text)?;
    let lead = Some(lead).filter(|it| *it > 0.0 && *it <= 1e6);
    lead.ok_or_else(|| "write the mm in a turn, such as `10`".to_owned())
}
