//! The channels of one axis in a recording.

use super::finding::TraceFinding;
use super::track::Track;
use crate::diagnostic::Code;
use crate::trace::{
    Channel, ChannelQuantity, ChannelSelection, Choice, NotAligned, Pick, SelectError, TimeSource,
    TraceRecording,
};

/// Which channels are the motion and the torque of an axis.
#[derive(Debug, Clone, Default)]
pub struct AxisChannels {
    time: Option<Pick>,
    velocity: Option<Pick>,
    position: Option<Pick>,
    torque: Option<Pick>,
}

/// What was recorded of an axis, and what there is to say about it.
#[derive(Debug, Clone, Default)]
pub struct AxisRecording {
    /// Motion and torque.
    pub track: Track,
    /// The unit of the torque, where it is no drive unit.
    pub torque_unit: Option<String>,
    /// How the file was read, each a sentence in lower case.
    pub remarks: Vec<String>,
    /// What may be wrong with it.
    pub findings: Vec<TraceFinding>,
}

impl AxisChannels {
    /// The channels that the user names, and those with the short names `t`, `v`, `x`, `torque`.
    ///
    /// # Errors
    /// A channel that is named or needed is not there.
    pub fn find(selection: &ChannelSelection, channels: &[Channel]) -> Result<Self, SelectError> {
        let find = |quantity| selection.find(quantity, channels);
        let found = Self {
            time: find(ChannelQuantity::Time)?,
            velocity: find(ChannelQuantity::Velocity)?,
            position: find(ChannelQuantity::Position)?,
            torque: Some(selection.require(ChannelQuantity::Torque, channels)?),
        };
        if found.velocity.is_none() && found.position.is_none() {
            selection.require(ChannelQuantity::Velocity, channels)?;
        }
        Ok(found)
    }

    /// What is kept of the file.
    pub fn choice(&self) -> Choice {
        Choice {
            values: self.picks().map(|(_, pick)| pick.channel).collect(),
            time: self.time.map_or(TimeSource::Layout, TimeSource::Channel),
            ..Choice::default()
        }
    }

    fn picks(&self) -> impl Iterator<Item = (ChannelQuantity, Pick)> {
        let picks = [
            (ChannelQuantity::Velocity, self.velocity),
            (ChannelQuantity::Position, self.position),
            (ChannelQuantity::Torque, self.torque),
        ];
        picks
            .into_iter()
            .filter_map(|(quantity, pick)| Some((quantity, pick?)))
    }

    /// The samples of the channels at common times. Rows without times are `cycle_s` apart.
    ///
    /// # Errors
    /// There are no common times.
    pub fn take(
        &self,
        recording: &TraceRecording,
        cycle_s: Option<f64>,
    ) -> Result<AxisRecording, NotAligned> {
        let picks: Vec<Pick> = self.picks().map(|(_, pick)| pick).collect();
        let aligned = recording.align(&picks, cycle_s)?;
        let mut columns = aligned.columns.into_iter();
        let mut column = |pick: Option<Pick>| pick.and_then(|_| columns.next());
        let track = Track {
            times_s: aligned.times_s,
            velocities: column(self.velocity),
            positions: column(self.position),
            torques: column(self.torque).unwrap_or_default(),
            step_s: aligned.step_s,
        };
        let mut remarks = recording.remarks().to_vec();
        remarks.extend(aligned.remarks);
        let drawn = self
            .picks()
            .map(|(_, pick)| &recording.channels()[pick.channel.get()]);
        for channel in drawn.filter(|channel| channel.is_drawn_scaled) {
            remarks.push(format!(
                "Scope draws `{}` with a factor or an offset, its samples are taken as they are",
                channel.name
            ));
        }
        let torque = self.torque.filter(|pick| !pick.unit.is_of_the_drive);
        let unit_of = |pick: Pick| recording.channels()[pick.channel.get()].unit.clone();
        Ok(AxisRecording {
            track,
            torque_unit: torque
                .map(|pick| unit_of(pick).unwrap_or_else(|| "its own unit".to_owned())),
            remarks,
            findings: self.unit_findings(recording),
        })
    }

    /// FC519 for every unit that nobody named, unless the channel has the short name that says it.
    fn unit_findings(&self, recording: &TraceRecording) -> Vec<TraceFinding> {
        let finding = |(quantity, pick): (ChannelQuantity, Pick)| {
            let channel = &recording.channels()[pick.channel.get()];
            let name = &channel.name;
            let is_short = ["v", "x", "torque"]
                .iter()
                .any(|it| name.eq_ignore_ascii_case(it));
            if !pick.unit.is_of_the_drive {
                return Some(TraceFinding::new(
                    Code::Fc519,
                    format!(
                        "`{name}` is in {}, and so is every `out`",
                        channel.unit.as_deref().unwrap_or("no drive units")
                    ),
                    "a value list has the unit of `dig_drv.act_torque`; record that, or convert the outputs",
                ));
            }
            (pick.is_unit_assumed && (!is_short || channel.unit.is_some())).then(|| {
                TraceFinding::new(
                    Code::Fc519,
                    format!(
                        "`{name}` has no known unit and is taken in {}",
                        quantity.own_unit()
                    ),
                    format!("name it, as in `{name}=mm/s`, where that is not so"),
                )
            })
        };
        self.picks().filter_map(finding).collect()
    }
}
