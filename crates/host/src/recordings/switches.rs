//! The times at which friction compensation was on in a recording (R16.9).

use std::path::Path;

use super::traces::read_trace;
use crate::disk::Disk;
use crate::error::HostError;
use frictcomp_physics::current::Switched;
use frictcomp_recordings::identify::state_channel;
use frictcomp_recordings::trace::{ChannelQuantity, ChannelSelection, Choice, Pick, TimeSource};

/// Returns the times in s at which the channel of the compensation of an axis changes, with its state from then on, the
/// first sample included; empty where the recording has none. Rows without times are `cycle_s` apart.
///
/// # Errors
/// The file cannot be read, or is not a recording.
pub(crate) fn switches_of(
    path: &Path,
    selection: &ChannelSelection,
    cycle_s: Option<f64>,
) -> Result<Vec<(f64, Switched)>, HostError> {
    let mut state: Option<Pick> = None;
    let recording = read_trace(path, &Disk::default(), |channels| {
        state = state_channel(selection, channels);
        let time = selection.find(ChannelQuantity::Time, channels)?;
        Ok(Choice {
            values: state.iter().map(|pick| pick.channel).collect(),
            time: time.map_or(TimeSource::Layout, TimeSource::Channel),
            ..Choice::default()
        })
    })?;
    let Some(state) = state else {
        return Ok(Vec::new());
    };
    let Ok(aligned) = recording.align(&[state], cycle_s) else {
        return Ok(Vec::new());
    };
    let samples = aligned.columns.first().map_or(&[][..], Vec::as_slice);
    let mut switches: Vec<(f64, Switched)> = Vec::new();
    for (&time_s, &value) in aligned.times_s.iter().zip(samples) {
        let now = if value == 0.0 {
            Switched::Off
        } else {
            Switched::On
        };
        if switches.last().is_none_or(|(_, last)| *last != now) {
            switches.push((time_s, now));
        }
    }
    Ok(switches)
}
