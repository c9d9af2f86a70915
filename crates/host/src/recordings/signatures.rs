//! The programs in a recording, identified by their signatures (R16.1), and the switches of compensation (R16.9).

use std::path::Path;

use super::trace_error::TraceError;
use super::traces::read_trace;
use crate::disk::Disk;
use crate::error::HostError;
use frictcomp_physics::current::{POSITION_UNITS_PER_MM, Switched, VELOCITY_UNITS_PER_MM_PER_S};
use frictcomp_recordings::commission::{Signature, signature_in};
use frictcomp_recordings::identify::state_channel;
use frictcomp_recordings::trace::{
    ChannelQuantity, ChannelSelection, Choice, Pick, SelectError, TimeSource,
};

/// A signature in a recording, and the time in s at which its strokes end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SignedAt {
    /// The signature.
    pub(crate) signature: Signature,
    /// The end of its strokes in the times of the recording.
    pub(crate) end_s: f64,
}

/// Returns the signatures in the motion of an axis, whose channels are its position or its velocity; rows without
/// times are `cycle_s` apart. None if the recording has no such channel. A position without a unit is
/// tried in 0.1 µm and in mm.
///
/// # Errors
/// The file cannot be read, or is not a recording.
pub(crate) fn signatures_of(
    path: &Path,
    selection: &ChannelSelection,
    cycle_s: Option<f64>,
) -> Result<Vec<SignedAt>, HostError> {
    let mut motion: Option<(ChannelQuantity, Pick)> = None;
    let recording = read_trace(path, &Disk::default(), |channels| {
        let find = |quantity| selection.find(quantity, channels);
        let named = |quantity| Ok::<_, SelectError>(find(quantity)?.map(|pick| (quantity, pick)));
        motion = match named(ChannelQuantity::Position)? {
            Some(found) => Some(found),
            None => named(ChannelQuantity::Velocity)?,
        };
        let time = find(ChannelQuantity::Time)?;
        Ok(Choice {
            values: motion.iter().map(|(_, pick)| pick.channel).collect(),
            time: time.map_or(TimeSource::Layout, TimeSource::Channel),
            ..Choice::default()
        })
    })?;
    let Some((quantity, pick)) = motion else {
        return Ok(Vec::new());
    };
    let aligned = recording.align(&[pick], cycle_s);
    let aligned = aligned.map_err(|reason| TraceError::Apart {
        path: path.to_owned(),
        reason,
    })?;
    let step_s = aligned.step_s;
    let samples = aligned.columns.first().map_or(&[][..], Vec::as_slice);
    let places: Vec<Vec<f64>> = if quantity == ChannelQuantity::Position {
        let scales = [
            Some(POSITION_UNITS_PER_MM),
            pick.is_unit_assumed.then_some(1.0),
        ];
        let in_mm = |scale: f64| samples.iter().map(|it| it / scale).collect();
        scales.into_iter().flatten().map(in_mm).collect()
    } else {
        let way = samples.iter().scan(0.0, |place, speed| {
            *place += speed / VELOCITY_UNITS_PER_MM_PER_S * step_s;
            Some(*place)
        });
        vec![way.collect()]
    };
    let found = places.iter().flat_map(|place| signature_in(place, step_s));
    let at = |(signature, sample): (Signature, usize)| SignedAt {
        signature,
        end_s: aligned.times_s.get(sample).copied().unwrap_or_default(),
    };
    Ok(found.map(at).collect())
}

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
