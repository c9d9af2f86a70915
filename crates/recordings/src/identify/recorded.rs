//! The channels of one axis in a recording.

use super::finding::TraceFinding;
use super::measured::{Measured, RATED_UNITS, TorqueKind};
use super::track::Track;
use super::unit_doubts::{improbable_speed, scope_scale};
use crate::trace::{
    AxisMotion, Channel, ChannelIndex, ChannelQuantity, ChannelRole, ChannelSelection, Choice,
    CncObject, NotAligned, Pick, SelectError, TimeSource, TraceRecording, Unit,
};
use frictcomp::diagnostic::Code;
use frictcomp_physics::current::Switched;

/// Channels of the motion and the torque of an axis.
#[derive(Debug, Clone, Default)]
pub struct AxisChannels {
    time: Option<Pick>,
    velocity: Option<Pick>,
    position: Option<Pick>,
    torque: Option<Pick>,
    /// Channel of the state of friction compensation.
    state: Option<Pick>,
    /// The actual position in addition to the commanded one, or the following error itself.
    followed: Option<(FollowingForm, Pick)>,
}

/// Form of the recorded following error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum FollowingForm {
    /// The following error itself.
    Error,
    /// The actual position.
    Actual,
}

/// Recording of an axis, with its remarks.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct AxisRecording {
    /// Motion and torque.
    pub track: Track,
    /// Commanded less actual position at each sample in 0.1 µm or 0.0001°; empty if it was not
    /// recorded.
    pub following_errors: Vec<f64>,
    /// Known properties of the torque.
    pub measured: Measured,
    /// The unit of the torque, if it is not in drive units.
    pub torque_unit: Option<String>,
    /// Steps in which the file was read, each a sentence in lower case.
    pub remarks: Vec<String>,
    /// Possible faults.
    pub findings: Vec<TraceFinding>,
}

/// The actual torque in drive units, with nothing else known.
impl From<Track> for AxisRecording {
    fn from(track: Track) -> Self {
        Self {
            track,
            ..Self::default()
        }
    }
}

impl AxisRecording {
    /// Returns the recording with the user's statements about the torque, which take precedence over its channels.
    #[must_use]
    pub fn stated(self, kind: Option<TorqueKind>, compensation: Option<Switched>) -> Self {
        Self {
            measured: self.measured.stated(kind, compensation),
            ..self
        }
    }
}

impl AxisChannels {
    /// Returns the channels that the user names, those with the short names `t`, `v`, `x`, `torque`, and the state of
    /// friction compensation.
    ///
    /// # Errors
    /// A channel that is named or needed is missing.
    pub fn find(selection: &ChannelSelection, channels: &[Channel]) -> Result<Self, SelectError> {
        let torque = selection.require(ChannelQuantity::Torque, channels)?;
        Self::with(Some(torque), selection, channels)
    }

    /// Finds the channels without requiring the torque.
    ///
    /// # Errors
    /// A channel that is named is missing, or neither a velocity nor a position exists.
    pub fn of_motion(
        selection: &ChannelSelection,
        channels: &[Channel],
    ) -> Result<Self, SelectError> {
        let torque = selection.find(ChannelQuantity::Torque, channels);
        Self::with(torque.unwrap_or_default(), selection, channels)
    }

    fn with(
        torque: Option<Pick>,
        selection: &ChannelSelection,
        channels: &[Channel],
    ) -> Result<Self, SelectError> {
        let find = |quantity| selection.find(quantity, channels);
        let found = Self {
            time: find(ChannelQuantity::Time)?,
            velocity: find(ChannelQuantity::Velocity)?,
            position: find(ChannelQuantity::Position)?,
            torque,
            state: state_channel(selection, channels),
            followed: followed_of(selection, channels)?,
        };
        if found.velocity.is_none() && found.position.is_none() {
            selection.require(ChannelQuantity::Velocity, channels)?;
        }
        selection.check_axis(found.picks(), channels)?;
        Ok(found)
    }

    /// Returns the channels to keep.
    pub fn choice(&self) -> Choice {
        Choice {
            values: self
                .picks()
                .map(|(_, pick)| pick)
                .chain(self.state)
                .chain(self.followed.map(|it| it.1))
                .map(|pick| pick.channel)
                .collect(),
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

    /// Returns the samples of the channels at common times. Rows without times are `cycle_s` apart.
    ///
    /// # Errors
    /// The channels have no common times.
    pub fn take(
        &self,
        recording: &TraceRecording,
        cycle_s: Option<f64>,
    ) -> Result<AxisRecording, NotAligned> {
        let picks = self.picks().map(|(_, pick)| pick);
        let picks: Vec<Pick> = picks.chain(self.followed.map(|it| it.1)).collect();
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
        let followed = column(self.followed.map(|it| it.1));
        let following_errors = match (self.followed, followed, &track.positions) {
            (Some((FollowingForm::Error, _)), Some(errors), _) => errors,
            (Some((FollowingForm::Actual, _)), Some(actual), Some(commanded)) => {
                commanded.iter().zip(&actual).map(|(x, y)| x - y).collect()
            }
            _ => Vec::new(),
        };
        let mut remarks = recording.remarks().to_vec();
        remarks.extend(aligned.remarks);
        let mut findings = self.unit_findings(recording);
        for (_, pick) in self.picks() {
            let channel = &recording.channels()[pick.channel.get()];
            let (remark, finding) = scope_scale(channel, recording.values(pick.channel));
            remarks.extend(remark);
            findings.extend(finding);
        }
        remarks.extend(self.names_that_were_taken(recording));
        let speed = self.velocity.or(self.position).and_then(|pick| {
            let channel = &recording.channels()[pick.channel.get()];
            improbable_speed(channel, &pick, &track)
        });
        findings.splice(0..0, speed);
        let torque = self.torque.filter(|pick| !pick.unit.is_of_the_drive);
        let unit_of = |pick: Pick| recording.channels()[pick.channel.get()].unit.clone();
        Ok(AxisRecording {
            track,
            torque_unit: torque
                .map(|pick| unit_of(pick).unwrap_or_else(|| "its own unit".to_owned())),
            remarks,
            following_errors,
            measured: self.measured(recording, torque.is_none()),
            findings,
        })
    }

    /// Returns the properties of the torque that its channel and the channel of the state show.
    fn measured(&self, recording: &TraceRecording, is_of_the_drive: bool) -> Measured {
        let channel = |pick: Pick| &recording.channels()[pick.channel.get()];
        let state = self.state.map(|pick| recording.values(pick.channel));
        let switched = |values: &[f64]| {
            let is_off = values.iter().all(|&it| it == 0.0);
            if is_off { Switched::Off } else { Switched::On }
        };
        Measured {
            kind: self.torque.and_then(|pick| TorqueKind::of(channel(pick))),
            compensation: state.filter(|it| !it.is_empty()).map(switched),
            rated: is_of_the_drive.then_some(RATED_UNITS),
            contradiction: None,
        }
    }

    /// Returns the units of channels that were chosen by their short names alone.
    fn names_that_were_taken(&self, recording: &TraceRecording) -> Option<String> {
        let taken = self.picks().filter_map(|(quantity, pick)| {
            let channel = &recording.channels()[pick.channel.get()];
            let is_said = channel.unit.is_some() || !pick.is_unit_assumed;
            (!is_said && is_short(&channel.name))
                .then(|| format!("`{}` in {}", channel.name, quantity.own_unit()))
        });
        let taken: Vec<String> = taken.collect();
        (!taken.is_empty()).then(|| format!("taken by their names: {}", taken.join(", ")))
    }

    /// Returns FC519 for every unit that gives reason for it.
    fn unit_findings(&self, recording: &TraceRecording) -> Vec<TraceFinding> {
        let findings = self.picks().filter_map(|(quantity, pick)| {
            unit_finding(&recording.channels()[pick.channel.get()], quantity, pick)
        });
        findings.collect()
    }
}

/// Returns FC519 for a unit that the recording does not give, unless the channel has a short name that implies it; for
/// a torque that is not in drive units; and for angles, which may be those of the motor of a linear axis (R6.26).
pub fn unit_finding(
    channel: &Channel,
    quantity: ChannelQuantity,
    pick: Pick,
) -> Option<TraceFinding> {
    let name = &channel.name;
    let (message, help) = if !pick.unit.is_of_the_drive {
        (
            format!(
                "`{name}` is in {}, and so is every `out`",
                channel.unit.as_deref().unwrap_or("no drive units")
            ),
            "a value list has the unit of `dig_drv.act_torque`; record that, or convert the outputs"
                .to_owned(),
        )
    } else if pick.unit.motion == Some(AxisMotion::Rotary) {
        (
            format!("`{name}` is in a unit of angles: where mm are shown, degrees are meant"),
            "that is right for a rotary axis; for a linear one give its lead, the mm in a turn of the motor"
                .to_owned(),
        )
    } else if pick.is_unit_assumed && (!is_short(name) || channel.unit.is_some()) {
        (
            format!(
                "`{name}` has no known unit and is taken in {}",
                quantity.own_unit()
            ),
            format!(
                "name it, as in `{name}={}`, where that is not so",
                quantity.example()
            ),
        )
    } else {
        return None;
    };
    Some(TraceFinding::new(Code::Fc519, message, help))
}

/// Returns the following error: the channel that the user names, `e`, the actual position `x_act`, or one that is
/// recognised.
fn followed_of(
    selection: &ChannelSelection,
    channels: &[Channel],
) -> Result<Option<(FollowingForm, Pick)>, SelectError> {
    let forms = [
        (FollowingForm::Error, &selection.following_error, "e"),
        (FollowingForm::Actual, &selection.actual_position, "x_act"),
    ];
    for (form, asked, taken) in forms {
        let is_there = |name: &&str| channels.iter().any(|it| it.name.eq_ignore_ascii_case(name));
        if let Some(name) = asked.as_deref().or(Some(taken).filter(is_there)) {
            let pick = selection.pick_named(name, ChannelQuantity::Position, channels)?;
            return Ok(Some((form, pick)));
        }
    }
    let roles = [
        (FollowingForm::Error, ChannelRole::FollowingError),
        (FollowingForm::Actual, ChannelRole::ActualPosition),
    ];
    for (form, role) in roles {
        if let Some(pick) = selection.recognised(role, channels)? {
            return Ok(Some((form, pick)));
        }
    }
    Ok(None)
}

/// Returns whether a channel has the short name that implies its unit.
fn is_short(name: &str) -> bool {
    ["v", "x", "torque"]
        .iter()
        .any(|it| name.eq_ignore_ascii_case(it))
}

/// The axis whose friction compensation a channel states.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum StatedAxis {
    /// The one of the recording: `comp`, or a variable without its axis.
    Own,
    /// Axis by its name: `active_<axis>`, `V.A.FRICT_COMP_ACTIVE.<axis>`.
    Named(String),
    /// Axis by its number in a CNC object.
    Numbered(u32),
}

/// Returns the axis whose friction compensation a channel states as on or off; `None` for any other channel (R6.29).
pub fn stated_axis(channel: &Channel) -> Option<StatedAxis> {
    const VARIABLE: &str = "FRICT_COMP_ACTIVE";
    const MEMBER: &str = "FRICT_COMP.F_IS_ACTIVE";
    const STATE: u32 = 0x221;
    let texts = [&channel.name, &channel.symbol].map(|text| text.to_uppercase());
    let of_variable = || {
        texts
            .iter()
            .find_map(|text| Some(text.split_once(VARIABLE)?.1))
    };
    if let Some(axis) = texts[0].strip_prefix("ACTIVE_").or_else(of_variable) {
        let axis = axis.trim_matches(|it: char| !it.is_alphanumeric());
        if !axis.is_empty() {
            return Some(StatedAxis::Named(axis.to_owned()));
        }
    }
    let is_state = |it: &CncObject| it.is_of_axis() && it.element() == STATE;
    if let Some(object) = channel.object.filter(is_state) {
        return Some(StatedAxis::Numbered(object.axis()));
    }
    let is_own = texts[0] == "COMP"
        || texts
            .iter()
            .any(|text| text.contains(VARIABLE) || text.ends_with(MEMBER));
    is_own.then_some(StatedAxis::Own)
}

/// Returns the channel that states whether the friction compensation of the axis is on: the only one, or that of the
/// selected axis.
pub fn state_channel(selection: &ChannelSelection, channels: &[Channel]) -> Option<Pick> {
    let states = channels.iter().enumerate();
    let states: Vec<(usize, StatedAxis)> = states
        .filter_map(|(at, channel)| Some((at, stated_axis(channel)?)))
        .collect();
    let is_selected = |(at, stated): &&(usize, StatedAxis)| match (stated, &selection.axis) {
        (StatedAxis::Named(name), Some(axis)) => name.eq_ignore_ascii_case(axis),
        (StatedAxis::Numbered(number), Some(axis)) if axis.parse() == Ok(*number) => true,
        (_, Some(_)) => selection.is_of_axis(&channels[*at]),
        _ => false,
    };
    let found = match &states[..] {
        [only] => only.0,
        all => {
            all.iter()
                .find(is_selected)
                .or_else(|| {
                    all.iter()
                        .find(|it| channels[it.0].name.eq_ignore_ascii_case("comp"))
                })?
                .0
        }
    };
    Some(Pick {
        channel: ChannelIndex::new(found),
        unit: Unit::own(ChannelQuantity::Time),
        is_unit_assumed: false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel(name: &str, symbol: &str, object: Option<CncObject>) -> Channel {
        Channel {
            name: name.to_owned(),
            symbol: symbol.to_owned(),
            object,
            ..Channel::default()
        }
    }

    #[test]
    fn a_state_is_found_in_every_way_it_is_recorded() {
        // R6.29
        let object = |offset| {
            Some(CncObject {
                group: 0x12_0300,
                offset,
            })
        };
        let of = |it: Channel| stated_axis(&it);
        assert_eq!(of(channel("Comp", "", None)), Some(StatedAxis::Own));
        assert_eq!(
            of(channel("active_Y", "", None)),
            Some(StatedAxis::Named("Y".to_owned()))
        );
        assert_eq!(
            of(channel("A", "GVL.V.A.FRICT_COMP_ACTIVE.X1", None)),
            Some(StatedAxis::Named("X1".to_owned()))
        );
        assert_eq!(
            of(channel("A", "Axis.frict_comp.f_is_active", None)),
            Some(StatedAxis::Own)
        );
        assert_eq!(
            of(channel("Channel 3", "", object(0x2_0221))),
            Some(StatedAxis::Numbered(2))
        );
        assert_eq!(of(channel("Channel 3", "", object(0x2_0115))), None);
        let channels = [
            channel("v", "", None),
            channel("Channel 2", "", object(0x1_0221)),
            channel("Channel 3", "", object(0x2_0221)),
            channel("active_Z", "", None),
        ];
        let picked = |axis: &str| {
            let selection = ChannelSelection {
                axis: Some(axis.to_owned()),
                ..ChannelSelection::default()
            };
            state_channel(&selection, &channels).map(|it| it.channel.get())
        };
        assert_eq!(
            [picked("1"), picked("2"), picked("z")],
            [Some(1), Some(2), Some(3)]
        );
        assert_eq!(picked("W"), None);
        let only = state_channel(&ChannelSelection::default(), &channels[..2]);
        assert_eq!(only.map(|it| it.channel.get()), Some(1));
    }
}
