//! The recorded states of friction compensation.

use std::path::Path;

use crate::disk::Disk;
use crate::error::HostError;
use crate::recordings::{TraceError, lacks, numbers_of, position_column, read_trace};
use frictcomp::machine::Machine;
use frictcomp_physics::current::POSITION_UNITS_PER_MM;
use frictcomp_recordings::identify::{StatedAxis, stated_axis};
use frictcomp_recordings::replay::{RecordedAxis, RecordedChange, RecordedGap, StateRecording};
use frictcomp_recordings::trace::{
    Channel, ChannelIndex, ChannelQuantity, ChannelSelection, Choice, Clock, NotAligned, Pick,
    SelectError, TimeSource, TraceRecording,
};

/// Assignment of the channels.
#[derive(Debug, Clone, Default)]
pub struct ReplayChannels {
    /// The channel of the times, and units of channels.
    pub selection: ChannelSelection,
    /// Axes, each with the channel of its state.
    pub active: Vec<(String, String)>,
    /// Axes, each with the channel of its position.
    pub positions: Vec<(String, String)>,
    /// The channel of the line of the program.
    pub line: Option<String>,
    /// The channel of the block number, N.
    pub block: Option<String>,
    /// The channel of the program's running number, from 1.
    pub program: Option<String>,
}

/// The channels that were found.
#[derive(Default)]
struct RecordedChannels {
    axes: Vec<FoundAxis>,
    block: Option<ChannelIndex>,
    by_number: bool,
    program: Option<ChannelIndex>,
}

struct FoundAxis {
    name: String,
    state: ChannelIndex,
    /// The position with its factor to mm.
    position: Option<(ChannelIndex, f64)>,
}

/// Reads the states of friction compensation of the axes of a machine, with the blocks and positions where
/// they were recorded.
///
/// # Errors
/// The file cannot be read, has no channel with a state (R15.22), no times, or a state that is neither 0
/// nor 1.
pub fn read_states(
    path: &Path,
    channels: &ReplayChannels,
    machine: &Machine,
) -> Result<StateRecording, HostError> {
    let mut found = RecordedChannels::default();
    let recording = read_trace(path, &Disk::default(), |described| {
        found = channels.find(described, machine)?;
        let time = channels.selection.find(ChannelQuantity::Time, described)?;
        let axes = found.axes.iter();
        let values = axes.flat_map(|axis| {
            let position = axis.position.map(|(channel, _)| channel);
            std::iter::once(axis.state).chain(position)
        });
        Ok(Choice {
            values: values.chain(found.block).chain(found.program).collect(),
            time: time.map_or(TimeSource::Layout, TimeSource::Channel),
            ..Choice::default()
        })
    })?;
    let samples = RecordingSamples {
        path,
        recording: &recording,
        found: &found,
    };
    let axes = found.axes.iter().map(|axis| samples.axis(axis));
    Ok(StateRecording {
        axes: axes.collect::<Result<_, _>>()?,
        gap: samples.longest_gap(),
        by_number: found.by_number,
    })
}

impl ReplayChannels {
    fn find(
        &self,
        channels: &[Channel],
        machine: &Machine,
    ) -> Result<RecordedChannels, SelectError> {
        let named = |name: &str| {
            self.selection
                .pick_named(name, ChannelQuantity::Time, channels)
        };
        let short = |name: &str| {
            let found = channels
                .iter()
                .position(|it| it.name.eq_ignore_ascii_case(name));
            found.and_then(|at| named(&channels[at].name).ok())
        };
        let given = |option: &Option<String>, name: &str| match option {
            Some(option) => named(option).map(Some),
            None => Ok(short(name)),
        };
        let mut axes: Vec<FoundAxis> = Vec::new();
        for (axis, channel) in &self.active {
            axes.push(FoundAxis {
                name: axis.clone(),
                state: self
                    .of_axis(axis, (channel, ChannelQuantity::Time), channels)?
                    .channel,
                position: None,
            });
        }
        for channel in channels {
            let Some(name) = axis_of(channel, machine) else {
                continue;
            };
            if axes.iter().all(|axis| axis.name != name) {
                let object = channel.object.map(|it| it.to_string());
                let state = match (named(&channel.name), object) {
                    (Err(_), Some(object)) => named(&object)?,
                    (state, _) => state?,
                };
                axes.push(FoundAxis {
                    name,
                    state: state.channel,
                    position: None,
                });
            }
        }
        if axes.is_empty() {
            return Err(lacks(
                channels,
                "no channel with the state of friction compensation",
                "record of each axis the object `0x120300:0x<axis>0221`, `frict_comp.f_is_active`, or sample \
                 `V.A.FRICT_COMP_ACTIVE.<axis>` in the PLC; in a CSV file the column is `active_<axis>`, and \
                 any other is to be named",
            ));
        }
        for axis in &mut axes {
            axis.position = self.position_of(&axis.name, machine, channels)?;
        }
        let line = given(&self.line, "line")?.filter(|_| self.block.is_none());
        let block = match line {
            Some(_) => None,
            None => given(&self.block, "block")?.or_else(|| short("0x121301:0x21")),
        };
        Ok(RecordedChannels {
            axes,
            by_number: line.is_none() && block.is_some(),
            block: line.or(block).map(|pick| pick.channel),
            program: given(&self.program, "program")?.map(|pick| pick.channel),
        })
    }

    /// Returns the channel that is named for an axis.
    fn of_axis(
        &self,
        axis: &str,
        (name, quantity): (&str, ChannelQuantity),
        channels: &[Channel],
    ) -> Result<Pick, SelectError> {
        let selection = ChannelSelection {
            axis: Some(axis.to_owned()),
            ..self.selection.clone()
        };
        selection.pick_named(name, quantity, channels)
    }

    /// Returns the channel of the positions of an axis with its factor to mm.
    fn position_of(
        &self,
        axis: &str,
        machine: &Machine,
        channels: &[Channel],
    ) -> Result<Option<(ChannelIndex, f64)>, SelectError> {
        let position = ChannelQuantity::Position;
        let given = self.positions.iter().find(|(name, _)| name == axis);
        let pick = match given {
            Some((_, name)) => Some(self.of_axis(axis, (name, position), channels)?),
            None => match position_column(&self.selection, axis, channels)? {
                None => self.recognised_of(axis, machine, channels)?,
                column => column,
            },
        };
        Ok(pick.map(|pick| (pick.channel, pick.unit.factor / POSITION_UNITS_PER_MM)))
    }

    /// Returns the actual position of an axis that is recognised by its name or its number.
    fn recognised_of(
        &self,
        axis: &str,
        machine: &Machine,
        channels: &[Channel],
    ) -> Result<Option<Pick>, SelectError> {
        if let Some(found) = self.selection.actual_position_of(axis, channels)? {
            return Ok(Some(found));
        }
        let described = machine.axes.iter().find(|it| it.name == axis);
        let number = described.and_then(|it| it.number).map(|it| it.to_string());
        number.map_or(Ok(None), |it| {
            self.selection.actual_position_of(&it, channels)
        })
    }
}

/// Returns the axis whose state a channel holds, by its name, its symbol or its object.
pub(crate) fn axis_of(channel: &Channel, machine: &Machine) -> Option<String> {
    let mut axes = machine.axes.iter();
    match stated_axis(channel)? {
        StatedAxis::Named(written) => {
            let known = axes.find(|it| it.name.eq_ignore_ascii_case(&written));
            Some(known.map_or(written, |it| it.name.clone()))
        }
        StatedAxis::Numbered(number) => {
            let found = axes.find(|it| it.number == Some(number))?;
            Some(found.name.clone())
        }
        _ => None,
    }
}

/// The samples of a recording.
struct RecordingSamples<'a> {
    path: &'a Path,
    recording: &'a TraceRecording,
    found: &'a RecordedChannels,
}

impl RecordingSamples<'_> {
    fn axis(&self, axis: &FoundAxis) -> Result<RecordedAxis, TraceError> {
        let states = numbers_of(self.path, self.recording, axis.state)?;
        let times = self.times(axis.state)?;
        for state in states {
            if *state != 0.0 && (*state - 1.0).abs() > f64::EPSILON {
                return Err(TraceError::NoState {
                    path: self.path.to_owned(),
                    channel: self.recording.channels()[axis.state.get()].name.clone(),
                    value: *state,
                });
            }
        }
        let is_active = |at: usize| states[at] != 0.0;
        let whole = |channel: Option<ChannelIndex>, around: [f64; 2]| -> Result<_, TraceError> {
            let around = channel.map(|it| self.around(it, around)).transpose()?;
            Ok(around.flatten().map(|values| values.map(as_whole)))
        };
        let mut changes = Vec::new();
        for at in 1..states.len().min(times.len()) {
            if is_active(at) == is_active(at - 1) {
                continue;
            }
            let around = [times[at - 1], times[at]];
            let positions = match axis.position {
                Some((channel, factor)) => self
                    .around(channel, around)?
                    .map(|values| values.map(|it| it * factor)),
                None => None,
            };
            changes.push(RecordedChange {
                t_s: times[at],
                active: is_active(at),
                blocks: whole(self.found.block, around)?,
                programs: whole(self.found.program, around)?,
                positions,
            });
        }
        let ends = [times.first(), times.last()].map(|it| it.copied().unwrap_or_default());
        Ok(RecordedAxis {
            name: axis.name.clone(),
            start: states.first().is_some_and(|it| *it != 0.0),
            start_s: ends[0],
            changes,
            end_s: ends[1],
            blocks: whole(self.found.block, ends)?,
            programs: whole(self.found.program, ends)?,
        })
    }

    /// Returns the times of a channel, which increase.
    fn times(&self, channel: ChannelIndex) -> Result<&[f64], TraceError> {
        let times = self.recording.times_s(channel);
        let times = times.ok_or_else(|| TraceError::NoTimes(self.path.to_owned()))?;
        match times.windows(2).find(|pair| pair[1] <= pair[0]) {
            None => Ok(times),
            Some(pair) => Err(TraceError::Apart {
                path: self.path.to_owned(),
                reason: NotAligned::Backwards {
                    before_s: pair[0],
                    after_s: pair[1],
                },
            }),
        }
    }

    fn longest_gap(&self) -> Option<RecordedGap> {
        let states = self.found.axes.iter().map(|axis| axis.state);
        let clocks = states.filter_map(|state| Clock::of(self.recording.times_s(state)?));
        let gaps = clocks.filter(|clock| clock.gaps > 0);
        let gaps = gaps.map(|clock| RecordedGap {
            at_s: clock.gap_at_s,
            length_s: clock.longest_gap_s,
        });
        gaps.max_by(|one, other| one.length_s.total_cmp(&other.length_s))
    }

    /// Returns the values of a channel at two times; `None` where it had not yet begun.
    fn around(
        &self,
        channel: ChannelIndex,
        at_s: [f64; 2],
    ) -> Result<Option<[f64; 2]>, TraceError> {
        let values = numbers_of(self.path, self.recording, channel)?;
        let times = self.times(channel)?;
        let at = |time: f64| {
            let after = times.partition_point(|it| *it <= time);
            values.get(after.checked_sub(1)?).copied()
        };
        let [before, after] = at_s.map(at);
        Ok(before.zip(after).map(|(before, after)| [before, after]))
    }
}

#[allow(clippy::cast_possible_truncation)] // a line, a block number
fn as_whole(value: f64) -> i64 {
    value as i64
}
