//! `frictcomp.trace` and `frictcomp.verify`: what is in a recording, and whether a value list fits it.

use std::collections::HashMap;
use std::path::PathBuf;

use frictcomp::text::shown_path;
use frictcomp_host::{Disk, FileRegistry, read_axis, read_trace, read_value_list};
use frictcomp_recordings::identify::{Predictor, verify_recording};
use frictcomp_recordings::trace::{ChannelQuantity, ChannelSelection, Choice};
use frictcomp_report::results::trace::{self, TraceReport};
use frictcomp_report::results::verify::{self, VerifyReport};
use pyo3::prelude::*;

use crate::failure::Failure;
use crate::identify::{find_axis, given_units, switched};
use crate::json::JsonText;
use crate::words::{meant, meant_if_given, seconds};
use crate::work::interruptible;

/// The channels of a recording with their rates, lengths, ranges and gaps: the document of ``frictcomp trace --format json``.
///
/// ``time`` names the channel of the times, ``units`` its unit if the file does not.
#[pyfunction]
#[pyo3(name = "trace", signature = (recording, *, time=None, units=None))]
pub(crate) fn trace_recording(
    py: Python<'_>,
    recording: PathBuf,
    time: Option<String>,
    units: Option<HashMap<String, String>>,
) -> PyResult<JsonText> {
    let selection = ChannelSelection {
        time,
        units: given_units(units)?,
        ..ChannelSelection::default()
    };
    interruptible(py, move |_| {
        let read = read_trace(&recording, &Disk::default(), |channels| {
            let time = selection.find(ChannelQuantity::Time, channels)?;
            Ok(Choice::all(channels, time))
        })?;
        Ok(JsonText(trace::render_json(&TraceReport {
            name: shown_path(&recording),
            recording: &read,
        })))
    })
}

/// Compares a recorded torque with what a value list predicts: the document of ``frictcomp verify --format json``.
///
/// The channels are named as for ``identify``, which looks at the recording in the same way. ``actual_position`` or
/// ``following_error`` shows whether the list acted, and whether it is early or late at reversals.
#[pyfunction]
#[pyo3(name = "verify", signature = (recording, value_list, *, axis=None, time=None, position=None, velocity=None, torque=None, actual_position=None, following_error=None, units=None, cycle_time_ms=None, torque_kind=None, compensation=None, reading=None))]
// Each is a separate argument in Python.
#[allow(clippy::too_many_arguments)]
pub(crate) fn verify_list(
    py: Python<'_>,
    recording: PathBuf,
    value_list: PathBuf,
    axis: Option<String>,
    time: Option<String>,
    position: Option<String>,
    velocity: Option<String>,
    torque: Option<String>,
    actual_position: Option<String>,
    following_error: Option<String>,
    units: Option<HashMap<String, String>>,
    cycle_time_ms: Option<f64>,
    torque_kind: Option<&str>,
    compensation: Option<&str>,
    reading: Option<&str>,
) -> PyResult<JsonText> {
    let cycle_s = seconds(py, cycle_time_ms)?;
    let mut selection = ChannelSelection {
        axis,
        time,
        position,
        velocity,
        torque,
        actual_position,
        following_error,
        units: given_units(units)?,
        ..ChannelSelection::default()
    };
    let torque_kind = meant_if_given("torque_kind", torque_kind)?;
    let compensation = compensation.map(switched).transpose()?;
    let reading = meant("reading", reading)?;
    interruptible(py, move |_| {
        find_axis(&mut selection, &recording)?;
        let disk = Disk::default();
        let list = read_value_list(&value_list, &FileRegistry::default(), &disk)?.list;
        let read = read_axis(&recording, &selection, cycle_s, &disk)?;
        let mut read = read.stated(torque_kind, compensation);
        let predictor = Predictor {
            list: &list,
            reading,
            cycle_s,
        };
        let verified =
            verify_recording(&mut read, &predictor).map_err(Failure::of_identification)?;
        Ok(JsonText(verify::render_json(&[VerifyReport {
            axis: selection.axis,
            trace: shown_path(&recording),
            list: shown_path(&value_list),
            recording: read,
            verified,
        }])))
    })
}
